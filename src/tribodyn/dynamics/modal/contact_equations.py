"""Forces of all contacts over one period of the clock, their tangent, sides and jumps.

The motion at the contacts is sampled on equal steps. Where a force or its slope jumps between two
samples, because a contact opens or closes or an entry jumps at an event, the two samples are
corrected by the terms of Euler and Maclaurin, so that harmonics keep second order and vary
continuously with the place of the jump.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.grid import PointEvaluator, system_events, unrepeated
from tribodyn.dynamics.equations.motion import compression, has_gap, sides
from tribodyn.dynamics.equations.nodes import (
    Nodes,
    carried_load,
    evaluate_rows,
    friction_force,
    friction_tangent,
    lowest_of_each_law,
    over_spanned,
    spanned_coordinates,
    springs,
)
from tribodyn.dynamics.equations.orbit_coordinates import OverBases, Rest, at_rest, side_of
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.types import Array, Index, Mask

#: Part of an entry that is no jump.
_JUMP = 1e-5
#: Power of the correction of a spring that just touches: larger than 1, only near this.
_TOUCH = 4


class Rows(NamedTuple):
    """Entries at phases of the clock; directions by their components along the two bases."""

    nodes: Nodes
    along: Array  #: compressions by the motion, (p or 1, contacts, r)
    along_slope: Array  #: derivative by the clock
    push: Array  #: force along the basis per contact force, (p or 1, contacts, s)
    rub: Array  #: force along the basis per friction that follows its load, (p or 1, f, s)
    load: Array  #: external force along the basis, (p or 1, s)
    stiffness: Array  #: of the first spring and the ramps of each contact, (p, contacts, m)
    gap: Array  #: half dead zones of the same

    def at(self, index: Index | slice) -> Rows:
        """Some of the rows."""

        def some(values: Array) -> Array:
            return values if len(values) == 1 else values[index]

        nodes = Nodes(*(some(part) for part in self.nodes))
        return Rows(nodes, *(some(part) for part in self[1:]))

    def speed_of(
        self, contact: Index, frequency: float, y: Array, rate: Array
    ) -> tuple[Array, Array]:
        """Direction and rate of compression of a contact at each row, of motions (b, r)."""
        entries = self.along, self.along_slope, self.nodes.error_slope
        along, turning, slope = (of_contact(part, contact) for part in entries)
        turned = np.einsum("br,br->b", turning, y) - slope
        return along, np.einsum("br,br->b", along, rate) + frequency * turned


class Tangent(NamedTuple):
    """Change of the forces of contacts with their motion, by factors of each contact."""

    push: Array  #: generalized force per change of each contact force (p or 1, contacts, s)
    along: Array  #: compressions by the motion (p or 1, contacts, r)
    turning: Array | None  #: derivative of these by time, if any
    stiffness: Array  #: of the springs that touch (p, contacts)
    damping: Array  #: of the dampers that act (p, contacts)
    supports: Array | None = None  #: further stiffness (p, s, r)

    def force(self, y: Array, rate: Array) -> Array:
        """Change of the force (p, s) with a motion and its rate (p, r)."""
        speed = components(self.along, rate)
        if self.turning is not None:
            speed += components(self.turning, y)
        force = -_pushed(
            self.push, self.stiffness * components(self.along, y) + self.damping * speed
        )
        if self.supports is not None:
            force -= (self.supports @ y[..., None])[..., 0]
        return force

    def dense(self) -> tuple[Array, Array]:
        """Minus the derivatives of the force by the motion and its rate (p, s, r)."""
        rising = outer(self.push, self.stiffness, self.along)
        if self.turning is not None:
            rising += outer(self.push, self.damping, self.turning)
        if self.supports is not None:
            rising += self.supports
        return rising, outer(self.push, self.damping, self.along)

    def mapped(self, by: Callable[[Array], Array]) -> tuple[Array, Array]:
        """The dense derivatives after a linear map of the points (p, m) to others."""
        if len(self.push) == len(self.along) == 1 and self.turning is None:
            factors = by(self.stiffness), by(self.damping)
            return self._replace(stiffness=factors[0], damping=factors[1]).dense()
        rows = [
            [by(part[:, 0]) for part in self._replace(push=self.push[..., [row]]).dense()]
            for row in range(self.push.shape[-1])
        ]
        stiffness, damping = (np.stack(part, axis=1) for part in zip(*rows, strict=True))
        return stiffness, damping


class Law(NamedTuple):
    """Result of the contact law at points of the period."""

    compression: Array  #: (p, contacts) [m]
    contact: Array  #: contact forces (p, contacts) [N]
    open: Mask  #: whether the first spring carries nothing (p, contacts)
    force: Array  #: components of the generalized force (p, s)
    tangent: Tangent


class Breaks(NamedTuple):
    """Jumps of the force between samples ``step`` and ``after``, at a fraction of the step."""

    step: Index
    after: Index
    fraction: Array
    jump: Array  #: change of the force at the jump (b, s)
    correction: Array  #: correction of the sum of both samples (b, s)
    tangent: Array  #: its derivative by the motion at the jump (b, s, r)

    def gather(self, values: Array) -> Array:
        """Values (b, c) at the jumps, between those of the samples (p, c)."""
        part = self.fraction[:, None]
        return np.asarray((1.0 - part) * values[self.step] + part * values[self.after])

    def scatter(self, force: Array, values: Array) -> None:
        """Add values (b, s) to the two samples about each jump, by its distance from them."""
        if not self.step.size:
            return
        part = self.fraction[:, None]
        at = np.concatenate([self.step, self.after])
        shares = np.concatenate([(1.0 - part) * values, part * values])
        for column, share in zip(force.T, shares.T, strict=True):
            column += np.bincount(at, share, len(force))


#: Breaks of a motion that has none, or of one whose forces are integrated between them.
NO_BREAKS = Breaks(
    np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros((0, 0)),
    np.zeros((0, 0)), np.zeros((0, 0, 0)),
)  # fmt: skip


@dataclass(frozen=True)
class ContactLaw:
    """The law of the contacts of a system."""

    system: System
    dead: Mask  #: springs with a dead zone (contacts, m)

    def law(
        self,
        rows: Rows,
        frequency: float,
        y: Array,
        rate: Array,
        excess: Array,
        closed: Array | None = None,
    ) -> Law:
        """Contact forces at rows, for motions and rates (p, r)."""
        # excess (contacts,): damping on both sides of every contact; closed (contacts, m): sides of
        # springs that stay closed, 0 of those that stay open, whatever the motion.
        nodes = rows.nodes
        d = components(rows.along, y) - nodes.error
        speed = components(rows.along, rate) + frequency * (
            components(rows.along_slope, y) - nodes.error_slope
        )
        every = d[..., None]
        side = sides(every, rows.gap, self.dead) if closed is None else closed + 0.0 * every
        springs = np.where(side != 0.0, rows.stiffness, 0.0)
        stiffness = springs.sum(axis=-1)
        touching = (side[..., 0] != 0.0) | self.system._damped_in_gap
        damping = np.where(touching, nodes.damping, 0.0) + excess
        contact = (springs * (every - side * rows.gap)).sum(axis=-1) + damping * speed
        push = rows.push
        force = rows.load - _pushed(push, contact)
        if self.system.frictions:
            rub = friction_force(self.system, nodes.friction_coefficients, contact)
            force = force - np.einsum("...fs,...f->...s", rows.rub, rub)
            load = carried_load(self.system, contact)
            slope = friction_tangent(self.system, nodes.friction_coefficients, load)
            push = np.broadcast_to(push, (*d.shape, push.shape[-1])).copy()
            for f, friction in enumerate(self.system.frictions):
                push[:, list(friction.contacts)] += slope[:, f, None, None] * rows.rub[:, f, None]
        still = len(rows.along_slope) == 1 and not np.any(rows.along_slope)
        turning = None if still else frequency * rows.along_slope
        tangent = Tangent(push, rows.along, turning, stiffness, damping)
        return Law(d, contact, side[..., 0] == 0.0, force, tangent)


@dataclass(frozen=True)
class ContactEquations(ContactLaw):
    """The contacts of a system on equal steps of the clock."""

    rows: Rows
    before: Rows  #: entries just before the events at which one jumps
    after: Rows
    events: Array  #: these events [-]
    steps: int
    frequency: float = 0.0  #: of the clock [Hz]

    def turning(self, frequency: float) -> ContactEquations:
        """The same at a frequency of the clock."""
        return replace(self, frequency=frequency)

    def at(
        self, y: Array, rate: Array, excess: Array, closed: Array | None
    ) -> tuple[Law, Breaks, None]:
        """Law of a motion (steps, r) at the steps, and where it jumps between them."""
        motion = self.frequency, y, rate, excess, closed
        law, parts = self.law(self.rows, *motion), [self._event_breaks(*motion)]
        for edge in (1.0, -1.0) if closed is None else ():
            parts.append(self._crossings(law, *motion[:3], edge))
        return law, Breaks(*(np.concatenate(part) for part in zip(*parts, strict=True))), None

    def coarser(self) -> ContactEquations:
        """The same on half as many steps."""
        rows = self.rows.at(slice(None, None, 2))
        rows = rows._replace(nodes=rows.nodes._replace(weight=2.0 * rows.nodes.weight))
        return replace(self, rows=rows, steps=self.steps // 2)

    def _event_breaks(
        self, frequency: float, y: Array, rate: Array, excess: Array, closed: Array | None
    ) -> Breaks:
        """Jumps at the events."""
        place = self.events * self.steps
        step = np.ceil(place - 1e-6).astype(np.int64) - 1
        fraction = place - step
        step, after = step % self.steps, (step + 1) % self.steps
        at, pace = (_between(values, step, after, fraction) for values in (y, rate))
        left, right = (
            self.law(rows, frequency, at, pace, excess, closed)
            for rows in (self.before, self.after)
        )
        weight = 0.5 - fraction
        jump = right.force - left.force
        rising = [side.tangent.dense()[0] for side in (left, right)]
        tangent = -weight[:, None, None] * (rising[1] - rising[0])
        return Breaks(step, after, fraction, jump, weight[:, None] * jump, tangent)

    def _crossings(self, law: Law, frequency: float, y: Array, rate: Array, edge: float) -> Breaks:
        """Jumps where contacts open or close."""
        clearance = edge * law.compression[..., None] - self.rows.gap
        inside = (clearance > 0.0) & self.dead
        step, contact, spring = np.nonzero(inside != np.roll(inside, -1, axis=0))
        before, after = ((step + by) % self.steps for by in (-1, 1))
        begin, end = clearance[step, contact, spring], clearance[after, contact, spring]
        fraction = begin / (begin - end)
        touch = _touch_factor((step, contact, spring), (before, after), fraction, inside.shape)
        rows = self.rows.at(step)
        at_y, at_rate = (_between(values, step, after, fraction) for values in (y, rate))
        along, speed = rows.speed_of(contact, frequency, at_y, at_rate)
        opening = np.where(end > begin, 1.0, -1.0)
        steady = self.system._damped_in_gap[contact] | (spring > 0)
        damped = np.where(steady, 0.0, of_contact(rows.nodes.damping, contact))
        jump = opening * damped * speed
        bend = opening * edge * of_contact(rows.stiffness, contact, spring) * (end - begin)
        bernoulli = fraction * (fraction - 1.0) + touch / 6.0
        total = (0.5 - fraction) * jump + 0.5 * bernoulli * bend
        slope = edge * (jump - (fraction - 0.5) * bend) / (end - begin)
        push = law.tangent.push
        push = -push[step if len(push) > 1 else 0 * step, contact]
        tangent = slope[:, None, None] * push[:, :, None] * along[:, None, :]
        return Breaks(step, after, fraction, jump[:, None] * push, total[:, None] * push, tangent)


def _touch_factor(
    crossing: tuple[Index, Index, Index],
    neighbours: tuple[Index, Index],
    fraction: Array,
    shape: Sequence[int],
) -> Array:
    """Factor of each crossing that vanishes with a side that lasts for a single sample."""
    # Without it the correction of a spring that just touches would begin with a jump.
    step, *spring = crossing
    before, after = np.zeros(shape), np.ones(shape)
    before[step, *spring], after[step, *spring] = fraction, fraction
    ahead = fraction * (1.0 - after[neighbours[1], *spring])
    behind = before[neighbours[0], *spring] * (1.0 - fraction)
    return np.asarray((1.0 - ahead**_TOUCH) * (1.0 - behind**_TOUCH))


def close_contacts(
    compiled: OverBases, equilibrium: Rest | None = None
) -> tuple[ClosedStructure, Array]:
    """Structure with closed contacts, and the sides of those closed at rest, 0 of others."""
    nodes, bases = compiled.nodes, (compiled.push, compiled.along)
    still, floating = equilibrium or at_rest(compiled)
    stiffness, gap = springs(nodes)
    side = side_of(compiled, still)
    pressed = (side * compression(nodes, still @ compiled.bases[0]))[..., None] - gap
    closed = np.einsum("rs,rsjm->jm", nodes.weight, pressed) > 0.0
    closed[:, 0] |= lowest_of_each_law(nodes)
    carried = np.where(closed, stiffness, 0.0).sum(axis=-1)
    damped = np.where(closed[:, 0], nodes.damping, 0.0)
    into = _distinct(nodes.force_direction), _distinct(nodes.direction)
    means = [outer(into[0], part[:, 0], into[1]) for part in (carried, damped)]
    shifts = [np.tensordot(nodes.weight.sum(axis=1), part, 1) for part in means]
    structure = ClosedStructure(compiled.system, compiled.coordinates, *bases, *shifts)
    return structure, np.where(closed & ~floating[:, None], side[:, None], 0.0)


def contact_equations(
    system: System,
    structure: ClosedStructure,
    steps: int,
    template: ContactEquations | None = None,
) -> ContactEquations:
    """Sample the contacts of a system at ``steps`` equal steps of the clock."""
    # template: on other steps, with the same events.
    every = system_events(system)
    inverse, bases = structure.coordinates.inverse, (structure.along, structure.push)
    along, push = (inverse.T @ basis for basis in bases)

    def at_points(phase: Array, *, before: bool = False) -> Nodes:
        rows = PointEvaluator(phase, every, before=before)
        return over_spanned(system, partial(evaluate_rows, rows=rows))

    nodes = at_points(np.arange(steps) / steps)
    onto = spanned_coordinates(system, nodes)
    at = project_rows(nodes, along, push, onto)
    if template is not None:
        return replace(template, rows=at, steps=steps)
    points = np.array(every)
    before, after = (at_points(points, before=side) for side in (True, False))
    jumping = jumping_events(before, after, nodes)
    left, right = (
        project_rows(Nodes(*(values[jumping] for values in part)), along, push, onto)
        for part in (before, after)
    )
    return ContactEquations(system, with_dead_zone(nodes), at, left, right, points[jumping], steps)


def project_rows(nodes: Nodes, along: Array, push: Array, onto: Array | None = None) -> Rows:
    """Entries (p, 1, ...) with directions by their components along the columns of two bases."""
    # onto: coordinates over which the directions are (c, n)
    load = push
    along, push = (base if onto is None else onto @ base for base in (along, push))
    return Rows(
        Nodes(*(values[:, 0] for values in nodes)),
        _distinct(nodes.direction) @ along,
        _distinct(nodes.direction_slope) @ along,
        _distinct(nodes.force_direction) @ push,
        _distinct(nodes.friction_direction) @ push,
        _distinct(nodes.force) @ load,
        *(values[:, 0] for values in springs(nodes)),
    )


def with_dead_zone(nodes: Nodes) -> Mask:
    """Springs that have a dead zone (contacts, m)."""
    ramps = nodes.ramp_stiffness.any(axis=(0, 1))
    return np.concatenate((has_gap(nodes)[:, None], ramps), axis=1)


def _distinct(values: Array) -> Array:
    """Rows (p, ...) of values (p, 1, ...), or the row that they repeat."""
    return unrepeated(values[:, 0], values.ndim - 2)


def jumping_events(before: Nodes, after: Nodes, within: Nodes) -> Index:
    """Numbers of the events at which an entry jumps, compared with its values within a cycle."""
    jumps = np.zeros(len(before.phase), dtype=bool)
    for name, left, right, every in zip(Nodes._fields, before, after, within, strict=True):
        if name not in ("phase", "weight", "error_slope", "direction_slope"):
            scale = max(float(np.abs(part).max(initial=1e-300)) for part in (left, every))
            jump = np.abs(right - left).reshape(len(left), -1).max(axis=1, initial=0.0)
            jumps |= jump > _JUMP * scale
    return np.flatnonzero(jumps)


def of_contact(values: Array, *columns: Index) -> Array:
    """Values (b, ...) of a contact, or a spring of it, at each of rows (b or 1, contacts, ...)."""
    each = np.arange(columns[0].size)
    return np.asarray(values[(each if len(values) > 1 else 0 * each, *columns)])


def components(direction: Array, motion: Array) -> Array:
    """Motions (p, r) along directions (p or 1, contacts, r), (p, contacts)."""
    if len(direction) == 1:
        return np.asarray(motion @ direction[0].T)
    return np.asarray((direction @ motion[..., None])[..., 0])


def _pushed(push: Array, contact: Array) -> Array:
    """Sum over the contacts of push (p or 1, contacts, s) times force (p, contacts), (p, s)."""
    if len(push) == 1:
        return np.asarray(contact @ push[0])
    return np.asarray((contact[:, None] @ push)[:, 0])


def outer(push: Array, factor: Array, along: Array) -> Array:
    """Sum over the contacts of push, factor and direction, (p, s, r)."""
    if len(push) == len(along) == 1:
        pairs = push[0][:, :, None] * along[0][:, None, :]
        return np.asarray(np.tensordot(factor, pairs, 1))
    return np.swapaxes(push * factor[..., None], -1, -2) @ along


def _between(values: Array, step: Index, after: Index, fraction: Array) -> Array:
    """Samples (p, r) interpolated at fractions of steps."""
    part = fraction[:, None]
    return np.asarray((1.0 - part) * values[step] + part * values[after])
