"""One side of a pair: wheel flank, the pinion flank that it envelops, and their contact lines."""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.gear.hypoid.blank import HypoidBlank
from tribodyn.gear.hypoid.ease_off import EaseOff, eased_gap, working_depth
from tribodyn.gear.hypoid.envelope import (
    Curvature,
    Envelope,
    Surface,
    cross,
    envelope,
    relative_curvature,
    solved,
    turned_surface,
)
from tribodyn.gear.hypoid.wheel_flanks import pair_axes, wheel_flank
from tribodyn.types import Array, Mask


class Touch(NamedTuple):
    """Conjugate contact at places on the wheel, in the fixed frame."""

    places: Array  #: (..., 2) along and across the wheel's pitch cone
    contact: Envelope
    sliding: Array  #: (..., 3) of the pinion over the wheel, for a unit speed of the pinion
    lever: Array  #: of the normal about the wheel's axis, positive

    @property
    def curvature(self) -> Curvature:
        """Curvature of the gap about each contact."""
        return relative_curvature(self.contact)

    def at(self, chosen: tuple[slice, ...]) -> Touch:
        """Contact at some of the positions."""
        contact = self.contact
        wheel, pinion = (
            Surface(*(values[chosen] for values in each))
            for each in (contact.wheel, contact.pinion)
        )
        touch = Envelope(contact.rotation[chosen], wheel, pinion, contact.slope[chosen])
        return Touch(self.places[chosen], touch, self.sliding[chosen], self.lever[chosen])


class ConjugateFlanks:
    """Drive or coast side of a pair; points are counted by the parameters of the wheel flank."""

    def __init__(self, blank: HypoidBlank, side: str, ease_off: EaseOff) -> None:
        self.blank, self.ease_off = blank, ease_off
        self.wheel, self.axes = wheel_flank(blank, side), pair_axes(blank)
        moment = cross(self.wheel.point, self.wheel.normal)
        #: 1 where the rotations grow while the pinion drives, else -1.
        self.sense = -math.copysign(1.0, moment[2])

    def touch(self, places: Array) -> Touch:
        """Touch the wheel at places; NaN where it has no flank or never touches."""
        return self.touch_at(self.wheel.at(self.wheel.parameters(places)))

    def touch_at(self, surface: Surface) -> Touch:
        """Touch the wheel at points of its flank."""
        places, _ = self.wheel.projected(surface)
        contact = envelope(surface, self.axes)
        position, normal = contact.wheel[:2]
        return Touch(
            places,
            contact,
            self.axes.sliding(position),
            -self.sense * cross(position, normal)[..., 2],
        )

    def margins(self, touch: Touch) -> Array:
        """Distances (..., 4) to tip of wheel and pinion, to toe and heel; negative outside."""
        blank = self.blank
        along, across = np.moveaxis(touch.places, -1, 0)
        up = math.tan(blank.face_angle_wheel - blank.pitch_angle_wheel)
        pinion, axis = touch.contact.pinion.position, self.axes.axis
        place, pitch = pinion @ axis, blank.pitch_angle_pinion
        radius = np.linalg.norm(pinion - place[..., None] * axis, axis=-1)
        distance = radius * math.sin(pitch) + (place + blank.pitch_apex_pinion) * math.cos(pitch)
        tip = (place + blank.face_apex_pinion) * math.tan(blank.face_angle_pinion)
        mean = blank.mean_cone_distance_wheel
        toe = along - (blank.inner_cone_distance_wheel - mean)
        heel = blank.outer_cone_distance_wheel - mean - along
        return np.stack(
            [
                blank.mean_addendum_wheel + along * up - across,
                tip - radius,
                np.minimum(toe, distance - blank.inner_cone_distance_pinion),
                np.minimum(heel, blank.outer_cone_distance_pinion - distance),
            ],
            axis=-1,
        )

    def pinion_at(self, parameters: Array) -> tuple[Array, Array]:
        """Position about the pinion's origin and normal of the eased pinion flank at rest."""
        flank = self.wheel.at(parameters)
        contact = envelope(flank, self.axes)
        places, steps = self.wheel.projected(flank)
        gap, slope = eased_gap(self.ease_off, self.blank, places)
        pinion = turned_surface(contact.pinion, self.axes.axis, -contact.rotation / self.axes.ratio)
        gap_slope = np.einsum("...i,...ij->...j", slope, steps)
        tangents = (
            pinion.tangents
            - pinion.normal[..., :, None] * gap_slope[..., None, :]
            - gap[..., None, None] * pinion.turns
        )
        normal = cross(tangents[..., 0], tangents[..., 1])
        # A pinion that is undercut is run through backwards; its normal keeps its sense.
        normal *= np.sign(np.einsum("...i,...i->...", normal, pinion.normal))[..., None]
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        return pinion.position - gap[..., None] * pinion.normal, normal


