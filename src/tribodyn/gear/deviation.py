"""Deviations of the places of the teeth: pitch of each tooth, run-out, and when they recur."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.gear.spur_gear import SpurGear
from tribodyn.gear.spur_pair import SpurPair
from tribodyn.types import Array


def hunting_period(pair: SpurPair) -> int:
    """Mesh cycles until the same two teeth meet again.

    Parameters
    ----------
    pair : SpurPair
        The pair.

    Returns
    -------
    int
        Least common multiple of the numbers of teeth.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> hunting_period(pair)
    60
    """
    return math.lcm(pair.pinion.teeth, pair.wheel.teeth)


def tooth_positions(gear: SpurGear) -> Array:
    """By how much the loaded flank of each tooth stands further on than evenly spaced teeth.

    Parameters
    ----------
    gear : SpurGear
        Gear with its deviations.

    Returns
    -------
    array [m]
        One value for each tooth in the order in which the teeth come into contact: the cumulative
        deviation, or the sum of the single ones from tooth 0 on, which then has zero.

    Notes
    -----
    Source: ISO 1328-1, single and cumulative (index) pitch deviation.

    Examples
    --------
    >>> from tribodyn.gear import FlankModification
    >>> pitches = FlankModification(single_pitch_deviation=(-6e-6, 2e-6, 2e-6, 2e-6, 0.0))
    >>> gear = SpurGear(teeth=5, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                 profile_shift_coefficient=0.8, tip_diameter=16e-3, face_width=10e-3,
    ...                 modification=pitches)
    >>> [round(float(place) * 1e6, 6) for place in tooth_positions(gear)]
    [0.0, 2.0, 4.0, 6.0, 6.0]
    """
    given = gear.modification
    if given.cumulative_pitch_deviation:
        return np.array(given.cumulative_pitch_deviation)
    if given.single_pitch_deviation:
        single = np.array(given.single_pitch_deviation)
        places = np.cumsum(single - single.mean())
        return np.asarray(places - places[0])
    return np.zeros(gear.teeth)


def pitch_gap(pair: SpurPair, cycle: ArrayLike, pair_index: ArrayLike = 0) -> Array:
    """Gap of a tooth pair that the pitch deviations of its two teeth leave.

    Parameters
    ----------
    pair : SpurPair
        The pair with the deviations of its gears.
    cycle : int or array
        Mesh cycle [cycles], whole, any sign: the number of the pair that enters at its beginning.
        The teeth 0 of both gears meet in cycle 0.
    pair_index : int or array
        How many mesh cycles before the youngest pair this one entered; zero is the youngest, as
        in :meth:`tribodyn.contact.PathOfContact.pair_paths`.

    Returns
    -------
    array [m]
        The broadcast shape; positive where the flanks stand apart, negative where they come into
        touch too early.

    Notes
    -----
    A flank that stands further on in the order of contact comes later. The driving flank lies on
    the front of its tooth, so that the pair then has a gap; the driven flank lies on the back, and
    the pair touches early: gap = driving - driven. Equal deviations of both gears cancel.

    Examples
    --------
    >>> from tribodyn.gear import FlankModification, spur_pair
    >>> late = FlankModification(cumulative_pitch_deviation=(5e-6,) + (0.0,) * 19)
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3,
    ...                  pinion_modification=late)
    >>> [round(float(gap) * 1e6, 6) for gap in pitch_gap(pair, [0, 1, 1, 20], [0, 0, 1, 0])]
    [5.0, 0.0, 5.0, 5.0]
    """
    number = np.asarray(cycle, dtype=np.int64) - np.asarray(pair_index, dtype=np.int64)
    driving, driven = (
        tooth_positions(gear)[number % gear.teeth] for gear in (pair.driving, pair.driven)
    )
    return np.asarray(driving - driven)


def run_out_gap(pair: SpurPair, pinion_rotation: ArrayLike) -> Array:
    """Gap, common to all tooth pairs, that the eccentricity of both gears leaves.

    Parameters
    ----------
    pair : SpurPair
        The pair with the run-out of its gears.
    pinion_rotation : float or array [rad]
        Rotation of the pinion in its running sense since the teeth 0 of both gears came into
        contact at A.

    Returns
    -------
    array [m]
        Shape of ``pinion_rotation``; negative where the flanks come into touch too early.

    Notes
    -----
    The axis of the toothing lies F_r / 2 off the axis of rotation; its share along the line of
    action is -(F_r / 2) cos(rotation - phase), with the phase at which the flanks stand most
    proud. Source: ISO 1328-2, run-out and its relation to eccentricity.

    Examples
    --------
    >>> from tribodyn.gear import FlankModification, spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3,
    ...                  wheel_modification=FlankModification(run_out=20e-6))
    >>> [round(float(gap) * 1e6, 6) for gap in run_out_gap(pair, [0.0, 1.5 * math.pi])]
    [-10.0, 10.0]
    """
    turned = np.asarray(pinion_rotation, dtype=float)
    gap = np.zeros(turned.shape)
    for gear in (pair.pinion, pair.wheel):
        given = gear.modification
        angle = turned * (pair.pinion.teeth / gear.teeth) - given.run_out_phase
        gap = gap - 0.5 * given.run_out * np.cos(angle)
    return gap
