"""Damage of one tooth: a spall of its flank, a piece that has broken off, a crack at its root."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.errors import Argument, InputError, require_between
from tribodyn.faults.cracked_tooth import SQUARE, CrackLine, crack_compliance
from tribodyn.faults.fault import ToothFault
from tribodyn.gear import Material, SpurPair
from tribodyn.stiffness.loaded.problem import FAR, ContactPlaces
from tribodyn.types import Array


@dataclass(frozen=True, kw_only=True)
class Spall(ToothFault):
    """Flank material that is missing on a part of one tooth.

    Parameters
    ----------
    gear, tooth
        Gear, and number of its tooth in the order of contact, from 1.
    depth : float
        Depth [m]; deeper than the deflection of the teeth, nothing touches in the spall.
    start, end : float
        Part of the used flank, 0 at its lowest point and 1 at the tip [1].
    face_share : float
        Part of the face width, in its middle [1].

    Raises
    ------
    InputError
        If a value is out of range or the spall has no length.

    Examples
    --------
    >>> Spall(tooth=3, depth=50e-6, start=0.4, end=0.6, face_share=0.5).face_share
    0.5
    """

    depth: float
    start: float
    end: float
    face_share: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        require_between("depth", self.depth, 0.0, 0.01, "m")
        for name in ("start", "end", "face_share"):
            require_between(name, getattr(self, name), 0.0, 1.0, "")
        if self.end < self.start:
            what, why = (
                f"end = {self.end:g}, start = {self.start:g}",
                "A spall ends above its start",
            )
            raise InputError(what, "end", why, "Count from the lowest point of the flank")

    @property
    def _varies_over_face(self) -> bool:  # type: ignore[override]
        """Whether it is narrower than the face."""
        return 0.0 < self.face_share < 1.0

    def _gap(self, places: ContactPlaces, face: Array) -> Array:
        """Gap (p, s, n)."""
        share = self._flank_share(places)
        inside = self._has_tooth(places) & (share > self.start) & (share < self.end)
        half = 0.5 * self.face_share * places.contact.pair.common_face_width
        across = np.abs(face) < half
        return np.asarray(self.depth * (inside[:, None, :] & across))


@dataclass(frozen=True, kw_only=True)
class BrokenTooth(ToothFault):
    """A tooth whose upper part has broken off over the whole face.

    Parameters
    ----------
    gear, tooth
        Gear, and number of its tooth in the order of contact, from 1.
    remaining : float
        Part of the used flank that is left, from its lowest point; 0 if all of it is gone [1].

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> BrokenTooth(gear="wheel", tooth=5, remaining=0.3).remaining
    0.3
    """

    remaining: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        require_between("remaining", self.remaining, 0.0, 1.0, "")

    def _gap(self, places: ContactPlaces, face: Array) -> Array:
        """Gap (p, 1, n)."""
        missing = self._has_tooth(places)
        if self.remaining:
            missing = missing & (self._flank_share(places) > self.remaining)
        return np.asarray(FAR * missing[:, None, :])


@dataclass(frozen=True, kw_only=True)
class Crack(ToothFault):
    """A crack at the root of the loaded flank of one tooth.

    Parameters
    ----------
    gear, tooth
        Gear, and number of its tooth in the order of contact, from 1.
    depth : float
        Length of the crack from the surface into the tooth [m].
    angle : float
        Angle of the crack to the centre line of the tooth [rad], from pi/4, into the body, to pi/2,
        square to the tooth.
    root_tangent : float, optional
        Angle of the tangent of the fillet to the centre line where the crack begins [rad].
    face_share : float
        Part of the face width that is cracked [1].

    Raises
    ------
    InputError
        If a value is out of range, or, where a mesh is built, the crack crosses most of the tooth.

    Notes
    -----
    By default the crack begins at the lower end of the root fillet. It is open under load. Of a
    crack on a part of the face, cracked and sound parts carry in parallel.

    Examples
    --------
    >>> Crack(tooth=1, depth=1e-3).face_share
    1.0
    """

    depth: float
    angle: float = SQUARE
    root_tangent: float | None = None
    face_share: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        require_between("depth", self.depth, 0.0, 1.0, "m")
        require_between("face_share", self.face_share, 0.0, 1.0, "")

    def _check(self, pair: SpurPair) -> None:
        """Raise InputError if there is no such tooth, or the gear is a ring or helical."""
        super()._check(pair)
        if pair.helix_angle:
            why = "The compliance of a cracked tooth is that of a plane section of spur teeth"
            remedy = "Give helix_angle = 0, or a spall or a broken tooth"
            raise InputError("the cracked tooth is helical", Argument("kind"), why, remedy)
        if self._gear_of(pair).is_ring:
            why = "The crack runs through a tooth of an external gear"
            raise InputError("the cracked gear is a ring", "gear", why, "Crack the other gear")
        CrackLine(self.depth, self.angle, self.root_tangent).check(self._gear_of(pair))

    def _compliance(self, places: ContactPlaces, material: Material, sound: Array) -> Array:
        """Compliance that the crack adds where its tooth carries (p, n)."""
        if self.depth == 0.0 or self.face_share == 0.0:
            return np.zeros(places.path.shape)
        gear, start = self._gear_of(places.contact.pair), self.root_tangent
        radius, added = crack_compliance(
            gear, material, self.depth, angle=self.angle, root_tangent=start
        )
        cracked = sound + np.interp(self._radius_of(places), radius, added)
        combined = 1.0 / (self.face_share / cracked + (1.0 - self.face_share) / sound)
        return np.asarray(np.where(self._has_tooth(places), combined - sound, 0.0))
