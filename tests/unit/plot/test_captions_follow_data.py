"""Captions of figures say only what their data show."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.unit.plot.test_loaded_figures import loaded

from tribodyn import plot
from tribodyn.dynamics import Contact, System, speed_sweep


@pytest.mark.parametrize("direction", ["up", "down", "both"])
def test_a_sweep_in_one_way_speaks_of_one_way(direction: str) -> None:
    pair = Contact([1.0], stiffness=lambda p: 1.0 + 0.1 * np.cos(2 * np.pi * p), gap=1.0)
    system = System([[1.0]], [[0.2]], [[0.0]], [0.5], [pair])
    ways = {"up": ("up",), "down": ("down",), "both": ("up", "down")}[direction]
    sweep = speed_sweep(system, np.linspace(0.6, 0.7, 3) / (2 * np.pi), directions=ways)
    caption = plot.speed_sweep.caption_of(sweep)
    assert ("rising" in caption) == ("up" in ways)
    assert ("falling" in caption) == ("down" in ways)
    assert ("coexist" in caption) == bool(np.any(sweep.differs))
    assert ("jumps" in caption) == bool(sweep.jumps)


def worn(least: float) -> Any:
    """Wear of both flanks with a place that hardly wears, or none."""
    place = np.linspace(0.0, 1.0, 11)
    depth = np.maximum(np.abs(place - 0.4), least) * 1e-6
    depths = np.stack((0.0 * depth, depth))
    return SimpleNamespace(
        turns=np.array([0.0, 1e6]), place=place, depth_pinion=depths, depth_wheel=depths
    )


def test_wear_names_the_spared_place_where_there_is_one() -> None:
    caption = plot.motion.time_histories._wear_caption(worn(0.0))
    assert "the pinion at 0.4, the wheel at 0.4" in caption
    assert "slide" not in plot.motion.time_histories._wear_caption(worn(0.3))


def test_grey_ranges_are_named_where_they_are_drawn() -> None:
    heavy, light = loaded([200.0]), loaded([1e-3])
    for contact in (heavy, light):
        shapes = [s for s in plot.loaded_sharing(contact).layout.shapes if s.type == "rect"]
        caption = plot.loaded_sharing.caption_of(contact)
        assert ("grey" in caption) == bool(shapes)
        assert "teeth differ" not in caption
    assert "tip corner" in plot.loaded_sharing.caption_of(heavy)
