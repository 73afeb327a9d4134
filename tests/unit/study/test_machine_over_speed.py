"""Machines over the speed: sweeps of any key, levels of steady motions, run-ups."""

import json

import numpy as np
import pytest
from tests.unit.study.test_machine_run import GEARED, command

import tribodyn as td
from tribodyn.mesh.build import _cached_teeth
from tribodyn.plot import FIGURES
from tribodyn.study import read_case
from tribodyn.study.studies.sweep import points_under

#: The same machine with computed teeth: spur gears of constant friction.
TEETH = (
    GEARED.replace('helix_angle = "21 deg"\nhand = "left"\n', "")
    .replace('stiffness = "5.2e8 N/m"\ntransmission_error_amplitude = "2 um"\n', "")
    .replace('center_distance = "190 mm"\n', "")
    + """
[stiffness]
model = "rectangular"
pair_stiffness = "5e8 N/m"
[friction]
law = "constant"
coefficient = 0.05
[dynamics]
backlash = "0.1 mm"
"""
)


@pytest.fixture(scope="module")
def case():
    return read_case(GEARED)


@pytest.fixture(scope="module")
def levels(case):
    return td.speed_sweep(case, ("2500 rpm", "3500 rpm"), 5)


def test_a_sweep_of_any_key_has_the_figures_of_single_runs(case):
    over = {"bearings.A.radial_stiffness": ["3e8 N/m", "4e8 N/m"], "operation.torque": [500.0, 600]}
    sweep = td.sweep(case, over)
    assert sweep.shape == (2, 2)
    changes = {"bearings.A.radial_stiffness": 3e8, "operation.torque": 600.0, "load_cases": None}
    single = td.run(case.replace(changes)).summary()
    for name, value in single.items():
        assert sweep[name][0, 1] == pytest.approx(value, rel=1e-7, abs=1e-12), name
    peak = sweep["meshes.first.mean_mesh_force"]
    assert peak[:, 1] / peak[:, 0] == pytest.approx([1.2, 1.2])


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.friction-range")
@pytest.mark.parametrize("name", ["two-stage-helical", "planetary-stage"])
def test_a_speed_has_the_figures_of_a_run_of_its_own_in_any_order(name):
    """Balance and matrices at rest are shared by speeds of one torque, those of others are not."""
    case, single = td.load_case(name), {}
    torque, speed = case.operating_point.torque, case.operating_point.speed
    changes = [
        {"operation.speed": float(a * speed), "operation.torque": float(b * torque)}
        for a, b in ((1.3, 1.0), (0.3, 1.0), (0.3, 0.8), (1.3, 0.8))
    ]
    for number, change in enumerate(changes):
        fresh = td.load_case(name).replace({**change, "load_cases": None})
        single[number] = td.run(fresh).summary()
    for order in ((0, 1, 2, 3), (3, 0, 2, 1)):
        points = points_under(case, [changes[number] for number in order])
        for number, point in zip(order, points, strict=True):
            for key, value in single[number].items():
                assert point.figures[key] == pytest.approx(value, rel=1e-12, abs=1e-18), key


@pytest.mark.parametrize(
    ("key", "text"),
    [
        ("bearings.Z.radial_stiffness", 'Did you mean "bearings.D.radial_stiffness"'),
        ("bearings.A.radal_stiffness", 'Did you mean "bearings.A.radial_stiffness"'),
        ("operation", "there is no key"),
        ("meshes.first.stiffness", "cannot be expressed in N/m"),
    ],
)
def test_a_wrong_key_or_unit_is_refused_before_anything_is_computed(case, key, text):
    with pytest.raises(td.errors.InputError, match=text):
        td.sweep(case, key, ("1 mm", "2 mm"), 2)


def test_a_value_that_cannot_be_computed_is_listed_and_the_others_go_on(case):
    sweep = td.sweep(case, "gears.z1.position", ("145 mm", "345 mm"), 2)
    assert sweep.failed[0] == ""
    assert "gears.z1.position" in sweep.failed[1]


def test_levels_are_those_of_each_speed_and_of_the_line_that_causes_them(case, levels):
    assert levels.speed * 30 / np.pi == pytest.approx([2500, 2750, 3000, 3250, 3500])
    figures = td.run(case.replace({"load_cases": None})).summary()
    middle = (levels.mesh_force[2, 0], levels.transmission_error[2, 0], *levels.bearing_force[2])
    ends = ("alternating_rms_mesh_force", "transmission_error_peak_to_peak", "rms_radial_force")
    names = [key for end in ends for key in figures if key.endswith(end)]
    assert middle == pytest.approx([figures[name] for name in names], rel=1e-6)
    # A linear machine answers its sinusoidal error with one line.
    assert levels.line[0] == "first x 1"
    assert levels.mesh_force_line[:, 0, 0] == pytest.approx(np.sqrt(2.0) * levels.mesh_force[:, 0])
    assert np.all(levels.mesh_force_line[:, 1:] < 1e-6 * levels.mesh_force_line[:, :1])
    assert levels.order[:2] == pytest.approx([27.0, 54.0])


