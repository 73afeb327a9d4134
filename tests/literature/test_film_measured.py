"""Film over speed against films measured by optical interferometry.

A steel ball on a glass disc is a point contact, whose film loses oil to its sides: it rises with a
smaller power of the speed (0.67) than that of a line contact (0.69 to 0.73), and its thickness says
nothing about a line: it is not compared. What the two share is that the inlet alone, with its
exponential thickening, makes the film; the power distinguishes it from the other regimes.

Data: M. Ploss, tribology, doi:10.5281/zenodo.1117727 (MIT licence), EHD2 rig, ball of 9.525 mm
radius, 50 N, 31.5 degrees Celsius, pure rolling; seven of its 21 speeds.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.ehl import solve_line_contact
from tribodyn.lubricant import Lubricant

#: Rolling speed [m/s] and film [nm].
MEASURED = np.array(
    [
        (0.03723, 49.8), (0.07256, 80.9), (0.14146, 128.0), (0.27585, 200.4),
        (0.53826, 312.1), (1.05049, 479.6), (2.04999, 683.7),
    ]
)  # fmt: skip
RADIUS, LOAD = 9.525e-3, 50.0
#: Steel (210 GPa, 0.3) on glass (70 GPa, 0.22).
MODULUS = 2.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9)
#: Example values of the source at 31.5 degrees Celsius; the coefficient is not measured.
OIL = Lubricant(0.0734, 862.0, 30e-9)


def exponent(speed, film):
    return float(np.polyfit(np.log(speed), np.log(film), 1)[0])


def test_power_of_the_speed():
    speed, film = MEASURED.T
    contact_radius = (1.5 * LOAD * RADIUS / MODULUS) ** (1 / 3)
    hertz = 1.5 * LOAD / (math.pi * contact_radius**2)
    line_load = 2.0 * math.pi * RADIUS * hertz**2 / MODULUS  # the same Hertz pressure
    solutions = [
        solve_line_contact(line_load, RADIUS, solution, OIL, MODULUS, nodes=2049)
        for solution in speed
    ]
    assert solutions[0].hertz_pressure == pytest.approx(hertz, rel=1e-9)
    solved = exponent(speed, [solution.central_film for solution in solutions])
    measured = exponent(speed, film)
    assert measured == pytest.approx(0.667, abs=0.01)
    assert measured < solved < 8 / 11  # Grubin's power of a line contact
    assert solved - measured < 0.06
