"""Branches of periodic orbits followed over a parameter, around folds and through instability.

Pseudo-arclength continuation of the map of one or several mesh cycles: a step along the tangent,
then Newton's method in the plane across it, so that the branch may turn back in the parameter.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.nodes import lowest_of_each_law
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.harmonic_balance import TOLERANCE, harmonic_balance
from tribodyn.dynamics.orbits.continuation_path import (
    BranchPoint,
    Family,
    FamilyMap,
    Located,
    StalledError,
    Stepping,
    correct,
    follow,
    hold,
    locate,
    tests_of_multipliers,
    with_values,
)
from tribodyn.dynamics.orbits.orbit_map import OrbitMap, newton
from tribodyn.dynamics.orbits.search import find_orbit, motion_size
from tribodyn.dynamics.orbits.solution_branch import Branch, SpecialPoint
from tribodyn.dynamics.time.response import Response, build_response, sample_extremes
from tribodyn.dynamics.time.simulate import read_start
from tribodyn.errors import ComputationError, InputError, no_such, quiet, require_positive, warn
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array

#: A start this close to an orbit, relative to the motion, is taken for that orbit.
_NEAR = 0.1
#: Periods after which Newton's method starts in modal coordinates.
_SETTLED = 100
#: First step away from a point where the period doubles, relative to the motion.
_ASIDE = 1e-2
#: Figures of the orbits that a branch stores.
_COLUMNS = (
    "position",
    "velocity",
    "mean",
    "rms",
    "peak_to_peak",
    "peak_force",
    "contact_loss",
    "clearance",
)


def continuation(
    make_system: System | Callable[[float], System | tuple[System | Compiled, float]],
    mesh_frequency: float | None = None,
    *,
    parameter: str = "mesh_frequency",
    between: tuple[float, float],
    start: tuple[ArrayLike, ArrayLike] | SpecialPoint | None = None,
    at: ArrayLike = (),
    periods: int = 1,
    steps: int = 512,
    longest_step: float = 0.02,
    points: int = 2000,
    signals: Sequence[str] | None = None,
    tolerance: float = 1e-9,
    progress: Progress = SILENT,
) -> Branch:
    """Follow periodic orbits over a parameter, stable or not, and mark where they change.

    Parameters
    ----------
    make_system : System or function
        A system, whose mesh frequency is then the parameter; or a function of the parameter that
        returns a system, or a system and its mesh frequency.
    mesh_frequency : float, optional
        Mesh frequency [Hz] where the function returns systems only.
    parameter : str
        Name of the parameter.
    between : (float, float)
        First and last parameter [its unit]. The branch begins at the first and ends where it
        leaves the range, at either end.
    start : (position, velocity) or SpecialPoint, optional
        Two (n,) arrays [m or rad, m/s or rad/s] from which to look for the first orbit; the static
        equilibrium by default. Or a period doubling: the branch of twice the period is then
        followed from there.
    at : (m,) array
        Parameters whose orbits are added to the branch [its unit].
    periods : int
        Mesh cycles after which the motion repeats.
    steps : int
        Steps per mesh cycle.
    longest_step : float
        Longest step relative to the range [-].
    points : int
        Points at most.
    signals : sequence of str, optional
        Names of coordinates or ``"deflection"``, ``"deflection 1"`` ... for the compression of
        the contacts; the first contact by default.
    tolerance : float
        Largest error of a point relative to the first motion [-].
    progress : Progress
        Receives the progress over the points.

    Raises
    ------
    InputError
        If an argument is out of range or the step is too long.
    ComputationError
        If no first orbit is found.

    Notes
    -----
    Folds are where the parameter turns back, period doublings where a multiplier passes -1,
    Neimark-Sacker points where a complex pair passes the unit circle, branch points where another
    branch crosses, grazing where a contact begins to open. Pairs of such points between two
    neighbouring orbits are overlooked: a shorter ``longest_step`` finds them. If a branch cannot be
    followed further, a warning (``steady-state``) reports where and why, and the part so far is
    returned.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> mesh = Contact([1.0], stiffness=lambda p: 1 + 0.2 * np.cos(2 * np.pi * p), gap=1.0)
    >>> pair = System([[1.0]], [[0.1]], [[0.0]], [0.5], [mesh])
    >>> branch = continuation(pair, between=(0.12, 0.16), steps=256)
    >>> [f"{2 * np.pi * fold.parameter:.4f}" for fold in branch.special("fold")]
    ['0.9069', '0.8344']
    """
    _check(between, periods, longest_step, points)
    if isinstance(start, SpecialPoint):
        periods = 2 * start.period
    low = min(between) if isinstance(start, SpecialPoint) else between[0]
    family = Family(make_system, mesh_frequency, steps, min(between))
    function = FamilyMap(family, int(periods), (float(low), float(sum(between) - low)), tolerance)
    progress.start("Points of the branch", None)
    names = signal_names(function.at(low).compiled.system, signals)
    require_positive("tolerance", tolerance)
    first = _first(function, start, between)
    stepping = Stepping(longest_step, points)
    orbits, ending, complete = follow(function, first, stepping, progress)
    orbits = with_values(function, orbits, np.asarray(at, dtype=float))
    branch = _collect(function, orbits, names, parameter, (ending, complete))
    progress.finish()
    if not complete:
        warn("steady-state", f"the branch over {parameter} {ending}", stacklevel=2)
    return branch


def _check(between: tuple[float, float], periods: int, longest: float, points: int) -> None:
    first, last = between
    problem = ""
    if not (np.isfinite(first) and np.isfinite(last) and first != last):
        problem, where = f"between = {between}", "two different finite numbers"
    elif int(periods) != periods or periods < 1:
        problem, where = f"periods = {periods}", "a whole number >= 1"
    elif not 0.0 < longest <= 1.0:
        problem, where = f"longest_step = {longest}", "a part of the range in (0, 1]"
    elif points < 2:
        problem, where = f"points = {points}", "a whole number >= 2"
    if problem:
        name = problem.partition(" ")[0]
        why = f"It is {where}"
        raise InputError(problem, f"argument {name}", why, "Give a value of this range")


def _first(
    function: FamilyMap,
    start: tuple[ArrayLike, ArrayLike] | SpecialPoint | None,
    between: tuple[float, float],
) -> BranchPoint:
    if isinstance(start, SpecialPoint):
        return _aside(function, start)
    mapping = function.at(between[0])
    system = mapping.compiled.system
    state = static_start(mapping.compiled) if start is None else read_start(system, start)
    y = mapping.start(state)
    if start is not None:
        # The start may be a state of an unstable orbit, which a search would leave.
        function.size = motion_size(mapping, mapping.follow(y)[1])
        try:
            point = correct(function, np.append(y / function.size, 0.0), hold(y.size + 1), None)
            if np.linalg.norm(point.x[:-1] - y / function.size) < _NEAR:
                return point
        except StalledError:
            pass
    y, error = _search(mapping, y)
    if not error <= TOLERANCE:
        raise ComputationError(
            f"no orbit of {function.periods} mesh cycle(s) was found at {between[0]:g}: "
            f"certified error {error:.2e}",
            why=f"The limit is {TOLERANCE:.0e}",
            remedy="Begin at another value, give a start, or try periods = 2, 3, 4",
        )
    function.size = motion_size(mapping, mapping.follow(y)[1])
    x = np.append(y / function.size, 0.0)
    return correct(function, x, hold(x.size), None)


def _search(mapping: OrbitMap, y: Array) -> tuple[Array, float]:
    """Orbit that a start leads to, and its certified error."""
    if mapping.compiled.engine is None:
        orbit = find_orbit(mapping, y, TOLERANCE)
        return orbit.point, orbit.error
    if mapping.periods == 1 and mapping.balance is None:
        with quiet():  # what is not found is reported here
            motion = harmonic_balance(mapping.compiled.system, float(1.0 / mapping.period))
        y = mapping.start(np.concatenate((motion.position[0], motion.velocity[0])))
    else:
        for _ in range(_SETTLED):
            y = mapping(y)
    orbits = newton(mapping, y[None], TOLERANCE)
    return orbits.point[0], float(orbits.error[0])


def _aside(function: FamilyMap, start: SpecialPoint) -> BranchPoint:
    """First point of the branch of twice the period, near the point where it begins."""
    if not 0.0 <= (start.parameter - function.origin) / function.range <= 1.0:
        what = f"start lies at {start.parameter:.8g}"
        why = f"The range is {function.origin:g} to {function.origin + function.range:g}"
        raise InputError(what, "argument start", why, "Start within the range, or widen it")
    mapping = function.at(start.parameter)
    y = mapping.start(np.concatenate((start.position, start.velocity)))
    function.size = motion_size(mapping, mapping.follow(y)[1])
    x = np.append(y / function.size, (start.parameter - function.origin) / function.range)
    # Over twice the period the multiplier is +1: the direction is that in which nothing changes.
    values, vectors = np.linalg.eig(function.jet(x).matrix)
    real = np.real(vectors[:, np.argmin(np.abs(values - 1.0))])
    # Its sign is free, and that of a library: the first large component is positive.
    real *= np.sign(real[np.abs(real) > 0.5 * np.abs(real).max()][0])
    along = np.append(real / np.linalg.norm(real), 0.0)
    for length in _ASIDE * 0.5 ** np.arange(6 if start.kind == "period-doubling" else 0):
        try:
            point = correct(function, x + length * along, along, None)
        except StalledError:
            continue
        if (point.x - x) @ along > 0.5 * length:
            outward = np.sign(point.tangent @ along) or 1.0
            return replace(point, tangent=outward * point.tangent)
    raise ComputationError(
        f"no branch of {function.periods} mesh cycles was found at {start.parameter:.8g}",
        why=f"The start is a {start.kind} of period {start.period}",
        remedy="Start at a period-doubling; a linear system has no such branch",
    )


def _collect(
    function: FamilyMap,
    orbits: list[BranchPoint],
    signals: tuple[str, ...],
    name: str,
    ending: tuple[str, bool],
) -> Branch:
    def figures(point: BranchPoint) -> OrbitFigures:
        value = function.parameter(point.x)
        mapping = function.at(value)
        return measure(mapping, function.reduced(point.x), signals)

    measured = [figures(point) for point in orbits]
    opening = {id(point): item.opening for point, item in zip(orbits, measured, strict=True)}
    located = _located(function, orbits, figures, opening)
    values = np.array([function.parameter(point.x) for point in orbits])
    multipliers = np.array([point.multipliers for point in orbits])
    return Branch(
        name=name,
        parameter=values,
        mesh_frequency=np.array([item.mesh_frequency for item in measured]),
        period=function.periods,
        names=tuple(function.at(float(values[0])).compiled.system.names),
        signals=signals,
        **{name: np.array([getattr(item, name) for item in measured]) for name in _COLUMNS},
        floquet_multipliers=multipliers,
        stable=np.abs(multipliers).max(axis=1, initial=0.0) < 1.0,
        error=np.array([point.error for point in orbits]),
        special_points=tuple(_special(function, item, figures(item.point)) for item in located),
        ending=ending[0],
        complete=ending[1],
        cycles_used=function.cycles,
    )


def _located(
    function: FamilyMap,
    orbits: list[BranchPoint],
    figures: Callable[[BranchPoint], OrbitFigures],
    openings: dict[int, float],
) -> list[Located]:
    """Special points in the order of the branch."""
    located: list[Located] = []
    for kind, (test, holds) in tests_of_multipliers().items():
        located += locate(function, orbits, kind, test, holds)
    if np.isfinite(openings[id(orbits[0])]):

        def opening(point: BranchPoint) -> float:
            cached_opening = openings.get(id(point))
            return figures(point).opening if cached_opening is None else cached_opening

        located += locate(function, orbits, "grazing", opening, lambda point: True)
    return sorted(
        located, key=lambda item: (item.after, np.linalg.norm(item.point.x - orbits[item.after].x))
    )


def _special(function: FamilyMap, item: Located, figures: OrbitFigures) -> SpecialPoint:
    return SpecialPoint(
        kind=item.kind,
        parameter=function.parameter(item.point.x),
        mesh_frequency=figures.mesh_frequency,
        position=figures.position,
        velocity=figures.velocity,
        floquet_multipliers=item.point.multipliers,
        rms=figures.rms,
        peak_to_peak=figures.peak_to_peak,
        period=function.periods,
        index=item.after,
    )


@dataclass(frozen=True)
class OrbitFigures:
    """Figures of one orbit."""

    mesh_frequency: float  #: mesh frequency [Hz]
    position: Array  #: [m or rad, m/s or rad/s]
    velocity: Array  #: [m or rad, m/s or rad/s]
    mean: Array
    rms: Array
    peak_to_peak: Array
    peak_force: Array  #: largest force [N]
    contact_loss: Array  #: part of the time off the driving flank [-]
    clearance: Array  #: least compression beyond the gap [m]
    opening: float  #: the least clearance of those contacts that can open [m]


def signal_names(system: System, wanted: Sequence[str] | None) -> tuple[str, ...]:
    """Names of the signals to measure."""
    count = len(system.contacts)
    deflections = ("deflection",)[:count] + tuple(f"deflection {j}" for j in range(1, count))
    if wanted is None:
        return deflections[:1] or tuple(system.names)
    for name in wanted:
        if name not in (*deflections, *system.names):
            names = (*deflections, *system.names)
            raise InputError(no_such("signal", name, names, "argument signals"))
    return tuple(wanted)


def _signal(response: Response, name: str) -> Array:
    if name in response.names:
        return response.fine.position[:, response.index(name)]
    return response.fine.deflection[:, int(name.partition(" ")[2] or 0)]


def measure(mapping: OrbitMap, y: Array, signals: Sequence[str]) -> OrbitFigures:
    """Record one orbit and measure it."""
    states, extra = mapping.record(y)
    frequency = float(1.0 / mapping.period)
    response = build_response(mapping.compiled, frequency, states, extra)
    fine, nodes = response.fine, mapping.compiled.nodes
    values = np.stack([_signal(response, name) for name in signals], axis=1)
    mean = fine.mean(values)
    low, high = sample_extremes(values)
    count = nodes.gap.shape[2]
    gap = np.tile(nodes.gap, (response.periods, 1, 1))
    beyond = fine.deflection - gap.reshape(fine.deflection.shape)
    dead = np.any(nodes.gap > 0.0, axis=(0, 1))
    clearance = sample_extremes(beyond)[0] if count else np.zeros(0)
    able = dead & lowest_of_each_law(nodes) if count else dead
    return OrbitFigures(
        mesh_frequency=frequency,
        position=states[0, : response.position.shape[1]].copy(),
        velocity=response.velocity[0].copy(),
        mean=mean,
        rms=np.sqrt(fine.mean((values - mean) ** 2)),
        peak_to_peak=high - low,
        peak_force=sample_extremes(fine.contact_force)[1] if count else np.zeros(0),
        contact_loss=fine.mean(1.0 * ((beyond <= 0.0) & dead)),
        clearance=clearance,
        opening=float(clearance[able].min()) if able.any() else float("nan"),
    )
