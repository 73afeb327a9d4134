"""Factors by which the lanes of an ensemble scale the parts of one system."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, real_numbers
from tribodyn.types import Array, Index


@dataclass(frozen=True)
class LaneParameters:
    """Factors by which each lane of an ensemble scales its system.

    Each is a number for all lanes or an array (lanes,).

    Parameters
    ----------
    stiffness_scale : float or (lanes,) array
        Of the stiffness of every contact [1].
    damping_scale : float or (lanes,) array
        Of the damping of every contact [1].
    friction_scale : float or (lanes,) array
        Of every friction force [1].
    error_scale : float or (lanes,) array
        Of the displacement error and its rate [1].
    gap_scale : float or (lanes,) array
        Of the dead zone of every contact [1].
    force_scale : float or (lanes,) array
        Of the external force of the system; an extra force is not scaled [1].

    Raises
    ------
    InputError
        If a factor is not finite, a stiffness or gap factor is negative, or arrays differ in
        length.

    Examples
    --------
    >>> LaneParameters(stiffness_scale=[1.0, 1.2], force_scale=0.5)
    LaneParameters(stiffness_scale 1 to 1.2, force_scale 0.5)
    """

    stiffness_scale: ArrayLike = 1.0
    damping_scale: ArrayLike = 1.0
    friction_scale: ArrayLike = 1.0
    error_scale: ArrayLike = 1.0
    gap_scale: ArrayLike = 1.0
    force_scale: ArrayLike = 1.0

    def __post_init__(self) -> None:
        lengths: dict[int, str] = {}
        for name in _NAMES:
            values = real_numbers(f"LaneParameters.{name}", getattr(self, name)).copy()
            if values.ndim > 1 or not np.all(np.isfinite(values)):
                raise InputError(
                    f"{name} has the shape {values.shape}"
                    if values.ndim > 1
                    else f"{name} holds NaN or infinity",
                    where=f"LaneParameters.{name}",
                    why="A factor is one number, or one number per lane",
                    remedy="Give a finite factor, or a list of them",
                )
            if name in _NOT_NEGATIVE and np.any(values < 0.0):
                worst = int(np.argmin(values))
                what = f"{name} = {values.reshape(-1)[worst]:g} in lane {worst}"
                why = "The factor cannot be negative"
                remedy = "Give zero or more; 1 leaves it as it is"
                raise InputError(what, f"LaneParameters.{name}", why, remedy)
            if values.ndim:
                lengths[values.size] = name
            object.__setattr__(self, name, values)
        if len(lengths) > 1:
            (first_count, first), (second_count, second), *_ = lengths.items()
            what = f"{first} holds {first_count} factors and {second} holds {second_count}"
            why = "Every array has one factor for each lane"
            raise InputError(what, "LaneParameters", why, "Give as many factors to each")

    def __repr__(self) -> str:
        """One line."""
        parts = []
        for name in _NAMES:
            values = np.asarray(getattr(self, name))
            low, high = float(values.min()), float(values.max())
            if low != high:
                parts.append(f"{name} {low:g} to {high:g}")
            elif low != 1.0:
                parts.append(f"{name} {low:g}")
        return f"LaneParameters({', '.join(parts)})"

    @property
    def scales_contacts(self) -> bool:
        """Whether stiffness, damping or dead zone differ from those of the system."""
        return bool(np.any(kinds_of(self, self.count) & 1))

    @property
    def scales_friction(self) -> bool:
        """Whether friction differs from that of the system."""
        return bool(np.any(kinds_of(self, self.count) & 2))

    @property
    def count(self) -> int:
        """Number of lanes that the arrays hold; 1 if there are only numbers."""
        return max(np.asarray(getattr(self, name)).size for name in _NAMES)

    def table(self, lanes: int) -> Array:
        """All factors of all lanes.

        Parameters
        ----------
        lanes : int
            Number of lanes.

        Returns
        -------
        (lanes, 6) array
            Stiffness, damping, friction, error, gap and force [1].

        Raises
        ------
        InputError
            If an array has another length.
        """
        columns = []
        for name in _NAMES:
            values = np.asarray(getattr(self, name))
            if values.ndim and values.size != lanes:
                what = f"{name} holds {values.size} factors for {lanes} lanes"
                why = "One number, or one for each lane"
                remedy = "Give one number for all lanes, or one for each"
                raise InputError(what, f"LaneParameters.{name}", why, remedy)
            columns.append(np.broadcast_to(values, (lanes,)))
        return np.stack(columns, axis=1)


_NAMES = tuple(item.name for item in fields(LaneParameters))
_NOT_NEGATIVE = ("stiffness_scale", "gap_scale")
_OF_CONTACTS = ("stiffness_scale", "damping_scale", "gap_scale")


def kinds_of(parameters: LaneParameters, lanes: int) -> Index:
    """What each lane scales: 1 contacts (stiffness, damping, dead zone), 2 friction, 3 both."""
    scaled = parameters.table(lanes) != 1.0
    contacts = scaled[:, [_NAMES.index(name) for name in _OF_CONTACTS]].any(axis=1)
    return np.asarray(contacts + 2 * scaled[:, _NAMES.index("friction_scale")])
