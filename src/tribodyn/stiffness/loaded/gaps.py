"""Gaps of all tooth pairs without load: separation, modifications and deviations of the flanks."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import InputError, Problem
from tribodyn.gear import SpurPair, flank_gap, hunting_period, pitch_gap, run_out_gap
from tribodyn.stiffness.loaded.places import FAR, ContactPlaces

__all__ = ["mesh_period", "slice_gaps", "slice_widths"]

FloatArray = NDArray[np.float64]

#: Slices of a face width over which flanks vary; the middle one is in the middle of the face.
_SLICES = 21
_MOST_SLICES = 1001


def mesh_period(pair: SpurPair) -> int:
    """Mesh cycles after which everything repeats.

    Parameters
    ----------
    pair : SpurPair
        The pair with its deviations.

    Returns
    -------
    int
        One where all teeth are alike, else the hunting tooth period.
    """
    return hunting_period(pair) if pair.teeth_differ else 1


def slice_widths(pair: SpurPair, slices: int | None) -> FloatArray:
    """Widths of the slices of the common face.

    Parameters
    ----------
    pair : SpurPair
        The pair with its modifications.
    slices : int or None
        How many; by default one, or 21 where flanks vary over the face width.

    Returns
    -------
    array (s,) [m]

    Raises
    ------
    InputError
        If the number is out of range.
    """
    count = (_SLICES if pair.has_lead_modification else 1) if slices is None else slices
    if not 1 <= count <= _MOST_SLICES:
        raise InputError(
            Problem(
                what=f"slices = {count}",
                where="argument slices",
                why=f"The face width is cut into 1 to {_MOST_SLICES} slices",
                remedy="Leave it out: 21 are taken where flanks vary over the face width",
            )
        )
    return np.full(count, pair.common_face_width / count)


def slice_gaps(places: ContactPlaces, slices: int, *, teeth_alike: bool = False) -> FloatArray:
    """Gap of each pair in each slice, in the line-of-action measure.

    Parameters
    ----------
    places : ContactPlaces
        Where the pairs may touch; whole numbers in its phases count mesh cycles.
    slices : int
        Equal slices of the face width; a slice has the gap of its middle.
    teeth_alike : bool
        Leave out what differs from tooth to tooth, pitch deviations and run-out, so that every
        mesh cycle is the same.

    Returns
    -------
    array (p, s, n) [m]
        Least where the flanks touch first; negative where a flank stands proud.
    """
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
