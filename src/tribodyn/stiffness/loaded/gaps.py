"""Gaps of all tooth pairs without load: separation, modifications and deviations of the flanks."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.gear import SpurPair, flank_gap, hunting_period, pitch_gap, run_out_gap
from tribodyn.stiffness.loaded.places import FAR, ContactPlaces
from tribodyn.types import Array

#: Slices of a face width over which flanks vary; the middle one is in the middle of the face.
_SLICES = 21
_MOST_SLICES = 1001


def mesh_period(pair: SpurPair) -> int:
    """Mesh cycles after which everything repeats."""
    return hunting_period(pair) if pair.teeth_differ else 1


def slice_widths(pair: SpurPair, slices: int | None) -> Array:
    """Widths of the slices of the common face."""
    count = (_SLICES if pair.has_lead_modification else 1) if slices is None else slices
    if not 1 <= count <= _MOST_SLICES:
        raise InputError(
            Problem(
                what=f"slices = {count}",
                where=Argument("slices"),
                why=f"The face width is cut into 1 to {_MOST_SLICES} slices",
                remedy="Leave it out: 21 are taken where flanks vary over the face width",
            )
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
