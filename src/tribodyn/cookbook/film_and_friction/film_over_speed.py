"""At which torque and speed does the film break down?

The least film of the mesh cycle over the speed, one curve per torque, by a film formula.

Read on: film, lubricants
"""

import tribodyn as td

case = td.load_case("fzg-roughness")
films = td.film_over_operation(
    case, torque=["30 N*m", "90 N*m", "300 N*m"], speed=["200 rpm", "900 rpm", "3000 rpm"]
)
print(films)
films.plot().write_html("film_over_speed.html")
