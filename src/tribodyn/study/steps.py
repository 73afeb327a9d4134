"""How many integration steps a case takes per mesh cycle, and the least speed that this allows."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribodyn.errors import InputError, Problem
from tribodyn.study.structure import Solver

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.study.case import Case


_STEPS = "steps_per_mesh_cycle"
#: Margin of the least speed that is recommended.
_MARGIN = 1.05
#: Steps at which the fastest motion is looked up.
_COARSE = 1024


def steps_of(case: Case, system: System, mesh_frequency: float) -> int:
    """Steps per mesh cycle that were asked for, else those that follow the fastest motion."""
    from tribodyn.dynamics import recommended_steps
    from tribodyn.dynamics.equations.program import compile_system
    from tribodyn.dynamics.equations.step_limit import LIMIT, largest_rate

    spec = Solver.spec(_STEPS)
    most = spec.high if spec else float("inf")
    needed = largest_rate(system, compile_system(system, _COARSE)[1]) / (LIMIT * mesh_frequency)
    if needed > most:
        raise InputError(_too_slow(case, needed, most))
    return case.solver.steps_per_mesh_cycle or recommended_steps(system, mesh_frequency)


def _too_slow(case: Case, needed: float, most: float) -> Problem:
    from tribodyn import units

    def rpm(speed: float) -> str:
        return f"{units.convert(speed, 'rad/s', 'rpm'):.3g} rpm"

    speed = case.operation.speed
    return Problem(
        f"speed = {rpm(speed)} needs {needed:.3g} steps per mesh cycle",
        "argument pinion_speed",
        f"The structure vibrates so fast within one slow mesh cycle; {most:.0f} steps are the most",
        f"The least speed that works is {rpm(_MARGIN * speed * needed / most)}; slower gears carry "
        "their load statically",
    )
