"""What a load on a part of the face does over the flank and at other teeth of one gear."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.arrays.splines import (
    bspline_integrals,
    bspline_values,
    interpolation_knots,
)
from tribodyn.errors import Argument, InputError
from tribodyn.types import Array

#: Distance beyond the ends of the face, over its width, that is rounding.
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False, repr=False)
class FaceInfluence:
    """Compliances of one gear over radius of curvature and face position.

    Loads and displacements lie along the transverse line of action, per transverse force. The
    splines count the face from the end where the radius of curvature along a line of contact is
    largest (of a spur gear, from either end). The neighbour ``+n`` is the n-th tooth on the side of
    the loaded tooth where a contact at the same time has a larger radius of curvature. Radii of
    curvature of a ring are positive.

    Parameters
    ----------
    curvature_radius : array (K,) [m]
        Transverse radii of curvature of the involute at the nodes, increasing.
    knots : array (Z + 4,) [m]
        Knots of the cubic B-splines over the face, from 0 to the face width.
    self_compliance : array (K, K, Z, Z) [m/N]
        ``[i, j, a, b]``: coefficient ``b`` of the displacement at node ``j`` per integral over the
        face of the load at node ``i`` times spline ``a``, without the local compression.
    cross_compliance : array (N, K, K, Z, Z) [m/N]
        ``[n - 1]``: displacement of the neighbour ``+n``.

    Raises
    ------
    InputError
        If the shapes disagree, the nodes do not increase, or a compliance is not finite.

    Notes
    -----
    The neighbour ``-n`` follows from the reciprocal theorem of Betti and Maxwell. The case of one
    function over the face is :class:`tribodyn.stiffness.GearInfluence`.
    """

    curvature_radius: Array
    knots: Array
    self_compliance: Array
    cross_compliance: Array

    def __post_init__(self) -> None:
        nodes, functions = self.curvature_radius.size, self.knots.size - 4
        shape = (nodes, nodes, functions, functions)
        shapes = self.self_compliance.shape, self.cross_compliance.shape[1:]
        if shapes != (shape, shape) or nodes < 4 or functions < 4:
            raise _unusable(
                f"{nodes} nodes and {functions} functions with compliances of the shapes "
                f"{shapes[0]}, {shapes[1]}"
            )
        if np.any(np.diff(self.curvature_radius) <= 0.0) or np.any(np.diff(self.knots) < 0.0):
            raise _unusable("radii of curvature or knots that do not increase")
        if not all(np.all(np.isfinite(t)) for t in (self.self_compliance, self.cross_compliance)):
            raise _unusable("a compliance that is not finite")

    @property
    def neighbours(self) -> int:
        """Number of neighbours on each side that are known; those beyond do not move."""
        return int(self.cross_compliance.shape[0])

    @property
    def face_width(self) -> float:
        """Face width of the gear [m]."""
        return float(self.knots[-1])

    @cached_property
    def _radius_knots(self) -> Array:
        return interpolation_knots(self.curvature_radius**2)

    def sliced(self, edges: Array, *, rising: bool = False) -> SlicedInfluence:
        """Compliances between slices of the face.

        Parameters
        ----------
        edges : array (s + 1,) [m]
            Increasing ends of the slices, counted from the middle of the face of this gear.
        rising : bool
            Whether radii of curvature along a line of contact increase with the face position;
            otherwise they decrease. Of a helical pair it is true of one gear, or of a ring and
            its pinion.

        Returns
        -------
        SlicedInfluence

        Raises
        ------
        InputError
            If the edges do not increase or lie off the face.
        """
        places = np.asarray(edges, dtype=float)
        half = 0.5 * self.face_width
        most = np.abs(places).max(initial=0.0)
        if (
            places.ndim != 1
            or places.size < 2
            or most > half * (1.0 + _ROUNDING)
            or np.any(np.diff(places) <= 0.0)
        ):
            raise InputError(
                f"edges of slices up to {most * 1e3:.6g} mm from the middle of the face",
                where=Argument("edges"),
                why=f"They increase, two or more, within the face of {self.face_width * 1e3:.6g} "
                "mm",
                remedy="Cut the common face of the pair into slices",
            )
        order = -1 if rising else 1
        counted = np.clip(half + (order * places)[::order], 0.0, self.face_width)
        integrals = bspline_integrals(self.knots, counted)[::order]
        tables = np.concatenate([self.self_compliance[None], self.cross_compliance])
        over_face = integrals @ tables @ integrals.T
        radii = self._radius_knots
        inverse = np.linalg.inv(bspline_values(radii, self.curvature_radius**2))
        first = np.tensordot(over_face, inverse, (1, 1))
        coefficients = np.tensordot(first, inverse, (1, 1))
        return SlicedInfluence(
            radius_knots=radii,
            widths=np.diff(places),
            coefficients=np.ascontiguousarray(coefficients),
        )

    def __repr__(self) -> str:
        """One line with the ranges."""
        low, high = self.curvature_radius[[0, -1]] * 1e3
        return (
            f"FaceInfluence({self.curvature_radius.size} nodes from {low:.4g} to {high:.4g} mm, "
            f"{self.knots.size - 4} functions over {self.face_width * 1e3:.4g} mm, "
            f"{self.neighbours} neighbours)"
        )


@dataclass(frozen=True, eq=False)
class SlicedInfluence:
    """Compliances of one gear between slices of its face; made by :meth:`FaceInfluence.sliced`.

    Parameters
    ----------
    radius_knots : array (r,) [m^2]
        Knots over the square of the radius of curvature.
    widths : array (s,) [m]
        Widths of the slices.
    coefficients : array (N + 1, s, s, K, K) [m^3/N]
        ``[neighbour, loaded slice, displaced slice, loaded radius, displaced radius]``: mean
        displacement of a slice times its width per load per width.
    """

    radius_knots: Array
    widths: Array
    coefficients: Array

    def fill(self, out: Array, radii: Array, sense: int) -> None:
        """Add the compliance of this gear between all contacts.

        Parameters
        ----------
        out : array (p, c, c) [m^2/N]
            ``[phase, displaced, loaded]``, contacts ``c = pair * slices + slice``: mean
            displacement of a slice per load per width of another, without the local compression.
        radii : array (p, pairs, slices) [m]
            Radius of curvature of each contact, of a ring with any sign; beyond the nodes, the
            nearest node counts.
        sense : int
            1 where the next pair has the larger radii of curvature on this gear, otherwise -1.

        Raises
        ------
        InputError
            If the shapes disagree or ``sense`` is another number.
        """
        from tribodyn.stiffness.teeth.face_kernel import fill_compliance

        phases, pairs, slices = radii.shape
        contacts = pairs * slices
        if slices != self.widths.size or out.shape != (phases, contacts, contacts):
            raise InputError(
                f"radii of the shape {radii.shape}, compliance of the shape {out.shape}",
                where=Argument("out"),
                why=f"There are {self.widths.size} slices; the compliance has a row and a column "
                "for each slice of each pair at each phase",
                remedy="Give arrays of these shapes",
            )
        if sense not in (1, -1):
            why = "The next pair has larger radii of curvature or smaller ones"
            raise InputError(f"sense = {sense}", Argument("sense"), why, "Give 1 or -1")
        fill_compliance(
            self.coefficients,
            self.radius_knots,
            self.widths,
            np.ascontiguousarray(radii, dtype=float),
            sense,
            out,
        )


def _unusable(what: str) -> InputError:
    return InputError(
        what,
        where="FaceInfluence",
        why="It needs at least four increasing nodes, four functions over the face and one finite "
        "table of nodes by nodes by functions by functions for each tooth",
        remedy="Check the provider of the compliances",
    )
