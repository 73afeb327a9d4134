"""Coefficients of all friction laws for one tooth contact, also at lower sliding speed.

The first contact is that of an FZG type A pair at 90 N*m and 900 rpm, in the middle of the zone
where one tooth pair carries the full load.
"""

import numpy as np

import tribodyn as td
from tribodyn.friction import LAWS, TribologicalContact, pitch_point

options = {"constant": {"coefficient": 0.05}}
sliding = np.array([0.913038, 0.7, 0.5])  # m/s, pinion minus wheel
entrainment = np.full(3, 1.407953)  # m/s, half the sum of the surface speeds

contact = TribologicalContact(
    load_per_width=np.full(3, 133022.0),  # N/m
    hertz_pressure=np.full(3, 0.754725e9),  # Pa
    sliding_speed=sliding,
    entrainment_speed=entrainment,
    slide_to_roll_ratio=sliding / entrainment,
    equivalent_radius=np.full(3, 8.577181e-3),  # m
    dynamic_viscosity=0.082,  # Pa*s
    composite_roughness=0.53e-6,  # m
    oil_density=870.0,  # kg/m^3, for laws of the kinematic viscosity
    film_thickness=np.full(3, 0.5e-6),  # m, for laws of mixed lubrication
    pitch=pitch_point(td.load_case("fzg-roughness").gear_pair, 900.0 * np.pi / 30.0, 90.0),
)

print("sliding speed [m/s]   ", *(f"{speed:9.3f}" for speed in sliding))
for name, law in ((name, LAWS[name]) for name in LAWS):
    if law.needs_film:  # shears the solved oil film, which these contacts do not have
        continue
    coefficients = law(contact, **options.get(name, {}))
    print(f"{name:22}", *(f"{value:9.6f}" for value in coefficients))
