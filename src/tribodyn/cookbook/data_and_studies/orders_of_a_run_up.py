"""Which orders does a recorded run-up contain?

The tacho gives the angle of the shaft; orders are then sharp although the speed changes.

Read on: measured-signals
"""

from tribodyn.measurement import order_map, shaft_angle, synthetic_run_up

run = synthetic_run_up({14.5: 0.3, 29: 2.0}, (0.0, 314.0), duration=8.0, noise=0.05)
angle = shaft_angle(run["tacho"], run.sample_rate, pulses_per_revolution=60)
orders = order_map(run["signal"], angle, 40, run.sample_rate, unit="m/s^2")
print(orders)
orders.plot().write_html("orders_of_a_run_up.html")
