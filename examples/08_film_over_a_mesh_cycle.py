"""A tooth pair passes through the mesh, over time: what the squeeze of the film changes.

Load, radius and speed change while the pair moves from its entry to its exit. A steady film follows
them at once; a real one takes the time that the oil needs to cross the contact.

Run it with a folder to keep the figures: ``python examples/08_film_over_a_mesh_cycle.py figures``.
"""

import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

import tribodyn as td
from tribodyn.contact import effective_modulus
from tribodyn.ehl import solve_line_contacts, solve_transient_line_contact
from tribodyn.plot import film_over_time, film_transient

STEPS = 300
warnings.simplefilter("ignore", td.ModelWarning)  # of this pair and of its rough flanks
case = td.load_case("fzg-roughness")
mesh = td.run(case).mesh
life = mesh.in_contact.T
age = (mesh.phase[:, None] + np.arange(life.shape[0])).T[life]  # mesh cycles since the entry
columns = {
    name: getattr(mesh, name).T[life]
    for name in ("load_per_width", "equivalent_radius", "entrainment_speed")
}

# The load comes up from 2 % within a twentieth of a cycle and goes down in the same way; where the
# number of pairs changes, its jump is spread by the steps in time.
cycles = np.linspace(0.0, age[-1], STEPS + 1)
load, radius, speed = (np.interp(cycles, age, values) for values in columns.values())
ramp = np.minimum(np.minimum(cycles, age[-1] - cycles) / 0.05, 1.0)
load = load * (0.02 + 0.98 * ramp**2 * (3.0 - 2.0 * ramp))
time = cycles / mesh.mesh_frequency

steel, oil = case.material_properties, case.lubricant_properties
modulus = effective_modulus(steel, steel)
moving = solve_transient_line_contact(
    time, load, radius, speed, oil, modulus, nodes=257, keep_every=5
)
steady = solve_line_contacts(load, radius, speed, oil, modulus, nodes=257, stiffness=False)

alone = (ramp == 1.0) & (np.abs(cycles - 0.5 * cycles[-1]) < 0.1)
change = moving.central_film / steady.central_film - 1.0
print(moving)
print(f"steady film, one pair alone    {steady.central_film[alone].mean() * 1e6:.4f} um")
print(f"moving film, one pair alone    {moving.central_film[alone].mean() * 1e6:.4f} um")
print(f"largest excess over steady     {100 * change[ramp == 1.0].max():.1f} %")
print(f"largest lack against steady    {100 * change[ramp == 1.0].min():.1f} %")

with tempfile.TemporaryDirectory() as scratch:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(scratch)
    folder.mkdir(parents=True, exist_ok=True)
    film_transient(moving, steady=steady.central_film).write_html(folder / "film-over-time.html")
    film_over_time(moving).write_html(folder / "film-moving.html", auto_play=False)
    print("figures:", *sorted(found.name for found in folder.glob("film-*.html")))
