"""Tooth contact analysis of a hypoid pair: contact path, transmission error, lines and pattern."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import NamedTuple

import numpy as np

from tribodyn.errors import ComputationError, require_between, require_positive
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks, ContactLines, Touch, contact_lines
from tribodyn.gear.hypoid.ease_off import eased_gap
from tribodyn.gear.hypoid.envelope import turned
from tribodyn.gear.hypoid.flank import HypoidFlanks
from tribodyn.gear.hypoid.wheel_flanks import hand_sense
from tribodyn.nomenclature import require_flag, require_number, require_whole
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array, Mask


@dataclass(frozen=True, kw_only=True)
class Misalignment:
    """Displacements of both gears from their nominal places; none by default.

    Parameters
    ----------
    offset : float [m]
        By how much the offset is too large.
    pinion_axial : float [m]
        Displacement of the pinion along its axis, away from the crossing point.
    wheel_axial : float [m]
        Displacement of the wheel along its axis, away from the crossing point.
    shaft_angle : float [rad]
        By how much the shaft angle is too large.

    Raises
    ------
    InputError
        If a displacement is not finite or beyond 2 mm, or the angle beyond 0.02 rad.

    Notes
    -----
    The four values of V-H checks of bevel gears, also called E, P, G and alpha: V = E is the change
    of the offset, H = P that of the pinion's and J = G that of the wheel's mounting distance.
    Positive values move the axes, or the gear from the crossing point, apart: the pinion against
    its hand's x axis by ``offset``, along its axis towards its heel by ``pinion_axial``, the wheel
    likewise by ``wheel_axial``; a positive ``shaft_angle`` turns the pinion's axis away from the
    wheel's. They are the same for both sides of the teeth and both hands.

    Examples
    --------
    >>> Misalignment(pinion_axial=0.1e-3).wheel_axial
    0.0
    """

    offset: float = 0.0
    pinion_axial: float = 0.0
    wheel_axial: float = 0.0
    shaft_angle: float = 0.0

    def __post_init__(self) -> None:
        for each in fields(self):
            value = require_number(each.name, getattr(self, each.name))
            angle = each.name == "shaft_angle"
            most, unit = (0.02, "rad") if angle else (2e-3, "m")
            require_between(each.name, value, -most, most, unit, remedy="0.1 mm is 0.1e-3")
            object.__setattr__(self, each.name, value)


def pinion_motion(misalignment: Misalignment, axis: Array, sense: float) -> tuple[Array, Array]:
    """Rotation of the pinion about the crossing point and its displacement; sense of its hand."""
    cosine, sine = math.cos(misalignment.shaft_angle), math.sin(misalignment.shaft_angle)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])
    away = np.array([-sense * misalignment.offset, 0.0, 0.0])
    return turn, away + misalignment.pinion_axial * axis


def displaced_gap(
    misalignment: Misalignment, position: Array, normal: Array, axis: Array, sense: float
) -> Array:
    """Gap that the displacements leave where conjugate flanks would touch, to first order."""
    turn, shift = pinion_motion(misalignment, axis, sense)
    pinion = position @ (turn - np.eye(3)).T + shift
    wheel = np.array([0.0, 0.0, misalignment.wheel_axial])
    return np.asarray(np.einsum("...i,...i->...", wheel - pinion, normal))


#: Steps of Newton's method; units of a length [m] and of a rotation [rad]; step of differences.
_ROUNDS, _LENGTH, _ROTATION, _DIFFERENCE = 40, 1e-3, 1e-3, 1e-4
#: Error of position and normal that counts as none, and the one that is refused, over the unit.
_NONE, _REFUSED = 2e-12, 1e-9
#: Singular values below this share are those of flanks that touch along a line.
_LINE = 1e-10


class ExactContact(NamedTuple):
    """Contacts of two flanks."""

    wheel_rotation: Array  #: (n,)
    position: Array  #: (n, 3) in the fixed frame
    normal: Array  #: (n, 3)
    places: Array  #: (n, 2) along and across the wheel's pitch cone
    residual: Array  #: (n,) greatest error of position [m]


def exact_contact(
    flanks: ConjugateFlanks, rotation: Array, guess: Array, misalignment: Misalignment
) -> ExactContact:
    """Solve five equations for each rotation of the pinion, from a guess (n, 5).

    Unknowns are the parameters of the pinion's and of the wheel's flank, and the wheel's rotation.
    """
    swing = flanks.blank.cutter_radius
    unit = np.array([_LENGTH, _LENGTH / swing, _LENGTH, _LENGTH / swing, _ROTATION])
    axes, wheel_axis = flanks.axes, np.array([0.0, 0.0, 1.0])
    turn, shift = pinion_motion(misalignment, axes.axis, hand_sense(flanks.blank))

    def bodies(unknown: Array) -> tuple[Array, Array, Array, Array]:
        position, normal = flanks.pinion_at(unknown[..., :2])
        angle = np.broadcast_to(rotation, unknown.shape[:-1])
        place = (turned(position, axes.axis, angle) + axes.origin) @ turn.T + shift
        facing = turned(normal, axes.axis, angle) @ turn.T
        surface = flanks.wheel.at(unknown[..., 2:4])
        mate, mate_normal = (turned(each, wheel_axis, -unknown[..., 4]) for each in surface[:2])
        mate = mate + misalignment.wheel_axial * wheel_axis
        return place, facing, mate, mate_normal

    first = bodies(guess)[3]
    helper = np.where(np.abs(first[:, :1]) < 0.9, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    tangent = np.cross(first, helper)
    basis = np.stack([tangent, np.cross(first, tangent)], axis=-2)

    def error(unknown: Array) -> Array:
        place, facing, mate, mate_normal = bodies(unknown)
        turns = np.einsum("nij,...nj->...ni", basis, facing - mate_normal)
        return np.concatenate([(place - mate) / _LENGTH, turns], axis=-1)

    unknowns = guess.copy()
    steps = _DIFFERENCE * unit * np.eye(5)
    for _ in range(_ROUNDS):
        fault = error(unknowns)
        slope = error(unknowns + steps[:, None]) - error(unknowns - steps[:, None])
        matrix = np.moveaxis(slope, 0, -1) / (2.0 * _DIFFERENCE)
        change = np.einsum("nij,nj->ni", np.linalg.pinv(matrix, rcond=_LINE), fault)
        unknowns = unknowns - unit * change
        if np.max(np.abs(fault), initial=0.0) < _NONE:
            break
    left = np.max(np.abs(error(unknowns)), axis=-1)
    if not np.all(left < _REFUSED):
        worst = int(np.argmax(np.where(np.isfinite(left), left, np.inf)))
        raise ComputationError(
            f"at a rotation of the pinion of {rotation[worst]:.4g} rad the flanks stay "
            f"{left[worst] * _LENGTH * 1e6:.3g} um apart",
            why="The misalignment or the ease-off moves the contact off the surfaces",
            remedy="Give less of it, or take the analysis by the ease-off",
        )
    _, _, mate, normal = bodies(unknowns)
    places, _ = flanks.wheel.projected(flanks.wheel.at(unknowns[:, 2:4]))
    return ExactContact(unknowns[:, 4], mate, normal, places, left * _LENGTH)


#: Golden section: its ratio, and steps that leave a nanometre.
_GOLDEN, _STEPS = 0.5 * (math.sqrt(5.0) - 1.0), 30
#: Distance over which the curvature of the ease-off along a line is measured [m].
_NEAR = 1e-4
_LINES, _CELLS = ("rotation",), ("rotation", "cell")


#: Rotations of a pitch at which the transmission error of the running pair is compared.
_FINE = 1024


@record
class ToothContact(Record):
    """Contact of one tooth pair without load from entry to exit; made by :func:`tooth_contact`.

    Rotations follow the order of contact: both gears turn on from the calculation point.

    Parameters
    ----------
    rotation : array (rotation,) [rad]
        Rotation of the wheel in its running sense at which the conjugate flanks would touch.
    angular_transmission_error : array (rotation,) [rad]
        By how much the wheel runs ahead of the ratio; negative where it lags behind.
    along, across : array (rotation,) [m]
        Place of the contact on the wheel, along and across its pitch cone.
    position, normal : array (rotation, 3) [m]
        Contact in the fixed frame, and unit normal (a pure number) into the wheel.
    on_edge : array of bool (rotation,)
        Whether the contact lies on the end of its line: an edge touches.
    leads : array of bool (rotation,)
        Whether this pair touches, and not the one before or after it.
    cell_along, cell_across : array (rotation, cell) [m]
        Places on each contact line, from its first to its last point on both flanks.
    clearance : array (rotation, cell) [m]
        Gap there while the pair touches.
    line_length : array (rotation,) [m]
        Length of the contact line.
    semi_axes : array (rotation, 2) [m]
        Half length of the contact ellipse along and across the line, as far as the marking
        compound reaches; infinite along a line of conjugate flanks.
    exact : bool
        Whether both surfaces were brought into touch; else the ease-off was taken to first order.
    marking_thickness : float [m]
        Thickness of the marking compound.
    flanks : HypoidFlanks
        The flanks.
    misalignment : Misalignment
        Displacements of both gears.

    Notes
    -----
    Source: Litvin and Fuentes, Gear Geometry and Applied Theory, 2004, simulation of contact.
    """

    rotation: Array = quantity(*_LINES, unit="rad", axis=True)
    angular_transmission_error: Array = quantity(*_LINES, unit="rad")
    along: Array = quantity(*_LINES, unit="m")
    across: Array = quantity(*_LINES, unit="m")
    position: Array = quantity(*_LINES, "component", unit="m")
    normal: Array = quantity(*_LINES, "component", unit="1")
    on_edge: Mask = quantity(*_LINES, unit="1")
    leads: Mask = quantity(*_LINES, unit="1")
    cell_along: Array = quantity(*_CELLS, unit="m")
    cell_across: Array = quantity(*_CELLS, unit="m")
    clearance: Array = quantity(*_CELLS, unit="m")
    line_length: Array = quantity(*_LINES, unit="m")
    semi_axes: Array = quantity(*_LINES, "direction", unit="m")
    exact: bool = fact()
    marking_thickness: float = fact()
    flanks: HypoidFlanks = field()
    misalignment: Misalignment = field()

    @property
    def contact_ratio(self) -> float:
        """Rotation over which a pair has contact lines, over the pitch."""
        return contact_lines(self.flanks.conjugate).contact_ratio

    @property
    def peak_to_peak(self) -> float:
        """Transmission error of the running pair, from its least to its greatest value [rad]."""
        pitch = 2.0 * np.pi / self.flanks.blank.teeth_wheel
        order = np.argsort(self.rotation)
        rotation, error = self.rotation[order], self.angular_transmission_error[order]
        # The pair that is ahead of its neighbours touches. Where one takes over from another the
        # curve has a corner, which lies between the rotations of the analysis.
        turn = rotation[0] + pitch * np.arange(_FINE) / _FINE
        pairs = np.arange(math.ceil((rotation[-1] - rotation[0]) / pitch) + 1)
        places = turn + pitch * pairs[:, None]
        ahead = np.interp(places, rotation, error, left=-np.inf, right=-np.inf).max(axis=0)
        return float(np.ptp(ahead))

    @property
    def marked(self) -> Mask:
        """Cells (rotation, cell) of the contact pattern: the compound fills the gap."""
        return np.asarray(self.clearance <= self.marking_thickness)


def tooth_contact(
    flanks: HypoidFlanks,
    misalignment: Misalignment | None = None,
    *,
    exact: bool = False,
    marking_thickness: float = 6.35e-6,
    rotations_per_pitch: int = 24,
    cells: int = 41,
) -> ToothContact:
    """Contact of a tooth pair without load.

    Parameters
    ----------
    flanks : HypoidFlanks
        The flanks with their ease-off.
    misalignment : Misalignment, optional
        Displacements of both gears; none by default.
    exact : bool
        Bring both surfaces into touch where no edge touches; else take the gap to first order.
    marking_thickness : float
        Thickness of the marking compound [m].
    rotations_per_pitch : int
        Rotations over a pitch, at least 4.
    cells : int
        Places along each contact line, at least 5.

    Raises
    ------
    InputError
        If an argument is wrong.
    ComputationError
        If the flanks do not touch anywhere.

    Notes
    -----
    To first order the wheel lags by the least gap over the lever of the normal, taken over the
    contact line of the conjugate flanks; that is exact in the limit of a small ease-off.

    Examples
    --------
    >>> from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> ease_off = EaseOff(lengthwise_crowning=29e-6, profile_crowning=9e-6, bias=6e-6)
    >>> contact = tooth_contact(hypoid_flanks(blank, ease_off=ease_off))
    >>> round(contact.peak_to_peak * 1e6)
    37
    """
    exact = require_flag("exact", exact)
    require_positive("marking_thickness", marking_thickness, "m", remedy="6 um is 6e-6")
    require_between("marking_thickness", marking_thickness, 0.0, 1e-3, "m", remedy="6 um is 6e-6")
    counts = [
        require_whole("rotations_per_pitch", rotations_per_pitch, 4),
        require_whole("cells", cells, 5),
    ]
    for name, count in zip(("rotations_per_pitch", "cells"), counts, strict=True):
        require_between(name, count, 4, 1000, remedy="A thousand are enough")
    return _analysis(flanks, misalignment or Misalignment(), exact, marking_thickness, counts)


def _analysis(
    flanks: HypoidFlanks,
    misalignment: Misalignment,
    exact: bool,
    thickness: float,
    counts: list[int],
) -> ToothContact:
    conjugate = flanks.conjugate
    lines = contact_lines(conjugate)
    step = 2.0 * math.pi / flanks.blank.teeth_wheel / counts[0]
    low, high = lines.span
    rotation: Array = step * np.arange(math.ceil(low / step), math.floor(high / step) + 1.0)
    rotation = rotation if conjugate.sense > 0.0 else rotation[::-1]
    ends, on_flank = lines.ends(rotation)
    rotation, ends = rotation[on_flank], ends[on_flank]
    station, lag, at_end = lightest(lines, rotation, ends, misalignment)
    share = np.linspace(0.0, 1.0, counts[1])
    cells = lines.touch(rotation[:, None], ends[:, :1] + share * np.ptp(ends, axis=1)[:, None])
    clearance = (_lag(conjugate, cells, misalignment) - lag[:, None]) * cells.lever
    spots = cells.contact.wheel.position
    touch = lines.touch(rotation, station)
    error, position = -lag, touch.contact.wheel.position
    normal, places = touch.contact.wheel.normal, touch.places.copy()
    inner = ~at_end
    if exact and np.any(inner):
        exact_points = exact_contact(
            conjugate,
            rotation[inner] / conjugate.axes.ratio,
            start_values(lines, rotation[inner], station[inner], lag[inner]),
            misalignment,
        )
        error = error.copy()
        error[inner] = conjugate.sense * (exact_points.wheel_rotation - rotation[inner])
        position[inner] = exact_points.position
        normal[inner] = exact_points.normal
        places[inner] = exact_points.places
    return ToothContact(
        rotation=conjugate.sense * rotation,
        angular_transmission_error=error,
        along=places[:, 0],
        across=places[:, 1],
        position=position,
        normal=normal,
        on_edge=at_end,
        leads=_leads(np.round(rotation / step).astype(int), error, counts[0]),
        cell_along=cells.places[..., 0],
        cell_across=cells.places[..., 1],
        clearance=clearance,
        line_length=np.linalg.norm(np.diff(spots, axis=1), axis=-1).sum(axis=1),
        semi_axes=_semi_axes(lines, rotation, station, misalignment, thickness),
        exact=exact,
        marking_thickness=float(thickness),
        flanks=flanks,
        misalignment=misalignment,
    )


def gap_of(flanks: ConjugateFlanks, touch: Touch, misalignment: Misalignment) -> Array:
    """Gap of ease-off and misalignment where conjugate flanks would touch, to first order."""
    gap, _ = eased_gap(flanks.ease_off, flanks.blank, touch.places)
    wheel = touch.contact.wheel
    hand = flanks.axes.axis, hand_sense(flanks.blank)
    return np.asarray(gap + displaced_gap(misalignment, wheel.position, wheel.normal, *hand))


def _lag(flanks: ConjugateFlanks, touch: Touch, misalignment: Misalignment) -> Array:
    """Rotation of the wheel that would close the gap at each place."""
    return np.asarray(gap_of(flanks, touch, misalignment) / touch.lever)


def lightest(
    lines: ContactLines, rotation: Array, ends: Array, misalignment: Misalignment
) -> tuple[Array, Array, Mask]:
    """Station of each line where the wheel lags least, that lag, and whether it is an end."""

    def lag(station: Array) -> Array:
        return _lag(lines.flanks, lines.touch(rotation, station), misalignment)

    samples = ends[:, :1] + np.linspace(0.0, 1.0, 33) * np.ptp(ends, axis=1)[:, None]
    lags = _lag(lines.flanks, lines.touch(rotation[:, None], samples), misalignment)
    best, row = np.argmin(lags, axis=1), np.arange(len(rotation))
    low, high = (samples[row, np.clip(best + side, 0, 32)] for side in (-1, 1))
    for _ in range(_STEPS):
        width = _GOLDEN * (high - low)
        left = lag(high - width) <= lag(low + width)
        low, high = np.where(left, low, high - width), np.where(left, low + width, high)
    station = 0.5 * (low + high)
    tolerance = 1e-6 * np.ptp(ends, axis=1)
    at_start, at_stop = station - ends[:, 0] < tolerance, ends[:, 1] - station < tolerance
    station = np.where(at_start, ends[:, 0], np.where(at_stop, ends[:, 1], station))
    return station, lag(station), np.asarray(at_start | at_stop)


def start_values(lines: ContactLines, rotation: Array, station: Array, lag: Array) -> Array:
    """Guess of the exact contact: both flanks at the contact to first order."""
    parameters = lines.parameters(rotation, station)
    turn = rotation - lines.flanks.sense * lag
    return np.hstack([parameters, parameters, turn[:, None]])


def _leads(number: Array, error: Array, pitch: int) -> Mask:
    """Whether a pair runs ahead of those a pitch before and after it."""
    error_at = dict(zip(number.tolist(), error.tolist(), strict=True))
    shifts = range(-9 * pitch, 10 * pitch, pitch)
    return np.array(
        [
            value >= max(error_at.get(place + shift, -math.inf) for shift in shifts)
            for place, value in error_at.items()
        ]
    )


def _semi_axes(
    lines: ContactLines,
    rotation: Array,
    station: Array,
    misalignment: Misalignment,
    thickness: float,
) -> Array:
    """Half axes of the ellipse within which the gap stays below the compound's thickness."""
    stations = station + _NEAR * np.array([[-1.0], [0.0], [1.0]])
    touch = lines.touch(rotation, stations)
    lag = _lag(lines.flanks, touch, misalignment)
    gap = (lag - lag[1]) * touch.lever[1]
    position = touch.contact.wheel.position
    step = 0.5 * np.linalg.norm(position[2] - position[0], axis=-1)
    along = (gap[0] + gap[2]) / step**2
    across = touch.curvature.tensor[1, :, 1, 1]
    with np.errstate(divide="ignore"):
        curvature = np.maximum(np.stack([along, across], axis=-1), 0.0)
        return np.asarray(np.sqrt(2.0 * thickness / curvature))
