"""A rough flank in the contact: stationary, and moving through it.

A flank with waves of 50 um, 0.05 um high. If the rough flank is stationary and the other one
slides, the pressure flattens the waves slightly. If the rough flank moves, each wave also carries
a film disturbance from the inlet through the contact.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
from pathlib import Path

import numpy as np

from tribodyn.ehl import RoughnessProfile, solve_line_contact, solve_transient_line_contact
from tribodyn.lubricant import from_library
from tribodyn.plot import compare_line_contacts, film_over_time

LOAD, RADIUS, ENTRAINMENT, MODULUS = 147802.0, 8e-3, 3.0722, 2.2e11
FAST = 1.2 * ENTRAINMENT  # m/s: the rough flank; the smooth one has 0.8 times the entrainment speed
oil = from_library("80W")

wavelength, amplitude = 50e-6, 0.05e-6
x = np.arange(0.0, 20 * wavelength, 1e-6)
column = amplitude * np.sin(2 * np.pi * x / wavelength)
flank = RoughnessProfile.from_heights(1e-6, column, remove_tilt=False, beyond="periodic")

conditions = (LOAD, RADIUS, ENTRAINMENT, oil, MODULUS)
smooth = solve_line_contact(*conditions, nodes=1025)
standing = solve_line_contact(*conditions, nodes=1025, profile=flank)
period = wavelength / FAST
time = np.linspace(0.0, 10 * period, 10 * 25 + 1)
moving = solve_transient_line_contact(
    time,
    *conditions,
    nodes=513,
    roughness=(flank, None),
    surface_speeds=(FAST, 2 * ENTRAINMENT - FAST),
)


def waviness(position, film):
    """Half the difference of the highest and lowest film in the middle of the contact."""
    middle = np.abs(position) < 0.5 * smooth.half_width
    return 0.5 * np.ptp(film[..., middle], axis=-1)


settled, late = moving.stored_time > 7 * period, time > 7 * period
amplitudes = {
    "before": amplitude,
    "standing": waviness(standing.position, standing.film),
    "moving": waviness(moving.position, moving.film[settled]).mean(),
}
thinnest = {
    "smooth": smooth.minimum_film,
    "standing": standing.minimum_film,
    "moving": moving.minimum_film[late].min(),
}
for label, sizes in (("amplitude of the waves", amplitudes), ("thinnest film", thinnest)):
    for name, size in sizes.items():
        print(f"{label + ', ' + name:33}  {size * 1e6:.4f} um")

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
standing_still = compare_line_contacts([smooth, standing], ["smooth", "rough, standing"])
standing_still.write_html(folder / "rough-standing.html")
film_over_time(moving).write_html(folder / "rough-moving.html", auto_play=False)
print(f"figures in {folder.resolve()}:")
print(*sorted(file.name for file in folder.glob("rough-*.html")))
