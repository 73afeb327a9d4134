"""Entries of the contacts at points of several independent phases.

Contacts with the same cycles and offset are a mesh. The entries of a mesh depend on its mesh phase
alone, so that they are evaluated once at each different mesh phase and distributed to the points.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled, sample_system
from tribodyn.dynamics.equations.entry import entry_values
from tribodyn.dynamics.equations.grid import (
    PointEvaluator,
    RowEvaluator,
    build_grid,
    system_events,
    unrepeated,
)
from tribodyn.dynamics.equations.motion import Forces, compression, forces
from tribodyn.dynamics.equations.nodes import Nodes, evaluate_rows, ramp_count
from tribodyn.dynamics.equations.phases import Turning, phase_sum
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.radial_clearance import RadialClearance, clearance_forces
from tribodyn.dynamics.modal.contact_equations import Rows, jumping_events, project_rows
from tribodyn.errors import InputError
from tribodyn.types import Array, Index

#: Mesh phases nearer than this are the same; part of a turning error that is no jump.
_SAME, _CLOSED = 1e-12, 1e-6
#: Most mesh phases whose entries are cached.
_CACHED = 512
#: Steps of a mesh cycle on which entries are averaged, at least where teeth differ over many
#: cycles, and the most of all.
_STEPS, _FEWEST, _MOST = 128, 8, 2**15
#: Points over each phase at which external forces and the size of entries are sampled.
_SAMPLED = 8
#: Fields that have a column for each contact, or for each friction.
_OF_CONTACTS = (
    "stiffness", "damping", "error", "error_slope", "gap", "direction", "direction_slope",
    "force_direction", "ramp_stiffness", "ramp_gap",
)  # fmt: skip
_OF_FRICTIONS = ("friction_direction", "friction_coefficients", "rub")
#: Fields that the law of the contacts reads beside the projected ones.
_OF_LAW = ("damping", "error", "error_slope", "friction_coefficients")


@dataclass(frozen=True, eq=False)
class Mesh:
    """Contacts at one mesh phase."""

    system: System  #: the structure with these contacts alone, on one mesh cycle
    cycles: Array  #: mesh cycles over each phase (phases,)
    offset: float
    contacts: Index  #: their numbers in the system
    frictions: Index
    axes: frozenset[int]  #: phases that they follow
    _nodes: dict[Any, Nodes] = field(default_factory=dict)  #: entries at few phases

    @property
    def period(self) -> int:
        """Mesh cycles over which the entries repeat."""
        return max(contact.period for contact in self.system.contacts)

    @cached_property
    def events(self) -> tuple[float, ...]:
        """Mesh phases at which an entry may jump."""
        return system_events(self.system)

    @cached_property
    def jumps(self) -> Array:
        """Mesh phases at which an entry jumps."""
        at = np.array(self.events)
        before, after = (self.nodes(at, 0.0, before=side) for side in (True, False))
        within = self.nodes(np.arange(_SAMPLED) / _SAMPLED, 0.0)
        return np.asarray(at[jumping_events(before, after, within)])

    def nodes(self, phase: Array, rate: Any, before: bool = False) -> Nodes:
        """Entries at mesh phases (p, 1, ...), slopes over time at mesh frequencies [Hz]."""
        nodes = evaluate_rows(self.system, PointEvaluator(phase, self.events, before=before))

        def over_time(values: Array) -> Array:
            if not values.any():
                return np.broadcast_to(0.0, values.shape)
            return np.asarray(np.reshape(rate, (-1, *[1] * (values.ndim - 1))) * values)

        return nodes._replace(
            error_slope=over_time(nodes.error_slope),
            direction_slope=over_time(nodes.direction_slope),
        )

    def at(self, turned: tuple[Array, Any]) -> tuple[Nodes, Index | slice]:
        """Entries at the different mesh phases of points, and the row of each."""
        phase, rate = turned
        if np.ndim(rate):  # phases of different rates are all different
            return self.nodes(_rounded(phase), rate), slice(None)
        different, rows = _different(phase)
        key = different.tobytes(), rate
        nodes = self._nodes.get(key) or self.nodes(different, rate)
        if different.size <= _CACHED:
            self._nodes[key] = nodes
        return nodes, rows


@dataclass(frozen=True, eq=False)
class PhaseRows:
    """A system over several phases, ready to be evaluated at any point of them."""

    system: System
    frequency: Array  #: of each phase [Hz]
    meshes: tuple[Mesh, ...]
    means: Compiled  #: entries of every mesh over one cycle of its own, with checked functions
    supports: tuple[RadialClearance, ...] = ()  #: those that the last contacts stand for

    @classmethod
    def of(
        cls, system: System, frequency: Array, supports: Sequence[RadialClearance] = ()
    ) -> PhaseRows:
        """Divide the contacts of a system into meshes."""
        groups: dict[Any, list[int]] = {}
        first = len(system.contacts) - 2 * len(supports)
        for number, contact in enumerate(system.contacts):
            groups.setdefault((contact.cycles, contact.offset, number >= first), []).append(number)
        clock: dict[str, Any] = {"cycles": 1, "offset": 0.0}
        clock |= {"turning_error": (), "turning_cycles": ()}
        contacts = [replace(contact, **clock) for contact in system.contacts]
        still = replace(system, force=np.zeros(system.size), contacts=contacts, lead=None)
        _check_turning(system)
        meshes = []
        for (cycles, offset, of_support), numbers in groups.items():
            turns = [term.cycles for n in numbers for term in system.contacts[n].turning]
            followed = np.any([np.atleast_1d(each) != 0 for each in (cycles, *turns)], axis=0)
            axes = frozenset() if of_support else frozenset(np.flatnonzero(followed).tolist())
            meshes.append(_mesh(still, cycles, offset, numbers, axes))
        mean = replace(still, force=sampled_forces(system).mean(axis=0))
        means = sample_system(mean, min(_STEPS, max(_FEWEST, _MOST // mean.cycles)))
        return cls(system, frequency, tuple(meshes), means, tuple(supports))

    def some(self, meshes: Sequence[Mesh]) -> PhaseRows:
        """The rows of some meshes, without external forces and their balance."""
        contacts, frictions = (
            np.sort(np.concatenate([getattr(mesh, name) for mesh in meshes]))
            for name in ("contacts", "frictions")
        )
        still: dict[str, Any] = {"force": np.zeros(self.system.size), "balance": None}
        alone = replace(_with_contacts(self.system, contacts, frictions), **still)
        numbered = tuple(
            replace(
                mesh, contacts=np.searchsorted(contacts, mesh.contacts),
                frictions=np.searchsorted(frictions, mesh.frictions),
            )
            for mesh in meshes
        )  # fmt: skip
        nodes = self.means.nodes
        ramps = max(ramp_count("ramps", each) for each in alone.contacts)

        def part(name: str) -> Array:
            values = getattr(nodes, name)
            numbers = frictions if name in _OF_FRICTIONS else contacts
            chosen = unrepeated(values, values.ndim - 2)[:, :, numbers]
            chosen = chosen[..., :ramps] if name.startswith("ramp") else chosen
            return np.broadcast_to(chosen, (*values.shape[:2], *chosen.shape[2:]))

        names = {*_OF_CONTACTS, *_OF_FRICTIONS} & {*Nodes._fields}
        force = np.broadcast_to(0.0, nodes.force.shape)
        nodes = nodes._replace(force=force, **{name: part(name) for name in names})
        means = replace(self.means, system=alone, nodes=nodes)
        supports = () if meshes[0].axes else self.supports
        return PhaseRows(alone, self.frequency, numbered, means, supports)

    @property
    def memory(self) -> int:
        """That of the entries over one cycle [byte]."""
        return sum(unrepeated(each, each.ndim - 2).nbytes for each in self.means.nodes)

    def force(self, points: Array) -> Array:
        """External force at points (p or 1, n)."""
        return force_at(self.system, points)

    def rate(self, cycles: Any) -> float:
        """Frequency of so many cycles over each phase [Hz]."""
        return float(np.asarray(cycles, dtype=float) @ self.frequency)

    def teeth(self, axis: int) -> int:
        """Mesh cycles of all contacts over a phase, or one."""
        cycles = [int(mesh.period * abs(mesh.cycles[axis])) for mesh in self.meshes]
        return math.gcd(*cycles) or 1

    def turned(self, points: Array, cycles: Any, offset: float = 0.0) -> tuple[Array, Any]:
        """Phase at points (p, phases) of what turns so often over each, and its rate [Hz]."""
        rate = self.rate(cycles)
        if self.system.lead is None:
            return phase_sum(points, cycles, offset), rate
        ahead, slopes = self.system.lead(points)
        phase = phase_sum(points, cycles, offset + rate * ahead)
        return phase, rate * (1.0 + slopes @ self.frequency)

    def nodes(self, points: Array) -> Nodes:
        """Entries at points (p, phases), (p or 1, 1, ...); slopes are those over time."""
        parts = [mesh.at(self.turned(points, mesh.cycles, mesh.offset)) for mesh in self.meshes]
        fields = self._joined([(vars_of(nodes), rows) for nodes, rows in parts], axis=2)
        error, slope = self._turned(points, fields["error"][:, 0], fields["error_slope"][:, 0])
        fields |= {"error": error[:, None], "error_slope": slope[:, None]}
        phase = phase_sum(points, self.meshes[0].cycles)[:, None]
        force = self.force(points)[:, None]
        return Nodes(phase=phase, weight=np.ones((1, 1)), force=force, **fields)

    def forces(self, points: Array, q: Array, v: Array, extra: Array) -> Forces:
        """Contact forces and accelerations of a motion at points (p, 1, ...)."""
        nodes, first = self.nodes(points), len(self.system.contacts) - 2 * len(self.supports)
        if not self.supports:
            return forces(self.system, nodes, 1.0, q[:, None], v[:, None], extra=extra)
        moved, springs = compression(nodes, q[:, None])[:, 0, first:], nodes.stiffness[0, 0, first:]
        bearing_force = clearance_forces(self.supports, moved)[0]
        rows = nodes.direction[0, 0, first:]
        further = extra + (moved * springs - bearing_force) @ rows
        motion = forces(self.system, nodes, 1.0, q[:, None], v[:, None], extra=further[:, None])
        motion.contact[:, 0, first:] = bearing_force
        return motion

    def projected(self, points: Array, along: Array, push: Array) -> PointRows:
        """Rows at points along two bases."""
        parts: list[tuple[dict[str, Array], Index | slice]] = []
        for mesh in self.meshes:
            nodes, rows = mesh.at(self.turned(points, mesh.cycles, mesh.offset))
            part = project_rows(nodes, along, push)
            named = vars_of(part.nodes)
            columns = {name: named[name] for name in _OF_LAW} | {
                "along": part.along, "along_slope": part.along_slope, "push": part.push,
                "rub": part.rub, "springs": part.stiffness, "gaps": part.gap,
            }  # fmt: skip
            parts.append((columns, rows if isinstance(rows, slice) else rows.astype(np.int32)))
        errors = [
            ({name: columns.pop(name) for name in ("error", "error_slope")}, rows)
            for columns, rows in parts
        ]
        fields = self._joined(errors, axis=1)
        turned = self._turned(points, fields["error"], fields["error_slope"])
        return PointRows(self, parts, turned, self.force(points) @ push, len(points))

    def _joined(
        self, parts: Sequence[tuple[dict[str, Array], Index | slice]], axis: int
    ) -> dict[str, Array]:
        """Fields with a column for each contact or friction, from those of the meshes."""
        fields = {}
        for name in parts[0][0]:
            if name in ("phase", "weight", "force"):
                continue
            of_frictions = name in _OF_FRICTIONS
            count = len(self.system.frictions if of_frictions else self.system.contacts)
            numbers = [mesh.frictions if of_frictions else mesh.contacts for mesh in self.meshes]
            pieces = [(each[name], rows) for each, rows in parts]
            filler = 1.0 if name in ("ramp_gap", "gaps") else 0.0
            fields[name] = _join(list(zip(numbers, pieces, strict=True)), count, axis, filler)
        return fields

    def _turned(self, points: Array, error: Array, slope: Array) -> tuple[Array, Array]:
        """Errors and their rates (p or 1, contacts) with those that turn with shafts."""
        for contact, terms in enumerate(each.turning for each in self.system.contacts):
            for term in terms:
                wide = (len(points), error.shape[1])
                error, slope = (np.array(np.broadcast_to(part, wide)) for part in (error, slope))
                phase, rate = self.turned(points, term.cycles)
                values, slopes = _turning_values(term, phase)
                error[:, contact] += values
                slope[:, contact] += rate * slopes
        return error, slope


class PointRows(NamedTuple):
    """Entries at points, held once for each different phase of a mesh."""

    rows: PhaseRows
    parts: list[tuple[dict[str, Array], Index | slice]]  #: entries, and the one of each point
    turned: tuple[Array, Array]  #: errors and their rates (p or 1, contacts)
    load: Array  #: external force along the basis (p or 1, s)
    length: int  #: number of points

    def at(self, some: slice) -> Rows:
        """Entries at some of the points."""

        def chosen(values: Array) -> Array:
            return values if len(values) == 1 else values[some]

        parts = [
            (columns, rows[some])
            if not isinstance(rows, slice)
            else ({name: chosen(values) for name, values in columns.items()}, rows)
            for columns, rows in self.parts
        ]
        fields = self.rows._joined(parts, axis=1)
        fields |= dict(zip(("error", "error_slope"), map(chosen, self.turned), strict=True))
        nodes = Nodes(**{name: fields.get(name, np.zeros((1, 1))) for name in Nodes._fields})
        count = len(range(self.length)[some])
        stiffness, gap = (
            np.broadcast_to(fields[name], (count, *fields[name].shape[1:]))
            for name in ("springs", "gaps")
        )
        return Rows(
            nodes, fields["along"], fields["along_slope"], fields["push"], fields["rub"],
            chosen(self.load), stiffness, gap,
        )  # fmt: skip


def vars_of(part: Nodes) -> dict[str, Array]:
    """Fields by name, (1, ...) where all rows are one item."""
    return {
        name: values[:1] if values.strides[0] == 0 else values
        for name, values in part._asdict().items()
    }


def _rounded(phase: Array) -> Array:
    """Phases without the rounding in which those of equal places differ."""
    return np.asarray(np.round(phase / _SAME) * _SAME % 1.0)


def _different(phase: Array) -> tuple[Array, Index]:
    """Different phases among phases (p,), and the number of each."""
    values, rows = np.unique(_rounded(phase), return_inverse=True)
    return values, rows.reshape(-1)


def _join(
    pieces: list[tuple[Index, tuple[Array, Index | slice]]], count: int, axis: int, filler: float
) -> Array:
    """Columns of all contacts from those of the meshes, filled up to the longest."""
    columns = [piece if len(piece) == 1 else piece[rows] for _, (piece, rows) in pieces]
    if len(columns) == 1 and len(pieces[0][0]) == count:
        return columns[0]
    shape = [max(sizes) for sizes in zip(*(each.shape for each in columns), strict=True)]
    shape[axis] = count
    joined = np.full(shape, filler)
    for (numbers, _), each in zip(pieces, columns, strict=True):
        part: list[Any] = [slice(None), *map(slice, each.shape[1:])]
        for source, target in enumerate(numbers.tolist()):
            part[axis] = target
            joined[tuple(part)] = np.take(each, source, axis)
    return joined


def _mesh(
    still: System, cycles: Any, offset: float, numbers: list[int], axes: frozenset[int]
) -> Mesh:
    """Mesh of some contacts of a system, in which each contact is on one cycle."""
    chosen = [f for f, each in enumerate(still.frictions) if each.contacts[0] in numbers]
    alone = replace(_with_contacts(still, numbers, chosen), balance=None)
    counts = np.atleast_1d(np.asarray(cycles, dtype=float))
    return Mesh(alone, counts, offset, np.array(numbers), np.array(chosen, dtype=np.int64), axes)


def _with_contacts(system: System, numbers: Iterable[int], chosen: Iterable[int]) -> System:
    """A system with some of its contacts and frictions."""
    place = {number: at for at, number in enumerate(numbers)}
    each = [system.frictions[f] for f in chosen]
    frictions = [replace(f, contacts=tuple(place[j] for j in f.contacts)) for f in each]
    return replace(system, contacts=[system.contacts[n] for n in place], frictions=frictions)


def force_at(system: System, points: Array) -> Array:
    """External force of a system at points (p or 1, n)."""
    if not callable(system.force):
        return entry_values("force", system.force, np.zeros(1), system.size)
    values = np.asarray(system.force(points), dtype=float)
    return np.asarray(np.broadcast_to(values, (len(points), system.size)))


def sampled_forces(system: System) -> Array:
    """External forces at some points of all phases (p or 1, n)."""
    axes = [np.arange(_SAMPLED) / _SAMPLED] * system.phases
    return force_at(system, np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, len(axes)))


def _turning_values(term: Turning, phase: Array) -> tuple[Array, Array]:
    """Turning error and its derivative by the phase of the shaft (p,)."""
    different, numbers = _different(phase)
    rows = PointEvaluator(different, (0.0,))
    values, rates = (
        read("turning_error", term.error)[numbers, 0, 0] for read in (rows.values, rows.derivatives)
    )
    return values, rates


def _check_turning(system: System) -> None:
    """Refuse turning errors that jump, or depend on more than the phase of the shaft."""
    rows = RowEvaluator(build_grid((0.0,), _STEPS))
    for number, contact in enumerate(system.contacts):
        for term in contact.turning:
            where = f"contacts[{number}].turning_error"
            values = rows.values(where, term.error)[..., 0]
            jump = abs(values[-1, -1] - values[0, 0])
            if jump > _CLOSED * np.abs(values).max():
                what, why = f"it jumps by {jump:.4g} m at the phase 0", "A shaft turns steadily"
                raise InputError(what, where, why, "Give a function that continues after a turn")
