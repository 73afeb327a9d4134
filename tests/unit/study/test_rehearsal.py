"""A rehearsal refuses what a run refuses because of the case alone; a run-away names friction."""

import tracemalloc
import warnings

import pytest

import tribodyn as td
from tribodyn.cli import main
from tribodyn.errors import ComputationError, InputError, ModelWarning
from tribodyn.friction import LAWS
from tribodyn.study.machine.run import rehearse_machine
from tribodyn.study.pipeline.run import computed, rehearse


def _message(study, case):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        try:
            study(case)
        except InputError as error:
            return str(error)
    return ""


_REFUSED = {
    "friction.law": ["benedict-kelly", "xu-2007"],
    "gears.composite_roughness": ["0.5 um", "1.2 um", "3.2 um"],
    "stiffness.model": ["potential-energy", "weber", "iso6336", "analytic"],
    "operation.speed": ["1000 rpm", "0.02 rpm"],
}


@pytest.mark.parametrize("law", _REFUSED["friction.law"])
@pytest.mark.parametrize("roughness", _REFUSED["gears.composite_roughness"])
def test_a_rehearsal_fails_as_the_run_does(law, roughness):
    case = td.load_case("fzg-roughness").replace(
        {"friction.law": law, "gears.composite_roughness": roughness}
    )
    message = _message(rehearse, case)
    assert message == _message(computed, case)
    assert bool(message) == (
        roughness == "3.2 um" or (roughness, law) == ("1.2 um", "benedict-kelly")
    )


@pytest.mark.parametrize("model", _REFUSED["stiffness.model"])
@pytest.mark.parametrize("speed", _REFUSED["operation.speed"])
def test_models_and_speeds(model, speed):
    """The tooth of "weber" has no bore; a speed may be too slow to be marched."""
    case = td.load_case("fzg-roughness").replace(
        {"stiffness.model": model, "operation.speed": speed, "stiffness.reference": "bore"}
        if model == "weber"
        else {"stiffness.model": model, "operation.speed": speed}
    )
    message = _message(rehearse, case)
    assert bool(message) == (model == "weber" or speed == "0.02 rpm")
    if message:
        assert message.split(" ")[0] == _message(computed, case).split(" ")[0]


@pytest.mark.parametrize("key", ["roughness_ra", "roughness_rms"])
def test_a_refused_roughness_is_named_by_its_key(key):
    roughness = {f"gears.{gear}.{key}": "3 um" for gear in ("pinion", "wheel")}
    case = td.load_case("fzg-roughness").replace(
        {"friction.law": "xu-2007", "gears.composite_roughness": None, **roughness}
    )
    assert f"gears.pinion.{key}: xu-2007" in _message(rehearse, case)


def test_check_rehearses(tmp_path, capsys):
    path = tmp_path / "rough.toml"
    rough = td.load_case("fzg-roughness").replace({"gears.composite_roughness": "1.2 um"})
    path.write_text(rough.to_toml(), encoding="utf-8")
    with pytest.raises(SystemExit) as left:
        main(["check", str(path)])
    assert left.value.code == 2
    assert "diverges at 1.13 um" in capsys.readouterr().err


@pytest.mark.parametrize(
    "name",
    ["fzg-roughness", pytest.param("helical-pair", marks=pytest.mark.slow), "planetary-stage"],
)
def test_a_slow_case_is_rehearsed_without_the_tables_of_its_run(name):
    """Steps of a mesh cycle grow with its length; tables of all steps take up to 3 GB."""
    changes = {"stiffness.model": "iso6336", "operation.speed": "1 rpm", "load_cases": None}
    if name != "planetary-stage":
        changes |= {"solver.steps_per_mesh_cycle": 131072}
        del changes["load_cases"]
    case = td.load_case(name).replace(changes)
    tracemalloc.start()
    try:
        assert not _message(rehearse_machine if "load_cases" in changes else rehearse, case)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 150e6


def test_too_few_steps_are_refused_as_in_the_run():
    slow = {"operation.speed": "1 rpm", "solver.steps_per_mesh_cycle": 4096}
    case = td.load_case("fzg-roughness").replace({**slow, "film.model": "moes"})
    message = _message(rehearse, case)
    assert "Runge-Kutta is unstable" in message
    assert message == _message(computed, case)


@pytest.mark.parametrize("speed", ["0.06 rpm", "1 rpm"])
def test_a_slow_stage_needs_no_steps_of_a_time_integration(speed):
    """Its motion is found by harmonic balance, at any speed."""
    case = td.load_case("planetary-stage").replace(
        {"operation.speed": speed, "film.model": "dowson-higginson", "load_cases": None}
    )
    assert _message(rehearse_machine, case) == _message(td.run, case) == ""


def test_a_law_of_a_third_party_is_checked_too():
    """One mechanism for all models: the model itself says no."""

    @LAWS.define("shy", source="test", meaning="refuses rough flanks", needs_oil=True)
    def shy(contact):
        if contact.composite_roughness > 1e-7:
            raise InputError("too rough for the shy law", "argument roughness", "", "Polish")
        return 0.0 * contact.load_per_width + 0.05

    try:
        case = td.load_case("fzg-roughness").replace({"friction.law": "shy"})
        assert "too rough for the shy law" in _message(rehearse, case)
        assert not _message(rehearse, case.replace({"gears.composite_roughness": "0.05 um"}))
    finally:
        LAWS._items.pop("shy")


def test_a_run_away_names_the_friction_first(monkeypatch):
    case = td.load_case("fzg-roughness").replace({"gears.composite_roughness": "1.1 um",
                                                  "friction.law": "benedict-kelly"})  # fmt: skip

    def fails(*_):
        raise ComputationError("the motion grew beyond all bounds", why="a parametric resonance")

    monkeypatch.setattr("tribodyn.study.pipeline.run.motion_of", fails)
    with pytest.raises(ComputationError) as caught:
        td.run(case)
    first, second = caught.value.problems
    assert first.what.startswith("the friction coefficient reaches 0.78")
    assert second.why == "a parametric resonance"
    with pytest.raises(ComputationError) as caught:
        td.run(td.load_case("fzg-roughness"))
    assert len(caught.value.problems) == 1
