"""The outline of a tooth as points: root arc, fillet, involute flank and tip arc."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.errors import require_between
from tribodyn.gear.tooth_form import ToothForm
from tribodyn.types import Array


def _fillet(form: ToothForm, points: int) -> tuple[Array, Array]:
    """Radius and half tooth angle along the fillet, from the root circle to the form circle."""
    angle = np.linspace(math.pi / 2.0, form.form_normal_angle, points)
    return form.trochoid.radius(angle), form.trochoid.half_tooth_angle(angle)


def _flank(form: ToothForm, points: int) -> tuple[Array, Array]:
    """Radius and half tooth angle along the involute, from the form circle to the tip circle."""
    ends = form.roll_angle(form.form_radius), form.roll_angle(form.tip_radius)
    roll = np.linspace(*ends, points)
    half = form.base_half_angle - form.sign * (roll - np.arctan(roll))
    return form.base_radius * np.hypot(1.0, roll), half


def _cartesian(radius: Array, angle: Array) -> Array:
    return np.stack([radius * np.sin(angle), radius * np.cos(angle)])


def half_tooth(gear: ToothForm, points: int = 200) -> tuple[Array, Array]:
    """Half of the tooth section as thickness over height, fillet and undercut included.

    Parameters
    ----------
    gear : ToothForm or SpurGear
        Gear whose tooth is wanted.
    points : int
        Number of points, at least 8; half of them on the fillet and half on the involute.

    Returns
    -------
    tuple of array
        Height above the gear axis along the tooth axis [m], shape (points,), from the root circle
        to the tip corner: increasing, but decreasing for a ring, whose tip is inside; and half
        thickness across the tooth axis [m], same shape.

    Raises
    ------
    InputError
        If the number of points is out of range.

    Notes
    -----
    Points lie on the exact curves. Source: see :class:`Trochoid` and ISO 21771.

    Examples
    --------
    >>> from tribodyn.gear import SpurGear
    >>> gear = SpurGear(teeth=20, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                 profile_shift_coefficient=0.0, tip_diameter=44e-3, face_width=10e-3)
    >>> height, half_thickness = half_tooth(gear)
    >>> bool(abs(2.0 * half_thickness[-1] / gear.tip_thickness - 1.0) < 1e-3)
    True
    """
    require_between("points", points, 8, 10_000_000)
    on_fillet = points // 2
    fillet = _fillet(gear, on_fillet + 1)
    flank = _flank(gear, points - on_fillet)
    # The last point of the fillet is the first of the flank.
    radius = np.concatenate([fillet[0][:-1], flank[0]])
    angle = np.concatenate([fillet[1][:-1], flank[1]])
    half_thickness, height = _cartesian(radius, angle)
    return height, half_thickness


def tooth_outline(gear: ToothForm, points: int = 200) -> Array:
    """Outline of a tooth with its fillets in the transverse section; that of a ring points inwards.

    Parameters
    ----------
    gear : ToothForm or SpurGear
        Gear whose tooth is wanted.
    points : int
        Number of points, at least 40; an even number gives one point less, because the outline
        has one point on the tooth axis.

    Returns
    -------
    array
        Points (x, y) [m], shape (2, n), from the middle of the space on the right (x > 0) over the
        tip to the middle of the space on the left. The gear axis is the origin, the tooth axis the
        y axis. The ends meet those of the neighbouring teeth.

    Raises
    ------
    InputError
        If the number of points is out of range.

    Notes
    -----
    Source: see :class:`Trochoid` and ISO 21771.

    Examples
    --------
    >>> from tribodyn.gear import SpurGear
    >>> gear = SpurGear(teeth=20, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                 profile_shift_coefficient=0.0, tip_diameter=44e-3, face_width=10e-3)
    >>> outline = tooth_outline(gear)
    >>> outline.shape, float(outline[1].max())
    ((2, 199), 0.022)
    """
    require_between("points", points, 40, 10_000_000)
    half = (points + 1) // 2
    arc = half // 10
    on_fillet = (half - 2 * arc) // 2
    fillet = _fillet(gear, on_fillet + 1)
    flank = _flank(gear, half - 2 * arc - on_fillet)
    pitch_angle = math.pi / abs(gear.teeth)
    root_angle = np.linspace(pitch_angle, fillet[1][0], arc, endpoint=False)
    tip_angle = np.linspace(0.0, flank[1][-1], arc, endpoint=False)[::-1]
    radius = np.concatenate(
        [np.full(arc, gear.root_radius), fillet[0][:-1], flank[0], np.full(arc, gear.tip_radius)]
    )
    angle = np.concatenate([root_angle, fillet[1][:-1], flank[1], tip_angle])
    right = _cartesian(radius, angle)
    left = right[:, -2::-1] * np.array([[-1.0], [1.0]])
    return np.concatenate([right, left], axis=1)


def gear_outline(gear: ToothForm, points: int = 200) -> Array:
    """Outline of the whole gear, one tooth on the y axis.

    Parameters
    ----------
    gear : ToothForm or SpurGear
        Gear that is wanted.
    points : int
        Number of points of each tooth, at least 40.

    Returns
    -------
    array
        Points (x, y) [m], shape (2, n), anticlockwise; the last point equals the first.

    Raises
    ------
    InputError
        If the number of points is out of range.

    Notes
    -----
    Source: see :func:`tooth_outline`.

    Examples
    --------
    >>> from tribodyn.gear import SpurGear
    >>> gear = SpurGear(teeth=20, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                 profile_shift_coefficient=0.0, tip_diameter=44e-3, face_width=10e-3)
    >>> gear_outline(gear).shape
    (2, 3961)
    """
    tooth = tooth_outline(gear, points)[:, :-1]
    turn = 2.0 * math.pi / abs(gear.teeth) * np.arange(abs(gear.teeth))
    cosine, sine = np.cos(turn)[:, None], np.sin(turn)[:, None]
    x = cosine * tooth[0] - sine * tooth[1]
    y = sine * tooth[0] + cosine * tooth[1]
    ring = np.stack([x.ravel(), y.ravel()])
    return np.concatenate([ring, ring[:, :1]], axis=1)
