"""Where tooth pairs may touch at a mesh phase: on the path of contact and a little beyond it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.contact import PathOfContact, extended_contact, path_of_contact
from tribodyn.gear import SpurPair

__all__ = ["FAR", "ContactPlaces", "contact_places", "extended_places", "on_path_places"]

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Separation of flanks that cannot meet [m].
FAR = 1.0


@dataclass(frozen=True, eq=False)
class ContactPlaces:
    """Places of all tooth pairs that may touch; made by :func:`contact_places`.

    Parameters
    ----------
    contact : PathOfContact
        Path of contact of the pair.
    phase : array (p,)
        Mesh phase; zero where a pair reaches A.
    number : array (n,) of int
        Mesh cycles between the entry of each pair and that of pair 0.
    path : array (p, n) [m]
        Distance from the pinion's base tangent point along the line of action.
    separation : array (p, n) [m]
        Approach along the line of action that closes the gap of the true flanks: zero from A to
        E, :data:`FAR` where they cannot meet.
    pinion_curvature_radius, wheel_curvature_radius : array (p, n) [m]
        Where each gear is touched; at the tip beyond the ends of the path.
    """

    contact: PathOfContact
    phase: FloatArray
    number: NDArray[np.int64]
    path: FloatArray
    separation: FloatArray
    pinion_curvature_radius: FloatArray
    wheel_curvature_radius: FloatArray

    @property
    def possible(self) -> BoolArray:
        """Which pairs may touch (p, n)."""
        return np.asarray(self.separation < FAR)

    @property
    def on_path(self) -> BoolArray:
        """Which pairs are between A and E, where involutes roll on each other (p, n)."""
        return np.asarray(self.separation == 0.0)

    @property
    def direction(self) -> int:
        """Sense in which contacts move along the path: 1 when the pinion drives, -1 otherwise."""
        return self.contact.direction


def contact_places(
    pair: SpurPair, phase: ArrayLike, *, extended: bool = True, side: str = "right"
) -> ContactPlaces:
    """Find where tooth pairs may touch.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position.
    phase : array (p,)
        Mesh phases; only their fractions count.
    extended : bool
        With the contact of tip corners before A and after E.
    side : str
        Which limit is meant on an event where nothing is extended, as in
        :meth:`tribodyn.contact.PathOfContact.pair_paths`.

    Returns
    -------
    ContactPlaces
        With ``extended`` a pair more on each side.

    Raises
    ------
    InputError
        If a phase is not finite or the side unknown.

    Notes
    -----
    Source: :func:`tribodyn.contact.extended_contact`.
    """
    contact = path_of_contact(pair)
    path, touching = contact.pair_paths(phase, side)
    turned = np.atleast_1d(np.asarray(phase, dtype=float))
    if not extended:
        return on_path_places(contact, turned, path, touching)
    return extended_places(contact, turned, path)


def extended_places(contact: PathOfContact, phase: FloatArray, path: FloatArray) -> ContactPlaces:
    """Places of given pairs and of one more on each side, all of which may touch at a tip corner.

    Parameters
    ----------
    contact : PathOfContact
        Path of contact of the pair.
    phase : array (p,)
        Mesh phase.
    path : array (p, n) [m]
        Distance from the pinion's base tangent point of the pairs between A and E, and more.

    Returns
    -------
    ContactPlaces
        Of ``n + 2`` pairs.
    """
    step = contact.direction * contact.pair.base_pitch
    path = np.concatenate([path[:, :1] - step, path, path[:, -1:] + step], axis=1)
    beyond = extended_contact(contact.pair, path)
    touched = beyond.pinion_curvature_radius, beyond.wheel_curvature_radius
    return ContactPlaces(
        contact=contact,
        phase=phase,
        number=np.arange(-1, path.shape[1] - 1),
        path=path,
        separation=np.where(beyond.possible, beyond.separation, FAR),
        **_radii(contact, *touched, beyond.possible),
    )


def on_path_places(
    contact: PathOfContact, phase: FloatArray, path: FloatArray, touching: BoolArray
) -> ContactPlaces:
    """Places of pairs that are known to be between A and E, or apart.

    Parameters
    ----------
    contact : PathOfContact
        Path of contact of the pair.
    phase : array (p,)
        Mesh phase.
    path : array (p, n) [m]
        Distance from the pinion's base tangent point.
    touching : bool array (p, n)
        Whether the pair is between A and E.

    Returns
    -------
    ContactPlaces
    """
    length = contact.pair.line_of_action_length
    return ContactPlaces(
        contact=contact,
        phase=phase,
        number=np.arange(path.shape[1]),
        path=path,
        separation=np.where(touching, 0.0, FAR),
        **_radii(contact, path, length - path, touching),
    )


def _radii(
    contact: PathOfContact,
    pinion: FloatArray,
    wheel: FloatArray,
    possible: BoolArray,
) -> dict[str, FloatArray]:
    """Radii of curvature, with those of the pitch point where flanks cannot meet."""
    limits = sorted((contact.A, contact.E))
    middle = 0.5 * sum(limits)
    length = contact.pair.line_of_action_length
    return {
        "pinion_curvature_radius": np.where(possible, pinion, middle),
        "wheel_curvature_radius": np.where(possible, wheel, length - middle),
    }
