"""Steady motion of a machine by harmonic balance at its contacts.

The unknowns are the motions at the contacts over one period of the clock. The linear structure
appears by its receptances only, so that the cost hardly depends on the number of coordinates.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.arrays.linear_algebra import fast_length, periodic
from tribodyn.dynamics.equations.compiled import Compiled, sample_system
from tribodyn.dynamics.equations.grid import system_events
from tribodyn.dynamics.equations.orbit_coordinates import (
    OverBases,
    Rest,
    at_rest,
    refuse_disconnected,
    warn_of_unbalanced,
)
from tribodyn.dynamics.equations.system import System, contact_label
from tribodyn.dynamics.harmonic.newton import Solution, newton, refined
from tribodyn.dynamics.harmonic.orbit_response import orbit_response, starting_state
from tribodyn.dynamics.harmonic.phase_balance import phase_balance
from tribodyn.dynamics.harmonic.residual import ClockResidual
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.modal.contact_equations import (
    ContactEquations,
    close_contacts,
    components,
    contact_equations,
)
from tribodyn.dynamics.modal.modal_march import ModalMotion
from tribodyn.dynamics.modal.modal_tables import Trace
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.dynamics.time.simulate import read_start
from tribodyn.errors import ComputationError, InputError, require_positive, warn
from tribodyn.interrupt import single_blas_thread
from tribodyn.nomenclature import require_flag, require_number, require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, ComplexArray

#: An orbit whose certified error is above this is not converged.
TOLERANCE = 1e-8
#: Steps per cycle of the fastest mesh with which an automatic choice starts, largest number of
#: steps in a period that it takes, and the step error at which it stops.
_FIRST, _MOST, _ACCURATE = 64, 2**18, 2e-7
#: Most steps per mesh cycle of the response of an automatic choice.
_RECORDED = 512
#: Step error that causes a warning.
STEP_LIMIT = 1e-2
#: Damping added at first where Newton's method does not converge, over the critical damping at the
#: frequency of the fastest mesh, and the factors by which it is reduced.
_ADDED = (0.3, 0.1, 0.03, 0.01, 0.003)
#: Newton steps with each of them, and periods that are integrated, short ones and those that
#: forget their start.
_TRIES, _MARCHED, _LONG = 12, (3, 6, 12, 24), (1, 2)
#: Rounding of two equal multipliers, which is the root of that of one.
_NEUTRAL = 1e-3
#: Steps per cycle of the fastest mesh with which the growth of disturbances is looked at.
_PER_CYCLE = 64
#: Natural logarithm of the decay in a period after which nothing is left of a start.
_FORGOTTEN = 10.0


@dataclass
class Prepared:
    """A system, ready for harmonic balance at any frequency."""

    system: System
    structure: ClosedStructure
    closed: Array  #: sides of springs that are closed at rest, 0 of others (contacts, m)
    equilibrium: Rest  #: static equilibrium
    grids: dict[int, Compiled]
    samples: dict[int, ContactEquations] = field(default_factory=dict)

    def residual(
        self, steps: int, frequency: float, finer: ClockResidual | None = None
    ) -> ClockResidual:
        """Residual on a number of equal steps, or on half the steps of a finer one."""
        if steps not in self.samples:
            twice = self.samples.get(2 * steps)
            template = next(iter(self.samples.values()), None)
            self.samples[steps] = (
                contact_equations(self.system, self.structure, steps, template)
                if twice is None
                else twice.coarser()
            )
        rest = self.closed, self.equilibrium.floating
        return ClockResidual(self.structure, self.samples[steps], frequency, *rest, finer)

    def grid(self, steps: int) -> Compiled:
        """Grid of a response with a number of steps per cycle of the fastest mesh."""
        if steps not in self.grids:
            self.grids[steps] = sample_system(self.system, steps, narrow=True)
        return self.grids[steps]


def prepare(system: System, steps: int = 0) -> Prepared:
    """Evaluate a system once for all frequencies, with at least these steps per mesh cycle."""
    for reference, prepared in _cache:
        if reference() is system:
            return prepared
    steps = max(2 * _FIRST, steps, -(-2 * len(system_events(system)) // system.cycles))
    compiled = sample_system(system, steps, narrow=True)
    refuse_disconnected(compiled)
    narrow = OverBases.of(compiled)
    warn_of_unbalanced(compiled, narrow.coordinates)
    equilibrium = at_rest(narrow)
    structure, closed = close_contacts(narrow, equilibrium)
    prepared = Prepared(system, structure, closed, equilibrium, {steps: compiled})
    _cache[:] = [(weakref.ref(system), prepared), *_cache[:3]]
    return prepared


#: The last systems, so that a sweep over the frequency evaluates a system once.
_cache: list[tuple[weakref.ref[System], Prepared]] = []


def harmonic_balance(
    system: System,
    frequency: float | Sequence[float] | Array,
    *,
    steps: int | Sequence[int] | None = None,
    start: Response | tuple[ArrayLike, ArrayLike] | None = None,
    tolerance: float = TOLERANCE,
    stability: bool = False,
    progress: Progress = SILENT,
) -> Response:
    """Find the motion of a machine with several meshes, on one clock or over independent phases.

    Parameters
    ----------
    system : System
    frequency : float or (phases,) array
        Frequency of the clock: periods of the motion per second [Hz]. A system whose contacts give
        ``cycles`` for each of several phases takes the frequency of each.
    steps : int or sequence of int, optional
        Steps per cycle of the fastest mesh; over several phases the points of each. By default
        they are doubled until the motion changes by less than 2e-7 of its size.
    start : Response or (position, velocity), optional
        Motion, or position and velocity [m or rad, m/s or rad/s], from which the search starts;
        the static equilibrium by default.
    tolerance : float
        Largest certified error of a converged motion.
    stability : bool
        Integrate disturbances over a period for the Floquet multipliers: all, or the four leading
        ones where the motion has more than 24 states.
    progress : Progress
        Receives the progress of the search.

    Returns
    -------
    Response
        Over one period of the clock, with ``error``, ``step_error`` and ``converged``. A warning
        is issued when the motion is not converged (``steady-state``), is not stable
        (``unstable-orbit``) or depends on the steps by more than 1 % of its size (``step-size``).
        Floquet multipliers are those that ``stability`` asks for. A motion over several phases has
        no period: it is a :class:`PhaseResponse`, which gives the motion at any time, and its
        spectral lines with the cycles of each phase. Where that is not converged, a time
        integration from it replaces it, over the cycles that the warning states.

    Raises
    ------
    InputError
        If an argument is out of range or nothing can vibrate.

    Notes
    -----
    Unknowns are the compressions of the contacts over one period on equal steps. The structure
    responds by its receptances at the harmonics of the clock, contacts act in time. Newton's method
    takes steps by generalized minimal residuals; where it fails, the motion is integrated over some
    periods in modal coordinates before the next attempt. ``error`` is the size of the last step,
    ``step_error`` the change of the motion when the steps are halved, or an estimate of it where
    ``steps`` is chosen automatically. With dead zones the start decides which of several motions
    is found. One whose disturbances grow by more than 0.1 % a period, over several phases in a
    cycle of the fastest, which the linearized contacts show, is warned of; ``stability`` computes
    the multipliers of one on a clock.
    A body that nothing loads starts in the middle between its flanks and floats there without
    force, if they leave it room.

    Over several phases the unknowns are functions of all of them: a line of the whole numbers k has
    the frequency ``k.f``, so that no common period is needed. ``step_error`` is then the sum of the
    largest changes of a compression, over the largest, with twice the points over each phase.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> first = Contact([1.0, 0.0], 9.0, error=lambda phase: 0.1 * np.cos(2 * np.pi * phase))
    >>> second = Contact([1.0, -1.0], 5.0, cycles=3)
    >>> machine = System(np.eye(2), 0.2 * np.eye(2), np.eye(2), [1.0, 0.0], [first, second])
    >>> harmonic_balance(machine, 0.3).converged
    True
    >>> from dataclasses import replace
    >>> contacts = [replace(first, cycles=(1, 0)), replace(second, cycles=(0, 1))]
    >>> apart = replace(machine, contacts=contacts)
    >>> harmonic_balance(apart, (0.3, 0.9 / np.sqrt(2.0))).points
    (24, 24)
    """
    require_number("tolerance", tolerance)
    require_positive("tolerance", tolerance, "")
    require_flag("stability", stability)
    if system.phases:
        if stability:
            what, why = "stability = True", "Motions over several phases have no multipliers"
            raise InputError(what, "stability", why, "Integrate disturbances over time instead")
        progress.start("Steady motion", None)
        with single_blas_thread():  # threads of small matrices only wait for each other
            motion = phase_balance(system, frequency, steps, start, tolerance)
        progress.finish()
        return motion
    with single_blas_thread():
        return _on_clock(system, frequency, steps, start, tolerance, stability, progress)


def _on_clock(
    system: System,
    frequency: Any,
    steps: Any,
    start: Response | tuple[ArrayLike, ArrayLike] | None,
    tolerance: float,
    stability: bool,
    progress: Progress,
) -> Response:
    """Periodic motion on one clock."""
    frequency = frequency[0] if np.shape(frequency) == (1,) else frequency
    require_number("frequency", frequency)
    require_positive("frequency", frequency, "Hz")
    count = _FIRST if steps is None else require_whole("steps", steps, 8)
    progress.start("Steady motion", None)
    fewest = 0 if steps is None else count
    prepared = prepare(system, fewest) if system.contacts else None
    if prepared is None or prepared.structure.coordinates.moving.shape[1] == 0:
        what = "no coordinate is moved by a contact"
        remedy = "Add a contact, or use forced_response for a structure alone"
        raise InputError(what, "System.contacts", "Harmonic balance acts at contacts", remedy)
    samples = 2 * fast_length(-(-count * system.cycles // 2))  # an even number
    finer = prepared.residual(2 * samples, frequency)
    residual = prepared.residual(samples, frequency, finer)
    solution = _solve(prepared, residual, _start(prepared, residual, start), tolerance)
    while True:
        y = refined(solution.state.y, 2 * samples)
        if not solution.error <= tolerance:
            step_error = float("nan")
            break
        trial = finer.at(y)
        change = finer.correction(trial, 1e-3)[0]
        step_error = float(np.linalg.norm(change, axis=1).max()) / solution.state.size
        if steps is not None:
            break
        better = newton(finer, y + change, 0.01 * tolerance)
        if not better.error <= tolerance:
            break
        residual, solution, samples = finer, better, 2 * samples
        step_error /= 3.0  # the error of second order falls by a factor of four
        if step_error <= _ACCURATE or 4 * samples > _MOST:
            break
        finer = prepared.residual(2 * samples, frequency)
    progress.finish()
    fine = count if steps is not None else min(samples // (2 * system.cycles), _RECORDED)
    grid = prepared.grid(max(fine, min(prepared.grids)))
    multipliers = np.zeros(0, complex)
    if solution.error <= tolerance and prepared.structure.modes is not None:
        multipliers = _assessed(prepared, residual, solution, exactly=stability)
    error = max(solution.error, float(np.finfo(float).eps))
    facts = {"error": error, "step_error": step_error, "floquet_multipliers": multipliers}
    converged = bool(np.isfinite(error) and error <= tolerance)
    if not converged:
        warn("steady-state", _not_converged(residual, solution, tolerance), stacklevel=2)
    elif step_error > STEP_LIMIT:
        warn("step-size", _step_message(residual, step_error), stacklevel=2)
    response = orbit_response(grid, residual, solution.state, converged=converged, **facts)
    if converged or prepared.structure.modes is None:
        return response
    return _marched(prepared, residual, response, **facts)


def _assessed(
    prepared: Prepared, residual: ClockResidual, solution: Solution, *, exactly: bool
) -> ComplexArray:
    """Floquet multipliers, if they are requested; warns of an unstable motion."""
    from tribodyn.dynamics.harmonic.tangent_march import TangentMarch, warn_of_growth

    what = "Floquet multiplier"
    if not exactly:
        linear = TangentMarch.of(residual, solution.state, _PER_CYCLE * prepared.system.cycles)
        limit = 1.0 + _NEUTRAL
        warn_of_growth(what, linear.leading_multiplier(limit), limit)
        return np.zeros(0, dtype=complex)
    state, torque = starting_state(residual, solution.state)
    motion = _marching(prepared, residual)
    multipliers = motion.multipliers(state, residual.frequency, torque)
    # A body that floats between its flanks keeps a disturbance, two multipliers of 1.
    limit = 1.0 if solution.state.mean_stiffness is None else 1.0 + _NEUTRAL
    warn_of_growth(what, float(np.abs(multipliers[:1]).max(initial=0.0)), limit)
    return multipliers


def _start(
    prepared: Prepared,
    residual: ClockResidual,
    start: Response | tuple[ArrayLike, ArrayLike] | None,
) -> Array:
    """Motion at the contacts (steps, r) from which the search starts."""
    contacts, size = residual.contacts, prepared.system.size
    into = prepared.structure.coordinates.lower @ residual.structure.along
    if isinstance(start, Response):
        at = np.arange(contacts.steps) / contacts.steps
        phase = (start.time - start.time[0]) * start.mesh_frequency
        return periodic(at, phase, start.position @ into, start.periods)
    position = (
        prepared.equilibrium.position
        if start is None
        else read_start(prepared.system, start)[:size]
    )
    y = np.tile(position @ into, (contacts.steps, 1))
    if start is not None:
        return y
    state = residual.at(y, closed=True)  # linear equations: one step solves them
    return y + residual.correction(state)[0]


def _solve(prepared: Prepared, residual: ClockResidual, y: Array, tolerance: float) -> Solution:
    """Newton's method; where it fails, with damping that is removed again and from a march."""
    best = newton(residual, y, 0.01 * tolerance)
    searches = [_with_damping, _from_march]
    if _settles(prepared, residual):
        searches.reverse()
    for search in searches:
        if not best.error <= tolerance:
            trial = search(prepared, residual, y, tolerance)
            best = min(best, trial, key=lambda solution: solution.error)
    return best


