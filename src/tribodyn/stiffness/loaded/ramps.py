"""Ramps that add up to the force of a mesh over its deflection, fitted to the loaded contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tribodyn.errors import warn
from tribodyn.stiffness.loaded.problem import ContactProblem, Equilibrium, WideContactError
from tribodyn.types import Array

#: What is aimed at, for the error between the deflections that are looked at.
_AIM = 1e-3
#: Range of the force, over the load of the mesh, in which the error counts; and where the law ends
#: and goes on straight: the first load that the formula of the local compression covers.
_RANGE, _LAST = (0.1, 3.0), (4.0, 3.0, 2.5, 2.0, 1.5, 1.25, 1.0)
#: Deflections of the points of a law about the load, over that under the load.
_ABOUT_LOAD = np.array([0.3, 0.55, 0.75, 0.9, 1.0, 1.12, 1.3, 1.6, 2.1])
#: Deflections that are looked at, over that at the end, from the first touch on.
_LOOKED_AT = np.geomspace(0.02, 1.0, 45)
#: Slices, from the first to the last that touches, whose pairs are followed.
_SLICES = 7
#: Most deflections that become points.
_MOST = 30
#: Distance of two points, over the largest deflection, below which they are one.
_SAME = 1e-9
#: Stiffness of a ramp over the whole one that is rounding.
_FAINT = 1e-9


def ramps_about(problem: ContactProblem, loaded: Array) -> tuple[Array, Array]:
    """Few ramps that are exact at approaches under load (p,): places [m], stiffnesses [N/m]."""
    first = problem.least_gap
    approach = first + _ABOUT_LOAD[:, None] * (loaded - first)
    force, tangent = problem.at_approach(approach)
    return _chords(first, approach.T, force.T, tangent[-1])


def force_ramps(problem: ContactProblem, total_force: float) -> tuple[Array, Array, float]:
    """Fit ramps to the force over the deflection of a mesh; at last their greatest error."""
    parts = problem.compliance
    if parts.logarithm == 0.0 and not problem.places.contact.pair.has_modification:
        # Springs that all touch at once: one ramp, exactly.
        total_stiffness = problem.tangent_at(np.where(problem.places.on_path, 1.0, 0.0))
        return problem.least_gap[:, None], total_stiffness[:, None], 0.0
    last = _last_equilibrium(problem, total_force)
    first = problem.least_gap
    approach = first + _LOOKED_AT[:, None] * (last.approach[0] - first)
    force = problem.at_approach(approach)[0]
    counts = (force >= _RANGE[0] * total_force) & (force <= _RANGE[1] * total_force)
    # Slices of a line come into play one after the other, so that no kink is left.
    no_kinks = np.zeros((first.size, 0)), np.zeros((first.size, 0))
    kinks = no_kinks if problem.places.is_sliced else _kinks(problem, approach[-1])
    chosen = [0, _LOOKED_AT.size // 2, _LOOKED_AT.size - 1]
    while True:
        points = np.concatenate([approach[chosen].T, kinks[0]], axis=1)
        forces = np.concatenate([force[chosen].T, kinks[1]], axis=1)
        place, slope = _chords(first, points, forces, last.tangent[0])
        error = np.where(counts, np.abs(_force(place, slope, approach) / force - 1.0), 0.0)
        worst = int(np.argmax(error.max(axis=1)))
        if error.max() < _AIM or worst in chosen or len(chosen) >= _MOST:
            break
        chosen = sorted([*chosen, worst])
    return place, slope, float(error.max())


def _last_equilibrium(problem: ContactProblem, total_force: float) -> Equilibrium:
    """What the mesh does where its force law ends, with a warning if that is near its load."""
    for times in _LAST:
        try:
            last = problem.at_loads(np.array([times * total_force]))
            break
        except WideContactError:
            if times == _LAST[-1]:
                raise
    if times < _RANGE[1]:
        warn(
            "force-law",
            f"the force law of the mesh is computed up to {times:g} times its load and goes on "
            "straight: beyond, the contact is as wide as the teeth are thick",
            stacklevel=4,
        )
    return last


def _kinks(problem: ContactProblem, most: Array) -> tuple[Array, Array]:
    """Deflection (n, kinks) at which each pair begins to carry in a slice, and the force there."""
    order = np.argsort(problem.gaps.mean(axis=(0, 2)))
    slices = order[np.unique(np.linspace(0, order.size - 1, _SLICES).round().astype(int))]
    pickups = [replace(problem, gaps=problem.gaps[:, [s]]).pickups(most) for s in slices]
    pairs = np.concatenate(pickups, axis=1)
    # Pairs that never come into play within the range would be points without use.
    pairs = pairs[:, (pairs < most[:, None] * (1.0 - _SAME)).any(axis=0)]
    return pairs, problem.at_approach(pairs.T)[0].T


def _chords(first: Array, points: Array, forces: Array, last_slope: Array) -> tuple[Array, Array]:
    """Ramps from the first touch through all points, each column following its own point."""
    place = np.concatenate([first[:, None], points], axis=1)
    force = np.concatenate([np.zeros((first.size, 1)), forces], axis=1)
    order = np.argsort(place, axis=1, kind="stable")
    x, y = np.take_along_axis(place, order, 1), np.take_along_axis(force, order, 1)
    slope = np.zeros_like(x)
    width, rise = np.diff(x, axis=1), np.diff(y, axis=1)
    distinct = width > _SAME * (x[:, -1:] - x[:, :1])
    slope[:, :-1] = np.where(distinct, rise / np.where(distinct, width, 1.0), np.nan)
    slope[:, -1] = last_slope
    # Of several points in one place the first has the slope of the chord that follows.
    for column in range(x.shape[1] - 2, -1, -1):
        unknown = np.isnan(slope[:, column])
        slope[unknown, column] = slope[unknown, column + 1]
    slope = np.maximum.accumulate(slope, axis=1)
    added = np.diff(slope, axis=1, prepend=0.0)
    # What rounding leaves between points in one place would only be carried along.
    added[added < _FAINT * last_slope[:, None]] = 0.0
    stiffness = np.empty_like(added)
    np.put_along_axis(stiffness, order, added, 1)
    return place, stiffness


def _force(place: Array, slope: Array, approach: Array) -> Array:
    """Force of the law (d, n) at approaches (d, n)."""
    beyond = np.maximum(approach[:, :, None] - place, 0.0)
    return np.asarray((slope * beyond).sum(axis=2))
