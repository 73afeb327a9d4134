"""One lubricated contact in five lines: two flanks under 148 N/mm, rolling at 3 m/s."""

from tribodyn.ehl import solve_line_contact
from tribodyn.lubricant import from_library

contact = solve_line_contact(147802.0, 8e-3, 3.0722, from_library("80W"), 2.2e11)
contact.plot().write_html("contact.html")
print(contact)

print(f"central film          {contact.central_film * 1e6:.4f} um")
print(f"minimum film          {contact.minimum_film * 1e6:.4f} um")
print(f"dry Hertz pressure    {contact.hertz_pressure * 1e-9:.4f} GPa")
print(f"outlet                {contact.outlet / contact.half_width:.4f} half widths")
print(f"film stiffness        {contact.film_stiffness(length=20e-3):.4e} N/m")
print(f"mass flux constant to {contact.flux_error:.1e}")
