"""Contact lines of conjugate flanks with their exact ends."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks, Touch
from tribodyn.gear.hypoid.ease_off import working_depth
from tribodyn.gear.hypoid.envelope import envelope
from tribodyn.types import Array, Mask

#: Steps of Newton's method and of the search for ends, samples of a line, grid of a flank.
_NEWTON, _SEARCH, _SAMPLES, _GRID = 30, 60, 65, 33
#: What is left of a place [m] and of a rotation [rad].
_CLOSE = 1e-14


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
        self.start = np.linalg.inv(np.stack([slope, self.along]) @ steps)

    def parameters(self, rotation: Array, station: Array) -> Array:
        """Parameters of the flank at stations of the lines; NaN where there is none."""
        rotation, station = np.broadcast_arrays(rotation, station)
        wanted = np.stack([rotation, station], axis=-1)
        wheel, axes = self.flanks.wheel, self.flanks.axes
        found = wanted @ self.start.T
        with np.errstate(all="ignore"):
            for _ in range(_NEWTON):
                surface = wheel.at(found)
                places, steps = wheel.projected(surface)
                contact = envelope(surface, axes)
                here = np.stack([contact.rotation, places @ self.along], axis=-1)
                error = wanted - here
                rows = (contact.slope, np.einsum("i,...ij->...j", self.along, steps))
                (a, b), (c, d) = ((row[..., 0], row[..., 1]) for row in rows)
                step = np.stack(
                    [d * error[..., 0] - b * error[..., 1], a * error[..., 1] - c * error[..., 0]],
                    axis=-1,
                )
                found = found + step / (a * d - b * c)[..., None]
                if np.nanmax(np.abs(error), initial=0.0) < _CLOSE:
                    break
        lost = ~(np.max(np.abs(error), axis=-1) < 1e-11)
        return np.where(lost[..., None], np.nan, found)

    def touch(self, rotation: Array, station: Array) -> Touch:
        """Contact at stations of the lines."""
        surface = self.flanks.wheel.at(self.parameters(rotation, station))
        return self.flanks.touch_at(surface)

    def room(self, rotation: Array, station: Array) -> Array:
        """Least room to an end of the active flank; minus infinity where there is no flank."""
        margin = np.min(self.flanks.margins(self.touch(rotation, station)), axis=-1)
        return np.where(np.isfinite(margin), margin, -np.inf)

    def span(self) -> tuple[float, float]:
        """Rotations of the wheel at which the active flank comes into touch and leaves it."""
        from scipy.optimize import minimize

        blank, mean = self.flanks.blank, self.flanks.blank.mean_cone_distance_wheel
        along = np.linspace(
            blank.inner_cone_distance_wheel - mean, blank.outer_cone_distance_wheel - mean, _GRID
        )
        (low, _), (high, _) = working_depth(blank, along)
        across = low[:, None] + np.linspace(0.0, 1.0, _GRID) * (high - low)[:, None]
        places = np.stack(np.broadcast_arrays(along[:, None], across), axis=-1)
        touch = self.flanks.touch(places)
        inside = np.all(self.flanks.margins(touch) >= 0.0, axis=-1) & np.isfinite(
            touch.contact.rotation
        )
        if not np.any(inside):
            raise ComputationError(
                "the flanks of this pair never touch on their teeth",
                why="No point of the wheel's flank meets the pinion between its tip and its ends",
                remedy="Check the depth and the face width of the blank",
            )
        ends = []
        for sense in (-1.0, 1.0):
            best = np.argmax(np.where(inside, sense * touch.contact.rotation, -np.inf))
            found = minimize(
                lambda x, sense=sense: -sense * float(self._at(x).contact.rotation[0]),
                1e3 * places[np.unravel_index(best, inside.shape)],
                constraints={
                    "type": "ineq",
                    "fun": lambda x: 1e3 * self.flanks.margins(self._at(x))[0],
                },
                method="SLSQP",
                options={"ftol": 1e-13},
            )
            ends.append(float(self._at(found.x).contact.rotation[0]))
        return ends[0], ends[1]

    def _at(self, place: Array) -> Touch:
        return self.flanks.touch(1e-3 * np.asarray(place)[None])

    def _room_at(self, place: Array) -> Array:
        return np.asarray(1e3 * self.flanks.margins(self._at(place))[0])

    def ends(self, rotation: Array) -> tuple[Array, Mask]:
        """First and last station (n, 2) of the lines on the active flank, and whether they are."""
        blank, mean = self.flanks.blank, self.flanks.blank.mean_cone_distance_wheel
        corners = []
        for end in (blank.inner_cone_distance_wheel, blank.outer_cone_distance_wheel):
            (low, _), (high, _) = working_depth(blank, np.array(end - mean))
            corners += [(end - mean, float(low)), (end - mean, float(high))]
        reach = np.array(corners) @ self.along
        spread = 0.1 * np.ptp(reach)
        station = np.linspace(reach.min() - spread, reach.max() + spread, _SAMPLES)
        room = self.room(rotation[:, None], station)
        inside = room > 0.0
        middle = np.argmax(room, axis=1)
        number = np.arange(_SAMPLES)
        before = np.where(~inside & (number <= middle[:, None]), number, -1).max(axis=1)
        after = np.where(~inside & (number >= middle[:, None]), number, _SAMPLES).min(axis=1)
        there = inside.any(axis=1) & (before >= 0) & (after < _SAMPLES)
        before, after = np.where(there, before, 0), np.where(there, after, 1)
        row = np.arange(len(rotation))
        found = [
            self._end(rotation, station[[out, held]], np.stack([room[row, out], room[row, held]]))
            for out, held in ((before, before + 1), (after, after - 1))
        ]
        return np.stack(found, axis=-1), there

    def _end(self, rotation: Array, station: Array, room: Array) -> Array:
        """Close in on the end between a station (2, n) outside of the flank and one inside."""
        (outside, inside), (lack, rest) = station, room
        for _ in range(_SEARCH):
            with np.errstate(invalid="ignore"):
                share = rest / (rest - lack)
            # Far from any flank there is no room to interpolate; halves keep both ends moving.
            share = np.where(np.isfinite(lack) & (share > 0.0), share, 0.5)
            middle = inside + np.clip(share, 0.01, 0.99) * (outside - inside)
            here = self.room(rotation, middle)
            held = here > 0.0
            # The end that stays counts half the next time (Illinois).
            rest, lack = np.where(held, here, 0.5 * rest), np.where(held, 0.5 * lack, here)
            outside, inside = np.where(held, outside, middle), np.where(held, middle, inside)
            if np.nanmax(np.minimum(np.abs(here), np.abs(outside - inside))) < 1e-13:
                break
        return np.asarray(inside)
