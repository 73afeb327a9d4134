"""Bearings and shafts of machines: lives and safeties from computed loads."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest

import tribodyn as td
from tribodyn.cli import main
from tribodyn.errors import InputError
from tribodyn.rating import ShaftMaterial, ShaftNotch, ShaftStress, rate_shaft
from tribodyn.study import MachineCase, failure_probability, sobol_indices
from tribodyn.study.pipeline.summary_figures import is_figure
from tribodyn.study.rated_parts import SectionLoad, rate_notch

MACHINE: dict[str, Any] = {
    "shafts": {
        "in": {
            "sections": [[0.1, 0.04], [0.2, 0.05]],
            "tensile_strength": 900e6,
            "yield_strength": 700e6,
            "notches": {"step": {"position": 0.1, "radius": 2e-3}},
        },
        "out": {},
    },
    "bearings": {
        "A": {"shaft": "in", "position": 0.0, "radial_stiffness": 1e9, "axial_stiffness": 1e8,
              "dynamic_load_rating": 55.3e3, "static_load_rating": 31.5e3,
              "pitch_diameter": 72.5e-3},
        "B": {"shaft": "in", "position": 0.3, "radial_stiffness": 1e9,
              "dynamic_load_rating": 40e3, "elements": "roller"},
        "C": {"shaft": "out", "position": 0.0, "radial_stiffness": 1e9},
    },
    "gears": {
        "z1": {"shaft": "in", "position": 0.15, "teeth": 24, "face_width": 20e-3},
        "z2": {"shaft": "out", "teeth": 31, "face_width": 20e-3},
    },
    "meshes": {"first": {"gears": ["z1", "z2"], "normal_module": 3e-3, "stiffness": 3e8}},
    "operation": {"input": "in", "output": "out", "speed": "3000 rpm", "torque": 200.0},
    "rating": {"required_life": "1000 h"},
}  # fmt: skip
FORCE = 200.0 / (0.036 * math.cos(math.radians(20.0)))


def case(**changes: Any) -> MachineCase:
    return MachineCase(**MACHINE).replace(changes)


@pytest.fixture(scope="module")
def result() -> Any:
    return td.run(case())


@pytest.fixture(scope="module")
def rating(result: Any) -> Any:
    return result.rating


def supports(result: Any) -> dict[str, float]:
    """Loads of a beam on two supports with a force and its moment over the face in the middle."""
    moment = abs(result.operation.static.meshes["first"].moment) / 0.3
    return {"A": 0.5 * FORCE - moment, "B": 0.5 * FORCE + moment}


def test_bearings_live_as_long_as_the_closed_form_says(result, rating):
    for name, capacity, exponent in (("A", 55.3e3, 3.0), ("B", 40e3, 10.0 / 3.0)):
        (under,) = rating.bearings[name].lives
        assert 1.0 <= under.factors["f_dyn"] < 1.01
        load = supports(result)[name] * under.factors["f_dyn"]
        life = 1e6 * (capacity / load) ** exponent / 50.0
        assert rating.bearings[name].basic_life == pytest.approx(life, rel=1e-5)
    assert rating.bearings["C"].basic_life is None
    assert rating.bearings["C"].reason == "no dynamic_load_rating"
    assert rating.system_life < min(rating.bearings[n].life for n in "AB")
    verdict = next(v for v in rating.verdicts() if v.part == "A")
    assert verdict.safety**3 * 3.6e6 == pytest.approx(rating.bearings["A"].life)
    data = json.loads(json.dumps(rating.to_dict(), allow_nan=False))
    assert data["bearings"]["B"]["basic_life"] == rating.bearings["B"].basic_life
    assert data["bearings"]["A"]["modified_life"] is None  # a mesh without teeth has no oil
    assert "no oil" in rating.bearings["A"].reason


def test_oil_modifies_the_life_where_no_teeth_are_computed(rating):
    """nu_1 = 4500/sqrt(3000 rpm)/sqrt(72.5 mm); the oil has 18.75 mm2/s at 100 degC."""
    oil = {"lubricant.name": "ISO VG 220", "lubricant.temperature": "100 degC"}
    bearing = td.run(case(**oil)).rating.bearings["A"]
    (under,) = bearing.lives
    assert under.factors["kappa"] == pytest.approx(18.75 / 9.6490, rel=1e-4)
    assert bearing.modified_life == pytest.approx(under.factors["a_ISO"] * bearing.basic_life)
    assert rating.bearings["A"].modified_life is None


def test_a_notch_has_the_stress_of_a_beam_on_two_supports(result, rating):
    notch = ShaftNotch(diameter=0.04, large_diameter=0.05, radius=2e-3)
    steel = ShaftMaterial(tensile_strength=900e6, yield_strength=700e6)
    modulus = math.pi * 0.04**3 / 32.0
    bending, torsion = supports(result)["A"] * 0.1 / modulus, 200.0 / (2.0 * modulus)
    ours = rating.shafts["in"]["step"]
    dynamic = ours.factors["K_v"]
    assert ours.factors["sigma_ba"] == pytest.approx(dynamic * bending, rel=1e-5)
    assert ours.factors["tau_tm"] == pytest.approx(torsion, rel=1e-5)
    stress = ShaftStress((0.0, dynamic * bending, (dynamic - 1.0) * torsion), (0.0, 0.0, torsion))
    assert ours.safety == pytest.approx(rate_shaft(notch, steel, stress).safety, rel=1e-3)
    (verdict,) = (v for v in rating.verdicts() if v.mode == "shaft fatigue")
    assert (verdict.part, verdict.where, verdict.required) == ("in", "notch step", 1.2)
    (static,) = (v for v in rating.verdicts() if v.mode == "shaft yield")
    limits = [ours.factors[f"sigma_FK_{kind}"] for kind in ("bending", "torsion")]
    greatest = math.hypot(dynamic * bending / limits[0], dynamic * torsion / limits[1])
    assert static.safety == ours.yield_safety == pytest.approx(1.0 / greatest, rel=1e-4)
    assert result.summary()["shafts.in.yield_safety"] == ours.yield_safety


def test_a_section_at_rest_under_a_steady_torque_can_yield_only():
    notch = ShaftNotch(diameter=0.04, large_diameter=0.05, radius=2e-3)
    steel = ShaftMaterial(tensile_strength=900e6, yield_strength=700e6)
    load = SectionLoad(0.0, 0.0, 1000.0, 1.5, 1.0, turns=False)
    rating = rate_notch(("in", "step", "operation"), notch, steel, load)
    yielding = 700e6 * (1.0 - 0.34 * math.log10(2.5)) * 1.2 / math.sqrt(3.0)
    expected = yielding * math.pi * 0.04**3 / 16.0 / 1500.0
    assert rating.yield_safety == pytest.approx(expected, rel=1e-12)
    assert math.isinf(rating.safety)


@pytest.mark.filterwarnings("ignore")
def test_a_bearing_beyond_the_range_of_its_rating_is_named():
    rating = td.run(case(**{"bearings.B.dynamic_load_rating": 5e3})).rating
    (warning,) = rating.warnings
    assert warning.code == "rating-range"
    assert 'bearing "B": P/C = 0.5' in warning.message


def test_load_cases_add_up_by_their_shares():
    loads = [{"name": "low", "share": 0.75, "torque": 100.0}, {"name": "high", "share": 0.25}]
    bearing = td.run(MachineCase(**MACHINE, load_cases=loads)).rating.bearings["A"]
    low, high = (each.basic_life for each in bearing.lives)
    assert low / high == pytest.approx(8.0, rel=1e-3)
    assert bearing.basic_life == pytest.approx(1.0 / (0.75 / low + 0.25 / high), rel=1e-12)


def test_safeties_and_lives_are_figures_of_the_summary(result):
    figures, rating = result.summary(), result.rating
    assert figures["bearings.A.basic_life"] == rating.bearings["A"].basic_life
    assert figures["shafts.in.fatigue_safety"] == rating.shafts["in"]["step"].safety
    assert "bearings.C.basic_life" not in figures
    assert all(map(is_figure, figures))


def test_a_rated_machine_is_saved_with_its_report(result, tmp_path):
    report = (result.save(tmp_path / "r") / "report.html").read_text(encoding="utf-8")
    assert "Load capacity" in report
    assert td.load_result(tmp_path / "r").summary() == result.summary()


@pytest.mark.slow
@pytest.mark.parametrize("deviations", [0.0, 2.0])
def test_the_probability_of_failure_is_that_of_the_torque(result, deviations):
    spread = 0.01
    life = result.rating.bearings["A"].basic_life * (1.0 - deviations * spread) ** 3
    # the life falls with the third power of a normally distributed torque
    scattered = case(**{"rating.required_life": life, "operation.torque": "200 N*m +- 1 %"})
    answer = failure_probability(scattered, size=32, seed=1)
    place = list(answer.figure).index("bearings.A.basic_life")
    expected = 0.5 * math.erfc(deviations / math.sqrt(2.0))
    assert answer.probability[place] == pytest.approx(expected, abs=0.01)
    assert answer.share[place] == pytest.approx(expected, abs=0.04)


@pytest.mark.slow
def test_shares_of_the_scatter_of_safeties():
    spread = {"operation.torque": "200 N*m +- 2 %", "shafts.in.tensile_strength": "900 MPa +- 2 %"}
    names = ["bearings.A.basic_life", "shafts.in.fatigue_safety"]
    shares = sobol_indices(case(), names, spread, 8, seed=1).total_order
    assert shares[0, 1] == pytest.approx(0.0, abs=1e-6)  # steel of the shaft and its bearings
    assert shares[1].min() > 0.1


@pytest.mark.filterwarnings("ignore")
def test_pins_of_planets_carry_both_meshes():
    stage = td.load_case("planetary-stage")
    name, body = next(iter(stage.data["planets"].items()))
    changes = {f"planets.{name}.pin_dynamic_load_rating": "60 kN",
               f"planets.{name}.pin_elements": "roller", "rating.reliability": 99.0}  # fmt: skip
    result = td.run(stage.replace(changes))
    pins = result.rating.bearings
    assert len(pins) == body["count"]
    (first, *_), load_case = pins.values(), result.load_cases[0]
    figures = load_case.figures
    load = math.hypot(*load_case.static.bearings[first.bearing].load[1:3])
    load *= first.lives[0].factors["f_dyn"]
    speed = abs(figures[f"planets.{name}.planet_speed"]) / (2.0 * math.pi)
    life = 1e6 * (60e3 / load) ** (10.0 / 3.0) / speed
    assert first.lives[0].load == load_case.load.name
    assert first.lives[0].basic_life == pytest.approx(life, rel=1e-6)


@pytest.mark.filterwarnings("ignore")
def test_masses_of_a_stage_are_those_of_one_of_its_meshes():
    """A third of the sun moves with one of three planets; a held ring is infinitely heavy."""
    stage = td.load_case("planetary-stage")
    ratings = td.run(stage.replace({"rating.required_life": "1e4 h", "load_cases": None})).rating
    sun, ring = (mesh.rated.case.gear_pair for mesh in ratings.ratings)

    def disc(gear: Any) -> tuple[float, float]:
        """Mean radius, and share of a full disc of this radius outside of the bore."""
        depth = gear.rack.dedendum_coefficient - gear.profile_shift_coefficient
        mean = 0.5 * (gear.tip_radius + gear.reference_radius - depth * gear.normal_module)
        return mean, 1.0 - (gear.rim_radius / mean) ** 4

    def mass(pinion: Any) -> float:
        """The pinion as the standard has it [kg/m]; steel of 7800 kg/m^3."""
        return 0.5 * math.pi * 7800.0 * disc(pinion)[0] ** 4 / pinion.base_radius**2

    wheel = mass(sun.pinion) * disc(sun.wheel)[1] * (sun.wheel.teeth / sun.pinion.teeth) ** 2
    of_sun, planet = mass(sun.pinion) * disc(sun.pinion)[1] / 3.0, mass(ring.pinion)
    expected = 1.0 / (1.0 / wheel + 1.0 / of_sun), planet * disc(ring.pinion)[1]
    found = [mesh.standard.factors["m_red"] for mesh in ratings.ratings]
    assert found == pytest.approx(expected, rel=1e-9)
    # alone, both gears of the mesh move
    oil = td.rating.GearOil(kinematic_viscosity_at_40=220e-6)
    free = td.rating.rate_pair(ring, torque=100.0, speed=10.0, oil=oil)
    assert free.factors["m_red"] < planet


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"rating": None}, "dynamic_load_rating = .* has no effect"),
        ({"bearings.C.static_load_rating": 1e4}, "needs its dynamic load rating"),
        ({"rating.reliability": 92.0}, "ISO 281 has: 90, 95"),
        ({"rating.cleanliness": "clean"}, "bath -/17/14"),
        ({"rating.required_lief": 1.0}, "required_life"),
        ({"shafts.in.notches.step.radius": None}, "radius is missing"),
        ({"shafts.in.notches.step.position": 0.5}, "0 to 300 mm"),
        ({"shafts.in.notches.step.kind": "hole"}, "press fit"),
        ({"shafts.in.yield_strength": None}, "yield_strength is missing"),
        ({"shafts.in.notches": None}, "Only notches need"),
        ({"meshes.first.rating": {"reliability": 99.0}}, "has no effect"),
    ],
)  # fmt: skip
def test_wrong_keys_of_bearings_and_shafts_are_refused(changes, text):
    tables = json.loads(json.dumps(MACHINE))
    for key, value in changes.items():
        *names, name = key.split(".")
        table = tables
        for each in names:
            table = table.setdefault(each, {})
        table[name] = value
        if value is None:
            del table[name]
    with pytest.raises(InputError, match=text):
        MachineCase(**tables)


@pytest.mark.slow
def test_the_command_prints_probabilities_of_failure(tmp_path, capsys):
    path = tmp_path / "machine.toml"
    path.write_text(case(**{"operation.torque": "200 N*m +- 5 %"}).to_toml(), "utf-8")
    with pytest.raises(SystemExit) as left:
        main(["rate", str(path), "--variants", "8"])
    assert not left.value.code
    assert "below 1e-6 %" in capsys.readouterr().out
