"""Teeth and oil film in series: the stiffness of each tooth pair and the load that it takes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribodyn.errors import ComputationError, Problem, quiet
from tribodyn.mesh.path_film import FilmAt
from tribodyn.mesh.solved_places import ALL, PRESSURE, STIFFNESS
from tribodyn.mesh.teeth import Carried, Teeth
from tribodyn.types import Array, Mask

#: Films of the loads given, with the quantities in which they are checked between the positions.
FilmOf = Callable[[Array, tuple[int, ...]], FilmAt]

#: The film is solved anew until the load shares move by less than this.
_TOLERANCE = 1e-6
#: Where pairs are solved together one may be about to lose its load to its film: there it is this.
_TOLERANCE_TOGETHER = 1e-5
_PASSES = 60
#: What is checked between the positions, first and whenever the shares have settled. At last the
#: stiffness stays as it is, so that an end is reached where a pair is about to lose its load.
_STAGES = ((STIFFNESS,), ALL, ALL, ALL[:STIFFNESS])
#: Part of the last change to which the next shares settle.
_ENOUGH = 1e-3
#: Between two solutions the shares settle to this; each pass gains one digit or two, and after
#: every few of them the limit is extrapolated.
_SETTLED = 1e-13
#: Pairs that are solved together are solved to this.
_SETTLED_TOGETHER = 1e-9
_STEPS = 300
#: Steps that tell a slope, and bounds of that slope: 1 is a share that does not act on itself.
_TOLD, _FALLS, _FALLS_OF_PASSES = 1e-11, (0.2, 50.0), (0.4, 3.0)
_ROUND = 4
#: Change of the steps, relative to them, without which nothing can be extrapolated.
_BENT = 1e-3
#: Load share below which a pair has lost its load to a film that is softer than its teeth.
_LOST = 1e-9


def in_series(
    teeth: Teeth,
    total_load: float,
    film_of: FilmOf,
    where: Callable[[int, int], str],
) -> tuple[Carried, FilmAt]:
    """Put the film of each pair in series with its teeth, at the load share that follows."""
    tolerance = _TOLERANCE_TOGETHER if teeth.stiffness is None else _TOLERANCE
    share, stages = teeth.carried().share, list(_STAGES)
    checked, change = stages.pop(0), 1.0
    before, step, slope = share, np.zeros(share.shape), np.ones(share.shape)
    for _ in range(_PASSES):
        film_at = film_of(total_load * share, checked)
        enough = _ENOUGH * min(change, 1.0)
        carried = _settle(teeth, total_load, film_at, share, where, enough)
        earlier, step = step, carried.share - share
        change = float(np.max(np.abs(step)))
        if change < tolerance and PRESSURE in checked:
            return carried, film_at
        checked = stages.pop(0) if change < tolerance and stages else ()
        slope = _secant(share - before, step - earlier, slope, _FALLS_OF_PASSES)
        before, share = share, np.clip(share + step / slope, 0.0, 1.0)
    raise _unsettled(f"the load share still moves by {change:.2g} after {_PASSES} solutions")


def _settle(
    teeth: Teeth,
    total_load: float,
    film_at: FilmAt,
    share: Array,
    where: Callable[[int, int], str],
    enough: float,
) -> Carried:
    """Find the fixed point of share and stiffness with the films as a function of their load."""
    if teeth.stiffness is None:
        return _settle_together(teeth, total_load, film_at, share, where, enough)
    earlier = [share]
    loaded = teeth.in_contact & (share > _LOST)
    for _ in range(_STEPS):
        carried = teeth.carried(_film_stiffness(teeth.in_contact, total_load * share, film_at))
        share = carried.share
        change = np.abs(share - earlier[-1])
        if change.max() < _SETTLED:
            return carried
        lost = loaded & (share < _LOST)
        if lost.any():
            row, pair = np.argwhere(lost)[0]
            raise _unsettled(f"{where(row, pair)} loses its whole load to its film")
        earlier.append(share)
        if len(earlier) == _ROUND:
            share = _extrapolated(earlier, teeth.in_contact)
            earlier = [share]
    raise _still_moving(change, where)


def _settle_together(
    teeth: Teeth,
    total_load: float,
    film_at: FilmAt,
    share: Array,
    where: Callable[[int, int], str],
    enough: float,
) -> Carried:
    """The same for pairs solved together; a share that swings to and fro is slowed down."""
    least = teeth.least_share * total_load
    before, step = share, np.zeros(share.shape)
    slope = np.ones(share.shape)
    for _ in range(_STEPS):
        load = np.maximum(total_load * share, least)
        carried = teeth.carried(_film_stiffness(teeth.in_contact, load, film_at))
        earlier, step = step, carried.share - share
        if np.abs(step).max() < max(enough, _SETTLED_TOGETHER):
            return carried
        slope = _secant(share - before, step - earlier, slope, _FALLS)
        before, share = share, np.clip(share + step / slope, 0.0, 1.0)
    raise _still_moving(np.abs(step), where)


def _secant(moved: Array, change: Array, slope: Array, bounds: tuple[float, float]) -> Array:
    """Fall of the step over the share, within bounds that neither stop it nor let it jump."""
    told = np.abs(moved) > _TOLD
    fall = -change / np.where(told, moved, 1.0)
    return np.where(told, np.clip(fall, *bounds), slope)


def _still_moving(change: Array, where: Callable[[int, int], str]) -> ComputationError:
    row, pair = np.unravel_index(int(np.argmax(change)), change.shape)
    return _unsettled(
        f"the load share of {where(int(row), int(pair))} still moves by {change.max():.2g} after "
        f"{_STEPS} steps"
    )


def _film_stiffness(in_contact: Mask, load_per_width: Array, film_at: FilmAt) -> Array:
    """Stiffness of the films, zero where the pair is not in contact."""
    with quiet():
        # What a formula has to say, it says of the load share that is found.
        film = film_at(load_per_width[in_contact]).film_stiffness
    stiffness = np.zeros(load_per_width.shape)
    stiffness[in_contact] = np.asarray(film)
    return stiffness


def _extrapolated(earlier: list[Array], in_contact: Mask) -> Array:
    """Limit of the last three shares by the rule of Aitken, where it lies nearby."""
    first, second, third = earlier[-3:]
    step, bend = third - second, third - 2.0 * second + first
    safe = np.where(np.abs(bend) > _BENT * np.abs(step), bend, 1.0)
    limit = np.where(np.abs(bend) > _BENT * np.abs(step), third - step * step / safe, third)
    limit = np.where(in_contact & (limit > 0.5 * third), limit, third)
    return np.asarray(limit * (third.sum(axis=1) / limit.sum(axis=1))[:, None])


def _unsettled(what: str) -> ComputationError:
    return ComputationError(
        Problem(
            what=what,
            where="film stiffness in series with the teeth",
            why="The film of a lightly loaded pair is softer than its teeth",
            remedy='Give more torque, or set film.stiffness = "none"',
        )
    )
