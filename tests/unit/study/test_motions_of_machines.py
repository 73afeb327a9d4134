"""Diagrams, branches, exponents and basins of machines and stages, against single runs of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from test_machine_case import SMALL

import tribodyn as td
from tribodyn.dynamics.modal.modal_march import compile_modal
from tribodyn.dynamics.orbits.system_family import family_of
from tribodyn.errors import InputError
from tribodyn.nonlinear import bifurcation
from tribodyn.study import read_case
from tribodyn.study.studies import nonlinear
from tribodyn.study.studies.case_grid import moving, moving_at, settling_periods
from tribodyn.study.studies.needs import STUDIES, require_short, takes

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")


@pytest.fixture(scope="module")
def small() -> Any:
    return read_case(SMALL, "small.toml")


@pytest.fixture(scope="module")
def stage() -> Any:
    return td.load_case("planetary-stage")


def compression_rms(result: Any, contact: int) -> float:
    fine = result.response.fine
    values = fine.deflection[:, contact]
    return float(np.sqrt(fine.mean((values - fine.mean(values)) ** 2)))


@pytest.mark.parametrize("study", ["bifurcation", "continuation", "basins"])
def test_a_study_of_several_meshes_asks_for_one(small: Any, study: str) -> None:
    ranges = ("1000 rpm", "1100 rpm")
    options = {} if study == "basins" else {"between": ranges}
    with pytest.raises(InputError, match=f"{study} is about one mesh") as caught:
        getattr(td, study)(small, **options)
    assert "--mesh first" in str(caught.value)
    with pytest.raises(InputError, match='no mesh "third"'):
        getattr(td, study)(small, mesh="third", **options)


def test_every_kind_of_case_moves(small: Any, stage: Any) -> None:
    for study in ("bifurcation", "continuation", "basins", "lyapunov"):
        assert takes(study, small)
        assert takes(study, stage)
    assert "bifurcation" in STUDIES


def test_contacts_of_meshes_are_counted_in_the_order_of_the_machine(small: Any, stage: Any) -> None:
    assert [moving(small, mesh).contact for mesh in small.meshes] == [0, 1]
    names = [f"low_{kind}{number}" for number in (1, 2, 3) for kind in ("sun", "ring")]
    assert [moving(stage, mesh).contact for mesh in names] == list(range(6))


def test_motion_of_a_small_machine_is_that_of_its_run(small: Any) -> None:
    diagram = td.bifurcation(small, between=("1200 rpm", "1234 rpm"), points=2, mesh="second",
                             cycles=4, keep=4, steps=128, verdict=False)  # fmt: skip
    assert diagram.signal == "mesh second"
    assert diagram.period.tolist() == [[1, 1]]
    assert diagram.rms[0, 1] == pytest.approx(0.0, abs=1e-10)  # nothing excites constant springs
    spectrum = td.lyapunov_exponents(small, cycles=4, transient=4, steps=128, verdict=False)
    assert spectrum.largest < 0.0


@pytest.mark.slow
def test_motions_of_a_stage_are_those_of_its_run(stage: Any) -> None:
    ends, mesh = ("1500 rpm", "1530 rpm"), "sun"
    exact = [
        compression_rms(td.run(stage.replace({"operation.speed": speed})), 0) for speed in ends
    ]
    diagram = td.bifurcation(stage, between=ends, points=2, mesh=mesh, cycles=4, keep=4)
    assert diagram.signal == "mesh low_sun1"
    assert diagram.verdicts() == {"physical": 2}
    assert diagram.rms[0] == pytest.approx(exact, rel=1e-4)
    branch = td.continuation(stage, between=ends, mesh=mesh, longest_step=0.5)
    assert branch.contact_loss.shape[1] == 1
    assert [branch.rms[0, 0], branch.rms[-1, 0]] == pytest.approx(exact, rel=1e-4)
    spectrum = td.lyapunov_exponents(stage.replace({"operation.speed": ends[0]}), cycles=40,
                                     transient=160, verdict=False)  # fmt: skip
    growth = np.log(np.abs(branch.floquet_multipliers[0, 0])) * branch.mesh_frequency[0]
    assert spectrum.largest == pytest.approx(growth, rel=1e-4)


@pytest.mark.slow
def test_a_family_of_machines_is_the_machine_at_each_speed(stage: Any) -> None:
    def at(value: float) -> Any:
        return moving_at(stage, "operation.speed", "low_sun1", value)

    ends = (150.0, 165.0)
    family = family_of(at, ends, 64)
    assert family is not None
    value = 153.3
    compiled, frequency = family(value)
    exact = at(value)
    assert frequency == pytest.approx(exact.frequency, rel=1e-12)
    for name in ("stiffness", "gyroscopic"):
        matrix = np.asarray(getattr(exact.system, name))
        assert np.abs(getattr(compiled.system, name) - matrix).max() <= 1e-8 * np.abs(matrix).max()


def test_a_diagram_of_a_machine_is_as_long_as_that_of_a_pair(small: Any) -> None:
    """A period of the clock has many mesh cycles: so many fewer periods are followed."""
    ends = {"between": ("1200 rpm", "1234 rpm"), "points": 2, "mesh": "second", "verdict": False}
    fastest = max(small.machine().clock.cycles.values())
    assert fastest > 4
    diagram = td.bifurcation(small, **ends)
    assert diagram.section.shape[2] == max(16, -(-64 // fastest))
    longer = td.bifurcation(small, **ends, cycles=40)
    assert longer.section.shape[2] == 40
    assert longer.rms == pytest.approx(diagram.rms, rel=1e-9, abs=1e-12)


def test_a_motion_settles_as_long_as_its_slowest_mode_decays(small: Any) -> None:
    member = moving(small, "second")
    member = member._replace(frequency=100.0 * member.frequency)
    slowest = -float(compile_modal(*member[:3]).engine.motion.modes.values.real.max())
    assert settling_periods(member) == int(np.ceil(np.log(1e9) * member.frequency / slowest)) > 10
    contacts = [replace(each, damping=0.0) for each in member.system.contacts]
    undamped = replace(member.system, damping=0.0 * member.system.damping, contacts=contacts)
    assert settling_periods(member._replace(system=undamped)) == 500


def test_a_branch_with_too_many_derivatives_is_refused_with_a_remedy(
    small: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    require_short("continuation", 2432, 114)
    require_short("bifurcation", 6528, 109)
    with pytest.raises(InputError, match=r"would follow 3.1e\+08 derivatives"):
        require_short("continuation", 6528, 109)
    monkeypatch.setitem(STUDIES, "continuation", STUDIES["continuation"]._replace(most=1e4))
    with pytest.raises(InputError, match="derivatives over each period") as caught:
        td.continuation(small, between=("1200 rpm", "1234 rpm"), mesh="second")
    assert "bifurcation, which needs none" in str(caught.value)


@pytest.mark.parametrize("study", ["lyapunov_exponents", "continuation", "basins"])
def test_what_takes_too_long_is_refused_before_teeth_are_computed(
    small: Any, study: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    needs = {name: need._replace(most=1e4) for name, need in STUDIES.items()}
    monkeypatch.setattr("tribodyn.study.studies.needs.STUDIES", needs)
    monkeypatch.setattr(nonlinear, "_PATIENCE", 1e-3)
    monkeypatch.setattr(nonlinear, "moving_at", None)

    def rehearsed(*of_case: Any, rehearsal: bool = False) -> Any:
        assert rehearsal
        return moving(*of_case, rehearsal=True)

    monkeypatch.setattr(nonlinear, "moving", rehearsed)
    options = {} if study == "lyapunov_exponents" else {"mesh": "second"}
    if study == "continuation":
        options["between"] = ("1200 rpm", "1234 rpm")  # type: ignore[assignment]
    with pytest.raises(InputError) as caught:
        getattr(td, study)(small, **options)
    assert all(problem.why and problem.remedy for problem in caught.value.problems)


def test_starts_of_a_machine_are_as_many_as_one_waits_for(
    small: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each start takes thrice the steps of its settling; twice as many values have four times."""
    told: list[str] = []
    monkeypatch.setattr(nonlinear, "announce", told.append)
    rehearsed = moving(small, "second")
    steps = rehearsed.steps * rehearsed.system.cycles
    monkeypatch.setattr(nonlinear, "_STEP", 1.0 / (steps * rehearsed.system.size))
    settling = settling_periods(rehearsed)
    for each, count in ((9.0, 3), (36.0, 6), (1e9, 41)):
        monkeypatch.setattr(nonlinear, "_PATIENCE", 3.0 * settling * (each + 0.5))
        assert nonlinear._starts(small, "second", 500, None) == count
        assert f"{count} x {count} starts" in told[-1]
    monkeypatch.setattr(nonlinear, "_PATIENCE", 3.0 * settling * 8.5)
    with pytest.raises(InputError, match="3 x 3 starts take"):
        nonlinear._starts(small, "second", 500, None)


def test_the_time_of_a_long_diagram_is_said_before_it_is_computed(
    small: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    monkeypatch.setattr(bifurcation, "announce", told.append)
    monkeypatch.setattr(bifurcation, "_LONG", 0.0)
    monkeypatch.setattr(bifurcation, "_MANY", 0.0)
    ends = {"between": ("1200 rpm", "1234 rpm"), "points": 2, "mesh": "second", "verdict": False}
    td.bifurcation(small, **ends)
    steps = 128 * max(small.machine().clock.cycles.values())
    assert len(told) == 1
    assert f"2 motions with {steps} steps in each period" in told[0]
    longest = settling_periods(moving(small.replace({"operation.speed": "1234 rpm"}), "second"))
    assert f"up to {max(32, longest)} periods until each repeats" in told[0]
    assert "fewer values" in told[0]
