"""Studies of planetary stages: modes, sweeps, run-ups, and values with a spread."""

import json
import sys

import numpy as np
import pytest
from tests.unit.study.test_machine_run import command
from tests.unit.study.test_planetary_case import QUICK
from tests.unit.study.test_summary_names import RMS

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.machine import load_shares
from tribodyn.mesh import sharing
from tribodyn.study import read_case
from tribodyn.study.studies.case_grid import results_under

#: Constant stiffness of a pair of teeth, so that the tooth contact takes no time.
FAST = QUICK | {"film.model": "none", "stiffness.model": "rectangular",
                "stiffness.pair_stiffness": "5e8 N/m"}  # fmt: skip
ERRORS = [f"planets.low.pin_errors.{i}" for i in (1, 2, 3)]


@pytest.fixture(scope="module")
def case():
    return td.load_case("planetary-stage").replace(FAST, by="test")


@pytest.fixture(scope="module")
def result(case):
    return td.run(case)


def test_modes_and_diagram_need_no_motion(case, result):
    modes = td.study.natural_modes(case)
    np.testing.assert_allclose(modes.frequency, result.modes.frequency)
    diagram = td.study.campbell(case, ("0 rpm", "3000 rpm"))
    named = ("mesh low x 1 (T)", "mesh low x 2 (T)", "mesh low x 3 (R)")
    assert diagram.excitation[:3] == named
    assert diagram.order[0] == pytest.approx(17 * (1 - 1 / 4.588235), rel=1e-6)
    first, second = diagram.frequency[:, 0], diagram.frequency[:, 1]
    # A pair of translational modes is one at rest and splits in proportion to the speed.
    assert second[0] - first[0] < 1e-6 * first[0]
    split = (second - first)[[2, 4]]
    assert split[1] / split[0] == pytest.approx(2.0, rel=1e-3)


def test_a_harmonic_excites_one_of_two_whirling_modes(result):
    """Planets in sequence push a member around: forwards or backwards, by their phases."""
    modes, orders = result.modes, result.operation.mesh_orders
    for order in orders[:2]:
        pairs = order.share[:2]
        assert pairs.min() < 1e-9 < 1e-3 < pairs.max()
    rotational = np.array(modes.of_stage("low").types) == "rotational"
    assert orders[2].share[~rotational].max() < 1e-9 < 0.5 < orders[2].share[rotational].max()


def test_levels_and_sweeps_have_the_figures_of_single_runs(case, result):
    levels = td.speed_sweep(case, ("1500 rpm", "1600 rpm"), 2)
    figures = result.summary()
    assert levels.mesh == ("sun", "ring")
    forces = [figures[f"meshes.low_{mesh}1.{RMS}"] for mesh in levels.mesh]
    np.testing.assert_allclose(levels.mesh_force[0], forces, rtol=1e-6)
    stage = result.operation.stage().motion
    pins = np.hypot(*stage.rms(stage.pin_force).T).max()
    assert levels.bearing_force[0, 0] == pytest.approx(pins, rel=1e-6)
    sweep = td.sweep(case, ERRORS[1], ("0 um", "40 um"), 2)
    for name, value in figures.items():
        assert sweep[name][0] == pytest.approx(value, rel=1e-6, abs=1e-9), name
    with pytest.warns(DeprecationWarning, match="meshes.low_sun2.peak_mesh_force"):
        greatest = sweep["meshes.sun.peak_mesh_force"]
    peaks = [sweep[f"meshes.low_sun{i}.peak_mesh_force"] for i in (1, 2, 3)]
    np.testing.assert_array_equal(greatest, np.max(peaks, axis=0))
    assert sweep.axes[0].name == "pin_errors_2"
    assert "Load factor" in sweep.plot().to_json()


def test_speeds_share_the_teeth_that_do_not_depend_on_them(case, monkeypatch):
    sys.modules["tribodyn.mesh.build"]._cached_teeth.cache_clear()
    computed, compute = [], sharing.ramps_about
    monkeypatch.setattr(sharing, "ramps_about", lambda *a: computed.append(a) or compute(*a))
    stage = case.replace({"stiffness.model": "iso6336", "stiffness.pair_stiffness": None})
    changes = [{"operation.speed": speed} for speed in (150.0, 160.0, 170.0)]
    results = [result for result, _ in results_under(stage, changes)]
    assert len(computed) == 2  # of the sun meshes and of the ring meshes
    sys.modules["tribodyn.mesh.build"]._cached_teeth.cache_clear()
    alone = td.run(stage.replace(changes[2])).summary()
    # A motion depends on no other one, and so not on how speeds are grouped.
    for name, value in results[2].figures.items():
        assert alone[name] == value, name


