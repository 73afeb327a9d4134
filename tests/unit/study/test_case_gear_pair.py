"""What a case leaves out of its gears, and what its backlash does to them."""

import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.study.pipeline.assembly import geometry

MINIMAL = """
[gears]
normal_module = "3 mm"
normal_pressure_angle = "20 deg"
driver = "pinion"
[gears.pinion]
teeth = 25
face_width = "20 mm"
[gears.wheel]
teeth = 40
[operation]
speed = "1000 rpm"
torque = "100 N*m"
[dynamics]
bearing_stiffness = "1e9 N/m"
"""


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "minimal.toml"
    path.write_text(MINIMAL)
    return td.load_case(path)


def test_a_minimal_case_is_enough(case):
    assert case.gear_pair.center_distance == pytest.approx(1.5e-3 * 65)
    assert case.gear_pair.wheel.face_width == 20e-3
    figures = td.run(case).summary()
    assert figures["mean_mesh_force"] == pytest.approx(100.0 / case.gear_pair.pinion.base_radius)


def test_gears_without_a_bore_are_measured_against_the_rim(case):
    rows = {row.key: row for row in td.run(case).assumptions}
    assert "rim" in rows["stiffness.reference"].value
    with pytest.raises(InputError, match="bore_diameter"):
        case.replace({"stiffness.reference": "bore"})


def test_backlash_thins_both_teeth(case):
    thin = case.replace({"dynamics.backlash": "0.1 mm"}).gear_pair
    full = case.gear_pair
    assert thin.backlash == pytest.approx(0.1e-3, rel=1e-9)
    assert full.backlash == pytest.approx(0.0, abs=1e-12)
    for gear in ("pinion", "wheel"):
        thinned, other = getattr(thin, gear), getattr(full, gear)
        radius = other.base_radius
        less = other.tooth_thickness(radius) - thinned.tooth_thickness(radius)
        assert less == pytest.approx(0.05e-3, rel=1e-6)


def test_less_backlash_than_the_centre_distance_leaves_is_a_contradiction(case):
    wide = case.replace({"gears.center_distance": "97.7 mm"})
    play = wide.backlash
    assert play > 0.1e-3
    with pytest.raises(InputError) as caught:
        wide.replace({"dynamics.backlash": "0.05 mm"})
    assert "0.05 mm" in str(caught.value)
    assert f"{play * 1e3:.6g} mm" in str(caught.value)
    assert "dynamics.backlash" in str(caught.value)


def test_zero_backlash_is_the_linear_mesh_of_full_teeth(case):
    linear = case.replace({"dynamics.backlash": "0 mm"})
    assert linear.gear_pair == case.gear_pair
    assert linear.backlash == 0.0


def test_check_reports_by_how_much_the_backlash_thins_the_teeth() -> None:
    case = td.load_case("fzg-roughness")
    figures = geometry(case)
    thinned = figures["tooth_thinning_pinion"] + figures["tooth_thinning_wheel"]
    full = geometry(case.replace({"dynamics.backlash": None}))
    assert full["tooth_thinning_pinion"] == 0.0
    assert thinned == pytest.approx(figures["backlash"] - full["backlash"], abs=1e-6)
