"""Gap between modified flanks where unmodified ones would touch."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_positive
from tribodyn.gear.cylindrical_gear import SpurGear
from tribodyn.gear.cylindrical_pair import SpurPair
from tribodyn.gear.mesh_geometry import FlankRange, default_relief_length, flank_ranges
from tribodyn.gear.modification import FlankModification
from tribodyn.nomenclature import require_one_shape
from tribodyn.types import Array

#: Length of an end relief over the face width, unless it is given.
END_RELIEF_LENGTH = 0.1
#: Places along the path of contact and along the face at which the least gap is searched.
_GRID = 65


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
    """Position errors of the loaded flanks of a gear: distance ahead of even spacing.

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
    modification = gear.modification
    if modification.cumulative_pitch_deviation:
        return np.array(modification.cumulative_pitch_deviation)
    if modification.single_pitch_deviation:
        single = np.array(modification.single_pitch_deviation)
        places = np.cumsum(single - single.mean())
        return np.asarray(places - places[0])
    return np.zeros(abs(gear.teeth))


def pitch_gap(pair: SpurPair, cycle: ArrayLike, pair_index: ArrayLike = 0) -> Array:
    """Gap of a tooth pair from the pitch deviations of its two teeth.

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
    A flank that is ahead in the order of contact touches later. The driving flank lies on
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
        tooth_positions(gear)[number % abs(gear.teeth)] for gear in (pair.driving, pair.driven)
    )
    return np.asarray(driving - driven)


def run_out_gap(pair: SpurPair, pinion_rotation: ArrayLike) -> Array:
    """Gap, common to all tooth pairs, from the eccentricity of both gears.

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
        modification = gear.modification
        angle = turned * (pair.pinion.teeth / abs(gear.teeth)) - modification.run_out_phase
        gap = gap - 0.5 * modification.run_out * np.cos(angle)
    return gap


def _relief(distance: Array, amount: float, length: float, shape: str) -> Array:
    """Relief at a distance from the end of the flank; constant beyond the end."""
    left = np.clip(1.0 - distance / length, 0.0, 1.0)
    return amount * (left if shape == "linear" else left**2)


def _worn(modification: FlankModification, place: Array) -> Array:
    depth = np.atleast_1d(np.asarray(modification.wear_depth, dtype=float))
    if depth.size == 0:
        return np.zeros(place.shape)
    return np.asarray(np.interp(place, np.linspace(0.0, 1.0, depth.size), depth))


def profile_gap(
    gear: SpurGear, curvature_radius: ArrayLike, flank: FlankRange, relief_length: float
) -> Array:
    """Material removed along the profile of a flank: reliefs, crowning, slope and wear.

    Parameters
    ----------
    gear : SpurGear
        Gear with its modification.
    curvature_radius : float or array [m]
        Radius of curvature of the flank at the contact, negative for a ring. Off the used flank
        the value at its end holds.
    flank : FlankRange
        Used flank of the gear.
    relief_length : float [m]
        Length of a relief whose own length is not stated.

    Returns
    -------
    array [m]
        Shape of ``curvature_radius``; positive where material is missing. Tip and root relief add
        where they overlap.

    Raises
    ------
    InputError
        If the length is not positive.

    Notes
    -----
    With the distance d from the end of the used flank a relief of amount C and length L is
    C (1 - d/L), or C (1 - d/L)^2 if it is parabolic. Profile crowning is C (2x - 1)^2 and profile
    slope C x, with x from zero at the lowest point to one at the tip. Source: ISO 21771.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import FlankModification
    >>> gear = SpurGear(teeth=20, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                 profile_shift_coefficient=0.0, tip_diameter=44e-3, face_width=10e-3,
    ...                 modification=FlankModification(tip_relief=10e-6))
    >>> gap = profile_gap(gear, [5e-3, 9e-3, 10e-3], FlankRange(4e-3, 10e-3), 2e-3)
    >>> [round(float(value) * 1e6, 6) for value in gap]
    [0.0, 5.0, 10.0]
    """
    require_positive("relief_length", relief_length, "m")
    modification = gear.modification
    radius = np.clip(np.asarray(curvature_radius, dtype=float), *flank)
    place = (radius - flank.lowest) / flank.length
    tip, root = (
        relief_length if length is None else length
        for length in (modification.tip_relief_length, modification.root_relief_length)
    )
    gap = _relief(
        flank.highest - radius, modification.tip_relief, tip, modification.tip_relief_shape
    )
    gap = gap + _relief(
        radius - flank.lowest, modification.root_relief, root, modification.root_relief_shape
    )
    gap = (
        gap
        + modification.profile_crowning * (2.0 * place - 1.0) ** 2
        + modification.profile_slope * place
    )
    return np.asarray(gap + _worn(modification, place))


