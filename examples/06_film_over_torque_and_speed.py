"""Pressure and film over torque and over speed, compared with those of a starved inlet.

The pair of an FZG rig at its pitch point, where one tooth pair carries everything and the wheel
with 24 teeth drives. The starved film is that of the same contact with the oil supply cut off 2.5
half widths before its centre: light loads lose most, so that the film seems to rise with torque.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import math
import sys
import warnings
from pathlib import Path

import numpy as np

from tribodyn.ehl import solve_line_contact
from tribodyn.errors import ModelWarning
from tribodyn.lubricant import from_library
from tribodyn.plot import compare_line_contacts

warnings.simplefilter("ignore", ModelWarning)  # the starved contacts are meant to be starved
BASE_RADIUS, FACE_WIDTH = 50.7434e-3, 20e-3  # m
RADIUS, CURVATURE = 8e-3, 20.9552e-3  # m: equivalent radius, and that of the flanks at C
OIL = from_library("80W")


def contact(torque, rpm, **options):
    """Contact at the pitch point under a torque [N*m] at a speed [rpm]."""
    load = torque / (BASE_RADIUS * FACE_WIDTH)
    entrainment = rpm * math.pi / 30 * CURVATURE
    return solve_line_contact(load, RADIUS, entrainment, OIL, 2.2e11, nodes=2049, **options)


def compare(name, unit, points):
    """Print one line for each operating point, and draw the flooded contacts."""
    print(f"{name:>8}  central [um]  minimum [um]  starved [um]  peak [p_h]  at [b]")
    flooded = {}
    for value, (torque, rpm) in points.items():
        full = contact(torque, rpm)
        starved = contact(torque, rpm, inlet="zero", domain=(-2.5, 1.5))
        behind = np.where(full.position > 0.15 * full.half_width, full.pressure, 0.0).argmax()
        figures = (
            full.central_film * 1e6,
            full.minimum_film * 1e6,
            starved.central_film * 1e6,
            full.pressure[behind] / full.hertz_pressure,
            full.position[behind] / full.half_width,
        )
        print("{:>8}  {:12.4f}  {:12.4f}  {:12.4f}  {:10.2f}  {:6.3f}".format(value, *figures))
        flooded[f"{value} {unit}"] = full
    return compare_line_contacts(flooded.values(), flooded)


figures = {
    "torque": compare("N*m", "N·m", {torque: (torque, 1400) for torque in (50, 150, 300)}),
    "speed": compare("rpm", "rpm", {rpm: (150, rpm) for rpm in (800, 1400, 1800, 3000)}),
}
folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
for name, figure in figures.items():
    figure.write_html(folder / f"film-over-{name}.html")
print(f"figures in {folder.resolve()}:")
print(*sorted(path.name for path in folder.glob("film-over-*.html")))
