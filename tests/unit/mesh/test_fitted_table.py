"""Polynomials fitted to solved contacts: exact, without the ripple of the nodes."""

import numpy as np
import pytest

from tribodyn.mesh.film.film_table import FittedTable


def smooth(places):
    first, second = places[0], places[-1]
    return np.stack([1.0 + 0.3 * first - 0.2 * first * second**2 + 0.05 * second**4, first + 2.0])


def rippled(places, share=0.02):
    tips = 7.3 * places[0] + 1.9 * places[-1]
    return places, smooth(places) * 1.0 + share * np.cos(2.0 * np.pi * tips + 0.7), tips


@pytest.mark.parametrize("dimensions", [2, 3])
def test_the_fit_leaves_out_the_ripple_of_the_nodes(dimensions):
    table = FittedTable(rippled, dimensions)
    places = np.random.default_rng(1).uniform(-1.0, 2.0, (dimensions, 200))
    np.testing.assert_allclose(table(places), smooth(places), rtol=0.0, atol=1e-10)
    # What a place has does not depend on the places before it.
    again = FittedTable(rippled, dimensions)
    np.testing.assert_allclose(again(places[:, :1]), table(places)[:, :1], rtol=1e-13)
    assert table.solved > again.solved


def test_places_without_enough_solutions_have_no_values():
    def failing(places):
        at, rows, tips = rippled(places)
        return at, np.where(places[0] > 1.0, np.nan, rows), tips

    values = FittedTable(failing, 2)(np.array([[0.5, 1.5], [0.5, 0.5]]))
    assert np.isfinite(values[:, 0]).all()
    assert np.isnan(values[:, 1]).all()
    few = FittedTable(lambda places: (places, np.where(places[0] > 0.9, np.nan, smooth(places)),
                                      7.0 * places[0]), 2)  # fmt: skip
    at = np.array([[0.4], [0.6]])
    np.testing.assert_allclose(few(at), smooth(at), atol=1e-10)
