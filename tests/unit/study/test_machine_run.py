"""Run of a machine: figures by part, files, report; and the modes of a machine."""

import json
from dataclasses import replace

import numpy as np
import pytest

import tribodyn as td
from tribodyn import plot
from tribodyn.cli import main
from tribodyn.machine import machine_modes
from tribodyn.study import read_case
from tribodyn.study.machine.modes import axial_notes, mode_rows
from tribodyn.study.machine.run import structure_at_rest
from tribodyn.study.pipeline.summary_figures import figure_of, is_figure
from tribodyn.study.studies.needs import STUDIES, takes

#: The geared shafts whose natural frequencies are printed, with a spur mesh of constant stiffness.
GEARED = """
title = "Two geared shafts"
[shafts.input]
sections = [["120 mm", "55 mm"], ["50 mm", "70 mm"], ["130 mm", "55 mm"]]
[shafts.output]
sections = [["125 mm", "75 mm", "20 mm"], ["50 mm", "90 mm", "20 mm"], ["125 mm", "75 mm", "20 mm"]]
[bearings]
B = { shaft = "input", position = "280 mm", radial_stiffness = "4e8 N/m" }
D = { shaft = "output", position = "280 mm", radial_stiffness = "5e8 N/m" }
[bearings.A]
shaft = "input"
position = "20 mm"
radial_stiffness = "4e8 N/m"
axial_stiffness = "2e8 N/m"
[bearings.C]
shaft = "output"
position = "20 mm"
radial_stiffness = "5e8 N/m"
axial_stiffness = "2e8 N/m"
[gears.z1]
shaft = "input"
position = "145 mm"
teeth = 27
face_width = "50 mm"
mass = "4 kg"
moment_of_inertia = "0.006 kg*m^2"
transverse_moment_of_inertia = "0.004 kg*m^2"
[gears.z2]
shaft = "output"
position = "150 mm"
teeth = 51
face_width = "50 mm"
mass = "18 kg"
moment_of_inertia = "0.140 kg*m^2"
transverse_moment_of_inertia = "0.075 kg*m^2"
[meshes.first]
gears = ["z1", "z2"]
normal_module = "4.5 mm"
helix_angle = "21 deg"
hand = "left"
center_distance = "190 mm"
angle = "30 deg"
stiffness = "5.2e8 N/m"
transmission_error_amplitude = "2 um"
[operation]
input = "input"
output = "output"
speed = "3000 rpm"
torque = "600 N*m"
[[load_cases]]
name = "light"
torque = "300 N*m"
"""
#: At 3000 rpm, the free rotation left out [Hz].
PRINTED = (414.96, 644.20, 693.93, 696.12, 795.98, 868.51, 1380.73, 1421.45, 2376.6, 2478.6, 3047.7)


def command(*arguments: str) -> int:
    """Exit code of a command."""
    with pytest.raises(SystemExit) as stop:
        main(list(arguments))
    return int(stop.value.code or 0)


@pytest.fixture(scope="module")
def case():
    return read_case(GEARED, "geared.toml")


@pytest.fixture(scope="module")
def result(case):
    return td.run(case)


def test_modes_of_the_geared_shafts_are_the_printed_ones(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "geared.toml").write_text(GEARED, encoding="utf-8")
    assert command("modes", "geared.toml", "--json") == 0
    modes = json.loads(capsys.readouterr().out)["modes"]
    frequencies = [mode["frequency"] for mode in modes[: len(PRINTED)]]
    np.testing.assert_allclose(frequencies, PRINTED, rtol=1e-3)
    assert sum(modes[0]["strain_share"].values()) == pytest.approx(1.0, abs=1e-9)
    report = (tmp_path / "geared-modes" / "report.html").read_text(encoding="utf-8")
    assert "Campbell diagram of the machine" in report


def test_forces_and_speeds_follow_from_torque_and_teeth(result):
    figures = result.summary()
    beta_b = np.radians(19.679338)
    radius = 0.5 * 27 * 4.5e-3 / np.cos(np.radians(21.0)) * np.cos(np.radians(21.299064))
    assert figures["meshes.first.mesh_frequency"] == pytest.approx(50.0 * 27)
    assert figures["meshes.first.mean_mesh_force"] == pytest.approx(600.0 / radius, rel=1e-6)
    assert figures["shafts.output.speed"] == pytest.approx(-100.0 * np.pi * 27 / 51)
    assert figures["shafts.output.torque"] == pytest.approx(600.0 * 51 / 27)
    # The axial force of the helix acts on the only axial bearing of each shaft.
    axial = 600.0 / radius * np.tan(beta_b)
    assert abs(figures["bearings.A.mean_axial_force"]) == pytest.approx(axial, rel=1e-6)
    assert abs(figures["bearings.C.mean_axial_force"]) == pytest.approx(axial, rel=1e-6)


