"""Motions of many operating points computed in one batch are those of single runs."""

from __future__ import annotations

import numpy as np
import pytest

import tribodyn as td
from tribodyn.dynamics.orbits.batched_orbits import SystemBatch
from tribodyn.errors import quiet
from tribodyn.study.pipeline.run import PreparedRun, computed, find_motions, prepare_run

#: Speed [rad/s], torque [N*m] and transmission error [m]: with 1024 and 2048 steps, and parting.
_POINTS = (300.0, 150.0, 0.0), (310.0, 60.0, 1e-6), (120.0, 250.0, 0.0), (366.0, 50.0, 2e-4)
_KEYS = "operation.speed", "operation.torque", "dynamics.transmission_error_amplitude"
#: Figures that are nothing but rounding, and one that is made of small differences.
_ROUNDED, _SMALL = {"steady_state_error"}, {"step_error"}


@pytest.fixture(scope="module")
def cases() -> list[td.Case]:
    case = td.load_case("fzg-roughness")
    return [case.replace(dict(zip(_KEYS, point, strict=True))) for point in _POINTS]


@pytest.fixture(scope="module")
def together(cases: list[td.Case]) -> list[PreparedRun]:
    points = [prepare_run(case) for case in cases]
    with quiet():
        find_motions(points)
    return points


def test_flanks_that_part_are_left_to_themselves(together: list[PreparedRun]) -> None:
    assert [point.response is None for point in together] == [False, False, False, True]


def test_figures_are_those_of_single_runs(
    cases: list[td.Case], together: list[PreparedRun]
) -> None:
    lost = []
    for case, point in zip(cases, together, strict=True):
        with quiet():
            single_run, grouped_run = computed(case), point.result()
        alone, grouped = single_run.summary(), grouped_run.summary()
        lost.append(alone["contact_loss_share"])
        assert list(grouped) == list(alone)
        assert [each.code for each in grouped_run.warnings] == [
            each.code for each in single_run.warnings
        ]
        for name in alone.keys() - _ROUNDED:
            exact = 1e-6 if name in _SMALL else 1e-9
            assert grouped[name] == pytest.approx(alone[name], rel=exact, abs=1e-300), name
        assert grouped["steady_state_error"] < 1e-10
        for name in ("position", "velocity", "acceleration", "contact_force"):
            values = getattr(single_run.response, name)
            error = np.abs(getattr(grouped_run.response, name) - values).max(axis=0)
            assert np.all(error <= 1e-9 * np.abs(values).max(axis=0)), name
        assert grouped_run.response.cycles_used == single_run.response.cycles_used
        assert grouped_run.response.floquet_multipliers == pytest.approx(
            single_run.response.floquet_multipliers, abs=1e-8
        )
    assert lost[-1] > 0.0 == max(lost[:-1])


def test_a_motion_depends_on_no_other(cases: list[td.Case], together: list[PreparedRun]) -> None:
    alone = [prepare_run(cases[1])]
    with quiet():
        find_motions(alone)
    assert alone[0].response == together[1].response
    with quiet():
        find_motions([prepare_run(cases[0])])
    assert alone[0].response == together[1].response


def test_slow_points_with_more_rounding_converge_in_one_batch() -> None:
    case = td.load_case("fzg-roughness")
    changed = [
        case.replace({"operation.speed": "400 rpm", "operation.torque": f"{torque} Nm"})
        for torque in (136.2, 265.5, 300.0)
    ]
    points = [prepare_run(each) for each in changed]
    with quiet():
        find_motions(points)
        alone = computed(changed[1]).summary()
    responses = [point.response for point in points if point.response is not None]
    assert len(responses) == len(points)
    assert all(each.converged and each.error < 1e-9 for each in responses)
    grouped = points[1].result().summary()
    for name in alone.keys() - _ROUNDED - _SMALL:
        assert grouped[name] == pytest.approx(alone[name], rel=1e-9, abs=1e-300), name


@pytest.mark.parametrize("count", [2, 8, 9])
def test_motions_of_systems_in_one_batch_are_those_of_single_runs(
    cases: list[td.Case], count: int
) -> None:
    points = [prepare_run(cases[number % 2]) for number in range(count)]
    frequencies = np.array([point.mesh.mesh_frequency for point in points])
    group = SystemBatch([point.system for point in points], frequencies, 1024)
    state, every = group.coordinates.expand(group.start()), np.arange(count)
    arguments = 1.0 / frequencies, group.full_steps.program.constant_load
    alone = SystemBatch([points[1].system], frequencies[1:2], 1024)
    load = alone.full_steps.program.constant_load
    exact = dict(alone.full_steps.march(1.0 / frequencies[1:2], load, state[1:2], np.arange(1)))[0]
    most = np.abs(exact).max(axis=0)
    motions = dict(group.full_steps.march(*arguments, state, every))
    assert motions.keys() == set(every.tolist())
    assert np.all(np.abs(motions[1] - exact) <= 1e-12 * most)
    assert dict(group.full_steps.march(*arguments, state, every[1:2])).keys() == {1}
    state[0] = np.inf
    grouped = dict(group.full_steps.march(*arguments, state, every))
    assert np.isnan(grouped[0]).all()
    assert all(np.array_equal(grouped[number], motions[number]) for number in every[1:])
