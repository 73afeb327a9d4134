"""How do the planets of a stage share the load, and what are its natural modes?

A pin that is 30 um ahead takes load off its planet. Four planets share it in opposite pairs, three
with a floating sun equally. The modes are rotational, translational or of the planets alone.

Read on: planetary, dynamics
"""

import numpy as np

import tribodyn as td

stage = {"planets": 4, "sun_pressure_angle": np.radians(24.6), "sun_support": 0.0}
stage |= {"ring_pressure_angle": np.radians(24.6), "ring_support": 1e8, "carrier_support": 1e8}
stage |= {"ring_torsional_support": 1e9, "pin_stiffness": 1e8}  # N/m, over radius squared
stage |= {"sun_mesh_stiffness": 5e8, "ring_mesh_stiffness": 5e8}
stage |= {"carrier_mass": 5.43, "ring_mass": 2.35, "sun_mass": 0.40, "planet_mass": 0.66}
stage |= {"carrier_inertia": 6.29, "ring_inertia": 3.00}  # kg, over radius squared
stage |= {"sun_inertia": 0.39, "planet_inertia": 0.61}
for planets in (3, 4):
    errors = {"planets": planets, "pin_errors": [30e-6, 0.0, 0.0, 0.0][:planets]}
    shares = td.machine.load_shares(**stage | errors, force_per_planet=3000.0)
    print(f"{planets} planets: {shares.share.round(3)}, K_gamma = {shares.load_factor:.3f}")
modes = td.machine.planetary_modes(td.machine.planetary_plane_model(**stage))
print(modes)
modes.plot().write_html("planetary_stage.html")