#: Steps of Newton's method and of the search for ends, samples of a line, grid of a flank.
_NEWTON, _SEARCH, _SAMPLES, _GRID = 30, 60, 65, 33
#: What is left of a place [m] and of a rotation [rad].
_CLOSE = 1e-14
#: Grid of the guess of parameters, how far it goes beyond the flank, and degree of its polynomials.
_FITTED, _WIDER, _DEGREE = 15, 0.15, 5


def _flank_places(blank: HypoidBlank, wider: float, count: int) -> Array:
    """Grid of places (count, count, 2) over the flank of the wheel, wider by a part of it."""
    share = np.linspace(-wider, 1.0 + wider, count)
    inner, outer = blank.inner_cone_distance_wheel, blank.outer_cone_distance_wheel
    along = inner - blank.mean_cone_distance_wheel + share * (outer - inner)
    (low, _), (high, _) = working_depth(blank, along)
    across = low[:, None] + share * (high - low)[:, None]
    return np.stack(np.broadcast_arrays(along[:, None], across), axis=-1)


def _powers(pair: Array) -> Array:
    """Products of powers of two numbers (n, 2) up to the degree of the guess."""
    x, y = pair.T
    return np.stack(
        [x**i * y**j for i in range(_DEGREE + 1) for j in range(_DEGREE + 1 - i)], axis=-1
    )


