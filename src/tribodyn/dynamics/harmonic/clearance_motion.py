"""Steady motion with supports that hold a point only beyond a radial clearance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from tribodyn.arrays.linear_algebra import periodic
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.harmonic_balance import TOLERANCE, harmonic_balance
from tribodyn.dynamics.harmonic.phase_balance import phase_balance
from tribodyn.dynamics.harmonic.radial_clearance import REMEDY, RadialClearance
from tribodyn.dynamics.time.response import Response
from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    ModelWarning,
    collected,
    warn,
)
from tribodyn.types import Array

#: Change of a displacement over its size that ends the search, and the most passes of it; steps by
#: default.
_SAME, _PASSES, _STEPS = 1e-8, 40, 200


def clearance_motion(
    system: System,
    supports: Sequence[RadialClearance],
    frequency: float | Sequence[float] | Array,
    *,
    steps: int | Sequence[int] = 200,
    start: Response | None = None,
) -> Response:
    """Find the steady motion of a system with further supports that have a radial clearance.

    Parameters
    ----------
    system : System
        Without these supports.
    supports : sequence of RadialClearance
        Supports; their contacts are behind those of the system, two for each.
    frequency : float or (phases,) array
        Frequency of the clock, or of each phase of a system over several [Hz].
    steps : int or sequence of int
        Steps per cycle of the fastest contact; over several phases the points of each, which 200,
        the default, leaves to the search.
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
    Over several phases supports are contacts of their own: the forces of the last two contacts of
    the motion are those in the direction of its mean load and across it.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pin = RadialClearance([[1.0, 0.0], [0.0, 1.0]], 1e8, 20e-6)
    >>> mesh = Contact([1.0, 0.0], 1e3, error=lambda phase: 1e-6 * np.cos(2 * np.pi * phase))
    >>> body = System(np.eye(2), 1e3 * np.eye(2), np.zeros((2, 2)), [0.0, 1e3], [mesh])
    >>> clearance_motion(body, [pin], 5.0).position[0, 1:].round(7)  # c + F/k
    array([3.e-05])
    """
    for support in supports:
        if np.asarray(support.directions).shape[1] != system.size:
            what = f"a support has {np.asarray(support.directions).shape[1]} coordinates"
            why = f"The system has {system.size}"
            remedy = "Give directions with one column for each"
            raise InputError(what, Argument("supports"), why, remedy)
    if system.phases:
        points = None if steps == _STEPS else steps
        return phase_balance(system, frequency, points, start, TOLERANCE, supports)
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
            with collected() as remarks:  # those about the last pass hold
                response = harmonic_balance(
                    replace(system, contacts=contacts), frequency, steps=steps, start=response
                )
        except ComputationError as error:
            what = f"no motion in the clearances of {len(supports)} supports is found"
            why = f"At its last approximation {error.problems[0].what}"
            raise ComputationError(what, "clearance_motion", why, REMEDY) from None
        grid = response.fine.phase
        moved = [support.displacement(response.fine.position) for support in supports]
        if not paths:  # the load that pushes the point beyond its clearance
            paths = [_pushed(d, s.clearance) for d, s in zip(moved, supports, strict=True)]
            if not any(support.clearance for support in supports):
                return _with(remarks, response)
            continue
        change = max(
            float(np.abs(new - old).max()) / (support.clearance + float(np.abs(new).max()))
            for new, old, support in zip(moved, paths, supports, strict=True)
        )
        if change <= _SAME:
            return _with(remarks, response)
        share = max(0.5 * share, 0.05) if change > last else min(1.0, 2.0 * share)
        last = change
        paths = [old + share * (new - old) for new, old in zip(moved, paths, strict=True)]
    what = f"the motion in the clearances of {len(supports)} supports does not settle"
    why = f"After {_PASSES} passes the displacements change by {change:.2g} of their size"
    raise ComputationError(what, "clearance_motion", why, REMEDY)


def _with(remarks: Sequence[ModelWarning], response: Response) -> Response:
    for each in remarks:
        warn(each.code, each.message, stacklevel=3)
    return response


def _pushed(displacement: Array, clearance: float) -> Array:
    """Displacement with the clearance added in its direction."""
    size = np.linalg.norm(displacement, axis=1, keepdims=True)
    return np.asarray(displacement * (1.0 + clearance / np.maximum(size, 1e-300)))


def _on_grid(grid: Array, path: Array) -> Callable[[Array], Array]:
    """Displacement over the phase of the clock between its samples."""
    order = np.argsort(grid % 1.0, kind="stable")
    at, values = (grid % 1.0)[order], path[order]

    return lambda phase: periodic(phase, at, values)
