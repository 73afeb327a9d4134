"""A rough flank in the contact: standing still, and moving through it.

A flank with waves of 50 um, 0.05 um high. Standing still, with the other flank
sliding by, the pressure flattens the waves a little. Carried along, each wave also brings its own
film with it from the inlet.

Figures go into the folder ``figures``, or into the one that is named behind the script.
"""

import sys
from pathlib import Path

import numpy as np

from tribodyn.ehl import RoughnessProfile, solve_line_contact, solve_transient_line_contact
from tribodyn.lubricant import from_library
from tribodyn.plot import compare_line_contacts, film_over_time

LOAD, RADIUS, ENTRAINMENT, MODULUS = 147802.0, 8e-3, 3.0722, 2.2e11
FAST = 1.2 * ENTRAINMENT  # m/s: the rough flank; the smooth one is as much slower
oil = from_library("80W")

wavelength, amplitude = 50e-6, 0.05e-6
x = np.arange(0.0, 20 * wavelength, 1e-6)
column = amplitude * np.sin(2 * np.pi * x / wavelength)
flank = RoughnessProfile.from_heights(1e-6, column, remove_tilt=False, beyond="periodic")

given = (LOAD, RADIUS, ENTRAINMENT, oil, MODULUS)
smooth = solve_line_contact(*given, nodes=1025)
standing = solve_line_contact(*given, nodes=1025, profile=flank)
period = wavelength / FAST
time = np.linspace(0.0, 10 * period, 10 * 25 + 1)
moving = solve_transient_line_contact(
    time, *given, nodes=513, roughness=(flank, None), surface_speeds=(FAST, 2 * ENTRAINMENT - FAST)
)


def waviness(position, film):
    """Half the difference of the highest and lowest film in the middle of the contact."""
    middle = np.abs(position) < 0.5 * smooth.half_width
    return 0.5 * np.ptp(film[..., middle], axis=-1)


settled, late = moving.kept_time > 7 * period, time > 7 * period
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
for words, sizes in (("amplitude of the waves", amplitudes), ("thinnest film", thinnest)):
    for name, size in sizes.items():
        print(f"{words + ', ' + name:33}  {size * 1e6:.4f} um")

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
standing_still = compare_line_contacts([smooth, standing], ["smooth", "rough, standing"])
standing_still.write_html(folder / "rough-standing.html")
film_over_time(moving).write_html(folder / "rough-moving.html", auto_play=False)
print(f"figures in {folder.resolve()}:")
print(*sorted(found.name for found in folder.glob("rough-*.html")))
