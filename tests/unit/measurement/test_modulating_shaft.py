"""Lines of one gear alone tell which of two meshing gears modulates the mesh."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.measurement import OrderSpectrum, modulating_shaft, order_spectrum
from tribodyn.measurement.sideband_cursors import explain_modulation


def orders_of(teeth: int, mate_teeth: int, shaft: float, mate: float) -> OrderSpectrum:
    """Mesh whose amplitude is modulated once a turn of the shaft and of the mate, with noise."""
    angle = 2.0 * np.pi * 50.0 * np.arange(40000) / 10000.0
    local = [
        size * sum(np.cos(k * ratio * angle) for k in (1, 2, 3))
        for size, ratio in ((shaft, 1.0), (mate, teeth / mate_teeth))
    ]
    wave = (1.0 + local[0] + local[1]) * np.cos(teeth * angle)
    noise = 0.01 * np.random.default_rng(2).standard_normal(wave.size)
    return order_spectrum(wave + noise, angle, 2.5 * teeth)


@pytest.mark.parametrize("teeth", [(16, 24), (17, 24), (24, 16), (16, 32), (32, 16)])
@pytest.mark.parametrize("sizes", [(0.1, 0.0), (0.0, 0.1), (0.0, 0.0)])
def test_the_modulating_gear_is_named(teeth: tuple[int, int], sizes: tuple[float, float]) -> None:
    lines = modulating_shaft(orders_of(*teeth, *sizes), *teeth)
    assert [each.stands_out for each in lines] == [size > 0.0 for size in sizes]


def test_both_gears_are_named() -> None:
    orders = orders_of(17, 24, 0.1, 0.05)
    shaft, mate = modulating_shaft(orders, 17, 24)
    # Six lines of the shaft and of the mate at half the amplitude of the modulation each.
    assert shaft.clear == mate.clear == 6
    np.testing.assert_allclose(
        [shaft.rms, mate.rms], np.sqrt(6 / 2) * np.array([0.05, 0.025]), 0.03
    )
    assert explain_modulation((shaft, mate), 17, 24, "").startswith("Both gears")


def test_a_common_factor_puts_lines_into_the_revolution_of_the_mate() -> None:
    def text_of(teeth: int, mate_teeth: int, shaft: float) -> str:
        lines = modulating_shaft(orders_of(teeth, mate_teeth, shaft, 0.0), teeth, mate_teeth)
        return explain_modulation(lines, teeth, mate_teeth, "m/s^2")

    assert "turns with the shaft" in text_of(16, 24, 0.1)
    assert "common factor 8" in text_of(16, 24, 0.1)
    assert "common factor" not in text_of(17, 24, 0.1)
    assert text_of(16, 24, 0.0) == ""
