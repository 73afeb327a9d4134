"""Supports that hold a point only beyond a radial clearance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.system import Contact
from tribodyn.errors import (
    Argument,
    InputError,
    real_numbers,
    require_between,
    require_positive,
)
from tribodyn.nomenclature import require_number
from tribodyn.types import Array

#: Width over the clearance of the transition between no contact and contact.
_SMOOTH = 1e-3
#: Displacement over the clearance of a support without load; least stiffness of the spring across
#: the load that replaces a support, over that along it.
_UNLOADED, _SOFT = 1e-9, 1e-2
#: What helps where no motion is found.
REMEDY = "Reduce the clearance, increase load or damping, or start from a similar motion"


@dataclass(frozen=True, eq=False)
class RadialClearance:
    """Support of a point in a plane: free within a circle, elastic beyond it.

    Parameters
    ----------
    directions : (2, n) array
        Derivatives of the two displacements of the point with respect to the coordinates [1].
    stiffness : float
        Radial stiffness beyond the clearance [N/m].
    clearance : float
        Radius of the circle, half of the diametral clearance [m].
    offset : (2,) array
        Displacement of the middle of the circle [m].

    Raises
    ------
    InputError
        If a value is out of range or an array has another shape.

    Notes
    -----
    The force ``k max(|d| - c, 0) d/|d|`` is against the displacement d. Its kink is smooth over
    0.001 of the clearance, which changes ``|d| - c`` by less than 0.0005 c.

    Examples
    --------
    >>> pin = RadialClearance([[1.0, 0.0], [0.0, 1.0]], 1e8, 20e-6)
    >>> pin.force(np.array([18e-6, 24e-6])).round(1)  # 10 um beyond the clearance
    array([600., 800.])
    """

    directions: ArrayLike
    stiffness: float
    clearance: float
    offset: ArrayLike = (0.0, 0.0)

    def __post_init__(self) -> None:
        require_positive("stiffness", require_number("stiffness", self.stiffness), "N/m")
        require_between("clearance", require_number("clearance", self.clearance), 0.0, 0.1, "m")
        for name, shape in (("directions", 2), ("offset", 1)):
            values = real_numbers(Argument(f"RadialClearance.{name}"), getattr(self, name))
            if values.ndim != shape or len(values) != 2:
                what, why = f"{name} has the shape {values.shape}", "A plane has two directions"
                remedy = "Give two rows" if shape == 2 else "Give two numbers in m"
                raise InputError(what, Argument(f"RadialClearance.{name}"), why, remedy)
            object.__setattr__(self, name, values)

    def displacement(self, position: ArrayLike) -> Array:
        """Displacement of the point from the middle of the circle.

        Parameters
        ----------
        position : (..., n) array
            Coordinates [m or rad].

        Returns
        -------
        (..., 2) array
            In m.
        """
        return np.asarray(
            np.asarray(position) @ np.asarray(self.directions).T - np.asarray(self.offset)
        )

    def force(self, displacement: Array) -> Array:
        """Force of the point on its support.

        Parameters
        ----------
        displacement : (..., 2) array
            From the middle of the circle [m].

        Returns
        -------
        (..., 2) array
            In N.
        """
        _, _, across = self._springs(displacement)
        return np.asarray(across[..., None] * displacement)

    def tangent(self, displacement: Array) -> Array:
        """Derivative of the force with respect to the displacement.

        Parameters
        ----------
        displacement : (..., 2) array
            From the middle of the circle [m].

        Returns
        -------
        (..., 2, 2) array
            In N/m.
        """
        toward, along, across = self._springs(displacement)
        radial = toward[..., :, None] * toward[..., None, :]
        out = (along - across)[..., None, None] * radial + across[..., None, None] * np.eye(2)
        return np.asarray(out)

    def linearized(self, at: Callable[[Array], Array]) -> list[Contact]:
        """Springs along and across a displacement that is a function of the clock.

        Parameters
        ----------
        at : function
            Of phases (p,), the displacement (p, 2) [m].

        Returns
        -------
        list of Contact
            Whose forces are those of the support to first order about the displacement.
        """
        rows, offset = np.asarray(self.directions), np.asarray(self.offset)

        def toward(phase: Array) -> Array:
            """Direction of the displacement."""
            return self._springs(at(phase))[0]

        def across(phase: Array) -> Array:
            """Direction across the displacement."""
            return np.asarray(toward(phase)[..., ::-1] * np.array([-1.0, 1.0]))

        def error(phase: Array) -> Array:
            """Displacement along itself at which the tangent has no force."""
            displacement = at(phase)
            unit, along, secant = self._springs(displacement)
            size = np.linalg.norm(displacement, axis=-1)
            return np.asarray(size * (1.0 - secant / along) + unit @ offset)

        return [
            Contact(lambda phase: toward(phase) @ rows,
                    lambda phase: self._springs(at(phase))[1], error=error),
            Contact(lambda phase: across(phase) @ rows,
                    lambda phase: self._springs(at(phase))[2],
                    error=lambda phase: across(phase) @ offset),
        ]  # fmt: skip

    def _springs(self, displacement: Array) -> tuple[Array, Array, Array]:
        """Direction of a displacement, and the stiffness along and across it."""
        size = np.linalg.norm(displacement, axis=-1)
        safe = np.where(size > 0.0, size, 1.0)
        toward = np.where(size[..., None] > 0.0, displacement / safe[..., None], [1.0, 0.0])
        if not self.clearance:
            stiffness = np.full(size.shape, float(self.stiffness))
            return toward, stiffness, stiffness
        width, beyond = _SMOOTH * self.clearance, size - self.clearance
        root, depth = np.hypot(beyond, width), np.abs(beyond)
        # Both halves of x + sqrt(x^2 + w^2) without cancellation, less its value in the middle.
        part = 0.5 * np.where(beyond < 0.0, width**2 / (root + depth), root + depth)
        slope = part / root
        middle = 0.5 * width**2 / (np.hypot(self.clearance, width) + self.clearance)
        secant = np.where(size > 1e-9 * self.clearance, (part - middle) / safe, slope)
        return toward, self.stiffness * slope, self.stiffness * np.maximum(secant, 0.0)


def about_load(
    support: RadialClearance, displacement: Array, cycles: Any
) -> tuple[RadialClearance, list[Contact]]:
    """Support for the compressions of springs along and across a displacement (2,), and these."""
    # The springs have the tangent of the support at this displacement beyond the clearance.
    size = float(np.linalg.norm(displacement))
    toward = displacement / size if size > 0.0 else np.array([1.0, 0.0])
    frame = np.stack((toward, toward[::-1] * np.array([-1.0, 1.0])))
    shift = np.array([support.clearance if size > _UNLOADED * support.clearance else 0.0, 0.0])
    rows, middle = frame @ np.asarray(support.directions), frame @ np.asarray(support.offset)
    across = max(size / (size + support.clearance), _SOFT) if support.clearance else 1.0
    stiffness = support.stiffness, support.stiffness * across
    springs = [
        Contact(row, k, error=float(e), cycles=cycles, name="support with clearance")
        for row, k, e in zip(rows, stiffness, middle + shift, strict=True)
    ]
    return replace(support, directions=rows, offset=-shift), springs


def clearance_forces(
    supports: Sequence[RadialClearance], compression: Array
) -> tuple[Array, Array]:
    """Forces of supports (p, 2 m) and their derivatives (p, 2 m, 2 m) at compressions (p, 2 m)."""
    force, tangent = np.empty_like(compression), np.zeros((*compression.shape, len(supports) * 2))
    for number, support in enumerate(supports):
        at = slice(2 * number, 2 * number + 2)
        displacement = compression[:, at] - np.asarray(support.offset)
        force[:, at] = support.force(displacement)
        tangent[:, at, at] = support.tangent(displacement)
    return force, tangent
