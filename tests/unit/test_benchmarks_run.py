"""The benchmarks run, and the contenders integrate the same equations to the same end."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

_FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Modules of the benchmarks by name."""
    monkeypatch.syspath_prepend(str(_FOLDER))
    names = sorted(path.stem for path in _FOLDER.glob("*.py"))
    return SimpleNamespace(**{name: importlib.import_module(name) for name in names})


def test_all_scripts_are_in_the_report(bench: Any) -> None:
    scripts = {name for name, module in vars(bench).items() if hasattr(module, "main")}
    assert scripts == {*bench.run_all.SCRIPTS, "run_all"}


@pytest.mark.parametrize("spread", [0, -1])
def test_two_reference_methods_agree(bench: Any, spread: int) -> None:
    pair = bench.reference_pair.lanes(bench.reference_pair.D2, 3)[spread]
    _, gap = bench.reference_solution.reference(pair, 2)
    assert gap < bench.reference_solution.AGREEMENT


def test_series_refuses_a_gap(bench: Any) -> None:
    with pytest.raises(ValueError, match="without gap"):
        bench.reference_solution.series_solution(bench.reference_pair.WITH_BACKLASH, 1)


def test_marching_reaches_the_reference_at_fourth_order(bench: Any) -> None:
    pair = bench.reference_pair.D2
    exact = bench.reference_solution.series_solution(pair, 2)
    coarse, fine = (
        bench.reference_solution.displacement_error(
            bench.marchers.end_displacements(pair, 2, steps), exact
        )
        for steps in (768, 1536)
    )
    assert fine < bench.equal_accuracy.ACCURACY
    assert np.log2(coarse / fine) > 3.8


def test_scipy_solves_the_linear_pair(bench: Any) -> None:
    pair = bench.reference_pair.D2
    exact = bench.reference_solution.series_solution(pair, 1)
    for name, solver in bench.peers.scipy_peers().items():
        position, evaluations = solver(pair, 1, 1e-8)
        end = bench.reference_pair.elastic(position)
        assert bench.reference_solution.displacement_error(end, exact) < 1e-6, name
        assert evaluations > 100, name


def test_scipy_solves_the_pair_with_backlash(bench: Any) -> None:
    pair = bench.reference_pair.WITH_BACKLASH
    ours = bench.marchers.end_displacements(pair, 4, 2048)
    for name, solver in bench.peers.scipy_peers().items():
        position, _ = solver(pair, 4, 1e-8)
        theirs = bench.reference_pair.elastic(position)
        assert bench.reference_solution.displacement_error(theirs, ours) < 1e-5, name


def test_the_teeth_of_the_pair_with_backlash_separate(bench: Any) -> None:
    from tribodyn.dynamics import simulate

    pair = bench.reference_pair.WITH_BACKLASH
    start = bench.reference_pair.starting_state(pair)
    motion = simulate(bench.reference_pair.system(pair), pair.mesh_frequency, 30, start)
    last = motion.contact_force[-512:, 0]
    assert 0.1 < np.mean(last == 0.0) < 0.9


def test_cheapest_setting_is_the_first_that_suffices(bench: Any) -> None:
    exact = np.ones(5)
    trajectories = [(bench.reference_pair.D2, exact)]

    def solve(_: Any, setting: float) -> Any:
        return exact * (1.0 + setting)

    cheapest = bench.equal_accuracy.cheapest(solve, (1e-5, 1e-6, 1e-7), trajectories)
    assert cheapest.value == 1e-6
    with pytest.raises(RuntimeError, match="no setting"):
        bench.equal_accuracy.cheapest(solve, (1e-5,), trajectories)


def test_a_race_takes_turns(bench: Any) -> None:
    order: list[str] = []

    def runner(name: str) -> Any:
        def run() -> float:
            order.append(name)
            return 1.0

        return run

    times = bench.race.race({"a": runner("a"), "b": runner("b")}, 2)
    assert order == ["a", "b"] * 3  # the first round does not count
    assert [len(samples.processor) for samples in times.values()] == [2, 2]


def test_ratios_are_medians_over_the_rounds(bench: Any) -> None:
    ours = bench.race.Times([1.0, 2.0, 1.0], [0.0] * 3)
    theirs = bench.race.Times([10.0, 40.0, 30.0], [0.0] * 3)
    assert ours.faster_than(theirs) == 20.0
    assert ours.best == 1.0


@pytest.mark.parametrize(
    ("goal", "measured", "at_least", "verdict"),
    [(2.0, 2.0, True, "ok"), (2.0, 1.9, True, "missed"), (2.0, 2.1, False, "missed")],
)
def test_goals_are_judged(
    bench: Any, goal: float, measured: float, at_least: bool, verdict: str
) -> None:
    row = bench.race.Goal("speed", goal, measured, "m/s", at_least=at_least).row
    assert row[-1] == verdict


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("steady_state_speed", "multiplier"),
        ("steady_state_cycles", "flanks in touch"),
        ("speed_sweep", "contact lost"),
        ("bifurcation_speed", "6 degrees of freedom"),
        ("parameter_map", "6 x 6 points"),
        ("cold_start", "import tribodyn"),
        ("losses_speed", "loss map"),
        ("friction_speed", "plain formula"),
        pytest.param("learning_speed", "MINPACK", marks=pytest.mark.slow),
        ("signals_speed", "resampled"),
        ("study_speed", "the store costs"),
    ],
)
def test_quick_run_prints_its_table(
    bench: Any, capsys: pytest.CaptureFixture[str], script: str, expected: str
) -> None:
    getattr(bench, script).main(["--quick"])
    assert expected in capsys.readouterr().out
