"""Where tooth pairs may touch at a mesh phase, and how far their flanks are apart there."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact import PathOfContact, extended_contact, path_of_contact
from tribodyn.errors import Argument, InputError
from tribodyn.gear import SpurPair, flank_gap, pitch_gap, run_out_gap
from tribodyn.types import Array, Index, Mask

#: Separation of flanks that cannot meet [m].
FAR = 1.0


@dataclass(frozen=True, eq=False)
class ContactPlaces:
    """Places of all tooth pairs that may touch; made by :func:`contact_places`."""

    contact: PathOfContact  #: path of contact of the pair
    phase: Array  #: mesh phase
    number: Index  #: mesh cycles between the entry of each pair and that of pair 0
    path: Array  #: distance from the pinion's base tangent point along the line of action [m]
    separation: Array  #: [m]
    pinion_curvature_radius: Array  #: [m]
    wheel_curvature_radius: Array  #: [m]

    @property
    def possible(self) -> Mask:
        """Which pairs may touch (p, n)."""
        return np.asarray(self.separation < FAR)

    @property
    def on_path(self) -> Mask:
        """Which pairs are between A and E, where involutes roll on each other (p, n)."""
        return np.asarray(self.separation == 0.0)

    @property
    def direction(self) -> int:
        """Sense in which contacts move along the path: 1 when the pinion drives, -1 otherwise."""
        return self.contact.direction


def contact_places(
    pair: SpurPair, phase: ArrayLike, *, extended: bool = True, side: str = "right"
) -> ContactPlaces:
    """Find where tooth pairs may touch."""
    contact = path_of_contact(pair)
    path, touching = contact.pair_paths(phase, side)
    turned = np.atleast_1d(np.asarray(phase, dtype=float))
    if not extended:
        return on_path_places(contact, turned, path, touching)
    return extended_places(contact, turned, path)


def extended_places(contact: PathOfContact, phase: Array, path: Array) -> ContactPlaces:
    """Places of given pairs and one more on each side, which may touch at a tip corner."""
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
    contact: PathOfContact, phase: Array, path: Array, touching: Mask
) -> ContactPlaces:
    """Places of pairs that are known to be between A and E, or apart."""
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
    pinion: Array,
    wheel: Array,
    possible: Mask,
) -> dict[str, Array]:
    """Radii of curvature, with those of the pitch point where flanks cannot meet."""
    limits = sorted((contact.A, contact.E))
    middle = 0.5 * sum(limits)
    length = contact.pair.line_of_action_length
    return {
        "pinion_curvature_radius": np.where(possible, pinion, middle),
        "wheel_curvature_radius": np.where(possible, wheel, length - middle),
    }


#: Slices of a face width over which flanks vary; the middle one is in the middle of the face.
_SLICES = 21
_MOST_SLICES = 1001


def mesh_period(pair: SpurPair) -> int:
    """Mesh cycles after which everything repeats: turns of the gears whose teeth differ."""
    differ = [gear for gear in (pair.pinion, pair.wheel) if gear.modification.teeth_differ]
    return math.lcm(*(gear.teeth for gear in differ))


def slice_widths(pair: SpurPair, slices: int | None) -> Array:
    """Widths of the slices of the common face."""
    count = (_SLICES if pair.has_lead_modification else 1) if slices is None else slices
    if not 1 <= count <= _MOST_SLICES:
        raise InputError(
            f"slices = {count}",
            where=Argument("slices"),
            why=f"The face width is cut into 1 to {_MOST_SLICES} slices",
            remedy="Leave it out: 21 are taken where flanks vary over the face width",
        )
    return np.full(count, pair.common_face_width / count)


def slice_gaps(places: ContactPlaces, slices: int, *, teeth_alike: bool = False) -> Array:
    """Gap of each pair in each slice, in the line-of-action measure."""
    pair = places.contact.pair
    middles = ((np.arange(slices) + 0.5) / slices - 0.5) * pair.common_face_width
    gaps = np.repeat(places.separation[:, None, :], slices, axis=1)
    if not pair.has_modification:
        return gaps
    flank = flank_gap(
        pair,
        places.pinion_curvature_radius[:, None, :],
        places.wheel_curvature_radius[:, None, :],
        middles[:, None],
    )
    gaps = gaps + flank
    if not teeth_alike and pair.teeth_differ:
        cycle = np.floor(places.phase).astype(int)
        turned = 2.0 * math.pi * places.phase / pair.pinion.teeth
        gaps = gaps + pitch_gap(pair, cycle[:, None], places.number)[:, None, :]
        gaps = gaps + run_out_gap(pair, turned)[:, None, None]
    return np.where(places.possible[:, None, :], gaps, FAR)
