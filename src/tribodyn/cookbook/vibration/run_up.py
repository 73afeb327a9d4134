"""What does a run-up on the test bench look like?

The motion while the speed rises, with its orders, overall level and resonances.

Read on: nonlinear, signals
"""

import tribodyn as td

case = td.load_case("fzg-12dof")
run = td.run_up(case, between=("500 rpm", "2500 rpm"), duration=0.5)
print(run)
run.plot_map().write_html("run_up.html")
