"""Planetary stages in the case of a machine with further shafts."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.plot.machine.orders import gains as gains_of
from tribodyn.study.machine.case import MachineCase

TEXT = """
title = "Planetary and parallel stage"
[lubricant]
name = "ISO VG 320"
temperature = "60 degC"
[gears]
s = { shaft = "low", teeth = 22, face_width = "200 mm" }
p = { teeth = 29, face_width = "200 mm" }
r = { shaft = "ring", teeth = -80, face_width = "200 mm" }
wheel = { shaft = "low", position = "400 mm", teeth = 88, face_width = "150 mm" }
pinion = { shaft = "high", teeth = 23, face_width = "150 mm" }
[planets.main]
sun = "s"
ring = "r"
planet = "p"
carrier = "rotor"
count = 3
normal_module = "10 mm"
[meshes.last]
gears = ["wheel", "pinion"]
normal_module = "7 mm"
helix_angle = "12 deg"
[operation]
input = "rotor"
output = "high"
speed = "20 rpm"
torque = "200 kN*m"
"""


def read(tmp_path: Path, text: str = TEXT) -> MachineCase:
    path = tmp_path / "case.toml"
    path.write_text(text, encoding="utf-8")
    case = td.load_case(path)
    assert isinstance(case, MachineCase)
    return case


def test_a_stage_with_further_shafts_is_a_machine(tmp_path: Path) -> None:
    case = read(tmp_path)
    machine = case.machine()
    flow = machine.kinematics
    ratio = (1.0 + 80.0 / 22.0) * 88.0 / 23.0
    assert flow.shafts["high"].speed == pytest.approx(-20.0 * math.pi / 30.0 * ratio, rel=1e-12)
    assert flow.shafts["high"].torque == pytest.approx(200e3 / ratio, rel=1e-9)
    assert flow.shafts["ring"].speed == 0.0
    assert [n for n, bearing in machine.bearings.items() if bearing.holds] == ["main_ring"]
    sun = case.pair("main_sun2", case.operating_point)
    force = 200e3 * 22 / 102 / 3 / (0.5 * 22 * 10e-3 * math.cos(math.radians(20.0)))
    assert flow.meshes["main_sun2"].force == pytest.approx(force, rel=1e-9)
    assert sun.gear_pair.center_distance == pytest.approx(0.255)
    assert sun.gears.driver == "wheel"  # the planets drive the sun
    relative = flow.shafts["low"].speed - flow.shafts["rotor"].speed
    assert sun.operation.speed == pytest.approx(relative, rel=1e-12)
    # The ring mesh has the centre distance of the sun mesh, and all phases follow from the teeth.
    ring = case.pair("main_ring2", case.operating_point).gear_pair
    assert abs(ring.center_distance) == pytest.approx(0.255)
    offsets = [machine.meshes[f"main_sun{i}"].offset for i in (1, 2, 3)]
    assert offsets == pytest.approx([0.0, (-22 / 3) % 1.0, (-44 / 3) % 1.0])
    assert case.tooth_group("main_sun1") == case.tooth_group("main_sun3")
    assert read(tmp_path, case.to_toml()).to_toml() == case.to_toml()


def test_power_of_a_stage_enters_by_the_carrier(tmp_path: Path) -> None:
    machine = read(tmp_path).machine()
    gains = [gains_of(machine, machine.kinematics, mesh) for mesh in machine.meshes]
    for gain in gains:
        assert sum(gain.values()) == pytest.approx(0.0, abs=1e-6)
    power = sum(gain.get("rotor", 0.0) for gain in gains)
    assert power == pytest.approx(-200e3 * 20.0 * math.pi / 30.0, rel=1e-9)


def test_faults_of_a_stage_name_the_key_of_the_file(tmp_path: Path) -> None:
    for old, new, message in (
        ("count = 3", "count = 4", r"planets\.main"),
        ('planet = "p"', 'planet = "q"', r'planets\.main\.planet.*no gear "q"'),
        ("teeth = -80", "teeth = 80", r"gears\.r\.teeth"),
        ("count = 3", 'count = 3\nangles = ["0 deg"]', r"planets\.main\.angles"),
    ):
        with pytest.raises(InputError, match=message):
            read(tmp_path, TEXT.replace(old, new))


def test_rigid_members_need_no_table_of_shafts() -> None:
    case = td.load_case("wind-turbine-gearbox")
    assert isinstance(case, MachineCase)
    assert case.implied_shafts == ("ring", "rotor")
    machine = case.machine()
    notes = td.plot.machine(machine).layout.annotations
    texts = [note.text for note in notes]
    assert "ring, main_planet1, 3" in texts
    assert "<b>low, ring, rotor</b>" in texts
    places = {(note.x, note.y, note.xshift, note.yshift) for note in notes}
    assert len(places) == len(texts)  # no name is behind another


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.friction-range")  # slow planets
def test_the_wind_turbine_gearbox_runs() -> None:
    result = td.run(td.load_case("wind-turbine-gearbox"))
    figures = result.summary()
    assert result.operation.response.converged
    teeth = {m: figures[f"meshes.main_{m}1.static_mesh_force"] for m in ("sun", "ring")}
    assert teeth["sun"] == pytest.approx(teeth["ring"], rel=1e-6)
    assert 1.0 < figures["planets.main.load_factor"] < 1.1  # the wheel pushes the sun aside
    ratio = (1.0 + 80.0 / 22.0) * 88.0 / 23.0
    assert figures["machine.output_torque"] == pytest.approx(
        250e3 / ratio * figures["machine.efficiency"], rel=1e-9
    )
    base = 0.5 * 22 * 11e-3 * math.cos(math.radians(20.0))
    suns = sum(figures[f"meshes.main_sun{i}.mean_mesh_force"] for i in (1, 2, 3))
    assert suns * base == pytest.approx(250e3 * 22 / 102, rel=2e-2)  # friction takes a part
    lost = sum(v for k, v in figures.items() if k.endswith(".friction_power") and "meshes" in k)
    assert figures["machine.friction_power"] == pytest.approx(lost)
    lines = [trace.name for trace in td.plot.machine_campbell(result.campbell).data]
    assert {name for name in lines if name.startswith("mesh")} == {"mesh last", "mesh main"}
    assert lines.count("mesh main") == 3  # the harmonics of six meshes


DOUBLE = """
[lubricant]
name = "ISO VG 220"
temperature = "70 degC"
[film]
model = "dowson-higginson"
[friction]
law = "constant"
coefficient = 0.05
[gears]
s = { teeth = 24, face_width = "20 mm" }
p = { teeth = 16, face_width = "20 mm" }
q = { teeth = 18, face_width = "20 mm" }
r = { teeth = -66, face_width = "20 mm", tip_diameter = "129 mm" }
[planets.low]
sun = "s"
ring = "r"
planet = "p"
ring_planet = "q"
planet_type = "meshed"
carrier = "c"
count = 3
normal_module = "2 mm"
[dynamics]
backlash = "0.1 mm"
[operation]
input = "s"
output = "c"
speed = "1500 rpm"
torque = "60 N*m"
"""
STEPPED = (
    DOUBLE.replace("meshed", "stepped").replace("24", "18").replace("teeth = 16", "teeth = 30")
)


def test_pairs_of_planets_from_a_file(tmp_path: Path) -> None:
    case = read(tmp_path, DOUBLE)
    machine = case.machine()
    flow = machine.kinematics
    speed = 1500.0 * math.pi / 30.0
    assert flow.shafts["c"].speed == pytest.approx(speed / (1.0 - 66 / 24), rel=1e-12)
    assert flow.shafts["r"].torque == pytest.approx(60.0 * 66 / 24, rel=1e-12)
    assert flow.meshes["low_pair1"].force == pytest.approx(flow.meshes["low_sun1"].force)
    # 24 teeth of the sun and 3 pairs: all sun meshes are in phase, and so are the others.
    for kind in ("sun", "pair", "ring"):
        offsets = [machine.meshes[f"low_{kind}{i}"].offset for i in (1, 2, 3)]
        assert [math.cos(math.tau * (o - offsets[0])) for o in offsets] == pytest.approx([1.0] * 3)
    pair = case.pair("low_pair2", case.operating_point)
    assert pair.gear_pair.center_distance == pytest.approx(0.034)
    assert case.tooth_group("low_pair1") == case.tooth_group("low_pair3")
    assert read(tmp_path, case.to_toml()).to_toml() == case.to_toml()


def test_stepped_planets_from_a_file(tmp_path: Path) -> None:
    machine = read(tmp_path, STEPPED).machine()
    flow = machine.kinematics
    assert flow.shafts["c"].torque == pytest.approx(60.0 * (1.0 + 66 * 30 / (18 * 18)), rel=1e-12)
    assert machine.clock.cycles["low_sun1"] * 3 == machine.clock.cycles["low_ring1"] * 5
    assert machine.gears["low_ring_planet2"].position == pytest.approx(0.02)
    assert flow.meshes["low_ring1"].force / flow.meshes["low_sun1"].force == pytest.approx(30 / 18)
    module = STEPPED.replace('"2 mm"', '"2 mm"\nring_normal_module = "2.5 mm"')
    with pytest.raises(InputError, match="center"):
        read(tmp_path, module)


def test_faults_of_double_planets_name_the_key_of_the_file(tmp_path: Path) -> None:
    for old, new, message in (
        ('ring_planet = "q"\n', "", r"planets\.low\.ring_planet.*without ring_planet"),
        ('planet_type = "meshed"', "", "single"),
        ("count = 3", "count = 4", r"planets\.low.*\(66 - 24\)/4 = 10.5 is not whole"),
        ('"meshed"', '"double"', r"planets\.low\.planet_type"),
    ):
        with pytest.raises(InputError, match=message):
            read(tmp_path, DOUBLE.replace(old, new))


def test_the_mirrored_stage_has_mirrored_phases(tmp_path: Path) -> None:
    """A torque on the sun the other way round is the stage seen from behind."""
    lags = {}
    for text, speed, mesh in ((TEXT, "20 rpm", "main_ring1"), (DOUBLE, "1500 rpm", "low_pair1")):
        meshes = [
            read(tmp_path, each).machine().meshes
            for each in (text, text.replace(f'"{speed}"', f'"-{speed}"'))
        ]
        lags[mesh] = [-m[mesh].offset % 1.0 for m in meshes]
    assert lags["main_ring1"][0] == pytest.approx(lags["main_ring1"][1])
    # Seen from behind the second planet of a pair is at the other side of the first, so that the
    # first one turns by twice the angle from its outward direction to its mate.
    to_sun, to_ring, between = 40.0, 48.0, 34.0
    line = math.pi - math.acos((to_sun**2 + between**2 - to_ring**2) / (2.0 * to_sun * between))
    forward, backward = lags["low_pair1"][0], lags["low_pair1"][1]
    assert (forward + 16 * line / math.pi) % 1.0 == pytest.approx(backward, abs=1e-9)


@pytest.mark.slow
def test_losses_of_stepped_planets(tmp_path: Path) -> None:
    figures = td.run(read(tmp_path, STEPPED)).summary()
    lost = sum(figures[f"meshes.low_{m}{i}.friction_power"] for m in ("sun", "ring") for i in "123")
    assert figures["machine.friction_power"] == pytest.approx(lost)
    power = 60.0 * 1500.0 * math.pi / 30.0
    assert figures["machine.efficiency"] == pytest.approx(1.0 - lost / power, rel=1e-6)
    assert 0.98 < figures["machine.efficiency"] < 1.0
    assert figures["planets.low.load_factor"] == pytest.approx(1.0, abs=1e-6)
