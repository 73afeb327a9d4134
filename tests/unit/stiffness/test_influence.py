"""The table of what loads on one gear do: interpolation, reciprocity, and its refusals."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.stiffness import GearInfluence

RHO = np.linspace(0.01, 0.02, 9)


def table() -> GearInfluence:
    """Cubic in the place of the load and of what is seen, so that splines are exact."""
    cross = np.stack([RHO[:, None] ** 3 + 2.0 * n * RHO[None, :] ** 2 for n in (1, 2)])
    return GearInfluence(RHO, 1.0 + RHO**3, cross)


def test_between_nodes_a_cubic_is_exact():
    place = np.array([0.0101, 0.0143, 0.0199])
    assert table().at(place) == pytest.approx(1.0 + place**3, rel=1e-13)
    other = place[::-1]
    expected = place**3 + 4.0 * other**2
    assert table().between(place, other, 2) == pytest.approx(expected, rel=1e-10)


def test_the_other_side_follows_from_reciprocity():
    influence = table()
    assert influence.between(0.012, 0.017, -1) == pytest.approx(influence.between(0.017, 0.012, 1))
    assert influence.between(0.012, 0.017, -1) != pytest.approx(influence.between(0.012, 0.017, 1))


def test_teeth_beyond_the_stored_neighbours_do_not_move():
    assert table().neighbours == 2
    assert table().between(np.full(3, 0.012), 0.017, -3).tolist() == [0.0, 0.0, 0.0]


def test_rounding_is_brought_back_and_more_is_refused():
    assert table().at(0.02 + 1e-13) == pytest.approx(1.0 + 0.02**3, rel=1e-12)
    with pytest.raises(InputError, match="known from 10 to 20 mm"):
        table().at(0.0201)
    with pytest.raises(InputError, match="neighbour = 0"):
        table().between(0.012, 0.012, 0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"self_compliance": np.ones(8)}, "shapes"),
        ({"cross_compliance": np.ones((1, 9, 8))}, "shapes"),
        ({"curvature_radius": RHO[::-1]}, "do not increase"),
        ({"self_compliance": np.zeros(9)}, "not positive"),
        ({"cross_compliance": np.full((1, 9, 9), np.nan)}, "not finite"),
    ],
)
def test_unusable_tables_are_refused(change, message):
    good = {"curvature_radius": RHO, "self_compliance": np.ones(9)}
    with pytest.raises(InputError, match=message):
        GearInfluence(**{**good, "cross_compliance": np.ones((1, 9, 9)), **change})


def test_range_is_described_in_one_line():
    assert repr(table()).startswith("GearInfluence(9 nodes from 10 to 20 mm")
