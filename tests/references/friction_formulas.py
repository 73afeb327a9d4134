"""Friction formulas once more, each in the units of its paper, with the standard library alone.

Load per width in N/mm, speeds in m/s (``rolling`` is the SUM of the surface speeds), radius and
diameter in mm, dynamic viscosity in mPa s, kinematic viscosity in mm^2/s, roughness in um, pressure
in kgf/cm^2, load intensity in N/mm^2 – except where a formula has inches.
"""

from __future__ import annotations

import math


def schlenk(load, rolling, radius, viscosity, ra, oil=1.0):
    """L. Schlenk, Diss. TU Munich (1994); ISO/TR 14179-2."""
    return 0.048 * (load / rolling / radius) ** 0.2 * viscosity ** (-0.05) * ra**0.25 * oil


def iso_6336_22(load, rolling, radius, viscosity, ra, oil=1.0):
    """ISO/TS 6336-22, with its factor of the roughness."""
    rough = 2.2 * (ra / radius) ** 0.25
    return 0.045 * (load / (rolling * radius)) ** 0.2 * viscosity ** (-0.05) * rough * oil


def niemann(load, rolling, radius, viscosity, ra, diameter, oil=1.0):
    """Niemann and Winter: the roughness over the diameter of the pinion."""
    rough = 3.8 * (ra / diameter) ** 0.25
    return 0.045 * (load / (rolling * radius)) ** 0.2 * viscosity ** (-0.05) * rough * oil


def iso_tc60(load, rolling, radius, viscosity, ra):
    """The older form."""
    return 0.12 * (load * ra / (radius * rolling * viscosity)) ** 0.25


def iso_14179_1(speed, intensity, kinematic):
    """ISO/TR 14179-1."""
    return 1.0 / (3.239 * kinematic**0.223 * intensity**0.4 * speed**0.7)


def misharin(sliding, rolling, kinematic):
    """Y. A. Misharin (1958)."""
    return 0.325 / (sliding * rolling * kinematic) ** 0.25


def drozdov(sliding, rolling, kinematic, pressure):
    """Y. N. Drozdov and Y. A. Gavrikov, Wear 11 (1968)."""
    phi = 0.47 - 0.13e-4 * pressure - 0.4e-3 * kinematic
    return 1.0 / (0.8 * math.sqrt(kinematic) * sliding + rolling * phi + 13.4)


def odonoghue_cameron(sliding, rolling, viscosity, microinches, inches):
    """J. P. O'Donoghue and A. Cameron, ASLE Trans. 9 (1966); speeds in in/s."""
    powers = viscosity ** (1 / 8) * sliding ** (1 / 3) * rolling ** (1 / 6) * inches ** (1 / 2)
    return 0.6 * (microinches + 22.0) / 35.0 / powers


def xu(ratio, pressure, viscosity, rough, entrainment, radius):
    """H. Xu (2007) by the table of a thesis and an open program: GPa, m/s, m."""
    b = (
        -8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305,
    )  # fmt: skip
    shear = abs(ratio) * pressure * math.log10(viscosity)
    f = b[0] + b[3] * shear + b[4] * math.exp(-shear) + b[8] * math.exp(rough)
    powers = pressure ** b[1] * abs(ratio) ** b[2] * entrainment ** b[5]
    return math.exp(f) * powers * viscosity ** b[6] * radius ** b[7]


def load_share(ratio):
    """D. Zhu and Y.-Z. Hu (2001), as fitted: above 1 from 2.0 on, and falling from 2.26 on."""
    return 1.21 * ratio**0.64 / (1.0 + 0.37 * ratio**1.26)
