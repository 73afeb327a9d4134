"""Within which limits the best tip relief is searched, and over which torques."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.gear import SpurPair, default_relief_length, flank_ranges
from tribodyn.gear.modification_checks import LARGEST_AMOUNT
from tribodyn.stiffness.harris import increasing_torques
from tribodyn.types import Array

#: Torques of a range that is given by its ends.
_TORQUES = 5
#: Lengths searched by default, over that where the number of pairs changes.
_LENGTHS = (0.2, 2.0)
#: Amounts searched by default, over the mean deflection under the greatest torque.
_AMOUNT = 2.0
_CHOICES = {
    "gears": ("both", "pinion", "wheel"),
    "shape": ("linear", "parabolic"),
    "objective": ("largest", "mean"),
}


def check_choices(grid: tuple[int, int], **chosen: str) -> None:
    """Refuse words that are not known, and a map without points."""
    problems = [
        Problem(
            what=f'{name} = "{value}"',
            where=Argument(name),
            why=f"Allowed: {', '.join(_CHOICES[name])}",
            remedy="Choose one of these",
        )
        for name, value in chosen.items()
        if value not in _CHOICES[name]
    ]
    if len(grid) != 2 or min(grid) < 2:
        why = "The map has at least two amounts and two lengths"
        problems.append(
            Problem(f"grid = {grid}", Argument("grid"), why, "Give for example (17, 11)")
        )
    if problems:
        raise InputError(problems)


def torques_and_weights(torque: ArrayLike, weight: ArrayLike | None) -> tuple[Array, Array]:
    """Torques of a range and their weights."""
    given = np.atleast_1d(np.asarray(torque, dtype=float))
    ordered = increasing_torques(given)
    torques = ordered
    if ordered.size == 2:
        torques = np.linspace(ordered[0], ordered[1], _TORQUES)
    if weight is None:
        return torques, np.full(torques.size, 1.0 / torques.size)
    weights = np.atleast_1d(np.asarray(weight, dtype=float))
    fits = weights.shape == given.shape == ordered.shape and np.all(weights >= 0.0)
    if not (fits and 0.0 < weights.sum() < np.inf):
        raise InputError(
            Problem(
                what=f"weight = {weights.tolist()}",
                where=Argument("weight"),
                why="There is one weight for each torque, none negative and not all zero",
                remedy=f"Give {given.size} weights for {given.size} different torques",
            )
        )
    spread = np.interp(torques, ordered, weights[np.argsort(given)])
    return torques, spread / spread.sum()


def relief_axes(
    pair: SpurPair,
    amount: tuple[float, float] | None,
    length: tuple[float, float] | None,
    deflection: float,
    grid: tuple[int, int],
) -> list[Array]:
    """Amounts and lengths of the map, from the least to the greatest that are searched."""
    flank = flank_ranges(pair)[0].length
    if amount is None:
        amount = (0.0, min(_AMOUNT * deflection, LARGEST_AMOUNT))
    if length is None:
        usual = default_relief_length(pair)
        length = (_LENGTHS[0] * usual, min(_LENGTHS[1] * usual, flank))
    problems = []
    if not 0.0 <= amount[0] < amount[1] <= LARGEST_AMOUNT:
        shown = " to ".join(f"{value * 1e6:.6g}" for value in amount)
        why = f"Amounts increase, from zero or more to at most {LARGEST_AMOUNT * 1e6:g} um"
        where = Argument("amount")
        problems.append(Problem(f"amount = {shown} um", where, why, "Check values and unit"))
    if not 0.0 < length[0] < length[1] <= flank * (1.0 + 1e-9):
        shown = " to ".join(f"{value * 1e3:.6g}" for value in length)
        why = f"Lengths increase, above zero and up to the used flank of {flank * 1e3:.6g} mm"
        where = Argument("length")
        problems.append(Problem(f"length = {shown} mm", where, why, "Search shorter reliefs"))
    if problems:
        raise InputError(problems)
    return [np.linspace(*ends, count) for ends, count in zip((amount, length), grid, strict=True)]
