"""Periodic motion with supports that hold a point only beyond a radial clearance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import require_number
from tribodyn.dynamics.equations.system import Contact, System
from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    real_numbers,
    require_between,
    require_positive,
)
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics.time.response import Response

#: Width over the clearance of the transition between no contact and contact.
_SMOOTH = 1e-3
#: Change of a displacement over its size that ends the search, and the most passes of it.
_SAME, _PASSES = 1e-8, 40

_REMEDY = "Reduce the clearance, increase load or damping, or start from a similar motion"


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


def clearance_motion(
    system: System,
    supports: Sequence[RadialClearance],
    frequency: float,
    *,
    steps: int = 200,
    start: Response | None = None,
) -> Response:
    """Find the periodic motion of a system with further supports that have a radial clearance.

    Parameters
    ----------
    system : System
        Without these supports.
    supports : sequence of RadialClearance
        Supports; their contacts are behind those of the system, two for each.
    frequency : float
        Frequency of the clock [Hz].
    steps : int
        Steps per cycle of the fastest contact.
    start : Response, optional
        Motion of a similar system from which the search starts.

    Returns
    -------
    Response

    Raises
    ------
    InputError
        If a support has other coordinates than the system, or an argument is out of range.
    ComputationError
        If the search does not converge.

    Notes
    -----
    Newton's method: every pass is a harmonic balance with the tangents of the supports along the
    motion before it. Without clearance one pass is exact. Of several motions, such as those of a
    point that hits its support all around, the one nearest to that without clearance is found.

    Examples
    --------
    >>> pin = RadialClearance([[1.0, 0.0], [0.0, 1.0]], 1e8, 20e-6)
    >>> mesh = Contact([1.0, 0.0], 1e3, error=lambda phase: 1e-6 * np.cos(2 * np.pi * phase))
    >>> body = System(np.eye(2), 1e3 * np.eye(2), np.zeros((2, 2)), [0.0, 1e3], [mesh])
    >>> clearance_motion(body, [pin], 5.0).position[0, 1:].round(7)  # c + F/k
    array([3.e-05])
    """
    from tribodyn.dynamics.harmonic.harmonic_balance import harmonic_balance

    for support in supports:
        if np.asarray(support.directions).shape[1] != system.size:
            what = f"a support has {np.asarray(support.directions).shape[1]} coordinates"
            why, remedy = (
                f"The system has {system.size}",
                "Give directions with one column for each",
            )
            raise InputError(what, Argument("supports"), why, remedy)
    paths: list[Array] = []
    response, grid = start, np.zeros(1)
    share, last = 1.0, np.inf
    for _ in range(_PASSES):
        contacts = list(system.contacts)
        for number, support in enumerate(supports):
            rigid = replace(support, clearance=0.0)
            contacts += (
                support.linearized(_on_grid(grid, paths[number]))
                if paths
                else rigid.linearized(lambda phase: np.zeros((np.size(phase), 2)))
            )
        try:
            response = harmonic_balance(
                replace(system, contacts=contacts), frequency, steps=steps, start=response
            )
        except ComputationError as error:
            what = f"no motion in the clearances of {len(supports)} supports is found"
            why = f"At its last approximation {error.problems[0].what}"
            raise ComputationError(what, "clearance_motion", why, _REMEDY) from None
        grid = response.fine.phase
        moved = [support.displacement(response.fine.position) for support in supports]
        if not paths:  # the load that pushes the point beyond its clearance
            paths = [_pushed(d, s.clearance) for d, s in zip(moved, supports, strict=True)]
            if not any(support.clearance for support in supports):
                return response
            continue
        change = max(
            float(np.abs(new - old).max()) / (support.clearance + float(np.abs(new).max()))
            for new, old, support in zip(moved, paths, supports, strict=True)
        )
        if change <= _SAME:
            return response
        share = max(0.5 * share, 0.05) if change > last else min(1.0, 2.0 * share)
        last = change
        paths = [old + share * (new - old) for new, old in zip(moved, paths, strict=True)]
    what = f"the motion in the clearances of {len(supports)} supports does not settle"
    why = f"After {_PASSES} passes the displacements change by {change:.2g} of their size"
    raise ComputationError(what, "clearance_motion", why, _REMEDY)


def _pushed(displacement: Array, clearance: float) -> Array:
    """Displacement with the clearance added in its direction."""
    size = np.linalg.norm(displacement, axis=1, keepdims=True)
    return np.asarray(displacement * (1.0 + clearance / np.maximum(size, 1e-300)))


def _on_grid(grid: Array, path: Array) -> Callable[[Array], Array]:
    """Displacement over the phase of the clock between its samples."""
    order = np.argsort(grid % 1.0, kind="stable")
    at, values = (grid % 1.0)[order], path[order]

    def function(phase: Array) -> Array:
        """Linear between the samples."""
        columns = [np.interp(phase, at, column, period=1.0) for column in values.T]
        return np.stack(columns, axis=-1)

    return function
