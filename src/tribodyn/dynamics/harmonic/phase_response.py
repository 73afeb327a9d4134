"""The response of a motion over several phases: at any time, and as spectral lines."""

from __future__ import annotations

from dataclasses import field, replace
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.equations.motion import forces
from tribodyn.dynamics.harmonic.newton import State
from tribodyn.dynamics.harmonic.phase_grid import PhaseGrid, PhaseResidual
from tribodyn.dynamics.harmonic.phase_rows import PhaseRows
from tribodyn.dynamics.time.response import FineSamples, Response
from tribodyn.errors import real_numbers, require_one_of
from tribodyn.record import record
from tribodyn.types import Array, ComplexArray, Index

#: Lines below this part of the strongest one are rounding.
_ROUNDING = 1e-14
#: Steps per cycle of the fastest phase in the record, and most steps of it.
_RECORDED, _MOST = 64, 4096
#: Numbers that are held at once while lines are summed up.
_TOGETHER = 2**22


class Lines(NamedTuple):
    """Spectral lines of a motion over several phases, by rising frequency."""

    frequency: Array  #: (k,) [Hz]
    amplitude: ComplexArray  #: of cosines, (k, m); the first line is the mean
    numbers: Index  #: cycles of each phase in the line (k, phases)


@record
class PhaseResponse(Response):
    """Motion over several independent phases.

    The record is a piece of the time history, which :meth:`at` continues to any time. Means and
    extremes over the whole motion are those of ``fine``, whose samples are the points of the grid
    over all phases, each with the same weight; their times count within a cycle of the first phase.

    Parameters
    ----------
    frequencies : (phases,) array
        Frequency of each phase [Hz].
    points : tuple of int
        Points over each phase with which the motion was found.
    """

    frequencies: Array = field(default_factory=lambda: np.zeros(0))
    points: tuple[int, ...] = ()
    _contact_lines: tuple[Index, ComplexArray] = field(default=None, repr=False)  # type: ignore[assignment]
    _rows: PhaseRows = field(default=None, repr=False)  # type: ignore[assignment]
    _lines: tuple[Index, ComplexArray] = field(default=None, repr=False)  # type: ignore[assignment]

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
            If a time is not a number.
        """
        times = real_numbers("time", time).reshape(-1)
        points = times[:, None] * self.frequencies % 1.0
        numbers, values = self._lines
        motion = sum_lines(points, numbers, values)
        q, v = np.split(motion, 2, axis=1)
        moved = [np.zeros((0, width)) for width in (q.shape[1], *2 * (len(self._contacts),))]
        step = max(1, _TOGETHER // max(1, q.shape[1] * len(self._contacts)))
        parts = [
            forces(
                self._rows.system, self._rows.nodes(points[at]), 1.0, q[at, None], v[at, None],
                extra=self.extra_force,
            )
            for at in (slice(begin, begin + step) for begin in range(0, len(times), step))
        ]  # fmt: skip
        accelerated, deflected, pressed = (
            np.concatenate([getattr(part, name)[:, 0] for part in parts]) if parts else empty
            for name, empty in zip(("acceleration", "deflection", "contact"), moved, strict=True)
        )
        weight = np.full(times.size, 1.0 / max(times.size, 1))
        phase = times * self.frequencies[0]
        samples = (q, v, accelerated, deflected, pressed)
        span = float(np.ptp(phase)) if times.size else 0.0
        return Response(
            times, phase % 1.0, *samples, self.names, self.mesh_frequency, max(1, round(span)),
            FineSamples(phase, times, weight, *samples), self.step_number,
            extra_force=self.extra_force, engine=self.engine,
        )  # fmt: skip

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
        known = ("contact_force", "deflection", "position", "velocity", "acceleration")
        require_one_of("quantity", quantity, known)
        grid = PhaseGrid(self.points, self.frequencies)
        numbers, values = cosines(grid, getattr(self.fine, quantity))
        frequency = np.asarray(numbers @ self.frequencies)
        order = np.argsort(frequency, kind="stable")
        return Lines(frequency[order], values[order], numbers[order])

    @property
    def _contacts(self) -> Any:
        return self._rows.system.contacts

    def __repr__(self) -> str:
        """One line."""
        listed = ", ".join(f"{frequency:.6g}" for frequency in self.frequencies)
        counts = " x ".join(map(str, self.points))
        return (
            f"Response(motion over {len(self.points)} phases at {listed} Hz, {counts} points, "
            f"{self.position.shape[1]} coordinates, error {self.error:.1e}, step error "
            f"{self.step_error:.1e})"
        )


def cosines(grid: PhaseGrid, values: Array) -> tuple[Index, ComplexArray]:
    """Whole numbers and amplitudes of the lines of values (p, c), each once, the mean first."""
    return _paired(grid, grid.spectrum(values) / grid.size)


def _paired(grid: PhaseGrid, spectrum: ComplexArray) -> tuple[Index, ComplexArray]:
    numbers = grid.numbers
    # Lines whose last number is zero are in the half spectrum with both signs.
    nonzero = numbers != 0
    first = numbers[np.arange(len(numbers)), nonzero.argmax(axis=1)]
    once = (numbers[:, -1] > 0) | (first > 0) | ~nonzero.any(axis=1)
    once &= ~grid.unpaired
    numbers, lines = numbers[once], 2.0 * spectrum[once]
    lines[0] /= 2.0
    back = grid.omega[once] < 0.0
    numbers = np.where(back[:, None], -numbers, numbers)
    lines = np.where(back[:, None], lines.conj(), lines)
    size = np.abs(lines).max(axis=0, initial=0.0)
    strong = (np.abs(lines) > _ROUNDING * size).any(axis=1)
    strong[0] = True
    return numbers[strong], lines[strong]


def sum_lines(points: Array, numbers: Index, values: ComplexArray) -> Array:
    """Sums of lines at points of the phases (p, phases), (p, c)."""
    total = np.empty((len(points), values.shape[1]))
    step = max(1, _TOGETHER // max(1, len(numbers)))
    for begin in range(0, len(points), step):
        turns = points[begin : begin + step] @ numbers.T
        total[begin : begin + step] = (np.exp(2j * np.pi * turns) @ values).real
    return total


def phase_response(
    rows: PhaseRows, residual: PhaseResidual, state: State, **facts: Any
) -> PhaseResponse:
    """Evaluate a motion at the points of its grid, and over a piece of time."""
    structure, grid, system = residual.structure, residual.grid, rows.system
    spectrum = grid.spectrum(state.force) / grid.size
    spectrum[grid.unpaired] = 0.0
    force, torque = structure.balanced(spectrum, state.y.mean(axis=0))
    amplitudes = structure.motion(grid.omega, force)
    q, v = (grid.values(part * grid.size) for part in amplitudes)
    (stiffness, damping), inverse = system.over_mass, structure.coordinates.inverse
    pushed = state.law.force @ structure.push.T @ inverse
    acceleration = pushed - q @ stiffness.T - v @ damping.T + system.inverse_mass @ torque
    fine = FineSamples(
        phase=grid.points[:, 0],
        time=grid.points[:, 0] / grid.frequency[0],
        weight=np.full(grid.size, 1.0 / grid.size),
        position=q,
        velocity=v,
        acceleration=acceleration,
        deflection=state.law.compression,
        contact_force=state.law.contact,
    )
    numbers, lines = _paired(grid, np.concatenate(amplitudes, axis=1))
    facts |= {"extra_force": torque, "period": 0, "engine": "harmonic-balance"}
    empty, step = np.zeros(0), structure.rate / float((grid.frequency * grid.shape).max())
    whole = PhaseResponse(
        empty, empty, q[:0], v[:0], q[:0], fine.deflection[:0], fine.contact_force[:0],
        tuple(system.names), float(grid.frequency[0]), 1, fine, step,
        frequencies=grid.frequency, points=grid.shape, _contact_lines=cosines(grid, state.y),
        _rows=rows, _lines=(numbers, lines), **facts,
    )  # fmt: skip
    # The record: a cycle of the slowest phase if that is short enough.
    fastest = _RECORDED * float(grid.frequency.max())
    count = min(int(np.ceil(fastest / float(grid.frequency.min()))), _MOST)
    history = whole.at(np.arange(count) / fastest)
    names = ("time", "phase", "position", "velocity", "acceleration", "deflection", "contact_force")
    columns = {name: getattr(history, name) for name in names}
    return replace(whole, **columns, periods=history.periods)