def _settles(prepared: Prepared, residual: ClockResidual) -> bool:
    """Whether a period of the clock forgets its start."""
    return prepared.structure.decay / residual.frequency > _FORGOTTEN


def _with_damping(
    prepared: Prepared, residual: ClockResidual, y: Array, tolerance: float
) -> Solution:
    """Newton's method with damping at the contacts that is removed in steps."""
    contacts = residual.contacts
    critical = contacts.rows.stiffness.sum(axis=-1).mean(axis=0)
    critical = critical / (np.pi * residual.frequency * contacts.system.cycles)
    for part in (*_ADDED, 0.0):
        residual.excess = part * critical
        trial = newton(residual, y, 0.01 * tolerance, _TRIES)
        if trial.error < 1e-3:
            y = trial.state.y
    residual.excess = 0.0 * critical
    return trial


def _from_march(
    prepared: Prepared, residual: ClockResidual, y: Array, tolerance: float
) -> Solution:
    """Newton's method from motions that are integrated over some periods."""
    best = Solution(residual.at(y), np.inf, 0, 0)
    if prepared.structure.modes is None:
        return best
    motion = _marching(prepared, residual)
    state, torque = starting_state(residual, best.state)
    for periods in _LONG if _settles(prepared, residual) else _MARCHED:
        try:
            states, _, trace = motion.advance(state, residual.frequency, periods, torque)
        except ComputationError:  # it grows without bounds
            break
        state = states[-1]
        start = _resampled(motion.compiled, trace, residual.contacts.steps)
        trial = newton(residual, start, 0.01 * tolerance, _TRIES)
        best = min(best, trial, key=lambda solution: solution.error)
        if best.error <= tolerance:
            break
    return best


