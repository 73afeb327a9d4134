"""Computed and measured motions side by side: what was put in is what is told."""

from __future__ import annotations

import numpy as np
import pytest
import xarray

from tribodyn.errors import InputError
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


def by_measure(found) -> dict[str, tuple[float, float, float]]:
    rows = zip(found.measure, found.computed, found.measured, found.error, strict=True)
    return {str(name): tuple(map(float, rest)) for name, *rest in rows}


def test_equal_motions_have_no_error() -> None:
    found = compare(COMPUTED, rig(SIZE), {"acc": "acceleration"})
    assert np.abs(found.error).max() < 2e-3
    rows = by_measure(found)
    assert rows["rms"][0] == pytest.approx(np.sqrt(0.5 * np.sum(SIZE**2)))
    assert rows["rms"][1] == pytest.approx(rows["rms"][0], rel=1e-3)


@pytest.mark.parametrize(("base", "error"), [("measured", 1.0), ("computed", 0.5), ("mean", 2 / 3)])
def test_errors_by_base(base: str, error: float) -> None:
    rows = by_measure(compare(COMPUTED, rig(0.5 * SIZE), {"acc": "acceleration"}, base=base))
    for each in rows.values():
        assert each[2] == pytest.approx(error, rel=5e-3)


def test_units_of_the_channel_are_converted() -> None:
    found = compare(COMPUTED, rig(1e3 * SIZE, unit="mm/s^2"), {"acc": "acceleration"})
    assert np.abs(found.error).max() < 2e-3
    with pytest.raises(InputError, match="units or sensitivity"):
        compare(COMPUTED, rig(SIZE, unit="N"), {"acc": "acceleration"})


def test_a_gain_is_given_or_fitted_and_told() -> None:
    halved = rig(0.5 * SIZE, noise=0.01)
    given = compare(COMPUTED, halved, {"acc": "acceleration"}, gain={"acc": 0.5})
    assert np.abs(given.error).max() < 0.02
    fitted = compare(COMPUTED, halved, {"acc": "acceleration"}, gain="fit")
    assert fitted.gains["acc"] == pytest.approx(0.5, rel=1e-3)
    assert fitted.fitted
    assert not given.fitted


def test_noise_counts_in_the_whole_and_not_in_the_harmonics() -> None:
    rows = by_measure(compare(COMPUTED, rig(SIZE, noise=4.0), {"acc": "acceleration"}))
    assert rows["rms"][1] == pytest.approx(np.sqrt(0.5 * np.sum(SIZE**2) + 16.0), rel=0.01)
    assert rows["rms of mesh harmonics"][1] == pytest.approx(rows["rms"][0], rel=0.01)


def test_a_speed_that_is_a_little_off_and_one_that_changes() -> None:
    off = compare(COMPUTED, rig(SIZE, 1.003 * MESH), {"acc": "acceleration"})
    assert np.abs(off.error).max() < 5e-3
    run = synthetic_run_up({20 * k: a for k, a in enumerate(SIZE, 1)}, (100.0, 150.0), duration=4.0)
    swept = compare(COMPUTED, run, {"signal": "acceleration"}, angle="angle", teeth=20)
    assert np.abs(swept.error).max() < 5e-3


def test_the_figure_and_the_table() -> None:
    found = compare(COMPUTED, rig(SIZE), {"acc": "acceleration"})
    assert "harmonic" in found.plot().layout.title.text
    assert found.to_xarray().sizes["row"] == 7
    assert "Comparison(1 channels" in repr(found)


@pytest.mark.parametrize(
    ("options", "told"),
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
        ({"measured": 3}, "Wanted: a Recording"),
        ({"computed": 3}, "mesh frequency"),
    ],
)
def test_refusals(options: dict, told: str) -> None:
    given = {"computed": COMPUTED, "measured": rig(SIZE), "channels": {"acc": "acceleration"}}
    with pytest.raises(InputError) as error:
        compare(**{**given, **options})
    assert told.lower() in str(error.value).lower()
