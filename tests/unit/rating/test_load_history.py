"""Load histories: rainflow cycles of shafts, load duration classes of gears."""

from __future__ import annotations

import numpy as np
import pytest

from known_ratings import HELICAL_GEARS, SPUR_GEARS, TEST_OIL, helical_example, spur_example
from tribodyn.errors import InputError
from tribodyn.rating import SpectrumLoad, load_classes, rainflow_cycles, rate_spectrum

#: Counts, ranges and means of the example of ASTM E1049, as mathworks.com/help/signal/ref/rainflow
#: prints them.
PRINTED = [
    (0.5, 3.0, -0.5), (0.5, 4.0, -1.0), (1.0, 4.0, 1.0), (0.5, 8.0, 1.0), (0.5, 9.0, 0.5),
    (0.5, 8.0, 0.0), (0.5, 6.0, 1.0),
]  # fmt: skip


def test_the_example_of_the_standard():
    points = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
    between = np.interp(np.linspace(0.0, 8.0, 81), np.arange(9), points)
    for history in (points, between, np.repeat(points, 3)):
        cycles = rainflow_cycles(history)
        rows = np.round(np.stack([cycles.counts, cycles.ranges, cycles.means], axis=1), 9)
        assert sorted(map(tuple, rows.tolist())) == sorted(PRINTED)


@pytest.mark.parametrize("exponent", [3.0, 8.7])
def test_the_equivalent_of_a_constant_amplitude_is_that_amplitude(exponent):
    wave = 7.0 + 2.0 * np.cos(np.pi * np.arange(41))
    cycles = rainflow_cycles(wave)
    assert cycles.counts.sum() == 20.0
    assert cycles.equivalent_amplitude(exponent, 20.0) == pytest.approx(2.0, rel=1e-12)
    assert rainflow_cycles(-3.0 * wave).equivalent_amplitude(exponent, 20.0) == pytest.approx(6.0)


@pytest.mark.parametrize("history", [[1.0], [2.0, 2.0, 2.0]])
def test_a_history_that_does_not_change_is_refused(history):
    with pytest.raises(InputError, match="does not change"):
        rainflow_cycles(history)


@pytest.mark.parametrize(
    ("pair", "gears"), [(spur_example(), SPUR_GEARS), (helical_example(), HELICAL_GEARS)]
)
def test_fine_classes_damage_as_each_moment_by_itself(pair, gears):
    torque = 150.0 + 60.0 * np.sin(np.arange(12.0)) - 300.0 * (np.arange(12) == 5)
    speed = np.linspace(120.0, 180.0, 12)
    common = {"oil": TEST_OIL, "pinion": gears[0], "wheel": gears[1]}
    moments = [SpectrumLoad(*pair, 3e6) for pair in zip(torque, speed, strict=True)]
    exact = rate_spectrum(pair, cases=moments, **common)
    fine, coarse = (
        rate_spectrum(pair, cases=load_classes(torque, speed, 36e6, count), **common)
        for count in (5000, 4)
    )
    for name in ("pitting_safety", "bending_safety"):
        assert getattr(fine, name) == pytest.approx(getattr(exact, name), rel=1e-9)
        assert getattr(coarse, name) <= getattr(exact, name)
    times = [each.duration * each.speed for each in load_classes(torque, speed, 36e6, 4)]
    assert sum(times) == pytest.approx(36e6 * speed.mean(), rel=1e-12)


def test_histories_of_different_lengths_are_refused():
    with pytest.raises(InputError, match="torque has 3 values and speed 2"):
        load_classes([1.0, 2.0, 3.0], [100.0, 120.0], 10.0)
