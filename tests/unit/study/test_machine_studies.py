"""Machines compared with each other and with recordings, and with values that are spread."""

import json

import numpy as np
import pytest
from tests.unit.study.test_machine_over_speed import TEETH
from tests.unit.study.test_machine_run import GEARED, command

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.measurement import Recording, compare
from tribodyn.study import read_case

#: A machine of two meshes whose errors have one line each.
TWO_MESHES = """
[gears]
z1 = { shaft = "in", teeth = 20, face_width = "30 mm" }
z2 = { shaft = "middle", teeth = 40, face_width = "30 mm" }
z3 = { shaft = "middle", position = "60 mm", teeth = 25, face_width = "40 mm" }
z4 = { shaft = "out", teeth = 50, face_width = "40 mm" }
[shafts]
in = {}
middle = {}
out = {}
[meshes.first]
gears = ["z1", "z2"]
normal_module = "3 mm"
stiffness = "3e8 N/m"
transmission_error_amplitude = "2 um"
[meshes.second]
gears = ["z3", "z4"]
normal_module = "4 mm"
stiffness = "5e8 N/m"
transmission_error_amplitude = "3 um"
[bearings]
A = { shaft = "in", position = "0 mm", radial_stiffness = "2e8 N/m", axial_stiffness = "1e8 N/m" }
C = { shaft = "out", position = "0 mm", radial_stiffness = "2e8 N/m" }
[bearings.B]
shaft = "middle"
position = "30 mm"
radial_stiffness = "2e8 N/m"
tilting_stiffness = "1e6 N*m/rad"
[operation]
input = "in"
output = "out"
speed = "1200 rpm"
torque = "100 N*m"
"""


@pytest.fixture(scope="module")
def result():
    return td.run(read_case(TWO_MESHES))


def recording(result, ratio=1.0, noise=0.0):
    """Transmission error of the second mesh at another speed, and pulses of the middle shaft."""
    motion, rate = result.motion, 40000.0
    time = np.arange(0.0, 4.0, 1.0 / rate)
    phase = time * ratio * motion.frequency
    signal = np.interp(phase % 1.0, motion.clock, motion.transmission_error[:, 1])
    turns = phase * float(result.machine.clock.turns["middle"])
    channels = {
        "error": signal + noise * np.random.default_rng(1).standard_normal(time.size),
        "tacho": (turns % 1.0 < 0.5).astype(float),
    }
    return Recording(channels, rate, {"error": "m", "tacho": "V"})


def test_spectra_over_the_order_of_a_mesh_have_the_lines_of_all_meshes(result):
    spectra = result.mesh_spectra("second")
    assert spectra.attrs["mesh_frequency"] == pytest.approx(1200 / 60 * 20 / 40 * 25)
    assert spectra.attrs["teeth"] == [25, 50]
    lines = spectra["bearings.B.force_y_spectrum"]
    size = {order: float(lines.sel(order=order, method="nearest")) for order in (1.0, 1.2, 1.6)}
    assert size[1.0] > 1.0
    assert size[1.6] > 1e-2  # 40 cycles of the first mesh on 25 of the second
    assert size[1.2] < 1e-6 * size[1.6]
    with pytest.raises(InputError, match="Known: first, second"):
        result.mesh_spectra("third")


def test_a_recording_of_the_same_motion_agrees_and_gives_its_speed(result):
    channels = {"error": "meshes.second.transmission_error"}
    for options in ({}, {"tacho": "tacho", "teeth": 25}):
        record = recording(result, 1.004, 1e-8)
        comparison = compare(result, record, channels, mesh="second", harmonics=1, **options)
        assert comparison.speed_ratio == pytest.approx(1.004, rel=1e-5)
        assert comparison.mesh_frequency == pytest.approx(250.0)
        assert np.abs(comparison.error).max() < 0.01
    with pytest.raises(InputError, match="no sensor is named"):
        compare(result, record, {"error": "meshes.second.error"}, mesh="second")
    with pytest.raises(InputError, match="third"):
        compare(result, record, channels, mesh="third")


def test_machines_are_compared_by_values_and_figures(result):
    case = result.case.replace({"bearings.A.radial_stiffness": "3e8 N/m"})
    comparison = td.compare_results(result, td.run(case), names=("soft", "stiff"))
    assert comparison.values == {"bearings.A.radial_stiffness": (2e8, 3e8)}
    assert comparison.figures["bearings.A.radial_stiffness"] == (2e8, 3e8)
    assert "from soft to stiff" in comparison.plot().layout.title.text
    with pytest.raises(InputError, match="of pairs or of machines"):
        td.compare_results(result, 5)