def test_the_level_has_a_maximum_where_the_mesh_meets_a_mode(case, levels):
    met = td.speed_sweep(case, ("1300 rpm", "2900 rpm"), 4).resonances[0]
    assert met.harmonic == 1  # there are no others
    assert met.frequency == pytest.approx(27 * met.speed / (2 * np.pi), rel=1e-6)
    near = td.speed_sweep(case, (0.9 * met.speed, 1.1 * met.speed), 3)
    response = near.bearing_force_line[:, 0].max(axis=1)
    assert response[1] > 1.5 * max(response[0], response[2])


def test_a_run_up_so_slow_that_nothing_changes_has_the_levels_of_the_steady_motion(case):
    ends = ("3000 rpm", "3000.01 rpm")
    steady = td.speed_sweep(case, ends, 2)
    slow = td.run_up(case, ends, 0.02)
    assert slow.time[-1] == pytest.approx(0.02, abs=1.0 / 1350)
    for name in ("mesh_force", "transmission_error", "bearing_force"):
        parts = getattr(slow, name)[[0, -1]], getattr(steady, name)
        assert parts[0] == pytest.approx(parts[1], rel=2e-3), name


def test_a_fast_run_up_lags_behind_the_resonance_and_says_what_is_coarse(case):
    met = td.speed_sweep(case, ("1600 rpm", "1900 rpm"), 3).resonances[0]
    run = td.run_up(case, (0.93 * met.speed, 1.07 * met.speed), 0.05, down=True)
    level, rising = run.bearing_force.max(axis=1), run.time < 0.05
    tops = [run.speed[part][np.argmax(level[part])] for part in (rising, ~rising)]
    assert tops[1] < tops[0]  # each way the vibration follows late
    with pytest.warns(td.errors.ModelWarning, match="rise more slowly"):
        td.run_up(case, (0.93 * met.speed, 1.07 * met.speed), 0.002)


def test_teeth_whose_load_does_not_depend_on_the_speed_are_computed_once():
    case = read_case(TEETH)
    td.run(case.replace({"load_cases": None}))
    before = _cached_teeth.cache_info().misses
    levels = td.speed_sweep(case, ("2000 rpm", "3000 rpm"), 3)
    assert _cached_teeth.cache_info().misses == before
    assert not any(levels.failed)
    sweep = td.sweep(case, "operation.speed", ("2000 rpm", "3000 rpm"), 3)
    assert _cached_teeth.cache_info().misses == before
    power = sweep["meshes.first.friction_power"]
    assert power / power[-1] == pytest.approx([2 / 3, 5 / 6, 1.0])  # of constant friction


def test_commands_write_the_levels(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pair.toml").write_text(GEARED, encoding="utf-8")
    assert command("sweep", "pair.toml", "operation.speed=2500..3500 rpm:2") == 0
    assert "meshes.first.alternating_rms_mesh_force" in capsys.readouterr().out
    report = (tmp_path / "pair-sweep" / "report.html").read_text(encoding="utf-8")
    assert "Levels of the parts" in report
    assert command("run-up", "pair.toml", "2500..2600 rpm", "--duration", "0.01", "--json") == 0
    facts = json.loads(capsys.readouterr().out)
    assert len(facts["alternating_rms_mesh_force"]["first"]) == len(facts["speed"])
    assert (tmp_path / "pair-run-up" / "study.nc").is_file()


def test_figures_name_the_mesh_and_the_mode(levels, case):
    for name in ("machine_levels", "machine_level_lines"):
        figure = FIGURES[name](levels)
        assert "rpm" in figure.layout.title.text
        marks = [note.text for note in figure.layout.annotations]
        assert all("mode" in text or "lies on" in text for text in marks), marks
        assert any("mode" in text for text in marks)
    sweep = td.sweep(case, "bearings.A.radial_stiffness", ("3e8 N/m", "4e8 N/m"), 2)
    assert {trace.name for trace in sweep.plot().data} == {"first", *"ABCD"}
    assert sweep.plot("bearings.B.rms_radial_force").layout.title.text
