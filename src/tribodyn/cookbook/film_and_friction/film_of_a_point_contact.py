"""How thick is the oil film of a point or elliptical contact?

Crowned flanks, balls and discs touch in a point. The radii are those of the gap along both axes,
and the oil may enter at any angle to them.

Read on: film
"""

from math import radians

from tribodyn.ehl import solve_point_contact
from tribodyn.lubricant import from_library

contact = solve_point_contact(
    normal_force=400.0,  # N
    radius_x=8e-3,  # m
    radius_y=24e-3,  # m
    entrainment_speed=3.07,  # m/s
    entrainment_angle=radians(20.0),
    lubricant=from_library("80W"),
    effective_modulus=2.2e11,  # Pa
)
print(f"film {1e6 * contact.central_film:.3f} um, minimum {1e6 * contact.minimum_film:.3f} um")
contact.plot().write_html("film_of_a_point_contact.html")
