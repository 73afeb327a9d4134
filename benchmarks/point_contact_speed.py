"""What point contacts and rollers cost: one solution of each kind on a grid, on one core."""

from __future__ import annotations

import time
from collections.abc import Sequence

from tribodyn.contact import hertz_line
from tribodyn.ehl import RollerProfile, solve_finite_line_contact, solve_point_contact
from tribodyn.errors import quiet
from tribodyn.lubricant import Lubricant

OIL, MODULUS = Lubricant(0.05, 880.0, 2e-8), 2.2e11
#: Force [N], radii [m], speed [m/s], angle [rad] of each contact.
CONTACTS = {
    "point, M 50": (20.0, 0.01, 0.01, 1.0, 0.0),
    "point, M 800": (300.0, 0.01, 0.01, 1.0, 0.0),
    "point, M 800, 45 deg": (300.0, 0.01, 0.01, 1.0, 0.785398),
    "ellipse 3:1": (300.0, 0.01, 0.05, 1.0, 0.0),
    "ellipse 3:1, 45 deg": (300.0, 0.01, 0.05, 1.0, 0.785398),
    "hypoid, 27:1, 34 deg": (2000.0, 0.01, 2.0, 5.0, 0.6),
}


def seconds(solve: object) -> tuple[float, object]:
    """Processor time of the second call, and its result."""
    solve()  # type: ignore[operator]  # compile, and fill the caches
    start = time.process_time()
    result = solve()  # type: ignore[operator]
    return time.process_time() - start, result


def main(arguments: Sequence[str] | None = None) -> None:
    """Print one line per contact."""
    nodes = 33 if arguments and "--quick" in arguments else 129
    with quiet("film-resolution"):
        for name, (force, radius_x, radius_y, speed, angle) in CONTACTS.items():

            def solve(
                values: tuple[float, ...] = (force, radius_x, radius_y, speed), turn: float = angle
            ) -> object:
                """Solve the contact."""
                return solve_point_contact(
                    *values, OIL, MODULUS, entrainment_angle=turn, nodes=nodes
                )

            time_used, contact = seconds(solve)
            print(f"{name:24s} {time_used:6.2f} s  {contact}")
        load, length = 2e5, 10e-3
        half_width = float(hertz_line(load, 8e-3, MODULUS).half_width)
        profile = RollerProfile.logarithmic(length, load, MODULUS, half_width)
        time_used, roller = seconds(
            lambda: solve_finite_line_contact(
                load * length, length, 8e-3, 2.0, OIL, MODULUS, profile=profile, nodes=65
            )
        )
        print(f"{'roller, 10 mm':24s} {time_used:6.2f} s  {roller}")


if __name__ == "__main__":
    main()
