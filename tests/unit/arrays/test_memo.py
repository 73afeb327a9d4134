"""Values that are remembered by what is in their arrays."""

from __future__ import annotations

import numpy as np

from tribodyn.arrays.memory import Memo


def test_a_value_is_computed_once_for_equal_arrays_and_anew_for_others() -> None:
    memo: Memo[float] = Memo(2)
    computed_for = []

    def total(array: np.ndarray) -> float:
        def compute() -> float:
            computed_for.append(array.copy())
            return float(array.sum())

        return memo.get((array,), compute)

    first, second = np.array([1.0, 2.0, 3.0]), np.array([5.0, 2.0, 3.0])
    assert [total(first), total(first.copy()), total(second), total(first)] == [6.0, 6.0, 10.0, 6.0]
    assert len(computed_for) == 2
    first[0] = 2.0  # what is remembered does not follow its array
    assert total(first) == 7.0
    assert total(first[:2]) == 4.0
    assert total(np.empty(0)) == total(np.empty(0)) == 0.0
    assert len(computed_for) == 5
    assert total(second) == 10.0  # of which only the last two are known
    assert len(computed_for) == 6
