"""The friction table of FZG type A, computed anew: ``python tests/references/friction_table.py``.

Geometry of the involute, Hertz's line contact and both friction formulas, each written out once
more from the papers with the standard library alone:

- H. Xu, A. Kahraman, N. E. Anderson, D. G. Maddock: Prediction of mechanical efficiency of
  parallel-axis gear pairs, J. Mech. Des. 129 (2007) 58-68, with its nine numbers unrounded;
- G. H. Benedict, B. W. Kelley: Instantaneous coefficients of gear tooth friction, ASLE Trans. 4
  (1961) 59-70, with the factor 1.13/(1.13 - S) for the roughness S in um and the number 29700 of
  later gear studies for a load in N/mm and a viscosity in mPa s.

Pinion of 16 teeth driving at 900 rpm with 90 N m, x 0.8635/-0.5103, m 4.5 mm, a 91.5 mm, face width
20 mm, 82 mPa s, E 210 GPa, nu 0.3, composite roughness 0.53 um. The load is shared equally by two
pairs before B and after D.
"""

from __future__ import annotations

import math

#: Roll angle at A, B, in the middle of B and D on the path of contact, and at E, and there: share,
#: sliding and entrainment speed [m/s], their ratio, R [mm], Hertz pressure [GPa], coefficients
#: after Xu and after Benedict and Kelly.
TABLE = (
    (0.324239, 0.5, -0.471463, 1.269503, -0.371376, 7.523826, 0.569806, 0.079431, 0.107659),
    (0.452633, 1.0, +0.210801, 1.337729, +0.157581, 8.598883, 0.753772, 0.063169, 0.122133),
    (0.584785, 1.0, +0.913038, 1.407953, +0.648486, 8.577181, 0.754725, 0.067992, 0.105843),
    (0.845332, 0.5, +2.297540, 1.546403, +1.485731, 5.181786, 0.686604, 0.060681, 0.087109),
)
NORMAL_FORCE, FACE_WIDTH, VISCOSITY = 2660.44, 20e-3, 0.082

MODULE, TEETH, SHIFTS = 4.5e-3, (16, 24), (0.8635, -0.5103)
DISTANCE, ANGLE, SPEED, TORQUE = 91.5e-3, math.radians(20.0), 30.0 * math.pi, 90.0
ROUGHNESS = 0.53

_XU = (-8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305)


def roll_angles() -> dict[str, float]:
    """Roll angles of the pinion [rad] at the five points of the path of contact."""
    r1, r2 = (0.5 * MODULE * z * math.cos(ANGLE) for z in TEETH)
    line = math.sqrt(DISTANCE**2 - (r1 + r2) ** 2)
    short = sum(SHIFTS) - (DISTANCE - 0.5 * MODULE * sum(TEETH)) / MODULE
    tips = [MODULE * (0.5 * z + 1.0 + x - short) for z, x in zip(TEETH, SHIFTS, strict=True)]
    pitch = math.pi * MODULE * math.cos(ANGLE)
    first, last = line - math.sqrt(tips[1] ** 2 - r2**2), math.sqrt(tips[0] ** 2 - r1**2)
    path = {"A": first, "B": last - pitch, "D": first + pitch, "E": last}
    path["C"] = r1 * line / (r1 + r2)
    return {name: value / r1 for name, value in path.items()}


def row(roll: float, share: float) -> tuple[float, ...]:
    """One row of the table."""
    r1, r2 = (0.5 * MODULE * z * math.cos(ANGLE) for z in TEETH)
    line = math.sqrt(DISTANCE**2 - (r1 + r2) ** 2)
    radii = roll * r1, line - roll * r1
    speeds = SPEED * radii[0], SPEED * TEETH[0] / TEETH[1] * radii[1]
    sliding, entrainment = speeds[0] - speeds[1], 0.5 * sum(speeds)
    radius = radii[0] * radii[1] / sum(radii)
    load = share * TORQUE / r1 / FACE_WIDTH
    modulus = 210e9 / (1.0 - 0.3**2)
    pressure = 1e-9 * math.sqrt(load * modulus / (2.0 * math.pi * radius))
    ratio = sliding / entrainment
    return (
        roll, share, sliding, entrainment, ratio, 1e3 * radius, pressure,
        xu(abs(ratio), pressure, entrainment, radius),
        benedict_kelly(load, abs(sliding), entrainment),
    )  # fmt: skip


def xu(ratio: float, pressure: float, entrainment: float, radius: float) -> float:
    """Coefficient after Xu with P_h in GPa, viscosity in mPa s and R in m."""
    b1, b2, b3, b4, b5, b6, b7, b8, b9 = _XU
    viscosity = 1e3 * VISCOSITY
    product = ratio * pressure * math.log10(viscosity)
    exponent = b1 + b4 * product + b5 * math.exp(-product) + b9 * math.exp(ROUGHNESS)
    powers = pressure**b2 * ratio**b3 * entrainment**b6 * viscosity**b7 * radius**b8
    return math.exp(exponent) * powers


def benedict_kelly(
    load: float,
    sliding: float,
    entrainment: float,
    roughness: float = ROUGHNESS,
    factor: float = 0.0127,
) -> float:
    """Coefficient after Benedict and Kelley with the load in N/m and the roughness in um."""
    argument = 29700.0 * 1e-3 * load / (1e3 * VISCOSITY * sliding * entrainment**2)
    return factor * 1.13 / (1.13 - roughness) * math.log10(argument)


if __name__ == "__main__":
    angles = roll_angles()
    print({name: round(value, 6) for name, value in angles.items()})
    middle = 0.5 * (angles["B"] + angles["D"])
    places = ((angles["A"], 0.5), (angles["B"], 1.0), (middle, 1.0), (angles["E"], 0.5))
    for place, stated in zip(places, TABLE, strict=True):
        print("found ", *(f"{value:.6f}" for value in row(*place)))
        print("stated", *(f"{value:.6f}" for value in stated))
    load, sliding, entrainment = 2660.44 / 20e-3, TABLE[2][2], TABLE[2][3]
    for roughness in (0.325, 0.53, 0.991):
        coefficient = benedict_kelly(load, sliding, entrainment, roughness, 0.0137)
        print(f"factor 0.0137, S {roughness}: {coefficient:.3f}")
