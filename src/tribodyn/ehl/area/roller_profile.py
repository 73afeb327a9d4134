"""Shape of a roller over its length: how far its surface falls back from the straight one."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tribodyn.errors import require_between, require_positive
from tribodyn.types import Array


@dataclass(frozen=True)
class RollerProfile:
    """Drop of a roller's surface over the distance from its middle; see the constructors.

    Parameters
    ----------
    drop : callable
        Drop [m] at distances [m] from the middle, an array of the same shape.
    name : str
        What it is called.

    Examples
    --------
    >>> profile = RollerProfile.crowned(2.0)
    >>> profile.drop(np.array([0.0, 5e-3])).tolist()
    [0.0, 6.25e-06]
    """

    drop: Callable[[Array], Array] = field(repr=False)
    name: str

    @classmethod
    def straight(cls) -> RollerProfile:
        """No drop but the rounded edges."""
        return cls(np.zeros_like, "straight")

    @classmethod
    def crowned(cls, crown_radius: float) -> RollerProfile:
        """Crown of a constant radius over the full length.

        Parameters
        ----------
        crown_radius : float [m]

        Returns
        -------
        RollerProfile

        Raises
        ------
        InputError
            If the radius is not positive.
        """
        require_positive("crown_radius", crown_radius, "m")
        return cls(lambda y: 0.5 * y**2 / crown_radius, f"crowned, radius {crown_radius:.4g} m")

    @classmethod
    def dub_off(cls, straight_length: float, radius: float) -> RollerProfile:
        """Straight in the middle, then an arc that starts without an edge.

        Parameters
        ----------
        straight_length, radius : float [m]
            Length of the straight part, and radius of the arcs.

        Returns
        -------
        RollerProfile

        Raises
        ------
        InputError
            If one of them is not positive.
        """
        require_positive("straight_length", straight_length, "m")
        require_positive("radius", radius, "m", remedy="A rounded edge has about 1e-3 m")
        half = 0.5 * straight_length

        def drop(y: Array) -> Array:
            """Drop of the arc, which ends where it is steep."""
            beyond = np.minimum(np.maximum(np.abs(y) - half, 0.0) / radius, 0.99)
            return np.asarray(radius * (1.0 - np.sqrt(1.0 - beyond**2)))

        return cls(drop, f"straight over {straight_length * 1e3:.4g} mm, then {radius:.4g} m")

    @classmethod
    def logarithmic(
        cls, length: float, load_per_length: float, effective_modulus: float, half_width: float
    ) -> RollerProfile:
        """Profile after Lundberg, which makes the dry pressure even at one load.

        ``2 w/(pi E') ln(1/[1 - (1 - 0.3033 b/a) (y/a)^2])`` with half the length a and the half
        width b of the contact, in the form of Johns and Gohar.

        Parameters
        ----------
        length : float [m]
            Length of the roller.
        load_per_length : float [N/m]
            Load for which the profile is made.
        effective_modulus : float [Pa]
            ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
        half_width : float [m]
            Half width of the dry contact at that load.

        Returns
        -------
        RollerProfile

        Raises
        ------
        InputError
            If a value is out of range.

        Source: Lundberg (1939); Johns and Gohar, Tribology International 14 (1981).
        """
        require_positive("length", length, "m")
        require_positive("load_per_length", load_per_length, "N/m")
        require_positive("effective_modulus", effective_modulus, "Pa")
        require_between("half_width", half_width, 1e-9, 0.5 * length, "m")
        half = 0.5 * length
        rounding = 1.0 - 0.3033 * half_width / half
        height = 2.0 * load_per_length / (math.pi * effective_modulus)

        def drop(y: Array) -> Array:
            """Drop of the curve, which goes on as steeply beyond the end."""
            inside = np.minimum(np.abs(y) / half, 1.0)
            slope = 2.0 * rounding / (1.0 - rounding)
            outside = np.maximum(np.abs(y) / half - 1.0, 0.0)
            return np.asarray(height * (-np.log1p(-rounding * inside**2) + slope * outside))

        return cls(drop, f"logarithmic for {load_per_length * 1e-3:.4g} N/mm")
