"""Run-up: refused input, choice of steps, grids, results."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.dynamics import Contact, SpeedProfile, System, run_up, speed_ramp
from tribodyn.dynamics.running_up.run_up_result import read_profile
from tribodyn.dynamics.running_up.run_up_tables import Tables, sampled_grid
from tribodyn.errors import ComputationError, InputError


def oscillator(**changes: object) -> System:
    options = {"stiffness": lambda p: 9.0 + np.cos(2 * np.pi * p), "events": (0.3,)} | changes
    return System([[1.0]], [[0.3]], [[0.0]], [1.0], [Contact([1.0], **options)], names=["gear_y"])


@pytest.mark.parametrize(
    ("profile", "message"),
    [
        (([0.0, 1.0], [0.0, 10.0]), "standing gear"),
        (([0.0, 0.0], [1.0, 10.0]), "do not rise"),
        (([0.0], [1.0]), "at least two corners"),
        (5.0, "not a pair"),
        (lambda t: 1.0 + t, "duration"),
    ],
)
def test_bad_profiles_are_refused_with_a_remedy(profile: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        run_up(oscillator(), profile)  # type: ignore[arg-type]


def test_a_function_of_time_is_a_profile() -> None:
    profile = read_profile(lambda t: 10.0 + t**2, 3.0)
    assert profile.cycles == pytest.approx(39.0, rel=1e-7)
    assert profile.phase_at(1.5) == pytest.approx(15.0 + 1.125, rel=1e-7)


def test_ramps_hold_and_fall() -> None:
    ramp = speed_ramp(10.0, 20.0, 2.0, hold=1.0, down=True)
    assert ramp.frequency_at([0.0, 1.0, 2.5, 4.0, 5.0]).tolist() == [10.0, 15.0, 20.0, 15.0, 10.0]
    assert isinstance(ramp, SpeedProfile)
    with pytest.raises(InputError, match="hold"):
        speed_ramp(10.0, 20.0, 2.0, hold=-1.0)


def test_events_and_samples_are_grid_points() -> None:
    grid = sampled_grid((0.0, 0.3, 0.5), 50, 8)
    for place in (*np.arange(8) / 8, 0.3):
        assert np.abs(grid.left - place).min() < 1e-14
    assert grid.width.sum() == pytest.approx(1.0, rel=1e-14)
    assert grid.width.max() <= 1 / 50 + 1e-12
    assert grid.left[grid.after_event].tolist() == [0.0, 0.3, 0.5]
    np.testing.assert_allclose(grid.left + grid.width, np.append(grid.left[1:], 1.0))


def test_low_speeds_get_more_steps_and_too_few_are_refused() -> None:
    stiff = System([[1.0]], [[0.0]], [[1e6]], [0.0])
    tables = Tables((stiff,), 16, 0.5, None)
    counts = [tables.steps_at(f) for f in (0.5, 2.0, 8.0, 100.0)]
    assert counts == sorted(counts, reverse=True)
    assert counts[-1] == 256
    assert all(1000.0 / (f * n) <= 0.35 for f, n in zip((0.5, 2.0, 8.0), counts, strict=False))
    with pytest.raises(InputError, match="omit steps") as caught:
        run_up(stiff, ([0.0, 1.0], [0.5, 2.0]), steps=512)
    assert "at 0.5 Hz" in str(caught.value)
    with pytest.raises(InputError, match="Begin at"):
        run_up(stiff, ([0.0, 1.0], [1e-3, 2.0]))


def test_a_change_of_grid_leaves_no_trace_in_the_motion() -> None:
    system, profile = oscillator(), speed_ramp(0.02, 0.2, 100.0)
    free = run_up(system, profile, start=([0.1], [0.0]), samples=8)
    assert free.cycles.steps[0] > free.cycles.steps[-1]
    assert free.step_number < 0.35 * 1.01
    stiff = oscillator(stiffness=lambda p: 900.0 + 100.0 * np.cos(2 * np.pi * p))
    changing = run_up(stiff, profile, start=([0.1], [0.0]), samples=8)
    assert np.unique(changing.cycles.steps).size > 3
    fixed = run_up(stiff, profile, start=([0.1], [0.0]), samples=8, steps=16384)
    assert np.abs(changing.position - fixed.position).max() < 2e-3 * 0.1


def test_results_have_units() -> None:
    rows = {"support": [2.0, 3.0]}
    run = run_up(oscillator(), speed_ramp(0.5, 0.6, 20.0), samples=8, teeth=4, outputs=rows)
    data = run.to_xarray()
    assert data.contact_force.attrs["units"] == "N"
    assert data.contact_force_rms.shape == (11, 1)
    assert data.speed.values == pytest.approx(2 * np.pi * run.mesh_frequency / 4)
    expected = 2.0 * run.position[:, 0] + 3.0 * run.velocity[:, 0]
    assert run.signal("support")[0] == pytest.approx(expected)
    assert run.signal("gear_y")[1] == "m/s^2"
    mean = run.output.reshape(-1, 8).mean(axis=1)
    assert run.cycles.output.mean[:, 0] == pytest.approx(mean, abs=1e-2)
    with pytest.raises(InputError, match="deflection, contact_force, gear_y, support"):
        run.signal("noise")
    with pytest.raises(InputError, match="shape"):
        run_up(oscillator(), speed_ramp(0.5, 0.6, 20.0), outputs={"support": [1.0]})


def test_systems_of_different_structures_are_refused() -> None:
    other = System([[2.0]], [[0.3]], [[0.0]], [1.0], [Contact([1.0], 9.0)])
    with pytest.raises(InputError, match="another structure"):
        run_up({1.0: oscillator(), 2.0: other}, speed_ramp(1.0, 2.0, 5.0))
    with pytest.raises(InputError, match="a gap at all"):
        run_up({1.0: oscillator(), 2.0: oscillator(gap=0.1)}, speed_ramp(1.0, 2.0, 5.0))


def test_a_growing_motion_is_reported_with_time_and_coordinate() -> None:
    growing = System([[1.0]], [[-50.0]], [[0.0]], [0.0], [Contact([1.0], 100.0)], names=["gear_y"])
    with pytest.raises(
        ComputationError, match=r"after 1\d.* s, at .* Hz, first in coordinate gear_y"
    ):
        run_up(growing, speed_ramp(1.0, 2.0, 60.0), start=([1e-3], [0.0]))
