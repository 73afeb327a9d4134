"""How thick is the oil film of one contact?

The solver takes a line contact as load per width, radius and entrainment speed (half the sum of
the surface speeds). No gear and no case are needed.

Read on: film
"""

from tribodyn.ehl import solve_line_contact
from tribodyn.lubricant import from_library

film = solve_line_contact(
    load_per_width=148e3,  # N/m
    equivalent_radius=8e-3,  # m
    entrainment_speed=3.07,  # m/s
    lubricant=from_library("80W"),
    effective_modulus=2.2e11,  # Pa
)
print(f"central film {1e6 * film.central_film:.3f} um, minimum {1e6 * film.minimum_film:.3f} um")
film.plot().write_html("film_of_a_contact.html")
