"""Compare computed and measured motions: known differences are reported."""

from __future__ import annotations

import numpy as np
import pytest
import xarray

from tribodyn.errors import InputError, ModelWarning
from tribodyn.measurement import Recording, compare, synthetic_run_up

RATE, MESH = 25600.0, 400.0
TIME = np.arange(int(4 * RATE)) / RATE
SIZE = np.array([5.0, 2.0, 1.0, 0.5, 0.25])
COMPUTED = xarray.Dataset(
    {"acceleration_spectrum": ("order", SIZE, {"units": "m/s^2"})},
    {"order": np.arange(1.0, 6.0)},
    {"mesh_frequency": MESH},
)


def rig(sizes, frequency=MESH, unit="m/s^2", noise=0.0) -> Recording:
    wave = sum(a * np.cos(2 * np.pi * k * frequency * TIME + k) for k, a in enumerate(sizes, 1))
    wave = wave + noise * np.random.default_rng(0).standard_normal(TIME.size) + 3.0
    return Recording({"acc": wave}, RATE, {"acc": unit})


def by_measure(comparison) -> dict[str, tuple[float, float, float]]:
    rows = zip(
        comparison.measure, comparison.computed, comparison.measured, comparison.error, strict=True
    )
    return {str(name): tuple(map(float, values)) for name, *values in rows}


def codes(warned) -> list[str]:
    return [each.message.code for each in warned]


def test_equal_motions_have_no_error() -> None:
    comparison = compare(COMPUTED, rig(SIZE), {"acc": "acceleration"})
    assert np.abs(comparison.error).max() < 2e-3
    rows = by_measure(comparison)
    assert rows["rms"][0] == pytest.approx(np.sqrt(0.5 * np.sum(SIZE**2)))
    assert rows["rms"][1] == pytest.approx(rows["rms"][0], rel=1e-3)


@pytest.mark.parametrize(("base", "error"), [("measured", 1.0), ("computed", 0.5), ("mean", 2 / 3)])
def test_errors_by_base(base: str, error: float) -> None:
    rows = by_measure(compare(COMPUTED, rig(0.5 * SIZE), {"acc": "acceleration"}, base=base))
    for each in rows.values():
        assert each[2] == pytest.approx(error, rel=5e-3)


def test_units_of_the_channel_are_converted() -> None:
    comparison = compare(COMPUTED, rig(1e3 * SIZE, unit="mm/s^2"), {"acc": "acceleration"})
    assert np.abs(comparison.error).max() < 2e-3
    with pytest.raises(InputError, match="units or sensitivity"):
        compare(COMPUTED, rig(SIZE, unit="N"), {"acc": "acceleration"})


def test_gain_is_prescribed_or_fitted() -> None:
    halved = rig(0.5 * SIZE, noise=0.01)
    prescribed = compare(COMPUTED, halved, {"acc": "acceleration"}, gain={"acc": 0.5})
    assert np.abs(prescribed.error).max() < 0.02
    fitted = compare(COMPUTED, halved, {"acc": "acceleration"}, gain="fit")
    assert fitted.gains["acc"] == pytest.approx(0.5, rel=1e-3)
    assert fitted.fitted
    assert not prescribed.fitted


def test_noise_counts_in_the_whole_and_not_in_the_harmonics() -> None:
    with pytest.warns(ModelWarning) as warned:
        rows = by_measure(compare(COMPUTED, rig(SIZE, noise=4.0), {"acc": "acceleration"}))
    assert codes(warned) == ["harmonics-in-noise", "signal-outside-harmonics"]
    assert rows["rms"][1] == pytest.approx(np.sqrt(0.5 * np.sum(SIZE**2) + 16.0), rel=0.01)
    assert rows["rms of mesh harmonics"][1] == pytest.approx(rows["rms"][0], rel=0.01)


def test_a_speed_that_is_a_little_off_and_one_that_changes() -> None:
    off = compare(COMPUTED, rig(SIZE, 1.003 * MESH), {"acc": "acceleration"})
    assert np.abs(off.error).max() < 5e-3
    run = synthetic_run_up({20 * k: a for k, a in enumerate(SIZE, 1)}, (100.0, 150.0), duration=4.0)
    swept = compare(COMPUTED, run, {"signal": "acceleration"}, angle="angle", teeth=20)
    assert np.abs(swept.error).max() < 5e-3


