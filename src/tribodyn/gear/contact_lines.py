"""Two gears with face widths in mesh: overlap, and length of the lines of contact.

In the plane of action, with ``s`` along the transverse line of action from where a pair enters and
``zeta`` across the face from the end that enters first, pair ``j`` touches on the line
``s = (phase + j) p_bt - zeta tan(beta_b)`` within ``0 <= s <= g_alpha`` and ``0 <= zeta <= b``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between
from tribodyn.gear.cylindrical_gear import GearData
from tribodyn.gear.mesh_geometry import MeshGeometry
from tribodyn.types import Array

#: Contact ratio by which a whole number may be missed.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class FaceGeometry(MeshGeometry):
    """Geometry of two gears in mesh with their face widths.

    Parameters
    ----------
    pinion, wheel : GearData
        Both gears.
    center_distance : float
        Distance of the axes [m].

    Notes
    -----
    Source: ISO 21771, contact ratios and lines of contact.
    """

    pinion: GearData
    wheel: GearData

    @cached_property
    def common_face_width(self) -> float:
        """Face width in contact [m]."""
        return min(self.pinion.face_width, self.wheel.face_width)

    @property
    def hand(self) -> str:
        """Hand of the pinion's helix."""
        return self.pinion.hand

    @cached_property
    def overlap_ratio(self) -> float:
        """Face width over the axial pitch; zero for spur gears."""
        return self.common_face_width * math.tan(self.base_helix_angle) / self.base_pitch

    @cached_property
    def axial_pitch(self) -> float:
        """Distance of neighbouring flanks along the axis [m]; infinite for spur gears."""
        sine = math.sin(self.helix_angle)
        return math.pi * self.pinion.normal_module / sine if sine else math.inf

    @cached_property
    def total_contact_ratio(self) -> float:
        """Sum of the transverse contact ratio and the overlap ratio."""
        return self.transverse_contact_ratio + self.overlap_ratio

    def contact_line_length(self, phase: ArrayLike) -> Array:
        """Length of all lines of contact together.

        Parameters
        ----------
        phase : float or array
            Mesh phase; zero when a pair enters, at the end of the face that enters first. Only its
            fraction counts.

        Returns
        -------
        array [m]
            Shape of ``phase``.

        Raises
        ------
        InputError
            If a phase is not finite.

        Examples
        --------
        >>> import math
        >>> from tribodyn.gear import cylindrical_pair
        >>> pair = cylindrical_pair(pinion_teeth=23, wheel_teeth=34, normal_module=6.5e-3,
        ...                         normal_pressure_angle=math.radians(20.0),
        ...                         helix_angle=math.radians(10.0), pinion_face_width=74e-3)
        >>> [round(float(length) * 1e3, 2) for length in pair.contact_line_length([0.0, 0.5])]
        [102.69, 134.6]
        """
        require_between("phase", phase, -math.inf, math.inf)
        turned = np.asarray(phase, dtype=float)
        pairs = math.ceil(self.total_contact_ratio - _ROUNDING)
        age = (turned - np.floor(turned))[..., None] + np.arange(pairs)
        ratio, overlap = self.transverse_contact_ratio, self.overlap_ratio
        if overlap == 0.0:
            parts = np.where(age < ratio - _ROUNDING, 1.0, 0.0)
        else:
            parts = np.minimum(age, overlap) - np.maximum(age - ratio, 0.0)
            parts = np.clip(parts / overlap, 0.0, 1.0)
        return np.asarray(self._longest_line * parts.sum(axis=-1))

    @property
    def _longest_line(self) -> float:
        """Length of a line of contact over the whole face [m]."""
        return self.common_face_width / math.cos(self.base_helix_angle)

    def _extreme_length(self, greatest: bool) -> float:
        """Total length where the most or the fewest parts of lines overlap in time [m]."""
        ratio, overlap = self.transverse_contact_ratio, self.overlap_ratio
        if overlap == 0.0:
            count = math.ceil(ratio - _ROUNDING) if greatest else math.floor(ratio + _ROUNDING)
            return self._longest_line * count
        (part, integer), (face_part, face_whole) = math.modf(ratio), math.modf(overlap)
        common = min(part, face_part) if greatest else max(0.0, part + face_part - 1.0)
        return self._longest_line * (integer + (part * face_whole + common) / overlap)

    @cached_property
    def least_contact_line_length(self) -> float:
        """Least total length of the lines of contact over the mesh cycle [m]."""
        return self._extreme_length(greatest=False)

    @cached_property
    def mean_contact_line_length(self) -> float:
        """Mean total length of the lines of contact over the mesh cycle [m]."""
        return self._longest_line * self.transverse_contact_ratio

    @cached_property
    def greatest_contact_line_length(self) -> float:
        """Greatest total length of the lines of contact over the mesh cycle [m]."""
        return self._extreme_length(greatest=True)
