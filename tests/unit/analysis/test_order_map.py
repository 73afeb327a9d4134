"""Order maps of run-ups: amplitudes at every speed, no smearing, no aliasing."""

import numpy as np
import pytest

from tribodyn.analysis import angular_resampling, order_map, spectrum
from tribodyn.errors import InputError

RATE = 4000.0
TIME = np.arange(24001) / RATE
SPEED = 2 * np.pi * (10.0 + 6.0 * TIME)
ROTATION = 2 * np.pi * (10.0 * TIME + 3.0 * TIME**2)
NATURAL, DAMPING = 400.0, 0.05


def gain(frequency):
    ratio = frequency / NATURAL
    return 1.0 / (1.0 - ratio**2 + 2j * DAMPING * ratio)


@pytest.fixture(scope="module")
def signal():
    mesh = gain(16 * SPEED / (2 * np.pi))
    steady = 2.0 * np.cos(ROTATION + 0.3) + 0.5
    return steady + np.abs(mesh) * np.cos(16 * ROTATION + np.angle(mesh))


@pytest.fixture(scope="module")
def orders_map(signal):
    return order_map(signal, TIME, speed=SPEED, highest_order=32, revolutions=2, unit="m/s^2")


def test_orders_have_their_amplitudes_within_one_percent(orders_map):
    assert orders_map.cut(1).amplitude == pytest.approx(2.0, rel=0.01)
    assert orders_map.amplitude[0] == pytest.approx(0.5, rel=0.01)
    mesh = orders_map.cut(16)
    assert mesh.amplitude == pytest.approx(np.abs(gain(16 * mesh.speed / 2 / np.pi)), rel=0.01)


def test_resonance_is_where_the_order_meets_the_natural_frequency(orders_map):
    mesh = orders_map.cut(16)
    top = mesh.speed[np.argmax(mesh.amplitude)] * 16 / (2 * np.pi)
    assert top == pytest.approx(NATURAL * np.sqrt(1 - 2 * DAMPING**2), rel=0.02)
    line, _ = orders_map.strongest()
    assert orders_map.order[line] == 16.0


def test_an_order_does_not_smear(orders_map, signal):
    """Over time the mesh order passes 470 Hz and leaves a small part of its amplitude anywhere."""
    elsewhere = np.abs(orders_map.order - 16.0) > 1.0
    elsewhere &= orders_map.order > 2.0
    assert orders_map.amplitude[elsewhere].max() < 0.02 * orders_map.amplitude.max()
    steady = np.cos(16 * ROTATION)
    over_time = spectrum(steady, RATE, window="hann").amplitude.max()
    over_rotation = order_map(steady, TIME, rotation=ROTATION, highest_order=20).cut(16).amplitude
    assert over_time < 0.1
    assert over_rotation == pytest.approx(1.0, rel=0.01)


def test_speeds_and_times_belong_together(orders_map):
    assert orders_map.speed == pytest.approx(np.interp(orders_map.time, TIME, SPEED), rel=1e-6)
    assert orders_map.revolutions == 2.0
    assert orders_map.order[1] == 0.5
    assert orders_map.to_xarray()["speed"].attrs["units"] == "rad/s"
    assert "order 16" in repr(orders_map)


def test_rotation_and_speed_give_the_same(orders_map, signal):
    other = order_map(signal, TIME, rotation=ROTATION, highest_order=32, revolutions=2)
    np.testing.assert_allclose(other.amplitude, orders_map.amplitude, atol=1e-6)


def test_order_between_lines_and_flat_top():
    slow = np.cos(7.44 * ROTATION)
    for window in ("hann", "flattop"):
        cut = order_map(slow, TIME, rotation=ROTATION, highest_order=12, window=window).cut(7.44)
        assert cut.amplitude == pytest.approx(1.0, rel=0.01)


def test_fixed_high_frequency_does_not_fold_into_the_orders():
    """At 10 revolutions per second 1500 Hz is order 150: seven times what the map samples."""
    whistle = np.sin(2 * np.pi * 1500.0 * TIME[:12000])
    with_it = order_map(
        whistle, TIME[:12000], rotation=ROTATION[:12000], highest_order=16, revolutions=4
    )
    assert with_it.amplitude.max() < 1e-3


def test_run_down_and_uneven_time():
    time = np.sort(np.random.default_rng(2).uniform(0.0, 3.0, 30000))
    speed = 2 * np.pi * (30.0 - 5.0 * time)
    rotation = 2 * np.pi * (30.0 * time - 2.5 * time**2)
    run_down = order_map(1.5 * np.sin(5 * rotation), time, speed=speed, highest_order=8)
    assert np.all(np.diff(run_down.speed) < 0.0)
    assert run_down.cut(5).amplitude == pytest.approx(1.5, rel=0.01)


def test_coarse_sampling_is_refined():
    """Order 16 at 46 revolutions per second has 2.7 samples per period at 2 kHz."""
    coarse = slice(None, None, 2)
    refined = order_map(
        np.cos(16 * ROTATION[coarse]), TIME[coarse], rotation=ROTATION[coarse], highest_order=18
    )
    assert refined.cut(16).amplitude[1:-1] == pytest.approx(1.0, rel=0.01)


def test_resampling_preserves_the_wave():
    resampled = angular_resampling(
        np.cos(7 * ROTATION + 0.2), TIME, ROTATION, samples_per_revolution=64
    )
    inside = slice(300, -300)
    error = resampled.signal - np.cos(7 * resampled.rotation + 0.2)
    assert np.abs(error[inside]).max() < 1e-3
    assert resampled.time[inside] == pytest.approx(
        np.interp(resampled.rotation[inside], ROTATION, TIME), abs=1e-6
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"speed": None}, "neither or both"),
        ({"rotation": ROTATION}, "neither or both"),
        ({"speed": -SPEED}, "speed"),
        ({"speed": SPEED[:-1]}, "24000 samples"),
        ({"time": TIME[::-1]}, "rise"),
        ({"time": TIME[:-1]}, "24000 samples"),
        ({"highest_order": 50.0}, "Nyquist"),
        ({"revolutions": 500}, "500"),
        ({"window": "door"}, "no window"),
        ({"speed": None, "rotation": np.minimum(ROTATION, 100.0)}, "rise"),
        ({"signal": np.full(TIME.size, np.inf)}, "inf at sample 0"),
    ],
)
def test_bad_input_is_refused(signal, change, message):
    arguments = {"signal": signal, "time": TIME, "speed": SPEED, "highest_order": 20.0, **change}
    with pytest.raises(InputError, match=message):
        order_map(arguments.pop("signal"), arguments.pop("time"), **arguments)


def test_near_standstill_and_unreached_order_are_refused(orders_map):
    slow = 2 * np.pi * (1e-5 * TIME + 5.0 * TIME**2)
    with pytest.raises(InputError, match="Cut the slow part off"):
        order_map(np.cos(slow), TIME, rotation=slow, highest_order=8)
    with pytest.raises(InputError, match="reaches from order 0 to 32"):
        orders_map.cut(33)
