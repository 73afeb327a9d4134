"""Motion of a machine over several independent phases, by harmonic balance at its contacts."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tribodyn.arrays.memory import machine_memory
from tribodyn.dynamics.equations.orbit_coordinates import (
    OverBases,
    at_rest,
    orbit_coordinates,
    refuse_disconnected,
)
from tribodyn.dynamics.equations.phases import read_frequencies
from tribodyn.dynamics.equations.system import System, contact_label
from tribodyn.dynamics.harmonic.newton import DIRECT, Solution, State, released, solved
from tribodyn.dynamics.harmonic.phase_grid import (
    AHEAD,
    Fields,
    Follower,
    PhaseGrid,
    Points,
    Work,
    doubled,
    first_sizes,
    most_points,
    points_of,
    read_points,
    time_of_grids,
    whose,
)
from tribodyn.dynamics.harmonic.phase_residual import Part, PhaseResidual, parts_of
from tribodyn.dynamics.harmonic.phase_response import (
    PhaseResponse,
    along_line,
    growth,
    marched_response,
    phase_response,
    recorded,
    sum_lines,
    time_of_march,
)
from tribodyn.dynamics.harmonic.phase_rows import PhaseRows, sampled_forces
from tribodyn.dynamics.harmonic.radial_clearance import REMEDY, RadialClearance, about_load
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.modal.contact_equations import close_contacts, components
from tribodyn.errors import ComputationError, InputError, warn
from tribodyn.types import Array, Index, Mask

#: Points over a phase with which a motion is tried to be found at last.
_LAST = 96
#: Most unknowns of any grids of an automatic choice, and of those where forces bend or jump.
_MANY, _MOST = 2**17, 3 * 2**14
#: Changes of the motion with twice the points at which it stops, each with the most unknowns for
#: it: while they fall to less than a part from grid to grid, and where forces bend or jump.
_SMOOTH, _FALLING, _BROKEN = ((2e-7, _MANY),), 0.1, ((1e-5, 2**13), (2e-3, _MOST))
#: Change above which grids grow further where a mesh rings, and the most unknowns for it.
_ROUGHLY, _LARGE = 9e-3, 2**18
#: Ratio of the changes with more and with twice the points above which lines that few points leave
#: out are those of a natural frequency.
_RINGS = 2.0
#: Memory per unknown of a motion on stated points, of one whose points grow, and of one that is
#: looked at with more points [byte]; copies of the entries along mesh cycles.
_PLAIN, _BYTES, _LOOKED, _SAMPLES = 1.5e3, 1.2e3, 6e2, 2.5
#: Least force of a contact on the first grids, over its mean, below which jumps may open it.
_OPENS = 0.5
#: Time per unknown of a motion on stated points [s], unknowns of grids up to which a trial motion
#: shows what forces do, and of the first ones up to which it has all their points; or so few.
_STATED, _TRIAL, _WHOLE, _FEW = 6e-5, 2**16, 2**14, 4
#: Time per line and sample of the record, and per sample of the closed line and column [s].
_SUMMED, _ALONG = 1.3e-8, 1e-7
#: Step error that causes a warning; part of the largest change with which a phase is refined too.
_LIMIT, _WORST = 1e-2, 0.2
#: Part of the step error that the error of a motion on the way to finer grids may have.
_NEARLY = 0.05
#: Part of the largest change below which that with twice the points is not estimated again.
_AGAIN = 1e-3
#: Unit of the damping that is added where Newton's method does not converge, over the critical
#: damping at the highest mesh frequency, and what is added at first: logarithm of one and its
#: number of units. Part of the least damping for which there is a motion to which it falls with
#: more points, or these are of no use.
_UNIT, _ADDED, _GAINS = 0.003, 4.6, 0.7
#: Growth in a cycle of the fastest phase that is warned of; logarithm of the largest stated one.
_GROWS, _HIGH = 1.001, 50.0
#: Accuracy of the linear motion, most products with the derivative of the motions with added
#: damping, and of these times unknowns.
_ROUGH, _RELEASE, _SPENT = 0.1, 480, 8_000_000


def work_of(system: System, frequency: Any, supports: Sequence[RadialClearance] = ()) -> Work:
    """What the motion of a system over phases takes, from a trial on its first grids."""
    search = _Search.of(system, read_frequencies(frequency, system.phases), supports)
    points = _first_points(search)
    if not (whole := search.size(points) <= _WHOLE):
        sizes = np.where(search.followed(), points, np.minimum(points, _FEW)).tolist()
        points = tuple(map(tuple, sizes))
    residual = search.residual(points)
    rows, firsts = search.rows, [part.rows.meshes[0] for part in search.parts]
    rates = [abs(rows.rate(mesh.cycles)) * mesh.period for mesh in firsts]
    columns = [part.along.shape[1] / part.members.size for part in search.parts]
    widths = tuple(zip(rates, columns, strict=True))
    untried = Work(size=system.size, columns=widths, samples=_SAMPLES * rows.memory)
    if residual.ends[-1] > _TRIAL:
        return untried
    state = (solution := solved(residual, search.linear(residual), 1e-4)).state
    again = np.full(np.shape(points), whole)  # few points tell nothing of those over other phases
    for number, part in enumerate(search.parts):
        again[number, part.axis] = bool(part.axes)
    errors, times = search.changes(points, residual, state, again, np.zeros(again.shape))
    cells = [each.pieces is not None for each in state.each]
    forces = [each.law.contact for each in state.each]
    low = [(each.min(axis=0) < _OPENS * each.mean(axis=0)).any() for each in forces]
    parted = [each.law.open.any() for each in state.each]
    kind = "smooth" if np.ptp(state.rate) else "steady"
    if any(parted) or any(np.logical_and(cells, low)):
        kind = "open"
    elif any(cells):
        kind = "ringing" if (times > 2).any() else "broken"
    over = whose(rows.frequency, [part.axis for part in search.parts], rates)
    changes = tuple(
        (rates[n], float(over[axis]), float(errors[n, axis]), int(times[n, axis]))
        for n, axis in np.ndindex(errors.shape)
        if again[n, axis]
    )
    springs = 1 + rows.means.nodes.ramp_gap.shape[-1]
    steps = solution.newton + 1  # one more has the accuracy of a motion
    products = solution.krylov * steps // max(solution.newton, 1)
    tried = untried._replace(kind=kind, newton=steps, products=products, springs=springs)
    return tried._replace(decay=search.structure.decay, changes=changes)


def phase_cost(
    fields: Sequence[Fields], frequency: Sequence[float], orders: Any = 0,
    mesh: int | None = None, work: Work | None = None,
) -> tuple[int, float, float, float]:  # fmt: skip
    """Unknowns, memory [byte], and times [s] if the motion is found, and at most if it is not."""
    phases, work, rates = len(frequency), work or Work(), np.asarray(frequency, dtype=float)
    followers = [work.wide(Follower(*each), rates) for each in fields]
    grids = first_sizes(followers, orders, mesh)
    parts = [each.contacts * size for each, size in zip(followers, grids, strict=True)]
    first = sum(parts)
    rings = work.kind == "ringing"
    largest = min(max(AHEAD * first, 2**14), _LARGE) if rings else min(2 * first, _MOST)
    unknowns = max(first, largest) if mesh is None else first
    # The largest part is looked at with twice its points, and with more where its forces jump.
    part = unknowns * max(parts) / first
    ahead = min(AHEAD * part, _LARGE) if work.kind not in ("steady", "smooth") else 0.0
    memory = 1e8 + 1.2e8 * phases + work.samples
    marched, products = time_of_march(followers, rates, work), _products_in_vain(first)
    if mesh is not None:
        seconds = 0.1 + _STATED * unknowns
        return unknowns, memory + _PLAIN * unknowns, seconds, seconds * products / 30 + marched
    memory += _BYTES * unknowns + _LOOKED * max(2.0 * part, ahead)
    seconds, lines = time_of_grids(followers, orders, rates, work, _poor)
    tried = work._replace(newton=products // 4, products=products)
    marched += time_of_grids(followers, orders, rates, tried, lambda *a: np.zeros_like(a[2]))[0]
    columns = 3 * work.size + 2 * sum(each.contacts for each in followers)
    seconds += _SUMMED * lines * recorded(rates) + _ALONG * columns * along_line(rates)
    return unknowns, memory, seconds, marched


def _products_in_vain(first: int) -> int:
    """Most products with the derivative, as on first grids of so many unknowns, of a search."""
    finer = first * 2.0 ** np.arange(1 + max(0, int(np.log2(_MOST / first))))
    return DIRECT + int(sum(min(_RELEASE * size, _SPENT) for size in finer) / first)


@dataclass
class _Search:
    """A system over several phases with what does not depend on the grids."""

    rows: PhaseRows
    structure: ClosedStructure
    parts: list[Part]
    start: Array  #: static equilibrium (n,)

    @classmethod
    def of(
        cls, system: System, frequency: Array, supports: Sequence[RadialClearance] = ()
    ) -> _Search:
        if supports:
            system, supports = _supported(system, supports, frequency)
        rows = PhaseRows.of(system, frequency, supports)
        means = rows.means
        refuse_disconnected(means)
        orbit_coordinates(means, float(frequency.max()))  # warns of forces that do not balance
        narrow = OverBases.of(means, sampled_forces(system))
        equilibrium = at_rest(narrow)
        structure, _ = close_contacts(narrow, equilibrium)
        parts = parts_of(rows, structure, equilibrium)
        return cls(rows, parts[0].structure, parts, equilibrium.position)

    def residual(self, points: Points, prior: PhaseResidual | None = None) -> PhaseResidual:
        """Residual on grids with so many points over each phase."""
        grids = [PhaseGrid(shape, self.rows.frequency) for shape in points]
        return PhaseResidual(self.parts, grids, self.rows.force, prior)

    def still(self, residual: PhaseResidual) -> Array:
        """Motion of the parts at rest."""
        x = self.start @ self.structure.coordinates.lower
        return residual.joined(
            [np.tile(x @ part.structure.along, (part.grid.size, 1)) for part in residual.parts]
        )

    def linear(self, residual: PhaseResidual) -> Array:
        """Motion with the contacts that are closed at rest."""
        static = self.still(residual)
        return static + residual.correction(residual.at(static, closed=True), _ROUGH)[0]

    @cached_property
    def damping(self) -> Array:
        """Unit of the damping that is added to the contacts [N*s/m]."""
        stiffness = self.rows.means.nodes.stiffness
        critical = stiffness.reshape(-1, stiffness.shape[-1]).mean(axis=0)
        fastest = max(abs(self.rows.rate(mesh.cycles)) * mesh.period for mesh in self.rows.meshes)
        return np.asarray(_UNIT * critical / (np.pi * fastest))

    def first(
        self, points: Points, start: PhaseResponse | None, tolerance: float, free: bool
    ) -> tuple[Points, PhaseResidual, Solution]:
        """Motion on the first grids, on finer ones if they are free and help to find it."""
        residual = self.residual(points)
        y = self.linear(residual) if start is None else self._resampled(start, residual)
        tried = points, residual, solved(residual, y, tolerance)
        if tried[-1].error <= tolerance:
            return tried
        level, before, followed = _ADDED, np.inf, self.followed()
        left = min(_RELEASE, _SPENT // self.size(points))
        while level <= _GAINS * before and left > 0:
            before = level
            solution, level, y, left = released(residual, y, self.damping, tolerance, level, left)
            if solution is not None:
                return points, residual, solution
            more = doubled(points, np.ones_like(followed))
            more = more if self.size(more) <= _MOST else doubled(points, followed)
            if not free or np.max(points) >= _LAST or self.size(more) > _MOST:
                break
            finer = self.residual(more, residual)
            points, residual, y = more, finer, residual.refined(y, finer)
        return tried

    def followed(self) -> Mask:
        """Phases that each part follows (parts, phases)."""
        phases = range(self.rows.frequency.size)
        return np.array([[axis in part.axes for axis in phases] for part in self.parts])

    def size(self, points: Points) -> int:
        """Number of unknowns on grids with so many points over each phase."""
        widths = (part.along.shape[1] for part in self.parts)
        return sum(math.prod(shape) * w for shape, w in zip(points, widths, strict=True))

    def _resampled(self, start: PhaseResponse, residual: PhaseResidual) -> Array:
        """Motion of the parts of another solution."""
        numbers, values = start._all_lines
        position = values[:, : len(start.names)]
        return residual.joined([
            sum_lines(
                part.grid.points, numbers,
                position @ (self.structure.coordinates.lower @ part.structure.along),
            )
            for part in residual.parts
        ])  # fmt: skip

    def changes(
        self, points: Points, residual: PhaseResidual, state: State, again: Mask, before: Array
    ) -> tuple[Array, Index]:
        """Change with more points of each part over each phase, or of before; times the points."""
        # Twice; more where the lines between excite a natural frequency.
        errors, times = before.copy(), np.full(before.shape, 2)
        first, size = _first_points(self), residual.extent(state.y) or 1.0

        def change(place: Index, factor: int) -> float:
            which = np.zeros(errors.shape, dtype=bool)
            which[*place] = True
            grids = doubled(points, which, factor)
            if factor > 2 and self.size(grids) > _LARGE:
                return 0.0
            return self.residual(grids, residual).change(residual, state, place[0]) / size

        for place in np.argwhere(again):
            errors[*place] = change(place, 2)
            jumps = state.each[place[0]].pieces is not None
            # As far as with so many times the points of the first grids.
            factor = AHEAD * first[place[0]][place[1]] // points[place[0]][place[1]]
            if jumps and place[1] == self.parts[place[0]].axis and factor > 2:
                ahead = change(place, factor)
                if ahead > _RINGS * errors[*place]:
                    errors[*place], times[*place] = ahead, factor
        return errors, times


def _poor(
    size: Callable[[Points], int], points: Points, errors: Array, times: Index, smooth: bool
) -> Mask:
    """Grids whose points are too few: those with the largest errors; none if they are small."""
    chosen = np.zeros(errors.shape, dtype=bool)
    # Where flanks part and nothing rings, more points would change the motion as much again.
    further = ((_ROUGHLY, _LARGE),) if (times > 2).any() else ()
    for limit, most in (*(_SMOOTH if smooth else _BROKEN), *further):
        large = errors > (limit / errors.size if smooth else _WORST * errors.max())
        left = errors.sum()
        if left <= limit or chosen.any():
            break
        for place in np.argsort(-errors, axis=None)[: np.count_nonzero(large)]:
            chosen.flat[place] = most != _LARGE or left > limit
            chosen.flat[place] &= size(doubled(points, chosen, times)) <= most
            left -= errors.flat[place] * chosen.flat[place]
    return chosen


def _supported(
    system: System, supports: Sequence[RadialClearance], frequency: Array
) -> tuple[System, list[RadialClearance]]:
    """System with springs for supports about their mean loads, and their laws for these."""
    cycles, loads = system.contacts[0].cycles, np.zeros((len(supports), 2))
    # Springs without clearance first, whose displacements have the directions of the loads.
    for laws in ([replace(each, clearance=0.0) for each in supports], supports):
        pairs = [about_load(each, load, cycles) for each, load in zip(laws, loads, strict=True)]
        springs = [spring for _, two in pairs for spring in two]
        supported = replace(system, contacts=[*system.contacts, *springs])
        if laws is not supports:
            means = PhaseRows.of(supported, frequency).means
            position = at_rest(OverBases.of(means)).position
            loads = np.array([each.displacement(position) for each in supports])
    return supported, [law for law, _ in pairs]


def phase_balance(
    system: System, frequency: Any, steps: Any, start: Any, tolerance: float,
    supports: Sequence[RadialClearance] = (),
) -> PhaseResponse:  # fmt: skip
    """Find the motion over several phases; arguments as of :func:`harmonic_balance`."""
    frequency = read_frequencies(frequency, system.phases)
    alike = isinstance(start, PhaseResponse) and start.frequencies.size == frequency.size
    if start is not None and not (alike and len(start.names) == system.size):
        what, why = "start is no motion over these phases", "Grids of several phases are refined"
        remedy = "Give the Response of another frequency of the same system, or leave it out"
        raise InputError(what, "start", why, remedy)
    search = _Search.of(system, frequency, supports)
    points = (
        _first_points(search)
        if steps is None
        else read_points(steps, frequency.size, len(search.parts))
    )
    _refuse_large(search, points)
    points, residual, solution = search.first(points, start, tolerance, steps is None)
    limit, errors = tolerance, np.full(np.shape(points), np.nan)
    converged_motion = points, residual, solution, errors
    smooth = not residual.bends(solution.state)
    poor, before = np.zeros(np.shape(points), dtype=bool), np.zeros(np.shape(points))
    while solution.error <= limit:
        # Parts with few points over a phase feel new lines of those that have more.
        coarse = np.array(points) < most_points(points)
        again = poor | (before >= _AGAIN * before.max()) | poor.any(axis=0) & coarse
        if solution.error <= tolerance:  # the coarser one takes memory
            converged_motion = points, residual, solution, before
        errors, times = search.changes(points, residual, solution.state, again, before)
        smooth &= bool(errors[poor].sum() <= _FALLING * before[poor].sum())
        if solution.error <= tolerance:
            converged_motion = points, residual, solution, errors
        poor, before = _poor(search.size, points, errors, times, smooth), errors
        if steps is not None or not poor.any():
            break
        points, limit = doubled(points, poor, times), max(tolerance, _NEARLY * errors.sum())
        finer = search.residual(points, residual)
        start_y = residual.refined(solution.state.y, finer)
        residual, solution = finer, solved(finer, start_y, tolerance)
    # Without a finer motion, a coarse one that more points would change much is none.
    if solution.error <= limit or converged_motion[-1].sum() <= _LIMIT:
        points, residual, solution, errors = converged_motion
    step_error, converged = float(errors.sum()), bool(solution.error <= tolerance)
    error = max(solution.error, float(np.finfo(float).eps))
    facts = {"error": error, "step_error": step_error, "converged": converged}
    motion = phase_response(
        search.rows, residual, solution.state, points=most_points(points), **facts
    )
    if not converged:
        return _integrated(search, residual, solution, tolerance, motion)
    if step_error > _LIMIT:
        text = _coarse(search, points, errors, steps is None)
        warn("step-size", text, stacklevel=3)
    from tribodyn.dynamics.harmonic.tangent_march import warn_of_growth

    grows = math.exp(min(growth(residual, solution.state, motion) / float(frequency.max()), _HIGH))
    warn_of_growth("growth of a disturbance in a cycle of the fastest phase", grows, _GROWS)
    return motion


def _refuse_large(search: _Search, points: Points) -> None:
    """Refuse grids that do not fit in the memory of this machine."""
    limit, size = machine_memory(), search.size(points)
    if size * _BYTES > limit:
        counts = " x ".join(map(str, most_points(points)))
        what = f"{counts} points over the phases are {size:.3g} unknowns"
        why = (
            f"They need about {1e-9 * _BYTES * size:.3g} GB; this machine has {1e-9 * limit:.3g} GB"
        )
        remedy = "Give fewer steps, or merge phases whose frequencies have a small whole ratio"
        raise InputError(what, "steps", why, remedy)


def _integrated(
    search: _Search, residual: PhaseResidual, solution: Solution, tolerance: float,
    motion: PhaseResponse,
) -> PhaseResponse:  # fmt: skip
    """Motion over time from one that is no solution, with a warning."""
    text, worst = _not_converged(search, residual, solution, tolerance)
    text += ". "
    slowest = min(search.rows.meshes, key=lambda mesh: abs(search.rows.rate(mesh.cycles)))
    label = contact_label(search.rows.system, int(slowest.contacts[0]))
    if search.rows.supports:
        what = f"no motion in the clearances of {len(search.rows.supports)} supports is found"
        raise ComputationError(what, "clearance_motion", text, REMEDY)
    try:
        marched = marched_response(motion, search.structure)
        cycles = abs(int(slowest.cycles @ np.array(marched.turns)))
        share = marched.fine.mean(marched.fine.contact_force == 0.0)[worst]
        text += (
            f"A time integration over {cycles} cycles of {label}, the slowest, replaces it; "
            f"{contact_label(search.rows.system, worst)} is open for {100.0 * share:.3g} % of it"
        )
    except (ComputationError, InputError) as error:
        marched = motion
        text += f"A time integration from it failed as well: {error.problems[0].what}"
    remedy = "Try another start, more load or more damping"
    warn("steady-state", f"{text}. {remedy}", stacklevel=4)
    return marched


def _first_points(search: _Search) -> Points:
    """Points over each phase with which an automatic choice starts."""
    still = Follower(1, (0,) * search.rows.frequency.size)
    followers = [
        Follower(1, np.atleast_1d(each.cycles), each.period, tuple(t.cycles for t in each.turning))
        if part.axes
        else still
        for part in search.parts
        for each in part.rows.system.contacts
    ]
    force, lead = (
        getattr(part, "orders", 0) for part in (search.rows.system.force, search.rows.system.lead)
    )
    points = points_of(followers, np.maximum(force, lead))
    ends = np.cumsum([part.members.size for part in search.parts])[:-1]
    return tuple(tuple(each.max(axis=0).tolist()) for each in np.split(points, ends))


def _coarse(search: _Search, points: Points, errors: Array, automatic: bool) -> str:
    """Message that names the contacts and the phase over which points lack most."""
    counts, rows = " x ".join(map(str, most_points(points))), search.rows
    number, axis = np.unravel_index(int(np.argmax(errors)), errors.shape)
    part = search.parts[number]
    name = contact_label(rows.system, int(part.members[0]))
    meshes = [mesh for mesh in rows.meshes if mesh.cycles[axis]]
    whose = "of what turns with it"
    if axis == part.axis:
        whose = "of its teeth"
    elif rows.system.phase_names:
        whose = f"of {rows.system.phase_names[int(axis)]}"
    elif meshes:
        whose = f"of {contact_label(rows.system, int(meshes[0].contacts[0]))}"
    remedy = "Give more steps, or omit them for an automatic choice"
    if automatic:
        remedy = (
            "A smoother change of the teeth (tip relief, a finite-element stiffness) or more "
            "damping needs fewer; in Python steps gives more"
        )
    return (
        f"the motion changes by {100.0 * errors.sum():.2g} % of its size with twice the points, "
        f"limit {100.0 * _LIMIT:g} %: {counts} points over the phases. Most of it, "
        f"{100.0 * errors.max():.2g} %, is that of {name} over the phase {whose} "
        f"({rows.frequency[axis]:.6g} Hz), {points[number][axis]} points. {remedy}"
    )


def _not_converged(
    search: _Search, residual: PhaseResidual, solution: Solution, tolerance: float
) -> tuple[str, int]:
    """Message that names the contact with the largest residual, and its number."""
    worst: tuple[float, int, str] = (-1.0, 0, "")
    for part, state in zip(residual.parts, solution.state.each, strict=True):
        distance = np.abs(components(part.contacts.rows.along, state.residual)).max(axis=0)
        number = int(np.argmax(distance))
        rows = part.structure.rows
        mesh = next(mesh for mesh in rows.meshes if number in mesh.contacts)
        rate = abs(rows.rate(mesh.cycles)) * mesh.period
        member = int(part.structure.members[number])
        label = contact_label(search.rows.system, member)
        text = f"{label} at {rate:.6g} Hz, {1e6 * distance[number]:.3g} um"
        worst = max(worst, (float(distance[number]), member, text))
    return (
        f"no motion over the phases was found: certified error {solution.error:.2e}, limit "
        f"{tolerance:.0e}. The largest residual is that of {worst[2]}"
    ), worst[1]
