"""The force law of a tooth mesh: force over deflection, as a sum of ramps that move with phase."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.errors import InputError, require_between
from tribodyn.mesh.grid import MonotonePhaseFunction, PhaseFunction, PhaseGrid
from tribodyn.types import Array

#: Fall of the slope from one point to the next, relative to the largest, that is rounding.
_ROUNDING = 1e-6
#: Stiffness over that of all ramps below which nothing carries.
_FAINT = 1e-12


@dataclass(frozen=True, eq=False)
class MeshForceLaw:
    """Convex force law ``N(phase, delta) = sum_m k_m(phase) max(delta - a_m(phase), 0)``.

    Parameters
    ----------
    grid : PhaseGrid
        Knots on the mesh phase, twice at each event.
    knot_deflection : array (n, ramps) [m]
        Deflection ``a_m`` at which each ramp begins; n counts the knots. Any order of columns, each
        of them smooth between two events.
    knot_stiffness : array (n, ramps) [N/m]
        Stiffness ``k_m`` that each ramp adds, not negative; zero where it is not there.

    Raises
    ------
    InputError
        If shapes disagree, a value is not finite, a stiffness is negative, or nothing carries at
        some phase.

    Notes
    -----
    Deflection is counted along the line of action from where the driving flanks of the nominal
    teeth touch. Because no ramp softens, force and tangent never fall with deflection and every
    force has one deflection. Between the knots several ramps follow monotone cubics, because
    pairs come to bear at phases that are no events; on an event the values after it are returned.

    Examples
    --------
    >>> from tribodyn.mesh import phase_grid
    >>> grid = phase_grid((0.0,), 16)
    >>> law = MeshForceLaw(grid, np.tile([0.0, 1e-5], (17, 1)), np.tile([2e8, 1e8], (17, 1)))
    >>> law.force(0.3, 2e-5), law.tangent(0.3, 2e-5), law.deflection(0.3, 5000.0)
    (array(5000.), array(3.e+08), array(2.e-05))
    """

    grid: PhaseGrid
    knot_deflection: Array
    knot_stiffness: Array

    def __post_init__(self) -> None:
        for name in ("knot_deflection", "knot_stiffness"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=float))
        place, stiffness = self.knot_deflection, self.knot_stiffness
        count = self.grid.phase.size
        if place.ndim != 2 or place.shape != stiffness.shape or place.shape[0] != count:
            _refuse(
                f"knot_deflection has the shape {place.shape}, knot_stiffness {stiffness.shape}",
                f"Both have the shape ({count}, ramps) on this phase grid",
            )
        if not (np.all(np.isfinite(place)) and np.all(np.isfinite(stiffness))):
            _refuse("a knot is NaN or infinite", "Every ramp has a place and a stiffness")
        if np.any(stiffness < 0.0):
            _refuse(
                f"knot_stiffness falls to {stiffness.min():.4g} N/m",
                "Each ramp adds stiffness: the force of teeth that come to bear one after the "
                "other is convex in the deflection",
            )
        if np.any(stiffness.sum(axis=1) == 0.0):
            phase = self.grid.phase[np.argmin(stiffness.sum(axis=1))]
            _refuse(f"no ramp carries at the mesh phase {phase:.4g}", "Some pair is always there")

    @classmethod
    def through(cls, grid: PhaseGrid, deflection: Array, force: Array) -> MeshForceLaw:
        """Join points of a convex law by straight lines; the last one goes on.

        Parameters
        ----------
        grid : PhaseGrid
            Knots on the mesh phase, twice at each event.
        deflection : array (n, points) [m]
            Deflections of the points of each phase, increasing.
        force : array (n, points) [N]
            Forces there, the first of them zero.

        Returns
        -------
        MeshForceLaw
            Column ``m`` begins at point ``m``, so that the first one is the lowest.

        Raises
        ------
        InputError
            If points are not in order, the law does not begin at zero, falls or is not convex.

        Notes
        -----
        A chord lies above a convex law: between two points the force is too large by at most an
        eighth of the curvature times the square of their distance.

        Examples
        --------
        >>> from tribodyn.mesh import phase_grid
        >>> points = np.tile([0.0, 1e-5, 2e-5], (17, 1))
        >>> law = MeshForceLaw.through(phase_grid((0.0,), 16), points, 4e13 * points**2)
        >>> law.force(0.0, np.array([1e-5, 2e-5])).round(6).tolist()
        [4000.0, 16000.0]
        """
        place, force = np.asarray(deflection, dtype=float), np.asarray(force, dtype=float)
        if place.ndim != 2 or place.shape != force.shape or place.shape[1] < 2:
            _refuse(
                f"deflection has the shape {place.shape}, force {force.shape}",
                "Both have the shape (knots of the grid, points), with at least two points",
            )
        if not np.all(np.diff(place, axis=1) > 0.0):
            _refuse("the deflections of the points do not increase", "Order them, drop doubles")
        if np.any(np.abs(force[:, 0]) > 1e-12 * np.abs(force).max()):
            _refuse(f"the first force is {force[:, 0].max():.4g} N", "The law begins at no force")
        slope = np.diff(force, axis=1) / np.diff(place, axis=1)
        if slope.min() < -_ROUNDING * slope.max():
            row, point = np.unravel_index(int(np.argmin(slope)), slope.shape)
            _refuse(
                f"the force falls from {force[row, point]:.6g} N at {1e6 * place[row, point]:.4g} "
                f"um to {force[row, point + 1]:.6g} N at {1e6 * place[row, point + 1]:.4g} um, at "
                f"the mesh phase {grid.phase[row]:.4g}",
                "Teeth that are pressed together push back more: each force has one deflection",
            )
        rise = np.diff(slope, axis=1, prepend=0.0)
        least = float((rise / slope.max(axis=1, keepdims=True)).min())
        if least < -_ROUNDING:
            _refuse(f"the slope falls by {-least:.2g} of the largest", "The law has to be convex")
        return cls(grid, place[:, :-1], np.maximum(rise, 0.0))

    @cached_property
    def _columns(self) -> PhaseFunction | MonotonePhaseFunction:
        return self.over_phase(np.stack((self.knot_deflection, self.knot_stiffness), -1))

    def over_phase(self, values: Array) -> PhaseFunction | MonotonePhaseFunction:
        """Lay a curve through values at the knots.

        Parameters
        ----------
        values : array (n, ...)
            One or several columns, in any unit.

        Returns
        -------
        PhaseFunction or MonotonePhaseFunction
            The former for a single ramp, which has no corners between events.
        """
        single = self.knot_stiffness.shape[1] == 1
        return (PhaseFunction if single else MonotonePhaseFunction)(self.grid, values)

    def ramps(self, phase: Array | float) -> tuple[Array, Array]:
        """Place and stiffness of every ramp at any mesh phase.

        Parameters
        ----------
        phase : float or array
            Mesh phase, taken modulo one.

        Returns
        -------
        tuple of array
            Deflections [m] and stiffnesses [N/m], shape of ``phase`` followed by the ramps.
        """
        ramp_columns = self._columns(phase)
        return ramp_columns[..., 0], ramp_columns[..., 1]

    def force(self, phase: Array | float, deflection: Array | float) -> Array:
        """Force of the driving flanks.

        Parameters
        ----------
        phase, deflection : float or array [mesh cycles], [m]
            Mesh phase, taken modulo one, and deflection; shapes are broadcast.

        Returns
        -------
        array [N]
        """
        return self._sum(phase, deflection, 1)

    def tangent(self, phase: Array | float, deflection: Array | float) -> Array:
        """Slope of the force over the deflection; on a knot that before it.

        Parameters
        ----------
        phase, deflection : float or array [mesh cycles], [m]
            Mesh phase, taken modulo one, and deflection; shapes are broadcast.

        Returns
        -------
        array [N/m]
        """
        return self._sum(phase, deflection, 0)

    def energy(self, phase: Array | float, deflection: Array | float) -> Array:
        """Elastic energy: the integral of the force from no deflection on.

        Parameters
        ----------
        phase, deflection : float or array [mesh cycles], [m]
            Mesh phase, taken modulo one, and deflection; shapes are broadcast.

        Returns
        -------
        array [J]
        """
        return self._sum(phase, deflection, 2)

    def _sum(self, phase: Array | float, deflection: Array | float, power: int) -> Array:
        place, stiffness = self.ramps(phase)
        beyond = np.asarray(deflection, dtype=float)[..., None] - place
        grown = beyond**power / max(power, 1)
        return np.asarray(np.where(beyond > 0.0, stiffness * grown, 0.0).sum(axis=-1))

    def deflection(self, phase: Array | float, force: Array | float) -> Array:
        """Deflection that a force causes at rest: the static transmission error.

        Parameters
        ----------
        phase, force : float or array [mesh cycles], [N]
            Mesh phase, taken modulo one, and total normal force, not negative; shapes are
            broadcast.

        Returns
        -------
        array [m]
            Where the first pair touches if the force is zero.

        Raises
        ------
        InputError
            If a force is negative.
        """
        require_between("force", force, 0.0, np.inf, "N")
        return _inverse(*self.ramps(phase), np.asarray(force, dtype=float))

    @cached_property
    def lowest(self) -> int | None:
        """Column that begins lowest and carries at every knot; None if no one does."""
        first = self.knot_first_touch
        always = (self.knot_stiffness > 0.0) & (self.knot_deflection <= first[:, None])
        candidates = np.flatnonzero(always.all(axis=0))
        return int(candidates[0]) if candidates.size else None

    @cached_property
    def knot_first_touch(self) -> Array:
        """Deflection at which the first pair touches, at every knot [m]."""
        starts = np.where(self.knot_stiffness > 0.0, self.knot_deflection, np.inf)
        return np.asarray(starts.min(axis=1))

    def first_touch(self, phase: Array | float) -> Array:
        """Deflection at which the first pair touches.

        Parameters
        ----------
        phase : float or array
            Mesh phase, taken modulo one.

        Returns
        -------
        array [m]
        """
        return self.over_phase(self.knot_first_touch)(phase)

    def __repr__(self) -> str:
        """One line."""
        low, high = self.knot_first_touch.min() * 1e6, self.knot_first_touch.max() * 1e6
        return (
            f"MeshForceLaw({self.knot_deflection.shape[1]} ramps, first touch at {low:.4g} to "
            f"{high:.4g} um)"
        )


def _inverse(place: Array, stiffness: Array, force: Array) -> Array:
    """Deflection at which ramps (..., m) carry a force."""
    order = np.argsort(place, axis=-1)
    place = np.take_along_axis(place, order, axis=-1)
    total = np.take_along_axis(stiffness, order, axis=-1).cumsum(axis=-1)
    risen = (total[..., :-1] * np.diff(place, axis=-1)).cumsum(axis=-1)
    risen = np.concatenate((np.zeros((*risen.shape[:-1], 1)), risen), axis=-1)
    # A convex law is the largest of its straight pieces, its inverse the smallest of theirs.
    carries = total > _FAINT * total[..., -1:]
    soft = np.where(carries, total, 1.0)
    deflections = np.where(carries, place + (force[..., None] - risen) / soft, np.inf)
    return np.asarray(deflections.min(axis=-1))


def at_rest(place: Array, stiffness: Array, force: float) -> tuple[Array, Array]:
    """Deflection [m] of ramps (n, m) under a force, and the slope there [N/m]."""
    deflection = _inverse(place, stiffness, np.full(place.shape[0], force))
    carries = place < deflection[:, None]
    return deflection, np.asarray(np.where(carries, stiffness, 0.0).sum(axis=1))


def _refuse(what: str, why: str) -> None:
    raise InputError(what, where="MeshForceLaw", why=why, remedy="Give both of the same shape")
