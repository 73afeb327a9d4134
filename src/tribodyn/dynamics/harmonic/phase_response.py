"""The response of a motion over several phases: at any time, and as spectral lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace
from typing import Any, NamedTuple

import numpy as np

from tribodyn.arrays.linear_algebra import fast_length
from tribodyn.dynamics.equations.nodes import springs
from tribodyn.dynamics.harmonic.newton import State, tangents
from tribodyn.dynamics.harmonic.phase_grid import Follower, Work
from tribodyn.dynamics.harmonic.phase_march import STEPS, PhaseMarch
from tribodyn.dynamics.harmonic.phase_residual import PhaseResidual
from tribodyn.dynamics.harmonic.phase_rows import PhaseRows
from tribodyn.dynamics.harmonic.residual import OnGrid
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.time.response import FineSamples, Response
from tribodyn.errors import real_numbers, require_between, require_one_of
from tribodyn.record import record
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Lines below this part of the strongest one are rounding.
_ROUNDING = 1e-14
#: Steps per cycle of the fastest phase in the record, and most steps of it.
_RECORDED, _MOST = 64, 4096
#: Logarithm of the decay after which a time integration has settled.
_SETTLED = 5.0
#: Time of a step of a time integration, and of it for each pair of contacts, and for each contact
#: and coordinate [s].
_EACH, _PAIR, _WIDE = 5e-6, 1.5e-6, 2.5e-7
#: Numbers that are held at once in samples, and while lines are summed up.
_TOGETHER, _WAVES = 2**22, 2**19
#: Samples per cycle of the fastest phase along the closed line, most cycles of it for each further
#: phase, and cycles over which no phases fall into step on it if it can be.
_SAMPLED, _LONGEST, _APART = 64, 512, 12
#: Logarithm of a disturbance over its start, after a cycle of each phase, below which none grows;
#: fewest cycles of the fastest and the slowest phase over which its growth is averaged.
_FORGOTTEN, _FEWEST, _TURNS = -7.0, 256, 8
#: What has lines, in the order of their columns.
_QUANTITIES = ("position", "velocity", "acceleration", "deflection", "contact_force")


class Lines(NamedTuple):
    """Spectral lines of a motion over several phases, by rising frequency."""

    frequency: Array  #: (k,) [Hz]
    amplitude: ComplexArray  #: of cosines, (k, m); the first line is the mean
    numbers: Index  #: cycles of each phase in the line (k, phases)


@record
class PhaseResponse(Response):
    """Motion over several independent phases.

    The record is a piece of the time history, which :meth:`at` continues to any time. Means and
    extremes over the whole motion are those of ``fine``: even samples along a line that closes
    after whole numbers of cycles of all phases, nearly in the ratio of their frequencies, and so
    comes near every state of the motion. ``fine.phase`` runs from 0 to 1 along it.

    Parameters
    ----------
    frequencies : (phases,) array
        Frequency of each phase [Hz].
    points : tuple of int
        Points over each phase of the contacts that follow it; others have fewer over it.
    turns : tuple of int
        Cycles of each phase along the closed line of ``fine``. Where harmonic balance does not
        converge, ``fine`` is a time integration over so many cycles, after it has settled, and
        lines are those of these samples.
    """

    frequencies: Array = field(default_factory=lambda: np.zeros(0))
    points: tuple[int, ...] = ()
    turns: tuple[int, ...] = ()
    _rows: PhaseRows = field(default=None, repr=False)  # type: ignore[assignment]
    _all_lines: tuple[Index, ComplexArray] = field(default=None, repr=False)  # type: ignore[assignment]
    _march: PhaseMarch | None = field(default=None, repr=False)

    def at(self, time: Any) -> Response:
        """Motion at given times.

        Parameters
        ----------
        time : (s,) array
            Times [s]; all phases are zero at the time zero, and the mesh phase of each contact is
            its offset there.

        Returns
        -------
        Response
            Positions, velocities, accelerations and contact forces at these times. Its ``fine``
            samples are the same ones with equal weights.

        Raises
        ------
        InputError
            If a time is not a number, or negative where the motion is a time integration.
        """
        times = real_numbers("time", time).reshape(-1)
        if times.size:
            require_between("time", times, 0.0 if self._march else -np.inf, np.inf, "s")
        points = times[:, None] * self.frequencies % 1.0
        if self._march is None:
            numbers, values = self._all_lines
            motion = sum_lines(points, numbers, values[:, : 2 * len(self.names)])
        else:
            motion = self._march.states(times)
        samples = self._samples(points, motion)
        weight = np.full(times.size, 1.0 / max(times.size, 1))
        phase = times * self.frequencies[0]
        span = float(np.ptp(phase)) if times.size else 0.0
        return Response(
            time=times, phase=phase % 1.0, names=self.names, mesh_frequency=self.mesh_frequency,
            periods=max(1, round(span)), fine=FineSamples(phase, times, weight, **samples),
            step_number=self.step_number, extra_force=self.extra_force, engine=self.engine,
            **samples,
        )  # fmt: skip

    def _samples(self, points: Array, motion: Array) -> dict[str, Any]:
        """Positions, forces and so on at points, from positions and velocities (p, 2 n)."""
        q, v = np.split(motion, 2, axis=1)
        count = len(self._rows.system.contacts)
        step = max(1, _TOGETHER // max(1, q.shape[1] * count))
        widths = {"acceleration": q.shape[1], "deflection": count, "contact": count}
        moved = {name: np.empty((len(q), width)) for name, width in widths.items()}
        for begin in range(0, len(q), step):
            at = slice(begin, begin + step)
            part = self._rows.forces(points[at], q[at], v[at], self.extra_force)
            for name, values in moved.items():
                values[at] = getattr(part, name)[:, 0]
        return dict(zip(_QUANTITIES, (q, v, *moved.values()), strict=True))

    def lines(self, quantity: str = "contact_force") -> Lines:
        """Spectral lines of a quantity.

        Parameters
        ----------
        quantity : str
            ``"contact_force"``, ``"deflection"``, ``"position"``, ``"velocity"`` or
            ``"acceleration"``.

        Returns
        -------
        Lines
            Frequency (k,) [Hz], complex amplitude of cosines (k, m) in the unit of the quantity,
            and the whole numbers of each line: how often each phase enters it. Line k is
            ``Re(amplitude_k exp(2 pi i frequency_k t))``.

        Raises
        ------
        InputError
            If the quantity is unknown.
        """
        require_one_of("quantity", quantity, _QUANTITIES)
        numbers, values = self._all_lines
        size, count = len(self.names), self.deflection.shape[1]
        ends = np.cumsum([0, size, size, size, count, count])
        place = _QUANTITIES.index(quantity)
        chosen = values[:, ends[place] : ends[place + 1]]
        strong = _strong(chosen)
        numbers, chosen = numbers[strong], chosen[strong]
        frequency = np.asarray(numbers @ self.frequencies)
        order = np.argsort(frequency, kind="stable")
        return Lines(frequency[order], chosen[order], numbers[order])

    def __repr__(self) -> str:
        """One line."""
        listed = ", ".join(f"{frequency:.6g}" for frequency in self.frequencies)
        counts = " x ".join(map(str, self.points))
        return (
            f"Response(motion over {len(self.points)} phase{'s' if len(self.points) > 1 else ''} "
            f"at {listed} Hz, {counts} points, "
            f"{self.position.shape[1]} coordinates, error {self.error:.1e}, step error "
            f"{self.step_error:.1e})"
        )


def _cosines(numbers: Index, lines: ComplexArray, frequency: Array) -> tuple[Index, ComplexArray]:
    """Lines of cosines with positive frequencies, each once, the mean first, from amplitudes."""
    # Lines whose last number is zero are in a half spectrum with both signs.
    nonzero = numbers != 0
    first = numbers[np.arange(len(numbers)), nonzero.argmax(axis=1)]
    once = (numbers[:, -1] > 0) | (first > 0) | ~nonzero.any(axis=1)
    numbers, lines = numbers[once], 2.0 * lines[once]
    lines[0] /= 2.0
    back = numbers @ frequency < 0.0
    numbers = np.where(back[:, None], -numbers, numbers)
    lines = np.where(back[:, None], lines.conj(), lines)
    strong = _strong(lines)
    return numbers[strong], lines[strong]


def _strong(lines: ComplexArray) -> Mask:
    """Lines (k, c) that are more than rounding in a column, and the mean, which is the first."""
    size = np.abs(lines).max(axis=0, initial=0.0)
    strong = (np.abs(lines) > _ROUNDING * size).any(axis=1)
    strong[0] = True
    return np.asarray(strong)


def sum_lines(points: Array, numbers: Index, values: ComplexArray) -> Array:
    """Sums of lines at points of the phases (p, phases), (p, c)."""
    total = np.empty((len(points), values.shape[1]))
    step = max(1, _WAVES // max(1, len(numbers)))
    # A wave of all phases is the product of those of each, of which there are few.
    orders = [np.unique(column, return_inverse=True) for column in numbers.T]
    parts = np.concatenate((values.real, -values.imag)).T
    for begin in range(0, len(points), step):
        some, wave = points[begin : begin + step].T, np.ones((1, 1), dtype=complex)
        for (different, place), phase in zip(orders, some, strict=True):
            wave = wave * np.exp(2j * np.pi * different[:, None] * phase)[place.reshape(-1)]
        total[begin : begin + step] = (parts @ np.concatenate((wave.real, wave.imag))).T
    return total


def closed_line(frequency: Array) -> tuple[int, ...]:
    """Cycles of each phase, nearly in the ratio of the frequencies, that cover all phases."""
    slowest, fastest = float(frequency.min()), float(frequency.max())
    longest = _LONGEST * max(1, frequency.size - 1)
    counts = np.arange(1, max(2, int(longest * slowest / fastest)) + 1)[:, None]
    lines = np.maximum(np.rint(counts * frequency / slowest), 1.0).astype(np.int64)
    distance = np.abs(lines * slowest / (counts * frequency) - 1.0).max(axis=1)
    order = np.argsort(distance, kind="stable")
    for reach in range(_APART if frequency.size < 4 else _APART // 3, 0, -1):
        axes = [np.arange(0 if axis == 0 else -reach, reach + 1) for axis in range(frequency.size)]
        small = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, frequency.size)
        small = small[small.any(axis=1)]
        for turns in lines[order]:
            if np.all(small @ turns):
                return tuple(turns.tolist())
    return tuple(lines[order[0]].tolist())


def _summed(line: tuple[int, ...], count: int, numbers: Index, values: ComplexArray) -> Array:
    """Sums of lines at even places of a closed line (count, c), as far as these tell them apart."""
    orders = numbers @ np.array(line)
    clear = np.abs(orders) <= count // 2
    orders, values = orders[clear], values[clear]
    lines = np.zeros((count // 2 + 1, values.shape[1]), dtype=complex)
    amplitudes = np.where((orders < 0)[:, None], values.conj(), values)
    np.add.at(lines, np.abs(orders), 0.5 * count * amplitudes)
    lines[0] = 2.0 * lines[0].real
    return np.fft.irfft(lines, count, axis=0)


def growth(residual: PhaseResidual, state: State, motion: PhaseResponse) -> float:
    """Mean rate of the disturbances that grow fastest along the closed line [1/s]."""
    from tribodyn.dynamics.harmonic.tangent_march import TangentMarch

    structure, line, count = residual.structure, motion.turns, motion.fine.phase.size
    if structure.modes is None:
        return -np.inf
    parts = [
        (
            structure.push.T @ part.structure.push,
            _tangents_along(line, count, part, each),
            np.kron(np.eye(2), part.structure.along.T @ structure.along),
        )
        for part, each in zip(residual.parts, state.each, strict=True)
    ]
    step, logs = float(motion.fine.time[1]), np.zeros(0)
    modes = np.count_nonzero(structure.modes[0].imag >= 0.0)
    disturbance = np.random.default_rng(0).standard_normal(2 * modes)
    passes = max(-(-_FEWEST // max(line)), -(-_TURNS // min(line)))
    for begin in range(0, passes * count, _MOST):
        at = np.arange(begin, begin + _MOST) % count
        march = TangentMarch(structure, sum(a @ each[at] @ b for a, each, b in parts), step)
        for first in range(0, _MOST, _SAMPLED):
            disturbance = march.moved(disturbance, slice(first, first + _SAMPLED))
            size = max(float(np.linalg.norm(disturbance)), 1e-300)
            disturbance, logs = disturbance / size, np.append(logs, np.log(size))
        if logs.sum() < _FORGOTTEN and (begin + _MOST) * min(line) >= count:
            break
    # Source: Das et al. (2017), Nonlinearity 30, 4111: weights that vanish smoothly at the ends.
    place = (np.arange(logs.size) + 0.5) / logs.size
    return float(np.average(logs, weights=np.exp(-1.0 / (place * (1 - place))))) / (step * _SAMPLED)


def _tangents_along(line: tuple[int, ...], count: int, part: OnGrid, state: State) -> Array:
    """Changes of the forces of a part with its motion and rate (count, s, 2 r) along a line."""
    grid, joined = part.grid, np.concatenate(tangents(part.structure, state), axis=2)
    spectrum, paired = grid.spectrum(joined.reshape(grid.size, -1)), ~grid.unpaired
    lines = _cosines(grid.numbers[paired], spectrum[paired], grid.frequency)
    along = _summed(line, count, *lines).reshape(count, *joined.shape[1:])
    if state.mean_stiffness is not None:  # it holds what nothing else does
        along[..., : joined.shape[2] // 2] -= state.mean_stiffness
    return along


def _along(line: tuple[int, ...], response: PhaseResponse) -> FineSamples:
    """Even samples of a motion along a closed line, each with the same weight."""
    numbers, values = response._all_lines
    highest = 2 * int(np.abs(numbers @ np.array(line)).max(initial=0)) + 2
    count = fast_length(max(_SAMPLED * max(line), highest))
    phase = np.arange(count) / count
    points = phase[:, None] * np.array(line) % 1.0
    moved = _summed(line, count, numbers, values[:, : 2 * len(response.names)])
    samples = response._samples(points, moved)
    fastest = int(np.argmax(line))
    time = phase * line[fastest] / response.frequencies[fastest]
    return FineSamples(phase, time, np.full(count, 1.0 / count), **samples)


def marched_response(motion: PhaseResponse, structure: ClosedStructure) -> PhaseResponse:
    """Integrate over time from the state of a motion at the time zero."""
    start, line = motion.at([0.0]), np.array(motion.turns)
    state = np.concatenate((start.position[0], start.velocity[0]))
    march = PhaseMarch(motion._rows, structure, motion.extra_force, [state])
    settling, span = _marched_times(motion.frequencies, structure.decay)
    count = motion.fine.phase.size
    phase = np.arange(count) / count
    time = settling + span * phase
    samples = motion._samples(time[:, None] * motion.frequencies % 1.0, march.states(time))
    fine = FineSamples(phase, time, motion.fine.weight, **samples)
    numbers = motion._all_lines[0]
    numbers = numbers[np.argsort(np.abs(numbers).sum(axis=1), kind="stable")]
    first = np.sort(
        np.unique(np.abs(numbers @ line), return_index=True)[1]
    )  # each sample line once
    numbers, orders = numbers[first], numbers[first] @ line
    turned = np.exp(-2j * np.pi * (numbers @ motion.frequencies) * time[0])[:, None]
    lines = []
    for name in _QUANTITIES:
        spectrum = np.fft.rfft(samples[name], axis=0)[np.abs(orders)] * (2.0 / count)
        lines.append(np.where((orders < 0)[:, None], spectrum.conj(), spectrum) * turned)
    values = np.concatenate(lines, axis=1)
    values[~numbers.any(axis=1)] /= 2.0
    motion = replace(motion, fine=fine, engine="modal", _all_lines=(numbers, values), _march=march)
    return _recorded(motion)


def _marched_times(frequency: Array, decay: float) -> tuple[float, float]:
    """Time in which an integration settles, and that of the closed line after it [s]."""
    line, fastest = closed_line(frequency), int(np.argmax(frequency))
    span = line[fastest] / float(frequency[fastest])
    return min(span, _SETTLED / max(decay, 1e-300)), span


def cycles_of_march(followers: Sequence[Follower], frequency: Array, decay: float) -> float:
    """Cycles of the fastest phase or mesh in an integration over time in place of a motion."""
    meshes = [abs(float(each.cycles @ frequency)) * each.period for each in followers]
    fastest: float = max(*frequency.tolist(), *meshes)
    return sum(_marched_times(frequency, decay)) * fastest


def time_of_march(followers: Sequence[Follower], frequency: Array, work: Work) -> float:
    """Time of this integration [s]."""
    contacts = sum(each.contacts for each in followers)
    step = _EACH + contacts * (_PAIR * contacts + _WIDE * work.size)
    return STEPS * cycles_of_march(followers, frequency, work.decay) * step


def phase_response(
    rows: PhaseRows, residual: PhaseResidual, state: State, **facts: Any
) -> PhaseResponse:
    """Evaluate a motion along a closed line through all phases, and over a piece of time."""
    structure, system, frequency = residual.structure, rows.system, rows.frequency
    numbers, force, others = _all_forces(rows, residual, state)
    parts = zip(residual.parts, state.each, strict=True)
    closing = sum(
        structure.push.T @ part.structure.push @ part.structure.contact_stiffness
        @ each.y.mean(axis=0)
        for part, each in parts
    )  # fmt: skip
    force, torque = structure.balanced(force, np.asarray(closing))
    omega = 2.0 * np.pi * (numbers @ frequency)
    q, v = structure.motion(omega, force)
    others += _beyond_grids(rows, residual, numbers, q, v)
    lines = np.concatenate((q, v, 1j * omega[:, None] * v, others), axis=1)
    facts |= {"extra_force": torque, "period": 0, "engine": "harmonic-balance"}
    empty = np.zeros(0)
    none: dict[str, Any] = dict.fromkeys(_QUANTITIES, np.zeros((0, 0)))
    fastest = max(float((part.grid.frequency * part.grid.shape).max()) for part in residual.parts)
    response = PhaseResponse(
        time=empty, phase=empty, names=tuple(system.names), mesh_frequency=float(frequency[0]),
        periods=1, fine=FineSamples(empty, empty, empty, **none),
        step_number=structure.rate / fastest, frequencies=frequency, turns=closed_line(frequency),
        _rows=rows, _all_lines=_cosines(numbers, lines, frequency), **none, **facts,
    )  # fmt: skip
    return _recorded(replace(response, fine=_along(response.turns, response)))


def recorded(frequency: Any) -> int:
    """Number of samples of the record of a motion over phases."""
    return min(int(np.ceil(_RECORDED * float(max(frequency)) / float(min(frequency)))), _MOST)


def along_line(frequency: Array) -> int:
    """Number of samples along the closed line of a motion over phases, of not too many lines."""
    return _SAMPLED * max(closed_line(frequency))


def _recorded(response: PhaseResponse) -> PhaseResponse:
    """Motion with a record: a cycle of the slowest phase if that is short enough."""
    fastest = _RECORDED * float(response.frequencies.max())
    history = response.at(np.arange(recorded(response.frequencies)) / fastest)
    names = ("time", "phase", "position", "velocity", "acceleration", "deflection", "contact_force")
    columns = {name: getattr(history, name) for name in names}
    return replace(response, **columns, periods=history.periods)


def _all_forces(
    rows: PhaseRows, residual: PhaseResidual, state: State
) -> tuple[Index, ComplexArray, ComplexArray]:
    """Lines of all parts: numbers, forces (k, s), and compressions and forces of the contacts."""
    structure, count = residual.structure, len(rows.system.contacts)
    listed, forces, others = [], [], []
    for part, each in zip(residual.parts, state.each, strict=True):
        paired, grid = ~part.grid.unpaired, part.grid
        listed.append(grid.numbers[paired])
        lines = grid.spectrum(each.force)[paired]
        forces.append(lines @ (part.structure.push.T @ structure.push))
        columns = np.zeros((len(lines), 2 * count), dtype=complex)
        members = part.structure.members
        for first, values in ((0, each.law.compression), (count, each.law.contact)):
            sampled = part.integral(values, each.pieces)
            columns[:, first + members] = grid.spectrum(sampled)[paired]
        others.append(columns)
    grid = max((part.grid for part in residual.parts), key=lambda grid: min(grid.shape))
    loads = rows.force(grid.points) @ structure.coordinates.inverse.T @ structure.push
    if len(loads) > 1:
        paired = ~grid.unpaired
        listed.append(grid.numbers[paired])
        forces.append(grid.spectrum(loads)[paired])
    else:
        listed.append(np.zeros((1, len(grid.shape)), dtype=np.int64))
        forces.append(loads.astype(complex))
    others.append(np.zeros((len(forces[-1]), 2 * count), dtype=complex))
    numbers, place = np.unique(np.concatenate(listed), axis=0, return_inverse=True)
    mean = int(np.flatnonzero(~numbers.any(axis=1))[0])
    order = np.concatenate(([mean], np.delete(np.arange(len(numbers)), mean)))
    totals = []
    for columns in (np.concatenate(forces), np.concatenate(others)):
        total = np.zeros((len(numbers), columns.shape[1]), dtype=complex)
        np.add.at(total, place.reshape(-1), columns)
        totals.append(total[order])
    return numbers[order], totals[0], totals[1]


def _beyond_grids(
    rows: PhaseRows, residual: PhaseResidual, numbers: Index, q: ComplexArray, v: ComplexArray
) -> ComplexArray:
    """Compressions and forces of contacts at lines that their grids lack, as closed at rest."""
    count = len(rows.system.contacts)
    columns = np.zeros((len(numbers), 2 * count), dtype=complex)
    for part in residual.parts:
        nodes = part.structure.rows.means.nodes
        entries = springs(nodes)[0], nodes.damping, nodes.direction
        stiffness, damping, along = (np.einsum("rs,rsj...->j...", nodes.weight, e) for e in entries)
        lacking = np.flatnonzero((2 * np.abs(numbers) >= np.array(part.grid.shape)).any(axis=1))
        moved, rate = (lines[lacking] @ along.T for lines in (q, v))
        closed = np.where(part.closed, stiffness, 0.0).sum(axis=-1)
        damped = np.where(part.closed[:, 0], damping, 0.0)
        columns[np.ix_(lacking, part.members)] = moved
        columns[np.ix_(lacking, count + part.members)] = moved * closed + rate * damped
    return columns
