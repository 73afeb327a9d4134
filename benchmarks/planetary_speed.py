"""Planetary stage: steady state of eight meshes, sweep of speeds, and case file to report.

The stage of Lin and Parker has four planets, mesh stiffnesses that vary by 10 % and dead zones. In
a sweep of 200 speeds each motion starts from the one before. The last row is the built-in stage
from its case file to the report, its kernels and the modules of Python loaded.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from tempfile import TemporaryDirectory

import numpy as np

from race import Goal, arguments, machine, print_goals, race
from tribodyn import load_case, run
from tribodyn.dynamics import System, harmonic_balance
from tribodyn.errors import ModelWarning
from tribodyn.machine import mesh_phases, planetary_plane_model
from tribodyn.mesh.build import _cached_teeth

__all__ = ["main", "stage"]

_SPEEDS, _STEPS = 200, 64


def stage() -> System:
    """Stage of Lin and Parker with four planets, 20 and 60 teeth, and 3000 N in every mesh."""

    def stiffness(phase: np.ndarray) -> np.ndarray:
        """Mesh stiffness over the phase."""
        return 5e8 * (1.0 + 0.1 * np.cos(2.0 * np.pi * phase))

    alpha = float(np.radians(24.6))
    return planetary_plane_model(
        planets=4, phases=mesh_phases(sun_teeth=20, ring_teeth=60, planets=4),
        carrier_mass=5.43, carrier_inertia=6.29, ring_mass=2.35, ring_inertia=3.0, sun_mass=0.4,
        sun_inertia=0.39, planet_mass=0.66, planet_inertia=0.61, sun_mesh_stiffness=stiffness,
        ring_mesh_stiffness=stiffness, pin_stiffness=1e8, carrier_support=1e8, ring_support=1e8,
        sun_support=1e8, ring_torsional_support=1e9, sun_pressure_angle=alpha,
        ring_pressure_angle=alpha, force_per_planet=3000.0, damping_ratio=0.03, mesh_gap=30e-6,
    )  # fmt: skip


def main(words: Sequence[str] | None = None) -> None:
    """Measure and print the times with their goals.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Planetary stage: {machine()}\n")
    count = 10 if quick else _SPEEDS
    case = load_case("planetary-stage")

    def steady() -> float:
        harmonic_balance(stage(), 700.0, steps=_STEPS)
        return 1.0

    def sweep() -> float:
        system, motion = stage(), None
        for frequency in np.linspace(200.0, 4000.0, count):
            motion = harmonic_balance(system, float(frequency), steps=_STEPS, start=motion)
        return count / _SPEEDS

    def report() -> float:
        _cached_teeth.cache_clear()
        with TemporaryDirectory() as folder:
            run(case).save(f"{folder}/result")
        return 1.0

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        times = race({"steady": steady, "sweep": sweep, "report": report}, 1 if quick else 3)
    goals = {"steady": ("steady state of 8 meshes", 0.3), "sweep": ("sweep of 200 speeds", 20.0),
             "report": ("case file to report, three loads", 8.0)}  # fmt: skip
    print_goals(
        [
            Goal(text, goal, times[name].median, "CPU s", at_least=False)
            for name, (text, goal) in goals.items()
        ]
    )


if __name__ == "__main__":
    main()
