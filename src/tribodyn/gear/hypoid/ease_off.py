"""Ease-off: material removed from the pinion flank relative to the conjugate one."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from tribodyn.errors import Argument, InputError, require_between
from tribodyn.gear.hypoid.blank import HypoidBlank
from tribodyn.nomenclature import require_number
from tribodyn.types import Array

#: Amount beyond which a unit is wrong, and length of a relief over the working depth [m, -].
_MOST, _RELIEF = 1e-3, 0.3


@dataclass(frozen=True, kw_only=True)
class EaseOff:
    """Gap between the flanks in their conjugate position; none by default.

    Places are measured on the wheel: along the pitch cone towards the heel and across it towards
    the tip, from the calculation point. The pinion bears all of it.

    Parameters
    ----------
    lengthwise_crowning : float [m]
        Gap half a face width before and behind the centre, as a parabola.
    profile_crowning : float [m]
        Gap half a working depth above and below the centre, as a parabola.
    bias : float [m]
        Gap added at heel and tip and at toe and root, and taken away at the other two corners.
    tip_relief : float [m]
        Gap at the tip of the wheel, as a parabola that begins a length below.
    root_relief : float [m]
        Gap at the lowest working depth of the wheel, where the pinion has its tip.
    relief_length : float [m], optional
        Length of both reliefs; by default three tenths of the working depth.
    center : tuple of float [m], optional
        Place (along, across) of the centre; by default the calculation point lengthwise and the
        middle of the working depth.

    Raises
    ------
    InputError
        If a value is out of range, or bias would make the flanks cut into each other.

    Examples
    --------
    >>> EaseOff(lengthwise_crowning=30e-6, profile_crowning=6e-6).bias
    0.0
    """

    lengthwise_crowning: float = 0.0
    profile_crowning: float = 0.0
    bias: float = 0.0
    tip_relief: float = 0.0
    root_relief: float = 0.0
    relief_length: float | None = None
    center: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        for each in fields(self)[:5]:
            value = require_number(each.name, getattr(self, each.name))
            low = -_MOST if each.name == "bias" else 0.0
            require_between(each.name, value, low, _MOST, "m", remedy="10 um is 10e-6")
            object.__setattr__(self, each.name, value)
        if self.relief_length is not None:
            require_between(
                "relief_length",
                require_number("relief_length", self.relief_length),
                1e-6,
                0.1,
                "m",
                remedy="3 mm is 3e-3",
            )
        self._require_center()
        if self.bias**2 > 4.0 * self.lengthwise_crowning * self.profile_crowning:
            most = 2.0 * math.sqrt(self.lengthwise_crowning * self.profile_crowning)
            raise InputError(
                f"bias = {self.bias * 1e6:.6g} um",
                Argument("bias"),
                f"Beyond {most * 1e6:.4g} um, twice the root of the product of both crownings, the "
                "flanks cut into each other",
                "Reduce the bias or give more crowning",
            )

    def _require_center(self) -> None:
        if self.center is None:
            return
        if not isinstance(self.center, list | tuple | np.ndarray) or len(self.center) != 2:
            why = "It is two places: along and across the pitch cone"
            remedy = "Give (along the profile, along the face) as fractions"
            raise InputError(f"center = {self.center!r}", Argument("center"), why, remedy)
        along, across = (require_number("center", value) for value in self.center)
        require_between("center", [along, across], -1.0, 1.0, "m", remedy="2 mm is 2e-3")
        object.__setattr__(self, "center", (along, across))


def eased_gap(ease_off: EaseOff, blank: HypoidBlank, places: Array) -> tuple[Array, Array]:
    """Gap and its gradient at places (along, across) the wheel's pitch cone."""
    working = blank.mean_addendum_pinion + blank.mean_addendum_wheel
    middle = 0.5 * (blank.mean_addendum_wheel - blank.mean_addendum_pinion)
    half = np.array([0.5 * blank.face_width_wheel, 0.5 * working])
    share = (places - np.asarray(ease_off.center or (0.0, middle))) / half
    x, y = np.moveaxis(share, -1, 0)
    gap = (
        ease_off.lengthwise_crowning * x**2
        + ease_off.profile_crowning * y**2
        + ease_off.bias * x * y
    )
    along = 2.0 * ease_off.lengthwise_crowning * x + ease_off.bias * y
    across = 2.0 * ease_off.profile_crowning * y + ease_off.bias * x
    slope = np.stack([along, across], axis=-1) / half
    length = ease_off.relief_length or _RELIEF * working
    low, high = working_depth(blank, places[..., 0])
    for amount, depth, (_, turn), sense in (
        (ease_off.tip_relief, high[0] - places[..., 1], high, 1.0),
        (ease_off.root_relief, places[..., 1] - low[0], low, -1.0),
    ):
        over = np.maximum(1.0 - depth / length, 0.0)
        gap = gap + amount * over**2
        step = 2.0 * amount * over / length * sense
        slope = slope + np.stack([-turn * step, step], axis=-1)
    return gap, slope


def working_depth(blank: HypoidBlank, along: Array) -> tuple[tuple[Array, float], ...]:
    """Lowest and highest working place across the wheel's pitch cone, each with its slope."""
    up = math.tan(blank.face_angle_wheel - blank.pitch_angle_wheel)
    down = math.tan(blank.pitch_angle_wheel - blank.root_angle_wheel)
    low = -blank.mean_addendum_pinion - along * down
    return (low, -down), (blank.mean_addendum_wheel + along * up, up)
