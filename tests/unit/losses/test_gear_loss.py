"""The gear loss factor, by integration and in closed form, and the power that friction takes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from known_pairs import pair_of, standard, type_c
from tribodyn.contact import equal_share, path_of_contact
from tribodyn.errors import ModelWarning
from tribodyn.losses import gear_loss_factor, ohlendorf_loss_factor


def by_areas(pair):
    """Equal sharing below a contact ratio of 2: areas under the distance from the pitch point."""
    path = path_of_contact(pair)
    first = path.direction * (path.A - path.C) / pair.base_pitch
    last = path.direction * (path.E - path.C) / pair.base_pitch

    def area(low, high):
        return 0.5 * (high * abs(high) - low * abs(low))  # of |x|

    area_sum = 0.5 * area(first, last - 1.0) + area(last - 1.0, first + 1.0)
    area_sum += 0.5 * area(first + 1.0, last)
    return area_sum * 2.0 * math.pi / pair.pinion.teeth * (1.0 + 1.0 / pair.ratio)


@pytest.mark.parametrize("pair", [type_c(), standard((20, 30)), standard((30, 31)), pair_of()])
@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_integral_and_closed_form_of_equal_sharing(pair, driver):
    turned = replace(pair, driver=driver)
    path = path_of_contact(turned)
    assert gear_loss_factor(turned) == pytest.approx(by_areas(turned), rel=1e-12)
    if min(path.B, path.D) <= path.C <= max(path.B, path.D):
        assert ohlendorf_loss_factor(turned) == pytest.approx(by_areas(turned), rel=1e-12)
    else:
        with pytest.warns(ModelWarning, match="loss-factor"):
            assert ohlendorf_loss_factor(turned) > 1.005 * by_areas(turned)


def test_fzg_c_agrees_and_fzg_a_is_warned_of():
    assert gear_loss_factor(type_c()) == pytest.approx(0.1950, abs=5e-5)
    assert ohlendorf_loss_factor(type_c()) == pytest.approx(gear_loss_factor(type_c()), rel=1e-12)
    with pytest.warns(ModelWarning, match=r"loss-factor.*0\.226 base pitches.*0\.327 to 1\.000"):
        closed = ohlendorf_loss_factor(pair_of())
    assert closed == pytest.approx(0.3064, abs=5e-5)
    assert gear_loss_factor(pair_of()) == pytest.approx(0.3031, abs=5e-5)


def test_closed_form_of_a_high_contact_ratio_is_warned_of(high_contact_pair):
    with pytest.warns(ModelWarning, match="contact ratio of 2."):
        ohlendorf_loss_factor(high_contact_pair)


def test_share_of_ones_own():
    pair = pair_of()
    path = path_of_contact(pair)
    assert gear_loss_factor(pair, lambda x: equal_share(path, x)) == gear_loss_factor(pair)
    half = gear_loss_factor(pair, lambda x: 0.5 * equal_share(path, x))
    assert half == pytest.approx(0.5 * gear_loss_factor(pair), rel=1e-12)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_friction_moments_times_speeds_are_friction_force_times_sliding(driver):
    pair = pair_of(driver=driver)
    path = path_of_contact(pair)
    where = np.linspace(min(path.A, path.E), max(path.A, path.E), 501)
    motion = path.kinematics(where, 94.2)
    load = 2660.0 * equal_share(path, where) * 0.05 * motion.sliding_direction
    power = load * motion.pinion_curvature_radius * 94.2
    power -= load * motion.wheel_curvature_radius * 94.2 / pair.ratio
    assert power == pytest.approx(load * motion.sliding_speed, rel=1e-10, abs=1e-10)
    # Its mean over a pair's way, times pairs in contact, is mu times H_V of the power.
    mean = 0.05 * gear_loss_factor(pair) * 2660.0 * pair.pinion.base_radius * 94.2
    inner = (where[1:] + where[:-1]) / 2.0
    motion = path.kinematics(inner, 94.2)
    lost = 2660.0 * equal_share(path, inner) * 0.05 * np.abs(motion.sliding_speed)
    assert lost.mean() * path.contact_ratio == pytest.approx(mean, rel=2e-3)
