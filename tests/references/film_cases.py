"""Films of solved line contacts, computed anew: ``python tests/references/film_cases.py``.

By the scheme of ``known_films`` (Okamura 1982; Houpert and Hamrock 1986), which shares nothing with
the discretisation of tribodyn: the first integral of the Reynolds equation on nodes spaced at will.
Tribodyn gives only the film to begin with. Each figure is shown on two sets of nodes, whose
difference shows how many of its digits are certain.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from known_films import KnownFilm, known_film, wetted

#: Cases of Moes' numbers with z = 0.68, alpha = 2.2e-8 1/Pa, P = 0 at both ends of (-4.5, 1.5):
#: M, L, compressible, central and minimum film in b^2/R, outlet in b.
MOES = {
    "M20 L10": (20.0, 10.0, True, 0.085232, 0.074163, 1.0753),
    "M20 L10 incompressible": (20.0, 10.0, False, 0.100013, 0.07526, 1.0544),
    "M5 L5": (5.0, 5.0, True, 0.301073, 0.243137, 1.1259),
}
#: The scheme does not converge to the spike of an oil that cannot be compressed: that case rests on
#: the two schemes of the solver alone.
KNOWN = ("M20 L10", "M5 L5")
#: FZG pair of the first source document, wheel of 24 teeth driving at 1400 rpm, pitch point, one
#: pair in contact, flooded: torque [N*m] -> load [N/m], Hertz pressure [GPa], half width [um],
#: central and minimum film [um].
FZG = {
    50: (49267.5, 0.4644, 67.544, 1.1395, 0.991),
    150: (147802.0, 0.8043, 116.989, 1.0248, 0.896),
}
RADIUS, SPEED, MODULUS = 8e-3, 3.0722, 2.2e11
VISCOSITY, COEFFICIENT = 0.082, 2.19e-8
#: Inlet of the flooded contacts in half widths, and index of Roelands of the oil.
INLET = -100.0
ROELANDS = COEFFICIENT / 5.1e-9 / (math.log(VISCOSITY) + 9.67)


def moes_film(name: str, nodes: int) -> KnownFilm:
    """One of the cases of Moes."""
    from tribodyn.ehl import solve_line_contact_moes

    M, L, compressible, *_ = MOES[name]
    start = solve_line_contact_moes(M, L, compressible=compressible, nodes=4097)
    return known_film(
        M, L, wetted(start), inlet=-4.5, compressible=compressible, nodes=nodes, width=5e-4
    )


def moes_numbers(load: float) -> tuple[float, float]:
    """Moes' load and material number, with E' over the radius of one cylinder on a plane."""
    speed = VISCOSITY * SPEED / (MODULUS * RADIUS)
    M = load / (MODULUS * RADIUS) / math.sqrt(2.0 * speed)
    return M, COEFFICIENT * MODULUS * (2.0 * speed) ** 0.25


def gear_film(torque: int, nodes: int) -> tuple[float, float, float, float]:
    """Hertz pressure [GPa], half width, central and minimum film [um] of the FZG pair."""
    from tribodyn.ehl import solve_line_contact_moes

    load = FZG[torque][0]
    M, L = moes_numbers(load)
    start = solve_line_contact_moes(
        M, L, pressure_viscosity_coefficient=COEFFICIENT, pressure_viscosity_index=ROELANDS,
        domain="auto", inlet="flooded", nodes=16385,
    )  # fmt: skip
    film = known_film(M, L, wetted(start), inlet=INLET, alpha=COEFFICIENT, z=ROELANDS, nodes=nodes)
    half_width = math.sqrt(8.0 * load * RADIUS / (math.pi * MODULUS))
    unit = 1e6 * half_width**2 / RADIUS
    pressure = 2.0 * load / (math.pi * half_width)
    return 1e-9 * pressure, 1e6 * half_width, unit * film.central, unit * film.minimum


if __name__ == "__main__":
    for name in KNOWN:
        *_, central, minimum, outlet = MOES[name]
        print(f"{name}: stated {central} {minimum} {outlet}")
        for nodes in (700, 1400):
            computed = moes_film(name, nodes)
            print(f"  {nodes}: {computed.central:.6f} {computed.minimum:.6f} {computed.X[-1]:.4f}")
    for torque, stated in FZG.items():
        print(f"{torque} N m: stated {stated[1:]}")
        for nodes in (800, 1200):
            print(f"  {nodes}:", *(f"{value:.4f}" for value in gear_film(torque, nodes)))
