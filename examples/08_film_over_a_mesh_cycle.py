"""Transient film of a tooth pair over a mesh cycle: the effect of squeeze on the film.

Load, radius and speed change while the pair moves from its entry to its exit. A steady film follows
them instantly; the real one is delayed by the time that the oil needs to cross the contact.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import tribodyn as td
from tribodyn.contact import effective_modulus
from tribodyn.ehl import solve_line_contacts
from tribodyn.mesh import moving_film
from tribodyn.plot import film_over_time, film_transient

warnings.simplefilter("ignore", td.ModelWarning)  # of this pair and of its rough flanks
case = td.load_case("fzg-roughness")
mesh = td.run(case).mesh
steel, oil = case.material_properties, case.lubricant_properties

print("The film moves through the mesh: 300 instants, a minute or so ...", flush=True)
moving = moving_film(mesh, oil, steel, steps=300, nodes=257, keep_every=5)
print(f"The same {moving.time.size} instants as steady contacts ...", flush=True)
steady = solve_line_contacts(
    moving.load_per_width,
    moving.equivalent_radius,
    moving.entrainment_speed,
    oil,
    effective_modulus(steel, steel),
    nodes=257,
    stiffness=False,
)

# Away from entry and exit, where the load rises and falls within a twentieth of a mesh cycle.
loaded = moving.load_per_width > 0.4 * moving.load_per_width.max()
middle = np.abs(moving.time / moving.time[-1] - 0.5) < 0.1
change = 100 * (moving.central_film / steady.central_film - 1.0)[loaded]
print(moving)
print(f"steady film, one pair alone    {steady.central_film[middle].mean() * 1e6:.4f} um")
print(f"moving film, one pair alone    {moving.central_film[middle].mean() * 1e6:.4f} um")
print(f"largest excess over steady     {change.max():.1f} %")
print(f"largest lack against steady    {change.min():.1f} %")

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
over_time = film_transient(moving, steady=steady.central_film)
over_time.write_html(folder / "film-over-time.html")
film_over_time(moving).write_html(folder / "film-moving.html", auto_play=False)
print(f"figures in {folder.resolve()}:")
print(*sorted(file.name for file in folder.glob("film-*.html")))
