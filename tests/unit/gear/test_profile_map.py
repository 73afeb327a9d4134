"""Measured maps of a flank: what is read between their points, and which are refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import ProfileMap

PLACES, FACES = (10e-3, 12e-3, 15e-3, 20e-3), (-8e-3, -2e-3, 3e-3, 9e-3)
BASE = 40e-3


def chart(function: Any, **options: Any) -> ProfileMap:
    rows = tuple(tuple(float(function(x, y)) for y in FACES) for x in PLACES)
    return ProfileMap(PLACES, FACES, rows, **options)


def test_points_are_stored() -> None:
    rng = np.random.default_rng(1)
    values = 1e-6 * rng.standard_normal((4, 4))
    rows = tuple(tuple(row) for row in values)
    for kind in ("linear", "cubic"):
        measured = ProfileMap(PLACES, FACES, rows, interpolation=kind)
        x, y = np.meshgrid(PLACES, FACES, indexing="ij")
        assert measured.at(x, y, base_radius=BASE) == pytest.approx(values, abs=1e-18)


def test_linear_is_bilinear() -> None:
    plane = chart(lambda x, y: 1e-6 + 1e-4 * x - 3e-4 * y + 1e-2 * x * y)
    at = plane.at([11e-3, 18e-3], [0.5e-3, -7e-3], base_radius=BASE)
    expected = [1e-6 + 1e-4 * x - 3e-4 * y + 1e-2 * x * y
                for x, y in ((11e-3, 0.5e-3), (18e-3, -7e-3))]  # fmt: skip
    assert at == pytest.approx(expected, rel=1e-9)


def test_cubic_follows_a_cubic() -> None:
    def shape(x: float, y: float) -> float:
        return 1e-6 * (1e2 * x) ** 3 - 1e-6 * (1e2 * y) ** 2

    curved = chart(shape, interpolation="cubic")
    assert float(curved.at(17e-3, 1e-3, base_radius=BASE)) == pytest.approx(shape(17e-3, 1e-3))
    straight = float(chart(shape).at(17e-3, 1e-3, base_radius=BASE))
    assert straight != pytest.approx(shape(17e-3, 1e-3), rel=1e-3)


def test_places_may_be_diameters() -> None:
    diameters = tuple(2.0 * math.hypot(BASE, place) for place in (10e-3, 20e-3))
    measured = ProfileMap(diameters, (0.0,), ((0.0,), (8e-6,)), coordinate="diameter")
    assert measured.limits(BASE) == pytest.approx((10e-3, 20e-3), rel=1e-12)
    middle = 0.5 * (diameters[0] + diameters[1])
    radius = math.sqrt(0.25 * middle**2 - BASE**2)
    assert float(measured.at(radius, 3e-3, base_radius=BASE)) == pytest.approx(4e-6)


def test_one_profile_holds_over_the_whole_face() -> None:
    measured = ProfileMap((10e-3, 20e-3), (2e-3,), ((0.0,), (8e-6,)))
    at = measured.at(15e-3, np.array([-9e-3, 2e-3, 9e-3]), base_radius=BASE)
    assert at == pytest.approx([4e-6, 4e-6, 4e-6], rel=1e-12)


def test_beyond_the_edge_is_as_at_the_edge() -> None:
    tilted = chart(lambda x, y: 1e-4 * x + 1e-4 * y)
    inside = tilted.at([10e-3, 20e-3], [-8e-3, 9e-3], base_radius=BASE)
    beyond = tilted.at([5e-3, 30e-3], [-20e-3, 20e-3], base_radius=BASE)
    assert np.array_equal(inside, beyond)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        (
            ((1.0, 2.0), (0.0,), ((0.0,),)),
            "1 rows of 1 values for 2 places along the profile",
        ),
        (((1.0, 2.0), (0.0, 1.0), ((0.0,), (0.0, 1e-6))), "2 rows of 1 or 2 values"),
        (((1.0,), (0.0,), ((0.0,),)), "two or more places"),
        (((2.0, 1.0), (0.0,), ((0.0,), (0.0,))), "position of profile_map is not finite and incr"),
        (((1.0, 2.0), (0.0, 0.0), ((0.0, 0.0),) * 2), "face_position of profile_map"),
        (((1.0, 2.0), (0.0,), ((0.0,), (math.nan,))), "deviation of profile_map is nan um"),
        (((1.0, 2.0), (0.0,), ((0.0,), (5.0,))), "deviation of profile_map is 5e+06 um"),
        (((1.0, 2.0), (0.0,), (0.0, 1.0)), "made of lists of numbers"),
    ],
)
def test_wrong_maps_are_refused(values: Any, says: str) -> None:
    with pytest.raises(InputError) as caught:
        ProfileMap(*values)
    assert says in str(caught.value)


@pytest.mark.parametrize("name", ["coordinate", "interpolation"])
def test_unknown_names_are_refused(name: str) -> None:
    with pytest.raises(InputError, match=f'{name} = "round" of profile_map'):
        ProfileMap((1.0, 2.0), (0.0,), ((0.0,), (0.0,)), **{name: "round"})  # type: ignore[arg-type]
