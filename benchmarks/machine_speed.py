"""Steady state of a two-stage machine of 40 coordinates: harmonic balance against integration.

The rivals integrate from the mean position until the motion is within 1e-6 of the periodic one.
That number of periods is found beforehand. The rivals run one of them, SciPy's DOP853 a part of
one, with as few steps as 1e-6 takes, and their time is multiplied. In a sweep of 300 speeds each
starts from the motion before. The last race is the built-in reducer from its case file to the
report, its kernels and the modules of Python loaded.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from tempfile import TemporaryDirectory

import numpy as np
from scipy.integrate import solve_ivp

from race import arguments, machine, print_table, race
from reference_machine import CLOCK, two_stage_machine
from tribodyn import load_case, run
from tribodyn.dynamics import Response, System, harmonic_balance, simulate
from tribodyn.errors import ModelWarning
from tribodyn.machine import system as assembled
from tribodyn.mesh.build import _cached_teeth
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.result import steady_motion

__all__ = ["main"]

_ACCURACY, _STEPS, _SPEEDS = 1e-6, 64, 300
#: Part of a period that SciPy integrates, and its relative tolerance.
_PART, _TOLERANCE = 51, 5e-5


def _slope(system: System, torque: np.ndarray) -> Callable[[float, np.ndarray], np.ndarray]:
    """Right-hand side in NumPy, with all constants multiplied beforehand."""
    size, inverse = system.size, system.inverse_mass
    directions = np.array([contact.direction for contact in system.contacts])
    matrix = -np.hstack(system.over_mass)
    push, load = -inverse @ directions.T, inverse @ (np.asarray(system.force) + torque)
    contacts, step = system.clocked_contacts, 1e-7

    def slope(time: float, state: np.ndarray) -> np.ndarray:
        clock = time * CLOCK % 1.0
        at = clock + np.array([-step, 0.0, step])
        d, rate = directions @ state[:size], directions @ state[size:]
        force = np.empty(len(contacts))
        for j, contact in enumerate(contacts):
            error = contact.error(at)
            gap = d[j] - error[1]
            speed = rate[j] - CLOCK * (error[2] - error[0]) / (2.0 * step)
            beyond = abs(gap) > contact.gap
            spring = contact.stiffness(at[1:2])[0] * (gap - np.sign(gap) * contact.gap)
            force[j] = beyond * (spring + contact.damping * speed)
        return np.concatenate((state[size:], matrix @ state + push @ force + load))

    return slope


def _periods_to_repeat(system: System, orbit: Response) -> int:
    """Periods of the clock after which compressions are within 1e-6 of the periodic motion."""
    position, velocity = orbit.position.mean(axis=0), 0.0 * orbit.velocity[0]
    exact = orbit.deflection[0]
    for period in range(1, 500):
        run = simulate(
            system, CLOCK, 2, (position, velocity), steps=_STEPS, method="modal",
            extra_force=orbit.extra_force,
        )  # fmt: skip
        half = run.time.size // 2
        position, velocity = run.position[half], run.velocity[half]
        if np.abs(run.deflection[half] - exact).max() <= _ACCURACY * np.abs(exact).max():
            return period
    raise RuntimeError("the motion does not repeat within 500 periods")


def _sweep(system: System, count: int) -> float:
    motion = None
    for frequency in CLOCK * np.linspace(0.5, 1.5, count):
        motion = harmonic_balance(system, float(frequency), steps=_STEPS, start=motion)
    return count


def _reducer(rounds: int) -> None:
    """Parts of a run of the built-in reducer, with its load cases and without."""
    case = load_case("two-stage-spur")
    single = case.replace({"load_cases": None})
    result = run(single)

    def whole(machine: MachineCase) -> Callable[[], float]:
        def compute() -> float:
            _cached_teeth.cache_clear()
            with TemporaryDirectory() as folder:
                run(machine).save(f"{folder}/result")
            return 1.0

        return compute

    def motion() -> float:
        steady_motion(result.structure, assembled(result.structure))
        return 1.0

    runners = {
        "built-in reducer, three loads": whole(case),
        "built-in reducer, one load": whole(single),
        "its motion under one load": motion,
    }
    rows = [(n, f"{each.median:.3g}") for n, each in race(runners, rounds).items()]
    print_table(("case file to report", "CPU s"), rows)


def main(words: Sequence[str] | None = None) -> None:
    """Run the comparison and print it.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Two-stage machine: {machine()}\n")
    system = two_stage_machine()
    orbit = harmonic_balance(system, CLOCK)
    start, torque = (orbit.position[0], orbit.velocity[0]), orbit.extra_force
    periods = _periods_to_repeat(system, orbit)
    state, slope = np.concatenate(start), _slope(system, torque)

    def balance() -> float:
        harmonic_balance(two_stage_machine(), CLOCK, steps=_STEPS)
        return 1.0

    def again() -> float:
        harmonic_balance(system, CLOCK, steps=_STEPS)
        return 1.0

    def integration(method: str, steps: int) -> Callable[[], float]:
        def run() -> float:
            simulate(system, CLOCK, 1, start, steps=steps, method=method, extra_force=torque)
            return 1.0 / periods

        return run

    def scipy() -> float:
        end = 1.0 / (CLOCK * _PART)
        solve_ivp(slope, (0.0, end), state, "DOP853", rtol=_TOLERANCE, atol=1e-14)
        return 1.0 / (_PART * periods)

    def sweep() -> float:
        return _sweep(system, 20 if quick else _SPEEDS)

    contenders = {
        "harmonic balance, set-up included": balance,
        "harmonic balance": again,
        "harmonic balance, per speed of a sweep": sweep,
        f"modal engine, {periods} periods": integration("modal", _STEPS),
        f"Runge-Kutta, {periods} periods": integration("rk4", _STEPS),
        f"SciPy DOP853, {periods} periods": scipy,
    }
    times = race(contenders, 1 if quick else 3)
    rows = [
        (name, f"{1e3 * spent.median:.4g}", f"{times['harmonic balance'].faster_than(spent):.3g}")
        for name, spent in times.items()
    ]
    print_table(("steady state to 1e-6", "CPU ms", "times harmonic balance"), rows)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        _reducer(1 if quick else 3)


if __name__ == "__main__":
    main()