def wandering(ratio, wander, sizes=SIZE, decibel=20.0, duration=4.0, seed=0) -> Recording:
    """Harmonics in closed form of a mesh at ratio (1 + wander cos(pi t)), noise and a tachometer.

    The tachometer of the pinion of 20 teeth gives twelve pulses in a revolution.
    """
    time = np.arange(round(duration * RATE)) / RATE
    angle = 2.0 * np.pi * MESH * ratio * (time + wander * np.sin(np.pi * time) / np.pi)
    wave = sum(a * np.cos(k * angle + k) for k, a in enumerate(sizes, 1)) + np.zeros(time.size)
    noise = np.random.default_rng(seed).standard_normal(time.size)
    wave = wave + np.std(wave) * 10.0 ** (-decibel / 20.0) * noise
    pulses = 5.0 * (np.sin(12.0 * angle / 20.0) > 0.2)
    return Recording({"acc": wave, "tacho": pulses}, RATE, {"acc": "m/s^2", "tacho": "V"})


@pytest.mark.parametrize("tacho", [{}, {"tacho": "tacho", "pulses": 12, "teeth": 20}])
@pytest.mark.parametrize(
    ("ratio", "wander"), [(0.99, 0.0), (1.03, 0.0), (0.97, 0.01), (1.03, 0.01)]
)
def test_harmonics_of_a_recording_off_speed_that_wanders(ratio, wander, tacho) -> None:
    comparison = compare(COMPUTED, wandering(ratio, wander), {"acc": "acceleration"}, **tacho)
    assert np.abs(comparison.error[2:]).max() < 0.05
    mean = ratio  # of a whole number of periods of the wander
    assert abs(comparison.speed_ratio - mean) < max(4.0 * comparison.speed_uncertainty, 1e-6)
    assert comparison.speed_uncertainty < 2e-5
    assert ("tachometer" if tacho else "phase demodulation") in comparison.speed_method
    assert comparison.speed_range == pytest.approx(
        (ratio * (1.0 - wander), ratio * (1.0 + wander)), abs=1e-3
    )
    assert comparison.shares["acc"] == pytest.approx(1.0 / 1.01, abs=5e-3)
    assert f"speed ratio {comparison.speed_ratio:.5g}" in repr(comparison)
    stated = float(comparison.speed_text.partition("computed one: ")[2].partition(" ")[0])
    assert stated == pytest.approx(comparison.speed_ratio, abs=2.0 * comparison.speed_uncertainty)


def test_one_line_one_percent_slow_is_that_line() -> None:
    """A line of 6 m/s^2 that is recorded 1 % slower than computed is 6 m/s^2, and a gain of it."""
    comparison = compare(
        COMPUTED, wandering(0.99, 0.0, [6.0]), {"acc": "acceleration"}, harmonics=1
    )
    assert by_measure(comparison)["mesh harmonic 1"][1] == pytest.approx(6.0, rel=0.01)
    with pytest.warns(ModelWarning, match="harmonics-in-noise"):
        fitted = compare(COMPUTED, wandering(0.99, 0.0, [6.0]), {"acc": "acceleration"}, gain="fit")
    assert fitted.gains["acc"] == pytest.approx(6.0 / 5.0, rel=0.01)


def test_a_recording_at_another_speed_is_not_compared() -> None:
    for ratio in (1.1, 1.3, 0.5):
        with pytest.warns(ModelWarning) as warned:
            comparison = compare(COMPUTED, wandering(ratio, 0.0), {"acc": "acceleration"})
        assert "speed-not-found" in codes(warned), ratio
        assert np.isnan(comparison.measured[1:]).all()
        assert np.isnan(comparison.speed_ratio)
        assert "not found" in repr(comparison)
        assert "not found" in comparison.speed_text
        assert "not found" in comparison.plot().layout.title.text


def test_lines_of_double_the_speed_leave_every_other_harmonic_in_noise() -> None:
    with pytest.warns(ModelWarning, match="1, 3, 5 not above it") as warned:
        compare(COMPUTED, wandering(2.0, 0.0), {"acc": "acceleration"})
    assert codes(warned) == ["harmonics-in-noise"]


def test_a_tachometer_with_other_pulses_or_on_the_other_gear_is_doubted() -> None:
    recording = wandering(1.0, 0.0)
    for wrong in ({"pulses": 6, "teeth": 20}, {"pulses": 12, "teeth": 47}):
        with pytest.warns(ModelWarning) as warned:
            compare(COMPUTED, recording, {"acc": "acceleration"}, tacho="tacho", **wrong)
        assert codes(warned)[0] == "speed-off"
        assert "harmonics-in-noise" in codes(warned)


def test_a_gain_is_not_fitted_to_noise_alone() -> None:
    nothing = Recording(
        {"acc": np.random.default_rng(3).standard_normal(TIME.size)}, RATE, {"acc": "m/s^2"}
    )
    with (
        pytest.warns(ModelWarning, match="speed-not-found"),
        pytest.raises(InputError, match=r"no gain can be fitted for channel acc\. .* unknown"),
    ):
        compare(COMPUTED, nothing, {"acc": "acceleration"}, gain="fit")
    with_angle = Recording(
        {**nothing.channels, "angle": 2.0 * np.pi * MESH / 20.0 * TIME}, RATE, nothing.units
    )
    with pytest.warns(ModelWarning), pytest.raises(InputError, match="None of its mesh harmonics"):
        compare(COMPUTED, with_angle, {"acc": "acceleration"}, gain="fit", angle="angle", teeth=20)


