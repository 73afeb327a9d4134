"""Cases D1 and D2, computed anew by SciPy: ``python tests/references/gear_pair_orbits.py``.

Both gears of FZG type A on supports of 3.5e9 N/m and 4 kN s/m, 2e8 N/m for every tooth pair over
its whole path, load shared equally, mesh damping 900 N s/m, no backlash; pinion driving at 900 rpm
with 90 N m, 135 N m on the wheel. D1 has no friction, D2 a constant coefficient of 0.1. Nothing
depends on the free rotation of the drive, so that ``u = r_1 theta_1 - r_2 theta_2`` stands for both
rotations. The equations are linear: the orbit is the fixed point of the map over one mesh cycle,
whose matrix DOP853 integrates between the jumps. Nothing of tribodyn is used.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from scipy.integrate import simpson, solve_ivp

#: Friction -> mean deflection and its span [um], mean, rms and peak mesh force [N], rms of the
#: acceleration of the pinion along the line of action [m/s^2].
ORBITS = {
    0.0: (11.119736, 14.707386, 2660.4444, 2693.7133, 5310.4822, 788.665),
    0.1: (10.690391, 13.808220, 2566.5476, 2596.5580, 5084.7270, 739.622),
}
#: Friction -> amplitudes of the first three mesh harmonics of the deflection [um].
HARMONICS = {0.0: (3.638129, 1.879799, 0.070201), 0.1: (3.377101, 1.734764, 0.070281)}
#: D2: rms about the mean of the bearing force of the pinion across and along the line of action,
#: rms friction force [N], rms of the acceleration of the pinion across [m/s^2].
ACROSS = {"bearing_x": 124.280, "bearing_y": 660.591, "friction": 225.238, "acceleration": 84.362}
#: D2: largest multiplier.
MULTIPLIER = 0.000949

FREQUENCY = 240.0
MODULE, TEETH, SHIFTS = 4.5e-3, (16, 24), (0.8635, -0.5103)
DISTANCE, ANGLE = 91.5e-3, math.radians(20.0)
MASS, INERTIA, TORQUE = (0.676, 1.084), (407e-6, 1168e-6), (90.0, 135.0)
PAIR, DAMPING, SUPPORT, SUPPORT_DAMPING = 2e8, 900.0, 3.5e9, 4e3

R1, R2 = (0.5 * MODULE * z * math.cos(ANGLE) for z in TEETH)
WORKING = math.acos((R1 + R2) / DISTANCE)
LINE, PITCH = DISTANCE * math.sin(WORKING), math.pi * MODULE * math.cos(ANGLE)
SHORT = sum(SHIFTS) - (DISTANCE - 0.5 * MODULE * sum(TEETH)) / MODULE
TIP = [MODULE * (0.5 * z + 1.0 + x - SHORT) for z, x in zip(TEETH, SHIFTS, strict=True)]
START, END = LINE - math.sqrt(TIP[1] ** 2 - R2**2), math.sqrt(TIP[0] ** 2 - R1**2)
POINT = R1 * math.tan(WORKING)
DOUBLE = (END - START) / PITCH - 1.0
EDGES = (0.0, (POINT - START) / PITCH, DOUBLE, 1.0)

#: Compression of the mesh by the coordinates x_1, y_1, x_2, y_2, u.
COMPRESSION = np.array([0.0, 1.0, 0.0, -1.0, 1.0])


def friction_levers(phase: float, middle: float, coefficient: float) -> tuple[float, float, float]:
    """Friction over mesh force: across, and its moments about pinion and wheel."""
    pairs = (0, 1) if middle < DOUBLE else (0,)
    total = np.zeros(3)
    for pair in pairs:
        place = START + (phase + pair) * PITCH
        sign = math.copysign(1.0, START + (middle + pair) * PITCH - POINT)
        total += sign * coefficient / len(pairs) * np.array([1.0, place, LINE - place])
    return tuple(total)  # type: ignore[return-value]


def equations(phase: float, middle: float, coefficient: float) -> tuple[np.ndarray, np.ndarray]:
    """Matrix and right side of the first order system of coordinates and velocities."""
    across, first, second = friction_levers(phase, middle, coefficient)
    stiffness = PAIR * (2.0 if middle < DOUBLE else 1.0)
    # acceleration by the mesh force
    push = -np.array(
        [
            across / MASS[0], 1.0 / MASS[0], -across / MASS[1], -1.0 / MASS[1],
            R1 * (R1 + first) / INERTIA[0] + R2 * (R2 + second) / INERTIA[1],
        ]
    )  # fmt: skip
    inverse_mass = np.array([1 / MASS[0], 1 / MASS[0], 1 / MASS[1], 1 / MASS[1], 0.0])
    matrix = np.zeros((10, 10))
    matrix[:5, 5:] = np.eye(5)
    matrix[5:, :5] = np.outer(push, stiffness * COMPRESSION) - np.diag(SUPPORT * inverse_mass)
    matrix[5:, 5:] = np.outer(push, DAMPING * COMPRESSION) - np.diag(SUPPORT_DAMPING * inverse_mass)
    right = np.zeros(10)
    right[9] = R1 * TORQUE[0] / INERTIA[0] + R2 * TORQUE[1] / INERTIA[1]
    return matrix, right


def _integrate(state: np.ndarray, coefficient: float, samples: int = 2) -> list[np.ndarray]:
    """States with their phase in front, in each piece of the cycle; several columns at once."""
    parts = []
    for low, high in pairwise(EDGES):
        middle = 0.5 * (low + high)

        def slope(phase: float, flat: np.ndarray, middle: float = middle) -> np.ndarray:
            matrix, right = equations(phase, middle, coefficient)
            columns = flat.reshape(10, -1)
            constant = np.zeros_like(columns)
            constant[:, -1] = right  # the last column is a motion, the others are disturbances
            return np.asarray((matrix @ columns + constant) / FREQUENCY).ravel()

        solved = solve_ivp(
            slope, (low, high), state.ravel(), "DOP853", np.linspace(low, high, samples),
            rtol=1e-11, atol=1e-14,
        )  # fmt: skip
        state = solved.y[:, -1].reshape(state.shape)
        parts.append(np.vstack((solved.t, solved.y)))
    return parts


def orbit(coefficient: float) -> tuple[list[np.ndarray], float]:
    """Pieces of the periodic motion and the largest multiplier."""
    image = _integrate(np.eye(10, 11), coefficient)[-1][1:, -1].reshape(10, 11)
    matrix, moved = image[:, :10], image[:, 10]
    start = np.linalg.solve(np.eye(10) - matrix, moved)
    multiplier = float(np.abs(np.linalg.eigvals(matrix)).max())
    return _integrate(start[:, None], coefficient, samples=8001), multiplier


def figures(coefficient: float) -> dict[str, tuple[float, ...]]:
    """The figures of the tables at the top, by their names."""
    parts, multiplier = orbit(coefficient)
    phases = [part[0] for part in parts]
    series: dict[str, list[np.ndarray]] = {}
    for part in parts:
        middle = 0.5 * (part[0][0] + part[0][-1])
        compression, speed = COMPRESSION @ part[1:6], COMPRESSION @ part[6:11]
        force = PAIR * (2.0 if middle < DOUBLE else 1.0) * compression + DAMPING * speed
        share = np.array([friction_levers(p, middle, coefficient)[0] for p in part[0]])
        support = [SUPPORT * part[i] + SUPPORT_DAMPING * part[i + 5] for i in (1, 2)]
        values = {
            "deflection": compression, "force": force, "friction": share * force,
            "bearing_x": support[0], "bearing_y": support[1],
            "acceleration_x": -(support[0] + share * force) / MASS[0],
            "acceleration_y": -(support[1] + force) / MASS[0],
        }  # fmt: skip
        for name, value in values.items():
            series.setdefault(name, []).append(value)

    def mean(values: list[np.ndarray]) -> complex:
        return sum(simpson(v, x=p) for v, p in zip(values, phases, strict=True))

    def rms(name: str, about: float = 0.0) -> float:
        return float(np.sqrt(mean([(v - about) ** 2 for v in series[name]])))

    deflection, force = (np.concatenate(series[name]) for name in ("deflection", "force"))
    waves = [
        2e6 * abs(mean([
            v * np.exp(-2j * np.pi * order * p)
            for v, p in zip(series["deflection"], phases, strict=True)
        ]))
        for order in (1, 2, 3)
    ]  # fmt: skip
    return {
        "orbit": (
            1e6 * float(mean(series["deflection"])), 1e6 * float(np.ptp(deflection)),
            float(mean(series["force"])), rms("force"), float(force.max()), rms("acceleration_y"),
        ),
        "harmonics": tuple(waves),
        "across": (
            *(rms(name, float(mean(series[name]))) for name in ("bearing_x", "bearing_y")),
            rms("friction"), rms("acceleration_x"),
        ),
        "multiplier": (multiplier,),
    }  # fmt: skip


if __name__ == "__main__":
    for friction, stated in ORBITS.items():
        computed = figures(friction)
        print(f"friction {friction}")
        for name, values in (("orbit", stated), ("harmonics", HARMONICS[friction])):
            print(f"  {name}: {[round(v, 7) for v in computed[name]]}, stated {list(values)}")
    print("  across:", computed["across"], "stated", list(ACROSS.values()))
    print("  multiplier:", computed["multiplier"], "stated", MULTIPLIER)
