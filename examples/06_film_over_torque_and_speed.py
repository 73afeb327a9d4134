"""Pressure and film over torque and over speed, beside what a cut-off inlet makes of them.

The pair of an FZG rig at its pitch point, where one tooth pair carries everything: the wheel with 24
teeth drives. The second figure of each row is the same contact with the oil supply cut off 2.5 half
widths before its centre: light loads starve most, so that the film seems to rise with the torque.

Run it with a folder to keep the figures: ``python examples/06_film_over_torque_and_speed.py figures``.
"""

import math
import sys
import tempfile
import warnings
from pathlib import Path

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
    print(f"{name:>8}    central [um]   minimum [um]   starved central [um]   pressure peak [p_h] at")
    flooded = {}
    for value, (torque, rpm) in points.items():
        full = contact(torque, rpm)
        starved = contact(torque, rpm, inlet="zero", domain=(-2.5, 1.5))
        behind = full.position > 0.25 * full.half_width
        peak = full.pressure[behind].argmax()
        print(
            f"{value:>8}    {full.central_film * 1e6:12.4f}   {full.minimum_film * 1e6:12.4f}"
            f"   {starved.central_film * 1e6:20.4f}"
            f"   {full.pressure[behind][peak] / full.hertz_pressure:19.2f}"
            f" {full.position[behind][peak] / full.half_width:.2f} b"
        )
        flooded[f"{value} {unit}"] = full
    return compare_line_contacts(flooded.values(), flooded)


figures = {
    "torque": compare("N*m", "N·m", {torque: (torque, 1400) for torque in (50, 150, 300)}),
    "speed": compare("rpm", "rpm", {rpm: (150, rpm) for rpm in (800, 1400, 1800, 3000)}),
}
with tempfile.TemporaryDirectory() as scratch:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(scratch)
    folder.mkdir(parents=True, exist_ok=True)
    for name, figure in figures.items():
        figure.write_html(folder / f"film-over-{name}.html")
    print("figures:", *sorted(path.name for path in folder.glob("film-over-*.html")))
