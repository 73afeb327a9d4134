"""Pressure and film of one tooth pair along the path of contact, animated.

Load, radius of curvature and speed change along the path. The figure has a slider and a play
button, and works offline.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import tribodyn as td
from tribodyn.contact import effective_modulus, path_of_contact
from tribodyn.ehl import solve_line_contacts
from tribodyn.plot import film_along_path

warnings.simplefilter("ignore", td.ModelWarning)  # of this pair and of its rough flanks
case = td.load_case("fzg-roughness")
mesh, pair = td.run(case).mesh, case.gear_pair

# The table counts pairs by the mesh cycles since they entered: its transpose is the life of a pair.
# Where the load jumps, a position occurs twice.
life = mesh.in_contact.T
columns = ("path", "load_per_width", "equivalent_radius", "entrainment_speed")
path, load, radius, speed = (getattr(mesh, column).T[life] for column in columns)
jumps = np.flatnonzero(np.abs(np.diff(load)) > 1e-2 * load[1:])
even = np.linspace(0, path.size - 1, 31).round().astype(int)
positions = np.unique(np.concatenate((even, jumps, jumps + 1)))
path, load, radius, speed = (values[positions] for values in (path, load, radius, speed))
steel, oil = case.material_properties, case.lubricant_properties
films = solve_line_contacts(
    load, radius, speed, oil, effective_modulus(steel, steel), nodes=513, keep_solutions=True
)

print("   path [mm]   load [N/mm]   radius [mm]   speed [m/s]   film [um]   thinnest [um]")
for row in zip(path, load, radius, speed, films.central_film, films.minimum_film, strict=True):
    print("{:12.3f}  {:12.1f}  {:12.3f}  {:12.3f}  {:10.4f}  {:14.4f}".format(
        *np.array(row) * (1e3, 1e-3, 1e3, 1.0, 1e6, 1e6)))  # fmt: skip
print(f"thinnest of all         {films.minimum_film.min() * 1e6:.4f} um")

figure = film_along_path(films, path, path_of_contact=path_of_contact(pair))
folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
figure.write_html(folder / "film-along-path.html", auto_play=False)
print(f"figures in {folder.resolve()}:")
print(*sorted(file.name for file in folder.glob("film-along-*.html")))