def _marching(prepared: Prepared, residual: ClockResidual) -> ModalMotion:
    """Motion on a grid with at least as many steps as the period has samples."""
    steps = -(-residual.contacts.steps // prepared.system.cycles)
    return ModalMotion(prepared.grid(max(steps, min(prepared.grids))), prepared.structure)


def _marched(
    prepared: Prepared, residual: ClockResidual, response: Response, **facts: Any
) -> Response:
    """The last of some periods that are integrated from a motion that does not repeat."""
    motion = _marching(prepared, residual)
    grid = motion.compiled
    start = response.position[0], response.velocity[0]
    frequency, extra = residual.frequency, response.extra_force
    try:
        states = motion.march(*start, frequency, _LONG[-1], extra, recorded=True)
    except ComputationError:  # it grows without bounds
        return response
    number = prepared.structure.rate * float(grid.grid.width.max()) / residual.frequency
    states = states[-grid.grid.steps - 1 :]
    facts |= {"engine": "modal", "period": 0, "step_error": float("nan")}
    compiled = replace(grid, step_number=number)
    return build_response(compiled, residual.frequency, states, response.extra_force, **facts)


def _resampled(grid: Compiled, trace: Trace, steps: int) -> Array:
    """Motion at the contacts (steps, r) over the last period of a march."""
    phase, at = grid.nodes.phase[:, 1:].reshape(-1), np.arange(steps) / steps
    return periodic(at, phase, np.split(trace.contacts, 2, axis=2)[0].reshape(phase.size, -1))


def _step_message(residual: ClockResidual, step_error: float) -> str:
    return (
        f"the motion changes by {100.0 * step_error:.2g} % of its size with half the steps, limit "
        f"{100.0 * STEP_LIMIT:g} %: {residual.contacts.steps} steps in a period of the clock. Use "
        "more steps per mesh cycle, or omit steps for an automatic choice"
    )


def _not_converged(residual: ClockResidual, solution: Solution, tolerance: float) -> str:
    """Message that names the contact with the largest residual."""
    state, contacts = solution.state, residual.contacts
    distance = np.abs(components(contacts.rows.along, state.residual)).max(axis=0)
    worst = int(np.argmax(distance))
    open_share = float(np.mean(state.law.open[:, worst]))
    reason = (
        f"it is open for {100.0 * open_share:.3g} % of the period, where several motions may exist "
        "or none repeats after a period"
        if open_share > 0.0
        else "it stays closed: its parametric excitation may be unstable"
    )
    return (
        f"no periodic motion was found: certified error {solution.error:.2e}, limit "
        f"{tolerance:.0e}. The largest residual is that of "
        f"{contact_label(contacts.system, worst)}, {1e6 * distance[worst]:.3g} um; {reason}. "
        "A time integration replaces it. Try another start or simulate over time"
    )
