"""Load capacity of cases: keys, results of pairs and machines, the command."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.cli import main
from tribodyn.errors import InputError, ModelWarning
from tribodyn.lubricant.library import library_base_oil
from tribodyn.study import Case
from tribodyn.study.rated_oil import gear_oil
from tribodyn.study.rating import conditions_of
from tribodyn.study.rating_summary import limits_in_words

PAIR: dict[str, Any] = {
    "gears": {
        "normal_module": 4.5e-3, "normal_pressure_angle": "20 deg", "center_distance": 91.5e-3,
        "driver": "pinion", "composite_roughness": 0.5e-6,
        "pinion": {"teeth": 16, "face_width": 14e-3, "profile_shift_coefficient": 0.1817,
                   "material": "steel"},
        "wheel": {"teeth": 24, "profile_shift_coefficient": 0.1715, "material": "steel"},
    },
    "lubricant": {"name": "ISO VG 220", "temperature": "80 degC"},
    "operation": {"speed": "1500 rpm", "torque": 200.0},
    "dynamics": {"model": "torsional"},
    "film": {"model": "none"},
    "friction": {"law": "none"},
    "stiffness": {"model": "iso6336"},
    "materials": {"steel": {"kind": "Eh", "grade": "MQ", "hardness": 720.0}},
    "rating": {"required_life": "20000 h", "application_factor": 1.25, "scuffing_load_stage": 12,
               "micropitting_load_stage": 9},
}  # fmt: skip
PROFILES: dict[str, Any] = {
    **PAIR["materials"]["steel"],
    "profile_depth": ["0 mm", "0.4 mm", "1 mm", "3 mm"],
    "hardness_profile": [720.0, 690.0, 550.0, 420.0],
    "residual_stress_profile": ["-300 MPa", "-300 MPa", "-100 MPa", "0 MPa"],
}
MACHINE: dict[str, Any] = {
    "gears": {
        "z1": {"shaft": "in", "teeth": 24, "face_width": 20e-3, "material": "steel"},
        "z2": {"shaft": "middle", "teeth": 31, "face_width": 20e-3, "material": "steel"},
        "z3": {"shaft": "out", "teeth": 37, "face_width": 20e-3},
    },
    "meshes": {
        "first": {"gears": ["z1", "z2"], "normal_module": 3e-3},
        "second": {"gears": ["z2", "z3"], "normal_module": 3e-3},
    },
    "operation": {"input": "in", "output": "out", "speed": "1200 rpm", "torque": 100.0},
    "load_cases": [
        {"name": "low", "share": 0.9, "torque": 100.0},
        {"name": "high", "share": 0.1, "torque": 180.0},
    ],
    "lubricant": {"name": "ISO VG 220", "temperature": "80 degC"},
    "film": {"model": "none"},
    "friction": {"law": "none"},
    "stiffness": {"model": "iso6336"},
    "materials": PAIR["materials"],
    "rating": {"required_life": "20000 h"},
}


def changed(data: dict[str, Any], **tables: Any) -> dict[str, Any]:
    return {name: table for name, table in {**data, **tables}.items() if table is not None}


@pytest.fixture(scope="module")
def result() -> Any:
    return td.run(Case(**PAIR))


def test_a_pair_is_rated_as_without_a_case(result):
    rating = result.rating
    case = result.case
    pair = td.rating.rate_pair(
        case.gear_pair, torque=200.0, speed=case.pinion_speed, required_life=7.2e7,
        application_factor=1.25,
        oil=td.rating.GearOil(
            kinematic_viscosity_at_40=220e-6, temperature=353.15, scuffing_load_stage=12,
            micropitting_load_stage=9,
        ),
    )  # fmt: skip
    ours = rating.meshes["mesh"]
    assert ours.pitting_safety == pytest.approx(pair.pitting_safety, rel=2e-3)
    assert ours.bending_safety == pytest.approx(pair.bending_safety, rel=1e-9)
    assert rating.gears["wheel"]["mesh"].bending_safety == ours.wheel.bending_safety
    assert ours.scuffing_safety_flash == pytest.approx(pair.scuffing_safety_flash, rel=2e-3)
    assert ours.micropitting_safety == pytest.approx(pair.micropitting_safety, rel=2e-3)


def test_computed_loads_stand_beside_those_of_the_standard(result):
    (mesh,) = result.rating.ratings
    peak = max(result.figures["dynamic_factor_peak"], 1.0)
    assert mesh.computed.factors["K_v"] == pytest.approx(peak, rel=1e-12)
    assert mesh.standard.factors["K_v"].branch.startswith("subcritical")
    ratio = (mesh.computed.bending_safety / mesh.standard.bending_safety) - 1.0
    assert (ratio < 0.0) == (peak > mesh.standard.factors["K_v"])
    verdicts = result.rating.verdicts()
    assert {v.mode for v in verdicts} == {
        "pitting", "bending", "scuffing (flash)", "scuffing (integral)", "micropitting",
    }  # fmt: skip
    assert [v.margin for v in verdicts] == sorted(v.margin for v in verdicts)
    json.dumps(result.rating.to_dict())


def test_load_sharing_is_that_of_perfect_flanks_where_there_is_no_relief(result):
    (mesh,) = result.rating.ratings
    for name in ("K_Halpha", "K_Falpha"):
        assert mesh.computed.factors[name] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("relief", ["0 um", "12 um"])
def test_relief_gives_one_of_three_tooth_pairs_more_than_its_share(relief):
    """Total contact ratio above 2: the greatest load of a pair over that of perfect flanks."""
    gears = {name: value for name, value in PAIR["gears"].items() if name != "center_distance"}
    flank = {"modification": {"tip_relief": relief}} if relief != "0 um" else {}
    for role in ("pinion", "wheel"):
        gears[role] = {
            **gears[role],
            "face_width": 40e-3,
            "profile_shift_coefficient": 0.0,
            **flank,
        }
    gears |= {"helix_angle": "25 deg"}
    result = td.run(Case(**changed(PAIR, gears=gears, stiffness={"model": "analytic"})))
    factor = result.rating.ratings[0].computed.factors["K_Halpha"]
    if relief == "0 um":
        assert factor == pytest.approx(1.0, abs=1e-9)
    else:
        assert 1.05 < factor < 2.0


def test_root_stress_by_finite_elements_stands_beside_the_standard(result):
    (mesh,) = result.rating.ratings
    assert set(mesh.root_stress) == {"pinion", "wheel"}
    peak = mesh.computed.factors["K_v"]
    for role, root in mesh.root_stress.items():
        assert 0.9 < root["ratio"] < 1.15
        assert root["dynamic_stress"] <= root["static_stress"] * peak * (1.0 + 1e-6)
        limit = mesh.standard.gears[role].factors["sigma_FG"]
        assert root["bending_safety"] == pytest.approx(limit / root["dynamic_stress"], rel=1e-12)
    assert mesh.to_dict()["root_stress"] == mesh.root_stress


@pytest.fixture(scope="module")
def rubbed() -> Any:
    tables = {"stiffness": {"model": "analytic"}, "film": {"model": "dowson-higginson"}}
    with pytest.warns(ModelWarning, match="mixed-lubrication"):
        return td.run(Case(**changed(PAIR, friction={"law": "iso-6336-22"}, **tables)))


def test_criteria_point_by_point_are_those_of_the_standard_with_the_same_loads(rubbed):
    """Hertz of the whole load at B and D; Dowson-Higginson with the heated oil of the contact."""
    (mesh,) = rubbed.rating.ratings
    table, factors, maps = rubbed.mesh, mesh.computed.factors, mesh.maps
    assert set(mesh.pointwise) == {
        "pitting_safety", "scuffing_safety_flash", "micropitting_safety",
        "micropitting_safety_method_a",
    }  # fmt: skip
    outer = factors["K_A"] * factors["K_gamma"] * factors["K_v"]
    limit = min(gear.factors["sigma_HG"] for gear in mesh.computed.gears.values())
    least = limit / (table.hertz_pressure.max() * math.sqrt(outer))
    assert mesh.pointwise["pitting_safety"]["safety"] == pytest.approx(
        least, rel=5e-3
    )  # a jump at B
    pair = rubbed.case.gear_pair
    start, end = pair.path_limits
    inner = [start + pair.base_pitch, end - pair.base_pitch]  # one pair carries between them
    place = mesh.pointwise["pitting_safety"]["path"]
    assert min(inner) - 2e-4 < place < max(inner) + 2e-4
    same = {"K_v": factors["K_v"], "K_Hbeta": 1.0, "K_Halpha": 1.0}
    speed, torque = mesh.rated.operation
    even = td.rating.rate_pair(pair, speed=speed, torque=torque, factors=same, **mesh.rated.common)
    assert mesh.pointwise["micropitting_safety"]["safety"] == pytest.approx(
        even.micropitting_safety, rel=0.06
    )
    # method A has the pressure of the computed load: at C that of the whole load, as method B
    film = maps["specific_film_a"].interp(path=pair.line_of_action_length / (1 + pair.ratio))
    assert float(film[0]) == pytest.approx(even.factors["lambda_C"], rel=0.03)  # a kink at C
    ratio = maps["specific_film_a"] / maps["micropitting_safety_a"]
    assert float(ratio.max()) == pytest.approx(factors["lambda_GFP"], rel=1e-9)
    at_c = maps["contact_temperature"].interp(path=pair.line_of_action_length / (1 + pair.ratio))
    bulk = float(maps["contact_temperature"].min())
    assert float(at_c[0]) == pytest.approx(bulk, abs=1.0)  # nothing slides there
    hottest = float(maps["contact_temperature"].max())
    margin = factors["theta_S"] - 353.15
    assert mesh.pointwise["scuffing_safety_flash"]["safety"] == pytest.approx(
        margin / (hottest - 353.15), rel=1e-9
    )
    by_mode = {verdict.mode: verdict.computed for verdict in mesh.verdicts()}
    assert by_mode["micropitting"] == mesh.pointwise["micropitting_safety"]["safety"]


def test_what_a_run_does_not_compute_has_no_map(result):
    (mesh,) = result.rating.ratings
    of_method_a = {"specific_film_a", "micropitting_safety_a"}
    assert set(mesh.maps) == {"pressure", "pitting_safety", *of_method_a}
    assert mesh.pointwise.keys() == {"pitting_safety", "micropitting_safety_method_a"}
    by_mode = {verdict.mode: verdict.computed for verdict in mesh.verdicts()}
    least = mesh.pointwise["micropitting_safety_method_a"]["safety"]
    assert by_mode["micropitting"] == least


def test_maps_of_a_rating_are_drawn(rubbed):
    (mesh,) = rubbed.rating.ratings
    drawn = td.plot.rating_maps(mesh)
    assert len(drawn.data) == 8
    assert f"{mesh.pointwise['pitting_safety']['safety']:.3g}" in drawn.layout.title.text


def test_hardness_and_residual_stress_below_the_flank_give_its_exposure():
    data = changed(PAIR, stiffness={"model": "analytic"}, materials={"steel": PROFILES})
    (mesh,) = td.run(Case(**data)).rating.ratings
    worst = mesh.exposure["pinion"]
    assert worst == mesh.exposure["wheel"]  # one material
    at = mesh.maps["pressure"].sel(path=worst["path"])
    radius = float(mesh.rated.table.over_face("equivalent_radius").sel(path=worst["path"])[0])
    (pressure,) = at.values
    modulus = 206e9 / (1.0 - 0.3**2)
    depths = np.linspace(0.0, 3e-3, 61)[1:]
    exposed = td.rating.subsurface_exposure(
        depths, np.interp(depths, [0.0, 4e-4, 1e-3, 3e-3], PROFILES["hardness_profile"]),
        residual_stress=np.interp(depths, [0.0, 4e-4, 1e-3, 3e-3], [-3e8, -3e8, -1e8, 0.0]),
        pressure=pressure, width=4.0 * pressure * radius / modulus,
    )  # fmt: skip
    assert (worst["exposure"], worst["depth"]) == pytest.approx(exposed.greatest, rel=1e-9)
    assert pressure == pytest.approx(float(mesh.maps["pressure"].max()), rel=1e-9)
    assert mesh.to_dict()["exposure"] == mesh.exposure


@pytest.mark.parametrize("helix", [{}, {"helix_angle": "10 deg", "center_distance": 93.5e-3}])
def test_wear_of_the_required_life_is_that_of_its_turns(helix):
    from tribodyn.study import wear

    rating = {**PAIR["rating"], "wear_coefficient": 1e-20, "required_life": "10 h"}
    tables = {"gears": {**PAIR["gears"], **helix}, "stiffness": {"model": "analytic"}}
    case = Case(**changed(PAIR, rating=rating, **tables))
    (mesh,) = td.run(case).rating.ratings
    worn = wear(case, 1e-20, 1500.0 / 60.0 * 36000.0)
    assert mesh.wear_depth["pinion"] == pytest.approx(worn.depth_pinion[-1].max(), rel=1e-9)
    assert mesh.wear_depth["wheel"] == pytest.approx(worn.depth_wheel[-1].max(), rel=1e-9)
    assert mesh.to_dict()["wear_depth"] == mesh.wear_depth


def test_one_required_safety_holds_for_all_modes():
    case = Case(**changed(PAIR, rating={**PAIR["rating"], "minimum_safety": 1.7}))
    assert {v.required for v in td.run(case).rating.verdicts()} == {1.7}


def test_a_case_without_a_rating_has_none():
    gears = {**PAIR["gears"]}
    for role in ("pinion", "wheel"):
        gears[role] = {k: v for k, v in gears[role].items() if k != "material"}
    case = Case(**changed(PAIR, gears=gears, materials=None, rating=None))
    assert not case.is_rated
    assert td.run(case).rating is None


def test_report_and_page_have_verdict_and_factors(result):
    from tribodyn.report.html import render_report, result_content

    page, content = render_report(result), result_content(result)
    section = page[page.index('id="load-capacity"') : page.index('id="numbers"')]
    rating = result.rating
    assert all(f"<td>{v.mode}</td>" in section for v in rating.verdicts())
    assert "The design is limited by" in section
    assert "<td>K_Hbeta</td>" in section
    tables = [rows for topic, _, rows, *_ in content["tables"] if topic == "Load capacity"]
    assert [row[0] for row in tables[0]] == [v.mode for v in rating.verdicts()]
    assert content["sentences"]


def wheel(**keys: Any) -> dict[str, Any]:
    return {"gears": {**PAIR["gears"], "wheel": {**PAIR["gears"]["wheel"], **keys}}}


def cut(shift: float) -> dict[str, Any]:
    return wheel(cutter={"teeth": 16, "profile_shift_coefficient": shift})


@pytest.mark.parametrize(
    ("tables", "text"),
    [
        ({"materials": {"stel": {}}}, 'there is no material "steel"'),
        ({"materials": {**PAIR["materials"], "other": {}}}, "other has no effect"),
        ({"materials": {"steel": {"hardness": 900.0}}}, "660 to 800 HV"),
        ({"materials": {"steel": {"kind": "V"}}}, "hardness is missing"),
        ({"materials": {"steel": {"kind": "Stahl"}}}, "GGG"),
        (
            {"materials": {"steel": {"kind": "V", "hardness": 300.0}}},
            "materials.steel.yield_strength: yield_strength of V is missing",
        ),
        (wheel(bore_diameter=94e-3), "gears.wheel.bore_diameter: rim of"),
        (wheel(face_width=0.5), "gears.wheel.face_width: face_width = 500 mm. The tolerances"),
        (cut(-1.9), "gears.wheel.cutter: cutter of 16 teeth .* leaves no fillet"),
        (cut(1.0), "gears.wheel.cutter: cutter of 16 teeth .* end in a point"),
        ({"rating": None}, "materials has no effect"),
        ({"lubricant": None}, "viscosity at 40 degC"),
        (
            {
                "lubricant": {
                    "dynamic_viscosity": 0.08,
                    "density": 880.0,
                    "pressure_viscosity_coefficient": 2e-8,
                }
            },
            "viscosity of the oil at 40 degC",
        ),
        ({"rating": {"edition": 2010}}, "2006 and 2019"),
        ({"materials": {"steel": {**PROFILES, "hardness_profile": [700.0]}}}, "1 values and"),
        ({"materials": {"steel": {**PROFILES, "residual_stress_profile": [0.0]}}}, "1 values and"),
        ({"materials": {"steel": {**PROFILES, "profile_depth": [0.0, 2e-3, 1e-3, 3e-3]}}}, "rise"),
        ({"rating": {"wear_coefficient": 1e-18}}, "required life"),
        ({"rating": {"required_lief": "1 h"}}, "required_life"),
    ],
)
def test_keys_that_are_wrong_or_have_no_effect_are_refused(tables, text):
    with pytest.raises(InputError, match=text):
        Case(**changed(PAIR, **tables))


def test_an_oil_with_a_slope_has_the_viscosity_of_its_line_at_40_degrees(result):
    from tribodyn.study.rated_oil import gear_oil

    case = result.case
    oil, known = case.lubricant_properties, gear_oil(case)
    properties = {
        "dynamic_viscosity": oil.dynamic_viscosity, "density": oil.density,
        "pressure_viscosity_coefficient": oil.pressure_viscosity_coefficient,
        "temperature": oil.temperature,
        "temperature_viscosity_coefficient": oil.temperature_viscosity_coefficient,
    }  # fmt: skip
    from_slope = gear_oil(Case(**changed(PAIR, lubricant=properties)))
    for name in ("kinematic_viscosity_at_40", "kinematic_viscosity_at_100"):
        assert getattr(from_slope, name) == pytest.approx(getattr(known, name), rel=2e-3)
    at_40 = {**properties, "temperature": 313.15}
    del at_40["temperature_viscosity_coefficient"]
    stated = gear_oil(Case(**changed(PAIR, lubricant=at_40)))
    assert stated.kinematic_viscosity_at_40 == pytest.approx(oil.kinematic_viscosity)
    assert stated.kinematic_viscosity_at_100 is None


@pytest.mark.parametrize("name", ["hypoid-mixed-ehl", "hypoid-axle"])
def test_bevel_and_hypoid_gears_are_refused_with_the_reason(name):
    with pytest.raises(InputError, match=r"not rated|others are not"):
        td.load_case(name).replace({"rating.required_life": "20000 h"})


def test_an_idler_of_a_machine_is_bent_both_ways_and_its_load_cases_add_up(tmp_path):
    from tribodyn.study import MachineCase
    from tribodyn.study.pipeline.summary_figures import is_figure

    result = td.run(MachineCase(**MACHINE))
    rating, figures = result.rating, result.summary()
    assert any(key.endswith("meshes.first.pitting_safety") for key in figures)
    assert all(map(is_figure, figures))
    result.save(tmp_path / "r")
    factors = {mesh: gears["z2"] for mesh, gears in _by_gear(rating).items()}
    assert all(gear.factors["Y_M"] < 1.0 for gear in factors.values())
    assert _by_gear(rating)["first"]["z1"].factors["Y_M"] == 1.0
    assert {each.load for each in rating.ratings} == {"low", "high"}
    cycles = {each.load: each.standard.pinion.load_cycles for each in rating.ratings}
    assert cycles["low"] / cycles["high"] == pytest.approx(9.0)
    spectrum = rating.spectra[0].rating
    high = [each for each in rating.ratings if (each.mesh, each.load) == ("first", "high")]
    assert spectrum.pinion.pitting_safety <= high[0].standard.pinion.pitting_safety * (1 + 1e-9)
    assert "all load cases" in {verdict.load for verdict in rating.verdicts()} or all(
        damage == 0.0 for damage in spectrum.pinion.pitting_damage[:1]
    )


@pytest.mark.parametrize(("turning", "torque", "sign"), [(-1, 1, -1), (-1, -1, 1)])
def test_speed_and_torque_say_which_flanks_a_load_case_wears(turning, torque, sign):
    """The torque counts in the running sense: backwards it loads the other flanks."""
    loads = [{**MACHINE["load_cases"][0]}, {**MACHINE["load_cases"][1]}]
    loads[1] |= {"speed": f"{1200 * turning} rpm", "torque": 180.0 * torque}
    rating = td.run(td.Case(**changed(MACHINE, load_cases=loads))).rating
    for spectrum, low in zip(rating.spectra, (100.0, 100.0 * 31 / 24), strict=True):
        torques = [each.torque for each in spectrum.rating.cases]
        assert torques == pytest.approx([low, 1.8 * low * sign], rel=1e-9)


def _by_gear(rating: Any) -> dict[str, dict[str, Any]]:
    meshes: dict[str, dict[str, Any]] = {}
    for gear, by_mesh in rating.gears.items():
        for mesh, each in by_mesh.items():
            meshes.setdefault(mesh, {})[gear] = each
    return meshes


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"materials": {**PAIR["materials"], "other": {}}}, "other has no effect"),
        ({"rating": None}, "has no effect"),
    ],
)
def test_keys_of_machines_that_have_no_effect_are_refused(change, text):
    from tribodyn.study import MachineCase

    with pytest.raises(InputError, match=text):
        td.run(MachineCase(**changed(MACHINE, **change)))


def command(*words: str) -> int:
    with pytest.raises(SystemExit) as left:
        main(list(words))
    return int(left.value.code or 0)


def test_the_command_prints_the_verdict(tmp_path, capsys):
    path = tmp_path / "rated.toml"
    path.write_text(Case(**PAIR).to_toml(), "utf-8")
    assert command("rate", str(path), "--all") == 0
    text = capsys.readouterr().out
    assert "The design is limited by" in text
    assert "K_Hbeta" in text
    assert command("rate", str(path), "--json") == 0
    data = json.loads(capsys.readouterr().out)
    assert data["meshes"]["mesh"]["factors"]["K_v"]["value"] >= 1.0
    assert command("rate", "fzg-film") == 2
    assert "[rating]" in capsys.readouterr().err


STATED = {
    "dynamic_viscosity": "30 mPa*s", "density": "860 kg/m^3",
    "pressure_viscosity_coefficient": "18 1/GPa",
}  # fmt: skip


def of_oil(at_40: str, **oil: Any) -> Any:
    tables = {"lubricant": {**STATED, **oil}}
    if at_40:
        tables["rating"] = {**PAIR["rating"], "kinematic_viscosity_at_40": at_40}
    return Case(**changed(PAIR, **tables))


def test_a_viscosity_at_40_degc_rates_an_oil_without_temperature():
    """The oil is as warm as the line of viscosity index 95 says where it has its viscosity."""
    oil = gear_oil(of_oil("150 mm^2/s"))
    assert oil.kinematic_viscosity_at_40 == pytest.approx(150e-6)
    assert oil.kinematic_viscosity(oil.temperature) == pytest.approx(0.030 / 860.0, rel=1e-9)
    at_100 = td.lubricant.viscosity_at_100_degc(150e-6, 95.0)
    assert oil.kinematic_viscosity(373.15) == pytest.approx(at_100, rel=1e-9)
    warm = gear_oil(of_oil("150 mm^2/s", temperature="70 degC"))
    assert warm.temperature == pytest.approx(343.15)
    assert warm.kinematic_viscosity(343.15) == pytest.approx(0.030 / 860.0, rel=1e-9)


@pytest.mark.parametrize(
    ("at_40", "oil", "message"),
    [
        ("", {}, "State it as rating.kinematic_viscosity_at_40"),
        ("150 mm^2/s", {"temperature": "40 degC"}, "has no effect here"),
        ("20 mm^2/s", {"temperature": "70 degC"}, "thinner where it is warmer"),
    ],
)
def test_viscosities_that_contradict_each_other_are_refused(at_40, oil, message):
    with pytest.raises(InputError, match=message):
        of_oil(at_40, **oil)


def test_a_viscosity_that_the_oil_has_at_no_temperature_is_refused():
    with pytest.raises(InputError, match="nowhere from -40 to 200 degC"):
        gear_oil(of_oil("10 mm^2/s", dynamic_viscosity="50 Pa*s"))


@pytest.mark.parametrize(("name", "factor"), [("ISO VG 220", 1.0), ("PAO", 0.8)])
def test_an_oil_of_the_library_has_the_lubricant_factor_of_its_base_oil(name, factor):
    if name == "PAO":
        (name,) = (n for n in td.lubricant.library() if library_base_oil(n) == "polyalphaolefin")
    case = Case(**changed(PAIR, lubricant={"name": name, "temperature": "80 degC"}))
    assert gear_oil(case).lubricant_factor == factor


def test_more_planets_than_the_table_has_are_reported():
    case = Case(**PAIR)
    with pytest.warns(ModelWarning, match="planets = 9 lies outside"):
        assert conditions_of(case, 9)["mesh_load_factor"] == 1.47


def test_sentences_name_safeties_that_computed_loads_find_too_low(result):
    (mesh,) = result.rating.ratings
    torque = 1.02 * 200.0 * mesh.standard.pitting_safety**2 / 1.0
    changes = {"operation.torque": torque, "rating.application_factor": 1.25}
    rating = td.run(result.case.replace(changes)).rating
    verdicts = rating.verdicts()
    enough = [v for v in verdicts if v.computed is not None and v.computed < v.required <= v.safety]
    standard = [v for v in verdicts if v.margin < 0.0]
    text = limits_in_words(rating)
    assert ("By computed loads" in text) == (not standard and bool(enough))
