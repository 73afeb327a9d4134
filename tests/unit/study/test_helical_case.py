"""Helical and internal pairs in the case file and on the command line."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import tribodyn as td
from tribodyn.cli import call
from tribodyn.errors import InputError
from tribodyn.exchange import case_from_rexs, read_rexs, write_rexs
from tribodyn.mesh.gears import spatial_columns
from tribodyn.study import read_case
from tribodyn.study.case.provenance import changed_keys

CASE = """
[gears]
normal_module = "2 mm"
normal_pressure_angle = "20 deg"
helix_angle = "15 deg"
driver = "pinion"
[gears.pinion]
teeth = 21
face_width = "25 mm"
profile_shift_coefficient = 0.2
[gears.wheel]
teeth = -72
profile_shift_coefficient = -0.1
[operation]
speed = "3000 rpm"
speed_of = "pinion"
torque = "40 N*m"
[dynamics]
model = "torsional"
"""


@pytest.mark.parametrize("ring", ["teeth = -72", "teeth = 72\ninternal = true"])
def test_check_reports_the_geometry_of_a_ring(
    ring: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "ring.toml"
    path.write_text(CASE.replace("teeth = -72", ring), "utf-8")
    assert call(["check", str(path), "--json"]) == 0
    streams = capsys.readouterr()
    figures = json.loads(streams.out)
    expected = {
        "helix_angle": math.radians(15.0),
        "transverse_pressure_angle": math.radians(20.646896),
        "working_transverse_pressure_angle": math.radians(20.052474),
        "base_helix_angle": math.radians(14.076095),
        "transverse_contact_ratio": 1.708058,
        "overlap_ratio": 1.029808,
        "total_contact_ratio": 2.737866,
        "tip_diameter_wheel": 145.47977e-3,
        "least_contact_line_length": 43.49507e-3,
        "gear_ratio": -72.0 / 21.0,
    }
    assert {name: figures[name] for name in expected} == pytest.approx(expected, rel=1e-6)
    assert "[fillet-contact]" in streams.err


RING = (
    CASE.replace("torsional", "helical-12dof").replace('"pinion"\n[gears.p', '"DRIVER"\n[gears.p')
    + """
[stiffness]
model = "iso6336"
[friction]
law = "constant"
coefficient = 0.05
"""
)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_a_ring_runs_with_its_friction_and_moments(driver: str) -> None:
    """Friction takes its sliding work; moving both gears as one body compresses nothing."""
    result = td.run(read_case(RING.replace("DRIVER", driver)))
    figures, pair, mesh = result.summary(), result.case.gear_pair, result.mesh
    speed = np.abs(mesh.sliding_speed) * 0.05 / math.cos(pair.base_helix_angle)
    lost = float(mesh.grid.mean(mesh.by_share(speed))) * figures["mean_mesh_force"]
    assert figures["mean_friction_power"] == pytest.approx(lost, rel=1e-3)
    equal = 0.05 * figures["gear_loss_factor"] * figures["input_power"]
    assert lost == pytest.approx(equal, rel=0.1)
    axial = figures["mean_bearing_force_axial_pinion"] + figures["mean_bearing_force_axial_wheel"]
    assert axial == pytest.approx(0.0, abs=1e-6)
    first, second = pair.pinion.base_radius, pair.wheel.base_radius
    across, along = first - second, pair.line_of_action_length
    row = spatial_columns(mesh)["direction"]
    x1, y1, z1, tx1, ty1, tz1, x2, y2, z2, tx2, ty2, tz2 = row.T
    tolerance = 1e-9 * second
    assert np.abs([x1 + x2, y1 + y2, z1 + z2]).max() < tolerance
    assert np.abs(tz1 + tz2 + across * y2).max() < tolerance
    assert np.abs(ty1 + ty2 - across * z2).max() < tolerance
    # The first rotation counts the other way.
    assert np.abs(tx1 + tx2 - along * z2).max() < tolerance


def test_a_ring_loses_the_power_of_its_loss_factor() -> None:
    """Constant friction: loss = mu H_V, up to the unequal sharing of the load."""
    friction = '[stiffness]\nmodel = "iso6336"\n[friction]\nlaw = "constant"\ncoefficient = 0.05\n'
    figures = td.run(read_case(CASE + friction)).summary()
    lost = 0.05 * figures["gear_loss_factor"]
    assert 1.0 - figures["efficiency"] == pytest.approx(lost, rel=0.1)
    assert figures["mean_friction_power"] == pytest.approx(lost * figures["input_power"], rel=0.1)


def test_helical_pairs_have_solid_teeth_unless_another_model_is_chosen() -> None:
    case = read_case(CASE)
    assert case.stiffness.model == "fe3d"
    assert case.replace({"gears.helix_angle": 0.0}).stiffness.model == "fe2d"
    assert case.replace({"stiffness.model": "iso6336"}).stiffness.model == "iso6336"
    assert "stiffness.model" not in changed_keys(case)


HELICAL = (
    CASE.replace("-72", "72").replace("-0.1", "0.1").replace("torsional", "helical-12dof")
    + """