class ContactLines:
    """Lines of one flank pair, each at a rotation of the wheel; stations run along them."""

    def __init__(self, flanks: ConjugateFlanks) -> None:
        self.flanks = flanks
        surface = flanks.wheel.at(np.zeros(2))
        _, steps = flanks.wheel.projected(surface)
        slope = envelope(surface, flanks.axes).slope @ np.linalg.inv(steps)
        #: Directions along and across the line of the calculation point, in (along, across).
        self.across = slope / np.linalg.norm(slope)
        self.along = np.array([-self.across[1], self.across[0]])
        self._unit = np.array([1e-3, 1e-3 / flanks.blank.cutter_radius])

    @cached_property
    def _start(self) -> tuple[Array, Array]:
        """Scale of rotation and station, and polynomials of them that guess the parameters."""
        places = _flank_places(self.flanks.blank, _WIDER, _FITTED)
        parameters = self.flanks.wheel.parameters(places.reshape(-1, 2))
        position, _ = self._lines_at(parameters)
        finite = np.isfinite(position).all(axis=-1)
        scale = np.abs(position[finite]).max(axis=0)
        terms = _powers(position[finite] / scale)
        return scale, np.asarray(np.linalg.lstsq(terms, parameters[finite], rcond=None)[0])

    def _lines_at(self, parameters: Array) -> tuple[Array, Array]:
        """Rotation and station of points of the flank, with derivatives by the parameters."""
        surface = self.flanks.wheel.at(parameters)
        places, steps = self.flanks.wheel.projected(surface)
        contact = envelope(surface, self.flanks.axes)
        position = np.stack([contact.rotation, places @ self.along], axis=-1)
        return position, np.stack([contact.slope, self.along @ steps], axis=-2)

    def parameters(self, rotation: Array, station: Array) -> Array:
        """Parameters of the flank at stations of the lines; NaN where there is none."""
        rotation, station = np.broadcast_arrays(rotation, station)
        wanted = np.stack([rotation.ravel(), station.ravel()], axis=-1)
        scale, guess = self._start
        with np.errstate(all="ignore"):
            parameters = _powers(wanted / scale) @ guess
            lost = np.full(len(parameters), np.inf)
            left = np.arange(len(parameters))
            for _ in range(_NEWTON):
                position, matrix = self._lines_at(parameters[left])
                error = wanted[left] - position
                lost[left] = np.max(np.abs(error), axis=-1)
                parameters[left] += solved(matrix, error)
                left = left[lost[left] > _CLOSE]
                if not left.size:
                    break
        parameters[~(lost < 1e-11)] = np.nan
        return parameters.reshape(*rotation.shape, 2)

    def touch(self, rotation: Array, station: Array) -> Touch:
        """Contact at stations of the lines."""
        surface = self.flanks.wheel.at(self.parameters(rotation, station))
        return self.flanks.touch_at(surface)

    def margin(self, rotation: Array, station: Array) -> Array:
        """Least distance to an edge of the active flank; minus infinity where there is no flank."""
        margin = np.min(self.flanks.margins(self.touch(rotation, station)), axis=-1)
        return np.where(np.isfinite(margin), margin, -np.inf)

    @cached_property
    def span(self) -> tuple[float, float]:
        """Rotations of the wheel at which the active flank comes into touch and leaves it."""
        from scipy.optimize import minimize

        places = _flank_places(self.flanks.blank, 0.0, _GRID)
        parameters = self.flanks.wheel.parameters(places)
        touch = self.flanks.touch_at(self.flanks.wheel.at(parameters))
        inside = np.all(self.flanks.margins(touch) >= 0.0, axis=-1) & np.isfinite(
            touch.contact.rotation
        )
        if not np.any(inside):
            raise ComputationError(
                "the flanks of this pair never touch on their teeth",
                why="No point of the wheel's flank meets the pinion between its tip and its ends",
                remedy="Check the depth and the face width of the blank",
            )

        @lru_cache(maxsize=8)
        def at(parameters: bytes) -> Touch:  # objective and margins at the same places
            return self._at(np.frombuffer(parameters))

        ends = []
        for sense in (-1.0, 1.0):
            best = np.argmax(np.where(inside, sense * touch.contact.rotation, -np.inf))
            minimum = minimize(
                lambda x, sense=sense: -sense * float(at(x.tobytes()).contact.rotation[0]),
                parameters[np.unravel_index(best, inside.shape)] / self._unit,
                constraints={
                    "type": "ineq",
                    "fun": lambda x: 1e3 * self.flanks.margins(at(x.tobytes()))[0],
                },
                method="SLSQP",
                options={"ftol": 1e-13},
            )
            ends.append(float(self._at(minimum.x).contact.rotation[0]))
        return ends[0], ends[1]

    @property
    def contact_ratio(self) -> float:
        """Rotation over which a pair has contact lines, over the pitch."""
        low, high = self.span
        return (high - low) * self.flanks.blank.teeth_wheel / (2.0 * math.pi)

    def _at(self, parameters: Array) -> Touch:
        return self.flanks.touch_at(self.flanks.wheel.at(self._unit * parameters[None]))

    def ends(self, rotation: Array) -> tuple[Array, Mask]:
        """First and last station (n, 2) of the lines on the active flank, and if they exist."""
        reach = _flank_places(self.flanks.blank, 0.0, 2) @ self.along
        spread = 0.1 * np.ptp(reach)
        samples = np.linspace(reach.min() - spread, reach.max() + spread, _SAMPLES)
        station = np.tile(samples, (len(rotation), 1))
        margins = self.margin(rotation[:, None], station)
        # A line shorter than the sample spacing is next to the sample with the largest margin.
        for step in (samples[1] - samples[0]) * np.array([1.0, 2.0 / _SAMPLES]):
            short = ~np.any(margins > 0.0, axis=1)
            middle = station[short, np.argmax(margins[short], axis=1)]
            station[short] = middle[:, None] + np.linspace(-step, step, _SAMPLES)
            margins[short] = self.margin(rotation[short, None], station[short])
        inside = margins > 0.0
        middle = np.argmax(margins, axis=1)
        number = np.arange(_SAMPLES)
        before = np.where(~inside & (number <= middle[:, None]), number, -1).max(axis=1)
        after = np.where(~inside & (number >= middle[:, None]), number, _SAMPLES).min(axis=1)
        exists = inside.any(axis=1) & (before >= 0) & (after < _SAMPLES)
        before, after = np.where(exists, before, 0), np.where(exists, after, 1)
        row = np.arange(len(rotation))
        stations = [
            self._end(
                rotation,
                *(np.stack([each[row, out], each[row, inside_end]]) for each in (station, margins)),
            )
            for out, inside_end in ((before, before + 1), (after, after - 1))
        ]
        return np.stack(stations, axis=-1), exists

    def _end(self, rotation: Array, station: Array, margins: Array) -> Array:
        """Close in on the end between a station (2, n) outside of the flank and one inside."""
        (outside, inside), (outside_margin, inside_margin) = station, margins
        for _ in range(_SEARCH):
            with np.errstate(invalid="ignore"):
                share = inside_margin / (inside_margin - outside_margin)
            # Far from any flank interpolation is not possible; halves keep both ends moving.
            share = np.where(np.isfinite(outside_margin) & (share > 0.0), share, 0.5)
            middle = inside + np.clip(share, 0.01, 0.99) * (outside - inside)
            middle_margin = self.margin(rotation, middle)
            is_inside = middle_margin > 0.0
            # The end that stays counts half the next time (Illinois).
            inside_margin = np.where(is_inside, middle_margin, 0.5 * inside_margin)
            outside_margin = np.where(is_inside, 0.5 * outside_margin, middle_margin)
            outside = np.where(is_inside, outside, middle)
            inside = np.where(is_inside, middle, inside)
            if np.nanmax(np.minimum(np.abs(middle_margin), np.abs(outside - inside))) < 1e-13:
                break
        return np.asarray(inside)


@lru_cache(maxsize=8)
def contact_lines(flanks: ConjugateFlanks) -> ContactLines:
    """Lines of a flank pair, one object for all its misalignments and loads."""
    return ContactLines(flanks)