def lead_gap(gear: SpurGear, face_position: ArrayLike) -> Array:
    """Material removed along the face width of a flank: crowning, slope and end relief.

    Parameters
    ----------
    gear : SpurGear
        Gear with its modification.
    face_position : float or array [m]
        Place along the face from its middle.

    Returns
    -------
    array [m]
        Shape of ``face_position``; positive where material is missing.

    Notes
    -----
    Crowning is C (2y/b)^2 and lead slope C y/b with the face width b of the gear; an end relief
    of amount C and length L is C (1 - d/L) at the distance d from an end, or C (1 - d/L)^2.
    Source: ISO 21771.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import FlankModification
    >>> gear = SpurGear(teeth=20, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                 profile_shift_coefficient=0.0, tip_diameter=44e-3, face_width=10e-3,
    ...                 modification=FlankModification(crowning=8e-6))
    >>> [round(float(value) * 1e6, 6) for value in lead_gap(gear, [-5e-3, 0.0, 2.5e-3])]
    [8.0, 0.0, 2.0]
    """
    modification = gear.modification
    place = np.asarray(face_position, dtype=float) / gear.face_width
    length = modification.end_relief_length
    end = _relief(
        (0.5 - np.abs(place)) * gear.face_width,
        modification.end_relief,
        END_RELIEF_LENGTH * gear.face_width if length is None else length,
        modification.end_relief_shape,
    )
    return np.asarray(
        modification.crowning * (2.0 * place) ** 2 + modification.lead_slope * place + end
    )


def twist_gap(
    gear: SpurGear, curvature_radius: ArrayLike, flank: FlankRange, face_position: ArrayLike
) -> Array:
    """Material removed by the twist of a flank: the slope over the face grows along the profile."""
    radius = np.clip(np.asarray(curvature_radius, dtype=float), *flank)
    place = (radius - flank.lowest) / flank.length - 0.5
    along = np.asarray(face_position, dtype=float) / gear.face_width
    return np.asarray(gear.modification.flank_twist * place * along)


def _tilted_path(pair: SpurPair, path: Array) -> Array | float:
    """Face width that makes the same gap, where the axes tilt, as a distance along the path."""
    if pair.base_helix_angle == 0.0:
        return 0.0
    sense = 1.0 if (pair.hand == "right") == (pair.driver == "pinion") else -1.0
    pitch_point = pair.pinion.base_radius * math.tan(pair.operating_pressure_angle)
    return np.asarray(sense * math.tan(pair.base_helix_angle) * (path - pitch_point))


def flank_gap(
    pair: SpurPair,
    pinion_curvature_radius: ArrayLike,
    wheel_curvature_radius: ArrayLike,
    face_position: ArrayLike = 0.0,
) -> Array:
    """Gap from the shapes of both flanks where involutes would touch.

    Parameters
    ----------
    pair : SpurPair
        The pair, with the modifications of its gears and its misalignment.
    pinion_curvature_radius, wheel_curvature_radius : float or array [m]
        Radii of curvature of both flanks at the contact, negative for a ring: ``path`` and the
        length of the line of action less ``path``, or those of
        :func:`tribodyn.contact.extended_contact`.
    face_position : float or array [m]
        Place along the face from its middle, within the common face width.

    Returns
    -------
    array [m]
        The broadcast shape of all three; positive where the flanks stand apart, negative where
        they would overlap. Pitch deviations and run-out are not part of it.

    Notes
    -----
    Sum of what is missing on both flanks, less what a measured map has in excess, and misalignment
    times y/b with the common face width b. The twist C of a flank is C (x - 1/2) y/b, with x from
    zero at its lowest used point to one at its tip. Axes that tilt in the plane of action move the
    inclined flanks of helical gears along the axes, too: to the y of a misalignment is added the
    distance from the pitch point along the path times tan(beta_b).

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import FlankModification, spur_pair
    >>> relief = FlankModification(tip_relief=10e-6)
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3,
    ...                  pinion_modification=relief, wheel_modification=relief)
    >>> low, high = pair.path_limits
    >>> path = np.array([low, 0.5 * (low + high), high])
    >>> [round(float(gap) * 1e6, 6)
    ...  for gap in flank_gap(pair, path, pair.line_of_action_length - path)]
    [10.0, 0.0, 10.0]
    """
    face = np.asarray(face_position, dtype=float)
    radii = np.asarray(pinion_curvature_radius), np.asarray(wheel_curvature_radius)
    require_one_shape(
        pinion_curvature_radius=radii[0], wheel_curvature_radius=radii[1], face_position=face
    )
    gap = pair.misalignment * (face + _tilted_path(pair, radii[0])) / pair.common_face_width
    length = default_relief_length(pair)
    for gear, flank, radius in zip(
        (pair.pinion, pair.wheel),
        flank_ranges(pair),
        (pinion_curvature_radius, wheel_curvature_radius),
        strict=True,
    ):
        gap = gap + profile_gap(gear, radius, flank, length) + lead_gap(gear, face)
        if gear.modification.flank_twist:
            gap = gap + twist_gap(gear, radius, flank, face)
        chart = gear.modification.profile_map
        if chart is not None:
            inside = np.abs(np.clip(np.asarray(radius, dtype=float), *flank))
            gap = gap - chart.at(inside, face, base_radius=gear.base_radius)
    return np.asarray(gap)


def least_gap(pair: SpurPair) -> float:
    """Least gap of all flanks of a pair [m]; negative where teeth touch before nominal ones do."""
    if not pair.has_modification:
        return 0.0
    path = np.linspace(*pair.path_limits, _GRID)[:, None]
    face = np.linspace(-0.5, 0.5, _GRID) * pair.common_face_width
    least = float(flank_gap(pair, path, pair.line_of_action_length - path, face).min())
    if pair.has_pitch_deviation:
        least += float(pitch_gap(pair, np.arange(hunting_period(pair))).min())
    return least - 0.5 * sum(abs(gear.modification.run_out) for gear in (pair.pinion, pair.wheel))
