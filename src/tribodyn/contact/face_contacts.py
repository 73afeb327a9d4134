"""Lines of contact of helical gears, cut into slices of the face width."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.contact.path import PathOfContact
from tribodyn.errors import Argument, InputError
from tribodyn.types import Array, Index, Mask

#: Slices of the face width of a helical pair.
SLICES = 24
MOST_SLICES = 1001
#: Part of a slice below which it is not on the path of contact.
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class FaceContacts:
    """Slices of the lines of contact at some mesh phases; made by :func:`face_contacts`.

    Contacts are counted pair by pair, and within a pair by rising ``face_position``.

    Parameters
    ----------
    contact : PathOfContact
        Path of contact of the pair.
    phase : array (p,)
        Mesh phases, 0 where a pair enters at one end of the face.
    slices : int
        Slices of the face.
    path : array (p, c) [m]
        Distance from the pinion's base tangent point of the middle of that part of each slice
        which is on the path of contact; of the middle of the slice where none is.
    width : array (p, c) [m]
        Face width of that part, zero where there is none.

    Notes
    -----
    Pair ``j`` touches on ``s = (phase + j) p_bt - zeta tan(beta_b)``, with ``s`` from A along the
    path of contact and ``zeta`` from the end of the face that enters first: of a right-hand pinion
    the end at positive ``face_position``, of a left-hand one that at negative. Source: ISO 21771,
    lines of contact in the plane of action.
    """

    contact: PathOfContact
    phase: Array
    slices: int
    path: Array
    width: Array

    @cached_property
    def number(self) -> Index:
        """Mesh cycles between the entry of the pair of each contact and that of pair 0 (c,)."""
        return np.repeat(np.arange(self.path.shape[1] // self.slices), self.slices)

    @cached_property
    def slice(self) -> Index:
        """Slice of each contact (c,)."""
        return np.tile(np.arange(self.slices), self.path.shape[1] // self.slices)

    @cached_property
    def face_position(self) -> Array:
        """Middle of the slice of each contact, from the middle of the face (c,) [m]."""
        return face_positions(self.contact, self.slices)[self.slice]

    @cached_property
    def delay(self) -> Array:
        """Mesh cycles between the entry of a pair and that of each of its slices (s,)."""
        return entry_delay(self.contact, self.slices)

    @property
    def in_contact(self) -> Mask:
        """Which contacts are on the path of contact (p, c)."""
        return np.asarray(self.width > 0.0)


def face_positions(contact: PathOfContact, slices: int) -> Array:
    """Middles of equal slices of the common face, from its middle (s,) [m]."""
    return ((np.arange(slices) + 0.5) / slices - 0.5) * contact.pair.common_face_width


def entry_delay(contact: PathOfContact, slices: int) -> Array:
    """Mesh cycles between the entry of a pair and that of each of equal slices of the face (s,)."""
    pair = contact.pair
    distance = pair.entry_distance(face_positions(contact, slices))
    return np.asarray(distance * math.tan(pair.base_helix_angle) / pair.base_pitch)


def checked_slices(slices: int | None, default: int) -> int:
    """Return the number of slices of the face width, or refuse it."""
    count = default if slices is None else slices
    if not 1 <= count <= MOST_SLICES:
        why = f"The face width is cut into 1 to {MOST_SLICES} slices"
        remedy = f"Omit it: the default is {default}"
        raise InputError(f"slices = {count}", Argument("slices"), why, remedy)
    return count


def face_contacts(
    contact: PathOfContact, phase: Array, slices: int, side: Array | None = None
) -> FaceContacts:
    """Cut the lines of contact at mesh phases into slices of equal width.

    Parameters
    ----------
    contact : PathOfContact
        Path of contact of the pair.
    phase : array (p,)
        Mesh phases; only their fraction counts.
    slices : int
        Number of slices.
    side : array (p,), optional
        Given for the knots of a mesh cycle, whose last one, at phase 1, counts the pairs as those
        before it: mesh phases of the same segments between two events, at which pairs of spur
        gears, which enter and leave at once, are or are not in contact.

    Examples
    --------
    >>> from tribodyn.contact import path_of_contact
    >>> from tribodyn.gear import cylindrical_pair
    >>> pair = cylindrical_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=math.radians(20.0), helix_angle=math.radians(15.0),
    ...     pinion_face_width=50e-3)
    >>> contacts = face_contacts(path_of_contact(pair), np.array([0.3]), 40)
    >>> length = contacts.width.sum() / math.cos(pair.base_helix_angle)
    >>> math.isclose(length, pair.contact_line_length(0.3), rel_tol=1e-9)
    True
    """
    pair = contact.pair
    width = pair.common_face_width
    slope = math.tan(pair.base_helix_angle)
    zeta = pair.entry_distance(face_positions(contact, slices))
    turned = phase - np.floor(phase)
    if side is not None:
        turned = np.where(phase == 1.0, 1.0, turned)
    travel = (turned[:, None] + np.arange(contact.pairs)) * pair.base_pitch
    middle = travel[:, :, None] - zeta * slope
    half = 0.5 * slope * width / slices
    low, high = (np.clip(middle + end, 0.0, contact.length) for end in (-half, half))
    if half > 0.0:
        share = (high - low) / (2.0 * half)
        share[share < _ROUNDING] = 0.0
    else:
        in_contact = contact.pair_paths(phase if side is None else side)[1]
        share = np.broadcast_to(in_contact[:, :, None], middle.shape).astype(float)
    place = np.where(share > 0.0, 0.5 * (low + high), middle) if half > 0.0 else middle
    shape = phase.size, -1
    return FaceContacts(
        contact=contact,
        phase=phase,
        slices=slices,
        path=(contact.A + contact.direction * place).reshape(shape),
        width=(share * (width / slices)).reshape(shape),
    )