def test_a_steady_tachometer_on_a_mesh_that_wanders_is_reported_as_smeared() -> None:
    recording = wandering(1.0, 0.003)
    steady = Recording(
        {"acc": recording["acc"], "angle": 2.0 * np.pi * MESH / 20.0 * TIME}, RATE,
        {"acc": "m/s^2"},
    )  # fmt: skip
    with pytest.warns(ModelWarning) as warned:
        compare(COMPUTED, steady, {"acc": "acceleration"}, angle="angle", teeth=20)
    assert "harmonics-smeared" in codes(warned)


@pytest.mark.parametrize(
    ("unit", "factor"), [("g", 1.0), ("gn", 1.0), ("g0", 1.0), ("g_n", 1.0), ("mg", 1e-3)]
)
def test_g_of_an_acceleration_is_gravity(unit, factor) -> None:
    comparison = compare(COMPUTED, rig(SIZE / 9.80665 / factor, unit=unit), {"acc": "acceleration"})
    assert np.abs(comparison.error).max() < 2e-3


def test_g_of_a_mass_is_a_gram() -> None:
    from tribodyn.units import convert, parse

    assert convert(5.0, "g", "kg") == 0.005
    assert convert(9.80665, "m/s^2", "g") == pytest.approx(1.0)
    assert parse("2 g", "m/s^2") == pytest.approx(19.6133)
    force = COMPUTED.rename(acceleration_spectrum="force_spectrum")
    force["force_spectrum"] = force["force_spectrum"].assign_attrs(units="N")
    with pytest.raises(InputError, match='is in "g", the computed signal in "N"'):
        compare(force, rig(SIZE, unit="g"), {"acc": "force"})


def test_the_figure_and_the_table() -> None:
    comparison = compare(COMPUTED, rig(SIZE), {"acc": "acceleration"})
    assert "harmonic" in comparison.plot().layout.title.text
    assert comparison.to_xarray().sizes["row"] == 7
    assert "Comparison(1 channels" in repr(comparison)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"channels": {"acc": "force"}}, "It has acceleration"),
        ({"channels": {"ac": "acceleration"}}, 'Did you mean "acc"'),
        ({"channels": {}}, "no channels"),
        ({"harmonics": 6}, "holds 5"),
        ({"mesh_frequency": 4000.0}, "Sample"),
        ({"mesh_frequency": 4000.0, "harmonics": 4}, "sample faster"),
        ({"mesh_frequency": 1.0}, "Record longer"),
        ({"base": "test"}, "base"),
        ({"gain": -1.0}, "gain"),
        ({"gain": "best"}, "gain"),
        ({"angle": "acc"}, "teeth"),
        ({"tacho": "acc", "angle": "acc"}, "Leave one"),
        ({"tacho": "pulses", "teeth": 20}, "no channel"),
        ({"tacho": "acc", "teeth": 20, "pulses": 0}, "pulses"),
        ({"measured": 3}, "Expected a Recording"),
        ({"computed": 3}, "mesh frequency"),
    ],
)
def test_refusals(options: dict, message: str) -> None:
    arguments = {"computed": COMPUTED, "measured": rig(SIZE), "channels": {"acc": "acceleration"}}
    with pytest.raises(InputError) as error:
        compare(**{**arguments, **options})
    assert message.lower() in str(error.value).lower()


def test_a_harmonic_without_a_line_leaves_the_others_in_their_places() -> None:
    """The computed motion has no line at order 2, the measured one has."""
    orders, sizes = [1.0, 2.5, 3.0], [4.0, 1.0, 2.0]
    computed = xarray.Dataset(
        {"force_spectrum": ("order", sizes, {"units": "N"})},
        {"order": orders},
        {"mesh_frequency": 100.0},
    )
    time = np.arange(40000) / 1e4
    wave = sum(
        size * np.cos(2 * np.pi * 100 * order * time)
        for order, size in ((1, 4.0), (2, 0.5), (3, 2.0))
    )
    recording = Recording({"cell": wave}, 1e4, {"cell": "N"})
    rows = by_measure(compare(computed, recording, {"cell": "force"}, harmonics=3))
    assert [rows[f"mesh harmonic {k}"][0] for k in (1, 2, 3)] == [4.0, 0.0, 2.0]
    assert rows["mesh harmonic 2"][1] == pytest.approx(0.5, rel=1e-3)
    assert rows["mesh harmonic 3"][1] == pytest.approx(2.0, rel=1e-3)