def test_radial_bearing_forces_are_those_of_hand_statics(result):
    motion, machine = result.motion, result.machine
    forces = {
        name: motion.mean(motion.bearing_force[:, i]) for i, name in enumerate(motion.bearing)
    }
    load = machine.gear_loads["z1"]
    # Moments of the gear's force and moment about bearing A, with B at 260 mm.
    arm, span = 0.145 - 0.020, 0.260
    by_hand = np.array([load[1] * arm + load[5], load[2] * arm - load[4]]) / span
    np.testing.assert_allclose(forces["B"][1:3], by_hand, rtol=1e-6)
    np.testing.assert_allclose((forces["A"] + forces["B"])[1:3], load[1:3], rtol=1e-6)


def test_half_the_torque_has_half_the_mean_force_and_the_same_vibration(result):
    figures = result.summary()
    for key, factor in (("mean_mesh_force", 0.5), ("alternating_rms_mesh_force", 1.0)):
        full = figures[f"meshes.first.{key}"]
        light = figures[f"load_cases.light.meshes.first.{key}"]
        assert light == pytest.approx(factor * full, rel=1e-6)


def test_lines_of_the_spectrum_belong_to_the_mesh(result):
    motion = result.motion
    assert motion.mesh_orders(2) == {1: [("first", 1)], 2: [("first", 2)]}
    lines = np.abs(motion.harmonics(motion.mesh_force, np.array([1, 2])))
    assert lines[0, 0] > 1e6 * lines[1, 0]  # a linear machine answers the error at its order only


def test_a_result_is_saved_with_its_report_and_every_figure(result, tmp_path):
    folder = result.save(tmp_path / "out", csv=True)
    names = {path.name for path in folder.iterdir()}
    files = {"case.toml", "summary.json", "motion.nc", "load-1-motion.nc", "report.html"}
    assert names == {*files, "response.csv"}
    assert json.loads((folder / "summary.json").read_text()) == result.summary()
    again = read_case((folder / "case.toml").read_text(encoding="utf-8"), "case.toml")
    assert again.to_toml() == result.case.to_toml()
    text = (folder / "report.html").read_text(encoding="utf-8")
    for heading in ("The machine", "Flow of power", "Which mesh causes which line", "Mesh first"):
        assert heading in text
    with pytest.raises(td.errors.OutputExistsError):
        result.save(folder)
    result.save(folder, force=True)


def test_every_key_of_the_summary_has_a_meaning_and_a_unit(result):
    rows = result.rows()
    assert {row[1] for row in rows} == set(result.summary())
    assert all(meaning for *_, meaning in rows)


def test_commands_for_pairs_name_those_for_machines(capsys):
    assert command("experiment", "friction", "two-stage-spur") == 2
    message = capsys.readouterr().err
    assert "this is a machine, and experiment does not take one" in message
    listed = message.partition("Studies of a machine: ")[2].rstrip(".\n").split(", ")
    assert listed == [name for name in STUDIES if takes(name, td.load_case("two-stage-spur"))]
    assert {"run", "study", "harris", "losses", "relief", "recording"} <= set(listed)


def test_check_shows_speeds_and_torques(capsys):
    assert command("check", "two-stage-spur") == 0
    captured = capsys.readouterr()
    (row,) = [line for line in captured.out.splitlines() if "mesh_frequency [Hz]" in line]
    assert row.split()[-1] == "423.68"


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:\\[friction-range\\]")
def test_the_built_in_reducer_runs_with_its_teeth(tmp_path):
    case = td.load_case("two-stage-spur").replace({"load_cases": None})
    result = td.run(case)
    figures = result.summary()
    assert figures["meshes.second.mesh_frequency"] == pytest.approx(3000 / 60 * 23 / 57 * 21)
    for name in ("first", "second"):
        mean, static = (figures[f"meshes.{name}.{k}_mesh_force"] for k in ("mean", "static"))
        assert mean == pytest.approx(static, rel=0.02)  # friction shifts the mean
        assert 1.0 < figures[f"meshes.{name}.dynamic_factor_peak"] < 2.0
    assert 0.98 < figures["machine.efficiency"] < 1.0
    contacts = result.operation.system.contacts
    assert [contact.ramp_gap(0.3).size for contact in contacts] == [9, 9]  # one contact per mesh
    linear = td.run(case.replace({"dynamics.mesh_law": "tangent"})).summary()
    for key in ("first.peak", "second.peak", "first.minimum", "second.minimum"):
        name = f"meshes.{key}_mesh_force"
        assert figures[name] == pytest.approx(linear[name], rel=0.01)  # the teeth hardly part
    folder = result.save(tmp_path / "out")
    assert (folder / "mesh-first.nc").is_file()