def test_a_slow_run_up_has_the_levels_of_steady_motions(case, result):
    rpm = np.pi / 30
    run = td.run_up(case, (1499 * rpm, 1501 * rpm), 0.02)
    middle = run.mesh_force[np.argmin(np.abs(run.speed - 1500 * rpm))]
    steady = [result.summary()[f"meshes.low_{mesh}1.{RMS}"] for mesh in run.mesh]
    np.testing.assert_allclose(middle, steady, rtol=0.01)


def test_variants_have_the_load_shares_of_their_errors(case):
    text = {"planets.low.pin_errors": "0 um +- 10 um", "planets.low.sun_support": "1e9 N/m"}
    spread = case.replace(text, by="test")
    assert list(spread.uncertain) == ERRORS
    assert read_case(spread.to_toml()).uncertain == spread.uncertain
    variants = td.ensemble(spread, size=4, seed=1)
    factors = variants.figures()["planets.low.load_factor"]
    assert factors[0] == pytest.approx(1.0)  # at the middle no pin has an error
    data = td.run(spread.replace(dict.fromkeys(ERRORS, 0.0))).operation.stage().plane_data
    for row, factor in zip(variants.value, factors[1:], strict=True):
        shares = load_shares(**{**data, "carrier_speed": 0.0, "pin_errors": row})
        assert factor == pytest.approx(shares.load_factor, rel=1e-9)
    statistics = td.study.load_share_statistics(spread, samples=20, seed=1)
    for pins, share in zip(statistics.pin_errors[:3], statistics.share, strict=False):
        expected = load_shares(**{**data, "carrier_speed": 0.0, "pin_errors": pins}).share
        np.testing.assert_allclose(share, expected, rtol=1e-9)
    assert "95 % of 4 stages" in variants.plot("load_share_statistics").layout.title.text
    with pytest.raises(InputError, match="has a spread"):
        td.study.load_share_statistics(case)


@pytest.mark.parametrize(
    ("changes", "location", "finding"),
    [
        ({"planets.low.pin_errors": "0 um +- 20 mm"}, "planets.low.pin_errors.1", "Allowed"),
        ({"planets.low.pin_errors.4": "5 um"}, "planets.low.pin_errors.4", "has 3 values"),
        ({"planets.low.pin_errors.1": "5 mm"}, "planets.low.pin_errors", "0.4 mm"),
        (
            {"planets.low.thickness_errors": ["0.5 mm", "0 m", "0 m"]},
            "thickness_errors",
            "0.4 mm",
        ),
        ({"operation.torque": "600 N +- 2 %"}, "operation.torque", "N"),
    ],
)
def test_spreads_that_make_no_sense_are_refused(case, changes, location, finding):
    with pytest.raises(InputError) as fault:
        case.replace({"planets.low.pin_errors": ["1 um", "0 um", "0 um"], **changes}, by="--set")
    assert location in str(fault.value)
    assert finding in str(fault.value)


@pytest.mark.parametrize(
    ("changes", "finding"),
    [
        ({"planets.low.count": 1}, "sun_support = 0 N/m with 1 planet"),
        ({"planets.low.ring_support": "0 N/m"}, "sun_support = 0 N/m and ring_support = 0 N/m"),
    ],
)
def test_members_that_nothing_holds_are_refused(case, changes, finding):
    with pytest.raises(InputError, match=finding):
        case.replace(changes, by="--set")
    held = case.replace({**changes, "planets.low.sun_support": "1e8 N/m"}, by="--set")
    assert (td.study.natural_modes(held).frequency > 0.0).all()


def test_commands(case, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(case.to_toml(), encoding="utf-8")
    assert command("modes", "s.toml", "--json") == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["excited_types"]["low"]["3"] == "R"
    assert len(facts["modes"]) == 17
    assert facts["modes"][0]["types"] == {"low": "translational"}
    assert command("sweep", "s.toml", "planets.low.pin_stifness=1e8..2e8 N/m:2") == 2
    assert 'Did you mean "planets.low.pin_stiffness"?' in capsys.readouterr().err
    assert command("sweep", "s.toml", "planets.low.pin_errors=0..9 um:2") == 2
    assert "such as planets.low.pin_errors.1" in capsys.readouterr().err
    assert command("sweep", "s.toml", "planets.low.pin_errors.4=0..9 um:2") == 1  # none is computed
    assert "has 3 values, counted from 1" in (tmp_path / "s-sweep" / "sweep.csv").read_text("utf-8")
    capsys.readouterr()
    setting = "planets.low.pin_errors=0 um +- 5 um"
    assert command("ensemble", "s.toml", "--size", "3", "--set", setting, "--json") == 0
    assert "planets.low.load_factor" in json.loads(capsys.readouterr().out)
