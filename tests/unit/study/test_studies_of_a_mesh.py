"""Studies of one mesh of a machine or a stage, and the table of what each study takes."""

import pytest

import tribodyn as td
from tribodyn.cli.app import COMMANDS
from tribodyn.study import harris_map, loss_map, operating_data, optimize_tip_relief, read_case
from tribodyn.study.studies.needs import KINDS, PARTS, STUDIES, kind_of, mesh_names, takes

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_MODELS = """
[operation]
speed = "1500 rpm"
torque = "120 N*m"
{operation}
[lubricant]
name = "ISO VG 100"
temperature = "60 degC"
[friction]
law = "schlenk"
[stiffness]
model = "iso6336"
"""
_PAIR = """
[gears]
normal_module = "3 mm"
center_distance = "135 mm"
driver = "pinion"
normal_pressure_angle = "20 deg"
composite_roughness = "0.5 um"
[gears.pinion]
teeth = 29
face_width = "20 mm"
[gears.wheel]
teeth = 61
face_width = "20 mm"
[dynamics]
model = "spur-6dof"
bearing_stiffness = "1e9 N/m"
"""
_MACHINE = """
[gears.a]
shaft = "in"
teeth = 29
face_width = "20 mm"
[gears.b]
shaft = "out"
teeth = 61
face_width = "20 mm"
[meshes.only]
gears = ["a", "b"]
normal_module = "3 mm"
center_distance = "135 mm"
composite_roughness = "0.5 um"
"""
_ENDS = 'input = "in"\noutput = "out"'


def _cases():
    pair = read_case(_PAIR + _MODELS.format(operation='speed_of = "pinion"'))
    return pair, read_case(_MACHINE + _MODELS.format(operation=_ENDS))


def test_a_mesh_between_rigid_shafts_is_the_pair():
    pair, machine = _cases()
    torques = ["60 N*m", "120 N*m"]
    alone, inside = harris_map(pair, torques), harris_map(machine, torques)
    assert inside.transmission_error == pytest.approx(alone.transmission_error, rel=1e-9)
    point = {"torque": torques, "speed": ["750 rpm", "1500 rpm"]}
    alone, inside = loss_map(pair, **point), loss_map(machine, mesh="only", **point)
    assert inside.efficiency == pytest.approx(alone.efficiency, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "mesh"),
    [
        pytest.param("two-stage-spur", "second", marks=pytest.mark.slow),
        ("planetary-stage", "ring"),
    ],
)
def test_the_better_case_has_the_error_of_the_optimum(name, mesh):
    case = td.load_case(name).replace({"stiffness.model": "iso6336", "load_cases": None})
    torques = ["150 N*m", "300 N*m"]
    best = optimize_tip_relief(case, torques, mesh=mesh, phases=64, grid=(5, 5))
    assert kind_of(best.case) == kind_of(case)
    before, after = (
        harris_map(each, best.torque, mesh=mesh, phases=64) for each in (case, best.case)
    )
    for study, peak in ((before, best.peak_to_peak_before), (after, best.peak_to_peak_after)):
        assert study.peak_to_peak_transmission_error == pytest.approx(peak, rel=2e-3)
    assert best.objective < best.objective_before


def test_a_mesh_is_named_where_there_are_several():
    case = td.load_case("two-stage-spur")
    with pytest.raises(td.InputError, match="Meshes with computed teeth: first, second"):
        harris_map(case)
    with pytest.raises(td.InputError, match='no mesh "secnd"'):
        loss_map(case, mesh="secnd")
    given = {f"meshes.{name}.stiffness": 5e8 for name in case.meshes}
    with pytest.raises(td.InputError, match="no mesh has computed teeth"):
        harris_map(case.replace(given))


def test_equal_planets_are_one_mesh():
    assert mesh_names(td.load_case("wind-turbine-gearbox")) == ("last", "main_sun1", "main_ring1")
    assert mesh_names(td.load_case("planetary-stage")) == ("sun", "ring")
    assert mesh_names(td.load_case("fzg-film")) == ("mesh",)


def test_flanks_of_a_hypoid_mesh_take_no_tip_relief():
    for name in ("hypoid-axle", "hypoid-mixed-ehl"):
        with pytest.raises(td.InputError, match="is a hypoid pair"):
            optimize_tip_relief(td.load_case(name), ["100 N*m", "200 N*m"])


def test_the_table_names_commands_and_decides_by_kind():
    commands = {each.name for each in COMMANDS}
    assert {study.partition(" ")[0] for study in STUDIES} - {"film"} <= commands
    cases = {kind_of(case): case for case in map(td.load_case, td.cases(machines=True))}
    assert set(KINDS) - {"mesh table"} == set(cases)
    for study, need in STUDIES.items():
        for kind, case in cases.items():
            assert takes(study, case) == (kind in need.kinds or (need.of_mesh and kind in PARTS))


@pytest.mark.parametrize("name", ["planetary-stage", "machine"])
def test_a_surrogate_learns_the_levels_of_parts(name):
    case = _cases()[1] if name == "machine" else td.load_case(name)
    over = {"operation.torque": "100 N*m .. 130 N*m"}
    data = operating_data(case, over, 4, seed=1)
    point = {"operation.torque": float(data["operation.torque"][2])}
    figures = td.run(case.replace(point)).summary()
    levels = [key for key in data.columns if key.endswith(".alternating_rms_mesh_force")]
    assert data.rows == 4
    assert levels
    for key in levels:
        assert data[key][2] == pytest.approx(figures[key], rel=1e-5)
        assert data.units[key] == "N"
    with pytest.raises(td.InputError, match="cannot be spread"):
        operating_data(case, {"friction_scale": "0.9 .. 1.1"}, 4, seed=1)
