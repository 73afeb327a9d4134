"""The gears of the drawing touch where the theory says, and nowhere else."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tribodyn.contact import path_of_contact
from tribodyn.plot.gear.gear_pair import (
    circle,
    on_line_of_action,
    placed_outline,
    tooth_angles,
)

Points = NDArray[np.float64]


def distance(outline: Points, point: Points) -> float:
    """Distance of a point from a polygon's edges."""
    start, edge = outline[:, :-1], np.diff(outline, axis=1)
    along = np.clip(((point[:, None] - start) * edge).sum(axis=0) / (edge**2).sum(axis=0), 0.0, 1.0)
    return float(np.min(np.hypot(*(point[:, None] - start - along * edge))))


def inside(polygon: Points, points: Points) -> NDArray[np.bool_]:
    """Whether points lie within a closed polygon, by counting crossings."""
    x0, y0 = polygon[:, :-1]
    x1, y1 = polygon[:, 1:]
    px, py = points[:, :, None]
    spans = (y0 > py) != (y1 > py)
    with np.errstate(divide="ignore", invalid="ignore"):
        left = px < x0 + (py - y0) * (x1 - x0) / (y1 - y0)
    return np.asarray((spans & left).sum(axis=1) % 2 == 1)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("part", [0.0, 0.3, 0.7, 1.0])
def test_both_flanks_pass_through_the_contact(drawable: Any, driver: str, part: float) -> None:
    pair = drawable(driver).case.gear_pair
    path = path_of_contact(pair)
    at = path.A + part * (path.E - path.A)
    point = on_line_of_action(pair, at)
    angles = tooth_angles(pair, at)
    pinion = placed_outline(pair.pinion, 0.0, angles[0], points=4000)
    wheel = placed_outline(pair.wheel, pair.center_distance, angles[1], points=4000)
    assert distance(pinion, point) < 1e-8
    assert distance(wheel, point) < 1e-8


def test_contact_is_pressed_and_the_gears_do_not_overlap(drawable: Any) -> None:
    pair = drawable().case.gear_pair
    path = path_of_contact(pair)
    at = 0.5 * (path.B + path.D)
    first, second = tooth_angles(pair, at)
    wheel = placed_outline(pair.wheel, pair.center_distance, second)
    turn = 30e-6 / pair.pinion.base_radius

    def overlapping(angle: float) -> int:
        return int(inside(wheel, placed_outline(pair.pinion, 0.0, angle)).sum())

    # the pinion turns anticlockwise against the wheel: further on it cuts into it
    assert overlapping(first) <= 2
    assert overlapping(first + 3 * turn) > overlapping(first)


def test_line_of_action_touches_both_base_circles(drawable: Any) -> None:
    pair = drawable().case.gear_pair
    ends = on_line_of_action(pair, np.array([0.0, pair.line_of_action_length]))
    direction = (ends[:, 1] - ends[:, 0]) / pair.line_of_action_length
    wheel_axis = np.array([pair.center_distance, 0.0])
    assert np.hypot(*ends[:, 0]) == pytest.approx(pair.pinion.base_radius, rel=1e-12)
    assert np.hypot(*(ends[:, 1] - wheel_axis)) == pytest.approx(pair.wheel.base_radius, rel=1e-12)
    assert ends[:, 0] @ direction == pytest.approx(0.0, abs=1e-12)
    assert (ends[:, 1] - wheel_axis) @ direction == pytest.approx(0.0, abs=1e-12)


def test_pitch_point_lies_between_the_axes(drawable: Any) -> None:
    pair = drawable().case.gear_pair
    x, y = on_line_of_action(pair, path_of_contact(pair).C)
    assert y == pytest.approx(0.0, abs=1e-12)
    assert x == pytest.approx(pair.center_distance / (1.0 + pair.ratio), rel=1e-12)


def test_circle_is_closed_and_round() -> None:
    x, y = circle(2.0, 3.0)
    np.testing.assert_allclose(np.hypot(x - 2.0, y), 3.0, rtol=1e-14)
    assert (x[0], y[0]) == pytest.approx((x[-1], y[-1]), abs=1e-14)
