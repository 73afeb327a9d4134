"""Teeth and oil film in series: the stiffness of each tooth pair and the load that it takes."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np

from tribodyn.errors import ComputationError, ModelWarning, Problem
from tribodyn.mesh.path_film import FilmAt
from tribodyn.mesh.teeth import Carried, Teeth
from tribodyn.types import Array, Mask

#: The film is solved anew until the load shares move by less than this.
_TOLERANCE = 1e-6
_PASSES = 20
#: Between two solutions the shares settle to this; each pass gains one digit or two, and after
#: every few of them the limit is extrapolated.
_SETTLED = 1e-13
#: Pairs that are solved together are solved to this.
_SETTLED_TOGETHER = 1e-9
_STEPS = 200
_ROUND = 4
#: Change of the steps, relative to them, without which nothing can be extrapolated.
_BENT = 1e-3
#: Load share below which a pair has lost its load to a film that is softer than its teeth.
_LOST = 1e-9


def in_series(
    teeth: Teeth,
    total_load: float,
    film_of: Callable[[Array], FilmAt],
    where: Callable[[int, int], str],
) -> tuple[Carried, FilmAt]:
    """Put the film of each pair in series with its teeth, at the load share that follows."""
    share = teeth.carried().share
    for _ in range(_PASSES):
        film_at = film_of(total_load * share)
        carried = _settle(teeth, total_load, film_at, share, where)
        change = float(np.max(np.abs(carried.share - share)))
        share = carried.share
        if change < _TOLERANCE:
            return carried, film_at
    raise _unsettled(f"the load share still moves by {change:.2g} after {_PASSES} solutions")


def _settle(
    teeth: Teeth,
    total_load: float,
    film_at: FilmAt,
    share: Array,
    where: Callable[[int, int], str],
) -> Carried:
    """Find the fixed point of share and stiffness with the films as a function of their load."""
    if teeth.stiffness is None:
        return _settle_together(teeth, total_load, film_at, share, where)
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
) -> Carried:
    """The same for pairs solved together; a share that swings to and fro is slowed down."""
    least = teeth.least_share * total_load
    pace, before = np.ones(share.shape), np.zeros(share.shape)
    for _ in range(_STEPS):
        load = np.maximum(total_load * share, least)
        carried = teeth.carried(_film_stiffness(teeth.in_contact, load, film_at))
        step = carried.share - share
        if np.abs(step).max() < _SETTLED_TOGETHER:
            return carried
        pace = np.where(step * before < 0.0, 0.5 * pace, np.minimum(1.1 * pace, 1.0))
        share, before = share + pace * step, step
    raise _still_moving(np.abs(step), where)


def _still_moving(change: Array, where: Callable[[int, int], str]) -> ComputationError:
    row, pair = np.unravel_index(int(np.argmax(change)), change.shape)
    return _unsettled(
        f"the load share of {where(int(row), int(pair))} still moves by {change.max():.2g} after "
        f"{_STEPS} steps"
    )


def _film_stiffness(in_contact: Mask, load_per_width: Array, film_at: FilmAt) -> Array:
    """Stiffness of the films, zero where the pair is not in contact."""
    with warnings.catch_warnings():
        # What a formula has to say, it says of the load share that is found.
        warnings.simplefilter("ignore", ModelWarning)
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