def test_commands_compare_results_and_a_recording(result, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    result.save("first")
    td.run(result.case.replace({"operation.torque": "110 N*m"})).save("second")
    record = recording(result)
    table = np.c_[np.arange(record["error"].size) / record.sample_rate, record["error"]]
    head = "time [s],error [m]"
    np.savetxt("record.csv", table, "%.9g", ",", header=head, comments="")
    assert command("compare", "first", "second", "--json") == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["values"] == {"operation.torque": [100.0, 110.0]}
    key = "meshes.first.static_mesh_force"
    assert facts["figures"][key][1] == pytest.approx(1.1 * facts["figures"][key][0])
    channel = "error=meshes.second.transmission_error"
    options = ("--mesh", "second", "--harmonics", "1", "--json")
    assert command("compare", "first", "record.csv", "--channel", channel, *options) == 0
    assert json.loads(capsys.readouterr().out)["speed_ratio"] == pytest.approx(1.0, abs=1e-4)


def test_variants_have_the_figures_of_their_values():
    case = read_case(TWO_MESHES)
    spread = {"operation.torque": "100 N*m +- 3 %", "meshes.first.stiffness": "3e8 N/m +- 5 %"}
    variants = td.ensemble(case, spread, 4, seed=1)
    figures = variants.figures()
    assert variants.value.shape == (4, 2)
    torque = variants.value[:, 0]
    force = figures["meshes.first.static_mesh_force"]
    assert force[1:] / torque == pytest.approx(np.full(4, force[1] / torque[0]))
    assert force[0] / np.median(torque) == pytest.approx(force[1] / torque[0])
    assert figures["meshes.first.mean_mesh_stiffness"][1:] == pytest.approx(variants.value[:, 1])
    assert "95 % of the variants" in variants.plot().layout.title.text


def test_the_torque_causes_the_spread_of_the_static_force():
    case = read_case(TWO_MESHES.replace('"100 N*m"', '"100 N*m +- 3 %"'))
    case = case.replace({"bearings.A.radial_stiffness": "2e8 N/m +- 10 %"}, by="test")
    assert read_case(case.to_toml()).uncertain == case.uncertain
    shares = td.sobol_indices(case, "meshes.first.static_mesh_force", size=4, seed=1)
    assert list(shares.input) == ["bearings.A.radial_stiffness", "operation.torque"]
    assert shares.total_order[0, 0] < 1e-9 < 0.1 < shares.total_order[0, 1]


@pytest.mark.parametrize(
    ("spread", "text"),
    [
        ({"bearings.Z.radial_stiffness": "1e8 N/m +- 2 %"}, "there is no key"),
        ({"bearings.A.shaft": "1 +- 2 %"}, "cannot be spread"),
        ({"stiffness_scale": "1 +- 2 %"}, "cannot be spread"),
        ({"meshes.first.stiffness": "3e8 N +- 5 %"}, "wrong kind of quantity"),
        ({}, "nothing is spread"),
    ],
)
def test_spreads_that_make_no_sense_are_refused(spread, text):
    with pytest.raises(InputError, match=text):
        td.ensemble(read_case(TWO_MESHES), spread, 4, seed=1)


def test_a_spread_beyond_the_range_of_its_key_is_refused_in_the_file():
    with pytest.raises(InputError, match=r"meshes\.first\.stiffness"):
        read_case(TWO_MESHES.replace('"3e8 N/m"', '"uniform 1 N/m .. 3e8 N/m"'))


def test_the_command_for_ensembles_takes_machines(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.toml").write_text(TWO_MESHES, encoding="utf-8")
    setting = "meshes.second.stiffness=5e8 N/m +- 5 %"
    assert command("ensemble", "two.toml", "--size", "3", "--set", setting, "--json") == 0
    assert "meshes.second.alternating_rms_mesh_force" in json.loads(capsys.readouterr().out)
    assert "Spread of the levels" in (tmp_path / "two-ensemble" / "report.html").read_text("utf-8")


def test_keys_of_machines_have_units():
    case, teeth = read_case(GEARED), read_case(TEETH)
    units = {
        "bearings.A.radial_stiffness": "N/m",
        "meshes.first.transmission_error_amplitude": "m",
        "operation.torque": "N*m",
        "gears.z1.mass": "kg",
        "dynamics.modal_damping_ratio": "",
    }
    for key, unit in units.items():
        assert case.option_of(key).unit == unit, key
    assert teeth.option_of("gears.z1.modification.tip_relief").unit == "m"
    assert teeth.option_of("friction.coefficient").unit == ""
    assert teeth.option_of("stiffness.pair_stiffness").unit == "N/m"
    for key in ("bearings.A.teeth", "bearings.A", "operation", "shafts.none.density"):
        assert case.option_of(key) is None, key
    values = dict(case.values())
    assert values["bearings.A.radial_stiffness"] == 4e8
    assert values["gears.z1.position"] == pytest.approx(0.145)
    assert values["load_cases.light.torque"] == 300.0