def test_a_mode_along_the_axis_of_a_shaft_names_what_holds_it():
    spur = GEARED.replace('helix_angle = "21 deg"\nhand = "left"\ncenter_distance = "190 mm"\n', "")
    case = read_case(spur.replace('"2e8 N/m"\n[gears', '"3e5 N/m"\n[gears'))
    modes = machine_modes(structure_at_rest(case))
    (note,) = [each for each in axial_notes(modes) if "shaft output" in each]
    assert "C with 0.3 N/um holds it at this load, D not at all" in note
    mass = modes.structure.shafts["output"].mass[::6, ::6].sum() + 18.0
    hertz = np.sqrt(3e5 / mass) / (2.0 * np.pi)
    assert float(note.partition("(")[2].partition(" Hz")[0]) == pytest.approx(hertz, rel=1e-3)
    number = int(note.split()[1])
    (row,) = [row for row in mode_rows(modes) if row[0] == str(number)]
    assert row[3].endswith("output along its axis")


def test_figures_of_a_load_case_whose_name_has_a_dot():
    figure = figure_of("load_cases.1.5 kW.meshes.first.rms_mesh_force")
    assert (figure.unit, figure.topic) == ("N", "1.5 kW: Mesh first")
    assert not is_figure("meshes.first.no_such_figure")
    assert not is_figure("no_such_figure")


def test_names_of_bearings_do_not_overlap_in_the_side_view():
    text = GEARED.replace("[bearings.A]", '[bearings."left bearing of the input shaft"]')
    names = ('"second bearing"', '"third bearing"')
    more = "".join(
        f'[bearings.{name}]\nshaft = "input"\nposition = "{at} mm"\nradial_stiffness = "1e8 N/m"\n'
        for name, at in zip(names, (40, 60), strict=True)
    )
    figure = plot.machine(read_case(text.replace("[gears.z1]", f"{more}[gears.z1]")).machine())
    notes = {note.text: note for note in figure.layout.annotations}
    shifts = [notes[name].yshift for name in notes if "bearing" in name]
    assert len(set(shifts)) == 3
    assert {notes[name].yshift for name in "BCD"} == {0}  # short names stay on their axis


def test_of_a_very_long_period_the_beginning_is_drawn(result):
    motion = result.motion
    count = 40_000 // motion.clock.size + 1
    clock = (np.arange(count)[:, None] + motion.clock).ravel() / count
    force = np.tile(motion.mesh_force, (count, 1))
    bearings = np.tile(motion.bearing_force, (count, 1, 1))
    weight = np.tile(motion.weight, count) / count
    parts = {"clock": clock, "mesh_force": force, "bearing_force": bearings, "weight": weight}
    figure = plot.machine_forces(replace(motion, **parts))
    assert max(len(trace.x) for trace in figure.data) == 30_000
    assert "its first" in figure.layout.xaxis.title.text
    assert "its first" not in plot.machine_forces(motion).layout.xaxis.title.text


def test_without_a_friction_law_no_efficiency_is_stated() -> None:
    gears = {
        name: {"shaft": shaft, "teeth": teeth, "face_width": "30 mm"}
        for name, shaft, teeth in (("z1", "in", 17), ("z2", "out", 23))
    }
    case = td.study.MachineCase(
        gears=gears, meshes={"pair": {"gears": ["z1", "z2"], "normal_module": "3 mm"}},
        stiffness={"model": "iso6336"},
        operation={"input": "in", "output": "out", "speed": "1000 rpm", "torque": "100 N*m"},
    )  # fmt: skip
    names = {"machine.friction_power", "machine.efficiency", "meshes.pair.friction_power"}
    assert not names & set(td.run(case).summary())
    law = {"friction.law": "constant", "friction.coefficient": 0.05}
    figures = td.run(case.replace(law)).summary()
    lost = figures["machine.friction_power"]
    assert lost == figures["meshes.pair.friction_power"] > 0.0
    assert figures["machine.efficiency"] == pytest.approx(1.0 - lost / (100.0 * 1000 / 30 * np.pi))