[stiffness]
model = "fe2d"
[friction]
law = "constant"
coefficient = 0.05
"""
)


def test_a_helical_pair_runs_with_axial_forces() -> None:
    """Axial force F_t tan(beta_w) at both supports, and the power that friction takes."""
    result = td.run(read_case(HELICAL))
    figures, pair = result.summary(), result.case.gear_pair
    mean = figures["mean_mesh_force"]
    axial = mean * math.tan(pair.base_helix_angle)
    assert figures["mean_bearing_force_axial_pinion"] == pytest.approx(axial, rel=1e-6)
    assert figures["mean_bearing_force_axial_wheel"] == pytest.approx(-axial, rel=1e-6)
    assert figures["face_load_factor"] == pytest.approx(1.0, abs=0.05)
    lost = 1.0 - figures["efficiency"]
    assert figures["mean_friction_power"] == pytest.approx(lost * figures["input_power"], rel=1e-3)


def test_speeds_of_a_ring_are_positive() -> None:
    case = read_case(CASE.replace('"pinion"\ntorque', '"wheel"\ntorque'))
    assert case.pinion_speed == pytest.approx(100.0 * math.pi * 72.0 / 21.0)


FAULTS = {
    "pinion_hand": ('teeth = -72\nhand = "up"', r"gears.wheel.hand: .*Allowed: right, left"),
    "contradiction": ("teeth = -72\ninternal = false", r"gears.wheel.teeth.*internal = false"),
    "small": ("teeth = -3", r"gears.wheel.teeth: teeth = -3. Allowed: 5 to 1000"),
    "inner": ("teeth = -20", r"the pinion has 21 teeth, the wheel -20. The gear inside of a ring"),
    "rim": ('teeth = -72\nrim_diameter = "150 mm"', r"gears.wheel.rim_diameter: rim diameter 150"),
}


@pytest.mark.parametrize(("change", "text"), FAULTS.values(), ids=list(FAULTS))
def test_faults_of_rings_name_the_key(change: str, text: str) -> None:
    with pytest.raises(InputError, match=text):
        read_case(CASE.replace("teeth = -72", change))


def test_a_model_of_external_teeth_is_refused_by_its_key() -> None:
    case = read_case(CASE).replace({"stiffness.model": "weber"})
    with pytest.raises(
        InputError, match=r'stiffness\.model: the stiffness model "weber" of a pair'
    ):
        td.run(case)


def test_faults_of_the_pinion() -> None:
    hands = CASE.replace("teeth = 21", 'teeth = 21\nhand = "right"')
    with pytest.raises(InputError, match=r"gears.wheel.hand: .*have equal hands"):
        read_case(hands.replace("teeth = -72", 'teeth = -72\nhand = "left"'))
    with pytest.raises(
        InputError, match=r"gears.hand: hand = .right. and hand = .left. are both given"
    ):
        read_case(
            CASE.replace("teeth = 21", 'teeth = 21\nhand = "left"').replace(
                '"15 deg"', '"15 deg"\nhand = "right"'
            )
        )
    for change, text in (
        ("teeth = 21\ninternal = true", "gears.pinion.internal: .*Only the wheel"),
        ('teeth = 21\nrim_diameter = "9 cm"', "gears.pinion.rim_diameter: .*Only a ring"),
    ):
        with pytest.raises(InputError, match=text):
            read_case(CASE.replace("teeth = 21", change))


def test_hand_of_the_pinion_alone() -> None:
    left = CASE.replace("teeth = 21", 'teeth = 21\nhand = "left"').replace("-72", "72")
    pair = read_case(left).gear_pair
    assert (pair.hand, pair.wheel.hand) == ("left", "right")
    by_wheel = CASE.replace("teeth = -72", 'teeth = 72\nhand = "left"')
    assert read_case(by_wheel).gear_pair.hand == "right"
    again = read_case(read_case(left).to_toml()).gear_pair
    assert again == pair


def test_rexs_has_the_helix_with_the_sign_of_its_hand(tmp_path: Path) -> None:
    case = read_case(CASE.replace("teeth = -72", 'teeth = 72\nhand = "right"'))
    path = tmp_path / "helical.rexs"
    write_rexs(case, path)
    stage = read_rexs(path).stages[0]
    angles = stage.gear_1.helix_angle, stage.gear_2.helix_angle
    assert angles == pytest.approx((-math.radians(15.0), math.radians(15.0)))
    assert case_from_rexs(read_rexs(path)).gear_pair == case.gear_pair


MACHINE = """
[shafts.input]
[shafts.output]
[bearings.A]
shaft = "input"
SUPPORT
[bearings.B]
shaft = "output"
SUPPORT
[gears.z1]
shaft = "input"
teeth = 21
face_width = "25 mm"
profile_shift_coefficient = 0.2
[gears.z2]
shaft = "output"
teeth = -72
face_width = "25 mm"
profile_shift_coefficient = -0.1
[meshes.first]
gears = ["z1", "z2"]
normal_module = "2 mm"
helix_angle = "15 deg"
backlash = "0.1 mm"
[operation]
input = "input"
speed = "3000 rpm"
torque = "40 N*m"
output = "output"
[stiffness]
model = "iso6336"
[friction]
law = "constant"
coefficient = 0.05
""".replace(
    "SUPPORT",
    'position = "0 mm"\nradial_stiffness = "1e11 N/m"\naxial_stiffness = "1e11 N/m"\n'
    'tilting_stiffness = "1e9 N*m/rad"',
)


def test_a_ring_in_a_machine_has_the_forces_of_the_pair(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(MACHINE, "utf-8")
    figures = td.run(td.load_case(path)).summary()
    pair = td.run(read_case(RING.replace("DRIVER", "pinion"))).summary()
    mesh = {name.removeprefix("meshes.first."): figures[name] for name in figures}
    assert mesh["mean_mesh_force"] == pytest.approx(pair["mean_mesh_force"], rel=1e-3)
    assert mesh["mean_mesh_stiffness"] == pytest.approx(pair["mean_mesh_stiffness"], rel=2e-2)
    axial = pair["mean_bearing_force_axial_pinion"]
    assert abs(figures["bearings.A.mean_axial_force"]) == pytest.approx(axial, rel=1e-3)
    assert mesh["friction_power"] == pytest.approx(pair["mean_friction_power"], rel=2e-2)
    assert figures["shafts.output.speed"] == pytest.approx(100.0 * math.pi * 21.0 / 72.0)
    exchanged = MACHINE.replace('["z1", "z2"]', '["z2", "z1"]\nangle = "180 deg"')
    path.write_text(exchanged, "utf-8")
    other = td.run(td.load_case(path)).summary()
    turned = ("first.axial_force",)  # on the first gear of the mesh, now the ring
    for key, value in figures.items():
        sign = -1.0 if key.endswith(turned) else 1.0
        assert other[key] == pytest.approx(sign * value, rel=1e-6, abs=1e-9), key
