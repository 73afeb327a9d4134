"""Products of a small matrix and many vectors."""

import numpy as np
import pytest

from tribodyn.arrays.linear_algebra import times

RANDOM = np.random.default_rng(3)
MATRIX = RANDOM.standard_normal((4, 3))


@pytest.mark.parametrize("lead", [0, 1])
@pytest.mark.parametrize("shape", [(5, 7, 3), (5, 7, 2, 3), (5, 1, 1, 3)])
def test_it_is_the_product_of_every_vector(shape: tuple[int, ...], lead: int) -> None:
    vectors = RANDOM.standard_normal(shape)
    product = times(vectors, MATRIX, lead)
    assert product == pytest.approx(vectors @ MATRIX.T, rel=1e-14)


@pytest.mark.parametrize("lead", [0, 1])
def test_each_item_of_all_vectors_lies_side_by_side(lead: int) -> None:
    products = times(RANDOM.standard_normal((5, 7, 3)), MATRIX, lead)
    for item in range(4):
        item_values = products[..., item]
        assert (item_values[0] if lead else item_values.reshape(-1)).flags.c_contiguous
        assert np.shares_memory(item_values.reshape(item_values.shape), products)
