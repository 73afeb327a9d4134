"""Path of contact: positions of tooth pairs on the line of action, and motion of their flanks.

Positions are called ``path``: the distance from the pinion's base tangent point, whichever gear
drives. With the pinion driving a contact moves to larger ``path``, with the wheel driving to
smaller ``path``. Nothing here assumes an order of the points A to E beyond the time order of A
and E: the pitch point may lie anywhere, and above a contact ratio of two D comes before B.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.gear import CylindricalPair
from tribodyn.types import Array, Mask


@dataclass(frozen=True)
class Kinematics:
    """Motion of the flanks at positions on the line of action; all arrays have one shape.

    Parameters
    ----------
    pinion_curvature_radius : array
        Radius of curvature of the pinion's flank [m].
    wheel_curvature_radius : array
        Radius of curvature of the wheel's flank [m]; negative for a ring. Both radii are those of
        the transverse section.
    equivalent_radius : array
        Radius of relative curvature in the normal section [m]: product over sum of the two radii,
        over the cosine of the base helix angle.
    pinion_surface_speed : array
        Speed of the contact point along the pinion's flank, omega_pinion rho_pinion [m/s].
    wheel_surface_speed : array
        The same of the wheel, omega_wheel rho_wheel [m/s].
    sliding_speed : array
        Pinion less wheel surface speed [m/s]; exactly zero at the pitch point.
    entrainment_speed : array
        Half the sum of the surface speeds [m/s].
    slide_to_roll_ratio : array
        Sliding speed over entrainment speed.
    sliding_direction : array
        Sign of the sliding speed: -1, 0 or 1.
    """

    pinion_curvature_radius: Array
    wheel_curvature_radius: Array
    equivalent_radius: Array
    pinion_surface_speed: Array
    wheel_surface_speed: Array
    sliding_speed: Array
    entrainment_speed: Array
    slide_to_roll_ratio: Array
    sliding_direction: Array


#: Distance over the base pitch, or difference of mesh phases, that counts as rounding.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class PathOfContact:
    """Path of contact of a cylindrical pair; made by :func:`path_of_contact`.

    Parameters
    ----------
    pair : CylindricalPair
        The pair in mesh.
    A : float
        ``path`` where a tooth pair enters contact [m].
    B : float
        ``path`` of a pair when the one before it leaves [m].
    C : float
        Pitch point [m]; it may lie anywhere, even outside of the path of contact.
    D : float
        ``path`` of a pair when the next one enters [m].
    E : float
        ``path`` where a tooth pair leaves contact [m].
    direction : int
        Sense in which contacts move: 1 when the pinion drives, -1 when the wheel drives.

    Notes
    -----
    Source: ISO 21771, path of contact and its points A to E.
    """

    pair: CylindricalPair
    A: float
    B: float
    C: float
    D: float
    E: float
    direction: int

    @cached_property
    def length(self) -> float:
        """Length of the path of contact [m]."""
        return abs(self.E - self.A)

    @cached_property
    def contact_ratio(self) -> float:
        """Transverse contact ratio."""
        return self.length / self.pair.base_pitch

    @cached_property
    def pairs(self) -> int:
        """Largest number of tooth pairs in contact at a time, anywhere on the face."""
        return math.ceil(self.contact_ratio + self.pair.overlap_ratio - _ROUNDING)

    @cached_property
    def roll_angles(self) -> dict[str, float]:
        """Roll angles of the driving gear at A to E [rad]."""
        length, base = self.pair.line_of_action_length, self.pair.driving.base_radius
        return {
            name: (path if self.direction > 0 else length - path) / base
            for name, path in zip("ABCDE", (self.A, self.B, self.C, self.D, self.E), strict=True)
        }

    def event_phases(self) -> tuple[float, ...]:
        """Mesh phases at which the tooth contact changes abruptly.

        Returns
        -------
        tuple of float
            Sorted phases in [0, 1): 0 where a pair enters, the fraction of the contact ratio where
            a pair leaves, and where a pair passes the pitch point. The line of a helical pair
            enters until the overlap ratio and leaves from the transverse to the total contact
            ratio, which are the kinks of the total length; it passes the pitch point gradually.
            Phases closer than 1e-12 are one.

        Examples
        --------
        >>> from tribodyn.gear import spur_pair
        >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
        ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
        >>> [round(phase, 4) for phase in path_of_contact(pair).event_phases()]
        [0.0, 0.6052, 0.8268]
        """
        ratio, overlap = self.contact_ratio, self.pair.overlap_ratio
        pitch_point = pitch_point_age(self)
        events = [0.0, overlap % 1.0, ratio % 1.0, (ratio + overlap) % 1.0]
        if overlap == 0.0 and 0.0 <= pitch_point < ratio:
            events.append(pitch_point % 1.0)
        phases = [0.0]
        for phase in sorted(events):
            if phase - phases[-1] > _ROUNDING and 1.0 - phase > _ROUNDING:
                phases.append(phase)
        return tuple(phases)

    def pair_paths(self, phase: ArrayLike, side: str = "right") -> tuple[Array, Mask]:
        """Positions of all tooth pairs at mesh phases, at the end of the face that enters first.

        Parameters
        ----------
        phase : array
            Mesh phase, shape (n,); zero when a pair enters at A. Only its fraction counts.
        side : str
            Which limit is meant at an event: ``"right"`` (after it; the phase is brought to
            [0, 1), a pair is in contact from A on and no more at E) or ``"left"`` (before it; the
            phase is brought to (0, 1], a pair is not yet in contact at A and still at E).

        Returns
        -------
        tuple of array
            ``path`` of each pair [m] and whether it is in contact, both of shape (n, pairs). Pair
            i entered i mesh cycles before the youngest. Positions of pairs out of contact lie
            beyond E.

        Raises
        ------
        InputError
            If a phase is not finite or the side is unknown.
        """
        path, in_contact = self.face_paths(phase, 0.0, side)
        return path[..., 0], in_contact[..., 0]

    def face_paths(
        self, phase: ArrayLike, entry_distance: ArrayLike, side: str = "right"
    ) -> tuple[Array, Mask]:
        """Positions of all tooth pairs at mesh phases and places on the face.

        Parameters
        ----------
        phase : array
            Mesh phase, shape (n,), as for :meth:`pair_paths`.
        entry_distance : float or array
            Distances across the face from the end that enters contact first [m], shape (slices,):
            see :meth:`tribodyn.gear.CylindricalPair.entry_distance`.
        side : str
            Which limit is meant at an event, as for :meth:`pair_paths`.

        Returns
        -------
        tuple of array
            ``path`` of each pair in each slice [m] and whether it is in contact, both of shape
            (n, pairs, slices). A line of contact lies at
            ``(phase + pair) base pitch - entry distance * tan(base helix angle)`` from A; where
            it has not entered yet it lies before A.

        Raises
        ------
        InputError
            If a phase or a distance is not finite, or the side is unknown.

        Notes
        -----
        Source: ISO 21771, lines of contact in the plane of action.

        Examples
        --------
        >>> from tribodyn.gear import cylindrical_pair
        >>> pair = cylindrical_pair(pinion_teeth=27, wheel_teeth=51, normal_module=4.5e-3,
        ...                         normal_pressure_angle=math.radians(20.0),
        ...                         helix_angle=math.radians(21.0), pinion_face_width=50e-3)
        >>> path, in_contact = path_of_contact(pair).face_paths(0.5, [0.0, 25e-3, 50e-3])
        >>> in_contact[0].tolist()
        [[True, False, False], [True, True, True], [False, False, True]]
        """
        require_between("phase", phase, -math.inf, math.inf)
        require_between("entry_distance", entry_distance, -math.inf, math.inf, "m")
        turned = np.atleast_1d(np.asarray(phase, dtype=float))
        if side == "right":
            turned = turned - np.floor(turned)
        elif side == "left":
            turned = turned - np.ceil(turned) + 1.0
        else:
            why = 'an event has two sides: "left" and "right"'
            raise InputError(f'side = "{side}"', Argument("side"), why, 'Write "left" or "right"')
        place = np.atleast_1d(np.asarray(entry_distance, dtype=float))
        lag = place * (math.tan(self.pair.base_helix_angle) / self.pair.base_pitch)
        rounding = _ROUNDING if side == "left" else -_ROUNDING
        travelled = (turned[:, None] + np.arange(self.pairs))[..., None] - lag
        in_contact = (travelled < self.contact_ratio + rounding) & (
            (travelled > rounding) | (lag == 0.0)
        )
        return self.A + self.direction * travelled * self.pair.base_pitch, in_contact

    def sliding_direction(self, path: ArrayLike, side: str | None = None) -> Array:
        """Sign of the sliding speed, one-sided at the pitch point if wanted.

        Parameters
        ----------
        path : float or array
            Positions on the line of action [m], any shape.
        side : str, optional
            At the pitch point: ``"left"`` gives the sign just before a contact passes it,
            ``"right"`` just after, nothing gives zero.

        Returns
        -------
        array
            -1, 0 or 1, same shape: sign of the pinion's less the wheel's surface speed.

        Raises
        ------
        InputError
            If the side is unknown.
        """
        offset = np.asarray(path, dtype=float) - self.C
        sides = {None: 0.0, "left": -1.0, "right": 1.0}
        if side not in sides:
            what, why = f'side = "{side}"', 'the pitch point has two sides: "left" and "right"'
            raise InputError(what, Argument("side"), why, 'Write "left", "right" or leave it out')
        at_pitch_point = np.abs(offset) <= _ROUNDING * self.pair.base_pitch
        return np.where(at_pitch_point, self.direction * sides[side], np.sign(offset))

    def kinematics(self, path: ArrayLike, pinion_speed: ArrayLike) -> Kinematics:
        """Curvatures and speeds of the flanks.

        Parameters
        ----------
        path : float or array
            Positions on the line of action [m], any shape. Beyond the base tangent points there is
            no contact and the radii of curvature are negative: pass contacts only.
        pinion_speed : float
            Angular speed of the pinion in its running sense [rad/s], positive whichever drives;
            broadcast against ``path``.

        Returns
        -------
        Kinematics
            Arrays of the broadcast shape.

        Raises
        ------
        InputError
            If the speed is not positive or a position is not finite.

        Notes
        -----
        u_i = omega_i rho_i, where speed and radius of a ring are negative. The sliding speed is
        (omega_pinion + omega_wheel) (path - C), the same difference without cancellation. Source:
        ISO 21771, sliding speed.
        """
        require_between("path", path, -math.inf, math.inf, "m")
        require_positive("pinion_speed", pinion_speed, "rad/s")
        pinion_radius, speed = np.broadcast_arrays(
            np.asarray(path, dtype=float), np.asarray(pinion_speed, dtype=float)
        )
        length = self.pair.line_of_action_length
        wheel_radius, wheel_speed = length - pinion_radius, speed / self.pair.ratio
        direction = self.sliding_direction(pinion_radius)
        cosine = math.cos(self.pair.base_helix_angle)
        distance = np.abs(pinion_radius - self.C)
        sliding = direction * distance * (speed + wheel_speed)
        entrainment = 0.5 * (speed * pinion_radius + wheel_speed * wheel_radius)
        return Kinematics(
            pinion_curvature_radius=pinion_radius,
            wheel_curvature_radius=wheel_radius,
            equivalent_radius=pinion_radius * wheel_radius / (length * cosine),
            pinion_surface_speed=speed * pinion_radius,
            wheel_surface_speed=wheel_speed * wheel_radius,
            sliding_speed=sliding,
            entrainment_speed=entrainment,
            slide_to_roll_ratio=sliding / entrainment,
            sliding_direction=direction,
        )


def path_of_contact(pair: CylindricalPair) -> PathOfContact:
    """Find the path of contact of a cylindrical pair.

    Parameters
    ----------
    pair : CylindricalPair
        The pair; its driver decides which end of the path is A.

    Notes
    -----
    Source: ISO 21771. A is where the driven gear's tip meets the line of action, E where the
    driving gear's tip leaves it.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> contact = path_of_contact(pair)
    >>> round(contact.roll_angles["C"], 6) == round(math.tan(math.radians(20.0)), 6)
    True
    """
    low, high = pair.path_limits
    direction = 1 if pair.driver == "pinion" else -1
    start, end = (low, high) if direction > 0 else (high, low)
    step = direction * pair.base_pitch
    return PathOfContact(
        pair=pair,
        A=start,
        B=end - step,
        C=pair.line_of_action_length / (1.0 + pair.ratio),
        D=start + step,
        E=end,
        direction=direction,
    )


def pitch_point_age(contact: PathOfContact) -> float:
    """Mesh cycles from where a tooth pair enters to the pitch point, wherever that lies."""
    return contact.direction * (contact.C - contact.A) / contact.pair.base_pitch
