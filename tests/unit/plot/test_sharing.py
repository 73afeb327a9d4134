"""Where the number of tooth pairs in contact changes, counted pair by pair."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tribodyn.plot.theme.path import further_changes, sharing_sentence

RATIOS = pytest.mark.parametrize("ratio", [1.33, 1.9, 2.0, 2.214, 2.75, 3.4])


def pairs(ratio: float, age: float) -> int:
    """Tooth pairs in contact while one of them has an age."""
    return sum(0.0 <= age + other < ratio for other in range(-9, 10))


@RATIOS
def test_every_change_is_marked_and_nothing_else(ratio: float) -> None:
    marks = {0.0, ratio - 1.0, 1.0, ratio, *further_changes(ratio).values()}
    assert all(0.0 <= age <= ratio for age in marks)
    step = 1e-6
    ages = np.sort(list(marks))
    for before, after in pairwise(ages):
        inside = {pairs(ratio, age) for age in np.linspace(before + step, after - step, 7)}
        assert len(inside) == 1
    if ratio != 2.0:  # there one pair enters just as another leaves
        for age in ages[1:-1]:
            assert pairs(ratio, age - step) != pairs(ratio, age + step)


@RATIOS
def test_sentence_names_the_numbers_of_pairs(ratio: float) -> None:
    number_words = ("no", "one", "two", "three", "four")
    counts = {pairs(ratio, age) for age in np.linspace(1e-6, ratio - 1e-6, 997)}
    sentence = sharing_sentence(ratio).lower()
    for count in counts:
        assert number_words[count] in sentence or str(count) in sentence
    assert ("alone" in sentence) == (1 in counts)
