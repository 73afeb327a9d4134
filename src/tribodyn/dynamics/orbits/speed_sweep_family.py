"""The systems of a sweep over the speed: compiled for each speed, and marched side by side."""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics._engine.blocks import Statistics, march
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.program import Program
from tribodyn.dynamics.orbits.coordinates import orbit_coordinates
from tribodyn.dynamics.orbits.orbit_map import OrbitMap
from tribodyn.dynamics.orbits.start import static_start
from tribodyn.dynamics.run_up_tables import Table, Tables, blend_weight
from tribodyn.dynamics.time.ensemble import fresh_moments
from tribodyn.types import Array, Index

#: Disturbance of the matrix of a map with dead zones relative to the motion.
_DISTURBANCE = 1e-6
#: Lanes that are marched at a time: more do not fit beside each other in the memory near a core.
_LANES = 16384
_ROUNDS = 3


class Orbits:
    """Periodic orbits of some speeds."""

    def __init__(self, point: Array, matrix: Array, error: Array) -> None:
        self.point, self.matrix, self.error = point, matrix, error


class SpeedFamily:
    """One system, or several over the speed, at the speeds of a sweep."""

    def __init__(self, tables: Tables, known: Array, frequency: Array) -> None:
        self.tables, self.frequency = tables, frequency
        self.system = tables.systems[0]
        self._made: dict[tuple[int, int, float], Compiled] = {}
        self._key = []
        for beat in frequency:
            left, part = blend_weight(known, float(beat))
            self._key.append((tables.steps_at(float(beat)), left, part))
        lowest = float(frequency.min())
        self.coordinates = orbit_coordinates(self.compiled(int(np.argmin(frequency))), lowest)
        first = OrbitMap(self.compiled(0), float(frequency[0]), 1, self.coordinates)
        self.balance, self.affine = first.balance, first.affine

    def compiled(self, number: int) -> Compiled:
        """System of one speed on its grid."""
        key = self._key[number]
        if key not in self._made:
            table = self.tables.at(float(self.frequency[number]))
            made = _blended(table, key[1], key[2])
            self._made[key] = Compiled(self.system, table.grid, table.nodes[key[1]], *made)
        return self._made[key]

    def mapping(self, number: int, periods: int) -> OrbitMap:
        """Map of one speed over some mesh cycles."""
        return OrbitMap(
            self.compiled(number), float(self.frequency[number]), periods, self.coordinates, 16
        )

    def start(self, number: int) -> Array:
        """Reduced vector of the static equilibrium."""
        y = self.coordinates.reduce(static_start(self.compiled(number)))
        return y if self.balance is None else np.append(y, 0.0)

    def groups(self) -> list[Index]:
        """Speeds that share one program."""
        found: dict[tuple[int, int, float], list[int]] = {}
        for number, key in enumerate(self._key):
            found.setdefault(key, []).append(number)
        return [np.array(each, dtype=np.int64) for each in found.values()]

    def split(self, y: Array, frequency: Array, periods: int) -> tuple[Array, Array]:
        """Take reduced vectors apart, as the map of one speed does."""
        if self.balance is None:
            return self.coordinates.expand(y), np.zeros((len(y), self.system.size))
        _, force, _ = self.balance
        extra = np.outer(y[:, -1] * frequency / periods, force)
        return self.coordinates.expand(y[:, :-1]), extra

    def _image(self, group: int, y: Array, frequency: Array) -> Array:
        """Map many vectors over one mesh cycle."""
        new = np.empty_like(y)
        for first in range(0, len(y), _LANES):
            part = slice(first, first + _LANES)
            state, extra = self.split(y[part], frequency[part], 1)
            end = march(self.compiled(group), 1.0 / frequency[part], state, 1, extra_force=extra)
            reduced = self.coordinates.reduce(end)
            if self.balance is not None:
                gained = self.coordinates.free_velocity(end) @ self.balance[0]
                reduced = np.column_stack((reduced, y[part][:, -1] - gained))
            new[part] = reduced
        return new

    def all_at_once(self, tolerance: float) -> Orbits:
        """Newton's method from rest at all speeds side by side."""
        point = np.array([self.start(number) for number in range(self.frequency.size)])
        matrix = np.zeros((*point.shape, point.shape[1]))
        error = np.full(len(point), np.inf)
        for group in self.groups():
            self._newton(group, point, matrix, error, tolerance)
        return Orbits(point, matrix, error)

    def _newton(
        self, group: Index, point: Array, matrix: Array, error: Array, tolerance: float
    ) -> None:
        size = point.shape[1]
        eye = np.eye(size)
        left = group
        for _ in range(_ROUNDS):
            y, beat = point[left], self.frequency[left]
            scale = np.linalg.norm(y, axis=1)[:, None] + 1e-300
            # Of a linear map any difference is exact, and a large one loses no digits.
            step = scale if self.affine else _DISTURBANCE * scale
            moved = y[:, None, :] + step[:, :, None] * np.vstack((np.zeros(size), eye))
            lanes = np.repeat(beat, size + 1)
            image = self._image(int(group[0]), moved.reshape(-1, size), lanes)
            image = image.reshape(len(left), size + 1, size)
            here = np.swapaxes(image[:, 1:] - image[:, :1], 1, 2) / step[:, :, None]
            residual = image[:, 0] - y
            good = np.linalg.cond(eye - here) < 1e15
            correction = np.full_like(y, np.inf)
            correction[good] = np.linalg.solve(eye - here[good], residual[good][..., None])[..., 0]
            matrix[left] = here
            error[left] = np.linalg.norm(correction, axis=1) / scale[:, 0]
            if not self.affine or np.any(error[left] > tolerance):
                point[left[good]] += correction[good]
            left = left[(error[left] > tolerance) & good]
            if left.size == 0:
                break

    def statistics(
        self, number: Index, y: Array, periods: Index, cycles: int,
        outputs: Array,
    ) -> Array:  # fmt: skip
        """March motions over their periods and gather their figures."""
        contacts, others = len(self.system.contacts), self.system.size + len(outputs)
        found = np.empty((2 * contacts + others, 5, number.size))
        for group in self.groups():
            inside = np.isin(number, group)
            for length in np.unique(periods[inside]):
                lanes = np.flatnonzero(inside & (periods == length))
                compiled, beat = self.compiled(int(group[0])), self.frequency[number[lanes]]
                state, extra = self.split(y[lanes], beat, max(int(length), 1))
                moments = fresh_moments(contacts, others, 0, lanes.size)
                waves = np.zeros((compiled.grid.steps, 3, 0, 2))
                march(
                    compiled, 1.0 / beat, state, int(length) or cycles, extra_force=extra,
                    statistics=Statistics(outputs, waves, moments),
                )  # fmt: skip
                found[:, :, lanes] = moments.reshape(-1, 5, lanes.size)
        return found


def _blended(table: Table, left: int, part: float) -> tuple[Program, float]:
    program = table.programs[left]
    if part > 0.0:
        other = table.programs[left + 1]
        program = program._replace(
            rows=program.rows + part * (other.rows - program.rows),
            constant_load=program.constant_load
            + part * (other.constant_load - program.constant_load),
        )
    return program, table.step_number
