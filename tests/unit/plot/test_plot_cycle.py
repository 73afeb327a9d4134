"""From the mesh table to curves: jumps, lives of tooth pairs, positions A to E."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.plot.mesh.cycle import (
    CYCLES,
    cycles,
    driving_roll_angle,
    mesh_events,
    pair_life,
    pair_lives,
    roll_angle_positions,
)
from tribodyn.plot.theme.path import pair_ages

DRIVERS = pytest.mark.parametrize("driver", ["pinion", "wheel"])


@DRIVERS
def test_positions_are_those_of_the_path_of_contact(drawable: Any, driver: str) -> None:
    result = drawable(driver)
    expected = path_of_contact(result.case.gear_pair).roll_angles
    positions = roll_angle_positions(result.mesh)
    assert list(positions) == list("ABCDE")
    for name, angle in positions.items():
        assert angle == pytest.approx(expected[name], abs=1e-12)


@DRIVERS
def test_roll_angle_runs_from_entry_to_exit(drawable: Any, driver: str) -> None:
    result = drawable(driver)
    angle = driving_roll_angle(result.mesh)
    ends = path_of_contact(result.case.gear_pair).roll_angles
    assert np.all(np.diff(angle) >= -1e-15)
    assert angle[[0, -1]] == pytest.approx([ends["A"], ends["E"]], abs=1e-12)


@DRIVERS
def test_marks_are_the_events_of_the_mesh(drawable: Any, driver: str) -> None:
    mesh = drawable(driver).mesh
    marks = mesh_events(mesh)
    within = sorted(x for _, x in marks if x < 1.0 - 1e-9)
    assert within == pytest.approx(mesh.event_phases, abs=1e-12)
    assert max(x for _, x in marks) == CYCLES
    assert len(marks) == CYCLES * len(mesh.event_phases) + 1


def test_sliding_changes_its_sign_at_the_pitch_point(drawable: Any) -> None:
    mesh = drawable().mesh
    age, sliding = pair_life(mesh, "sliding_speed")
    pitch_point = pair_ages(mesh.gear_pair)["C"]
    assert np.all(sliding[age < pitch_point - 1e-9] < 0.0)
    assert np.all(sliding[age > pitch_point + 1e-9] > 0.0)


def test_a_pair_lives_for_the_contact_ratio(drawable: Any) -> None:
    mesh = drawable().mesh
    age, _ = pair_life(mesh, "stiffness")
    assert age[0] == 0.0
    assert age[-1] == pytest.approx(mesh.transverse_contact_ratio, abs=1e-12)
    assert np.all(np.diff(age) >= 0.0)


def test_the_pairs_drawn_add_up_to_the_total(drawable: Any) -> None:
    mesh = drawable().mesh
    phase, total = cycles(mesh.phase, mesh.mesh_stiffness)
    inside = np.linspace(0.003, CYCLES - 0.003, 411)
    clear = np.min(np.abs(inside[:, None] - [x for _, x in mesh_events(mesh)]), axis=1) > 1e-3
    parts = sum(
        np.interp(inside, x, y, left=0.0, right=0.0) for x, y in pair_lives(mesh, "stiffness")
    )
    np.testing.assert_allclose(parts[clear], np.interp(inside, phase, total)[clear], rtol=1e-12)


def test_jumps_are_drawn_upright(drawable: Any) -> None:
    mesh = drawable().mesh
    phase, total = cycles(mesh.phase, mesh.mesh_stiffness)
    leaps = np.flatnonzero(np.abs(np.diff(total)) > 0.2 * total.max())
    assert len(leaps) == 2 * CYCLES - 1  # in and out in every cycle; the first entry is the edge
    np.testing.assert_array_equal(phase[leaps], phase[leaps + 1])


def test_each_life_starts_and_ends_on_the_axis(drawable: Any) -> None:
    lives = pair_lives(drawable().mesh, "stiffness")
    assert len(lives) == 3  # one pair is leaving as the window opens, two enter within it
    middle, values = lives[1]
    assert values[0] == values[-1] == 0.0
    assert middle[0] == middle[1] == 0.0
