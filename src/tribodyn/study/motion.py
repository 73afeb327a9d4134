"""From the mesh of a case to its motion: the structure, and the steady state or the transient."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribodyn.errors import ComputationError, ModelWarning, Problem, warn
from tribodyn.progress import Progress
from tribodyn.study.collect import collected
from tribodyn.study.provenance import effective
from tribodyn.study.steps import steps_of
from tribodyn.study.tooth_contact import mesh_law_of

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.study.case import Case


#: Mesh cycles after which a steady motion may repeat.
_PERIODS = (1, 2, 3, 4)


def motion_of(case: Case, system: System, mesh_frequency: float, progress: Progress) -> Response:
    """Compute the motion of a case."""
    steps = steps_of(case, system, mesh_frequency)
    if case.solver.method == "steady":
        response = _steady(system, mesh_frequency, steps, progress)
    else:
        response = _transient(case, system, mesh_frequency, steps, progress)
    _warn_of_tension(case, response)
    return response


def _transient(
    case: Case, system: System, mesh_frequency: float, steps: int, progress: Progress
) -> Response:
    """March from the static equilibrium; a balancing torque is that of the steady state."""
    from tribodyn.dynamics import simulate, steady_state
    from tribodyn.dynamics.equations.compiled import compile_for
    from tribodyn.dynamics.orbits.start import static_start

    cycles = effective(case)["solver.cycles"]
    extra = None
    if system.balance is not None:
        with collected():
            extra = steady_state(system, mesh_frequency, steps=steps).extra_force
    state = static_start(compile_for(system, mesh_frequency, steps))
    start = (state[: system.size], state[system.size :])
    return simulate(
        system, mesh_frequency, cycles, start, steps=steps, extra_force=extra, progress=progress
    )


def _steady(system: System, mesh_frequency: float, steps: int, progress: Progress) -> Response:
    """Search orbits of one to four mesh cycles; the first that is found is the answer."""
    from tribodyn.dynamics import steady_state

    for periods in _PERIODS:
        with collected() as found:
            orbit = steady_state(
                system, mesh_frequency, steps=steps, periods=periods, progress=progress
            )
        if orbit.converged and orbit.stable:
            _pass_on(found)
            if periods > 1:
                warn("subharmonic", f"the motion repeats only after {periods} mesh cycles")
            return orbit
    raise ComputationError(_lost(orbit))


def _pass_on(found: list[ModelWarning]) -> None:
    for warning in found:
        warn(warning.code, warning.message, stacklevel=3)


def _lost(orbit: Response) -> Problem:
    multiplier = abs(orbit.floquet_multipliers[0]) if orbit.floquet_multipliers.size else 0.0
    return Problem(
        f"no stable motion repeats within {_PERIODS[-1]} mesh cycles: error {orbit.error:.2e}, "
        f"largest multiplier {multiplier:.4g}",
        "solver.method",
        "The motion repeats after more cycles, or never",
        'Look at it over time with solver.method = "transient", or add damping',
    )


def _warn_of_tension(case: Case, response: Response) -> None:
    """A mesh without backlash pulls where real flanks would part."""
    least = float(response.contact_force.sum(axis=1).min())
    if case.backlash == 0.0 and least < 0.0:
        linear = mesh_law_of(case) != "force-law"
        kept = "makes the mesh linear" if linear else "lets the back flanks push at once"
        warn(
            "mesh-tension",
            f"backlash 0 {kept}, and its force falls to {least:.4g} N: real flanks "
            "part below 0 N. Give dynamics.backlash, for example 0.05 mm",
        )
