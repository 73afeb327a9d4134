"""The case: reading, replacing, writing, and where every value comes from."""

from __future__ import annotations

import math
import re
import tomllib
from typing import Any

import numpy as np
import pytest
from broken import SOUND

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.study import read_case
from tribodyn.study.case.provenance import assumptions, effective, provenance
from tribodyn.study.case.write import case_text
from tribodyn.study.pipeline.citations import cite


@pytest.fixture
def case() -> Any:
    return read_case(SOUND, "pair.toml")


def test_values_are_si(case: Any) -> None:
    assert case.gears.normal_module == pytest.approx(4.5e-3, rel=1e-15)
    assert case.gears.normal_pressure_angle == pytest.approx(math.radians(20.0), rel=1e-15)
    assert case.operation.speed == pytest.approx(30.0 * math.pi, rel=1e-14)


def test_replace_reads_floats_as_si_text_and_quantities(case: Any) -> None:
    import pint

    quantity = pint.UnitRegistry().Quantity(100.0, "N*m")
    changed = case.replace(
        {"gears.center_distance": 0.0916, "operation.torque": quantity, "gears.pinion.teeth": 16}
    )
    assert changed.gears.center_distance == 0.0916
    assert changed.operation.torque == pytest.approx(100.0)
    assert case.gears.center_distance == pytest.approx(0.0915)


def test_replace_checks_the_whole_case(case: Any) -> None:
    with pytest.raises(InputError, match=r"replace: gears\.composite_roughness: .*0\.001"):
        case.replace({"gears.composite_roughness": 1e-3})
    with pytest.raises(InputError, match="unknown key"):
        case.replace({"gears.modul": 1e-3})
    with pytest.raises(InputError, match="wrong kind of quantity"):
        case.replace({"operation.torque": "3 mm"})
    with pytest.raises(InputError, match="is a value, not a table"):
        case.replace({"title.text": "x"})


def test_replace_with_none_returns_to_the_default(case: Any) -> None:
    ratio = case.replace({"dynamics.mesh_damping_ratio": 0.1})
    assert ratio.replace({"dynamics.mesh_damping_ratio": None}) == case


def test_a_replaced_value_is_no_longer_assumed() -> None:
    case = td.load_case("fzg-roughness")
    key = "gears.composite_roughness"
    assert provenance(case)[key].startswith("assumed")
    assert provenance(case.replace({key: "0.991 um"}))[key] == "given"


def test_case_is_frozen(case: Any) -> None:
    with pytest.raises(ValueError, match="is immutable"):
        case.title = "other"
    with pytest.raises(ValueError, match="is immutable"):
        case.gears.pinion.teeth = 17


def test_case_from_python_takes_si() -> None:
    case = td.Case(
        title="made in Python",
        gears={
            "normal_module": 4.5e-3,
            "normal_pressure_angle": math.radians(20.0),
            "center_distance": 91.5e-3,
            "driver": "wheel",
            "pinion": {"teeth": 16, "profile_shift_coefficient": 0.8635, "face_width": "20 mm"},
            "wheel": {"teeth": 24, "profile_shift_coefficient": -0.5103},
        },
        operation={"speed": 100.0, "torque": 90},
        stiffness={"reference": "rim"},
        dynamics={"model": "torsional"},
    )
    assert case.gears.driver == "wheel"
    assert case.operation.torque == 90.0
    with pytest.raises(InputError, match="the table \\[gears\\] is missing"):
        td.Case(title="nothing")


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"gears.pinion.tip_diameter": "3.4878 inch", "operation.speed": 94.1234567890123},
        {"friction.law": "xu-2007", "friction.coefficient": None},
        {"solver.method": "transient"},
        {"film.model": "pan-hamrock", "lubricant.temperature": "40 degC"},
        {
            "stiffness.model": "fourier",
            "stiffness.pair_stiffness": None,
            "stiffness.mean_stiffness": "2.5e8 N/m",
            "stiffness.cosine": ["3.3333333333333e7 N/m", 2.7e7],
        },
    ],
)
def test_written_case_reads_back_equal(case: Any, changes: dict[str, Any]) -> None:
    changed = case.replace(changes)
    again = read_case(changed.to_toml(), "again.toml")
    assert again == changed
    assert hash(again) == hash(changed)
    assert provenance(again) == provenance(changed)
    assert again.to_toml() == changed.to_toml()


def test_every_line_of_a_written_case_is_commented() -> None:
    text = case_text(td.load_case("fzg-roughness"), comments=True)
    lines = text[: text.index("[assumed]")].splitlines()
    pairs = [line for line in lines if "=" in line]
    assert len(pairs) > 50
    assert all("  # " in line for line in pairs)
    assert 'center_distance = "91.5 mm"  # a: distance between the two axes; 0.1 mm' in text


def test_a_stale_default_is_reported() -> None:
    text = case_text(read_case(SOUND, "pair.toml"), comments=True)
    assert "mesh_damping_ratio = 0.04" in text
    older = text.replace("mesh_damping_ratio = 0.04", "mesh_damping_ratio = 0.05").replace(
        'mesh_damping_ratio" = { value = 0.04', 'mesh_damping_ratio" = { value = 0.05'
    )
    other = read_case(older)
    assert "while this version has 0.04" in provenance(other)["dynamics.mesh_damping_ratio"]


def test_defaults_and_derived_values_are_listed(case: Any) -> None:
    listed = {row.key: row for row in assumptions(case)}
    assert listed["dynamics.mesh_damping_ratio"].value == "0.04"
    assert listed["gears.wheel.tip_diameter"].value == "112.2285 mm"
    assert "derived from" in listed["gears.wheel.mass"].reason
    assert "gears.normal_module" not in listed
    assert "solver.cycles" not in listed


def test_a_given_damping_drops_the_default_ratio(case: Any) -> None:
    values = effective(case.replace({"dynamics.mesh_damping": "900 N*s/m"}))
    assert values["dynamics.mesh_damping"] == 900.0
    assert values["dynamics.mesh_damping_ratio"] is None


def test_repr_is_a_table_with_units(case: Any) -> None:
    assert "gears.center_distance" in str(case)
    assert "91.5 mm" in str(case)


def test_a_deleted_default_line_needs_no_second_edit() -> None:
    text = case_text(read_case(SOUND, "pair.toml"), comments=True)
    lines = [line for line in text.splitlines() if not line.startswith("dedendum_coefficient")]
    assert read_case("\n".join(lines)) == read_case(text)


def test_the_oil_of_the_library_brings_its_assumptions() -> None:
    case = read_case(SOUND.replace('"80W"', '"75W90-A"'))
    reasons = [row.reason for row in assumptions(case) if row.key == "lubricant"]
    assert reasons == list(case.lubricant_properties.assumptions)
    assert reasons


def test_a_copied_and_a_pickled_case_are_equal(case: Any) -> None:
    import copy
    import pickle

    assert copy.deepcopy(case) == case
    again = pickle.loads(pickle.dumps(case))
    assert again == case
    assert again.replace({"operation.torque": 1.0}).operation.torque == 1.0


def test_only_values_and_deeds_are_listed() -> None:
    case = td.load_case("fzg-roughness")
    listed = dir(case)
    assert {"operation", "replace", "gear_pair", "to_toml"} <= set(listed)
    assert not [name for name in listed if name.startswith(("model_", "_"))]
    assert "teeth" in dir(case.gears.pinion)


def test_a_value_that_is_set_names_replace() -> None:
    case = td.load_case("fzg-roughness")
    with pytest.raises(InputError, match=r"torque cannot be set.*case\.replace"):
        case.operation.torque = 120.0
    assert case.operation.torque == 90.0


def test_the_document_behind_a_case_is_cited() -> None:
    case = td.load_case("fzg-roughness")
    assert "authors and year not known" in cite(case)
    assert case.lubricant_properties.source.rstrip(".") in cite(case)
    assert "Values of the case" not in cite(case.replace({"origin": None}))


def test_the_papers_behind_the_losses_are_cited() -> None:
    case = td.load_case("fzg-roughness")
    parts = {
        "losses.pinion.bearing": ("NJ 406", "Rolling bearings, catalogue"),
        "losses.wheel.seal_diameter": ("30 mm", "ISO/TR 14179"),
        "losses.wheel.immersion": ("30 mm", "churning losses"),
    }
    plain, windage = cite(case), "Spur-gear-system efficiency"
    for key, (value, paper) in parts.items():
        sump = {"losses.oil_volume": "1.2 l"} if "immersion" in key else {}
        sources = cite(case.replace({key: value, **sump}))
        assert (paper in sources, windage in sources) == (True, True)
        assert (paper in plain, windage in plain) == (False, False)
        others = [other for _, other in parts.values() if other != paper]
        assert not any(other in sources for other in others)


def test_ra_becomes_rms_and_is_listed_as_assumption(case: Any) -> None:
    ra = {f"gears.{gear}.roughness_ra": "0.4 um" for gear in ("pinion", "wheel")}
    rough = case.replace({"gears.composite_roughness": None, **ra})
    assert rough.composite_roughness == pytest.approx(math.sqrt(2.0) * 0.5e-6)
    reasons = {row.key: row for row in assumptions(rough)}
    assert reasons["gears.pinion.roughness_rms"].value == "0.5 um"
    assert "Rq = 1.25 Ra" in reasons["gears.wheel.roughness_rms"].reason
    again = read_case(rough.to_toml())
    assert again == rough
    assert again.composite_roughness == rough.composite_roughness


def test_a_line_of_a_written_case_is_toml_when_its_comment_sign_goes(case: Any) -> None:
    lines = [
        line for line in case_text(case, comments=True).splitlines() if re.match(r"# \w+ = ", line)
    ]
    assert len(lines) > 40
    for line in lines:
        assert tomllib.loads(line.removeprefix("# "))
    assumed = {line.split()[1]: line for line in lines}
    assert assumed["inlet_heating"].endswith("belongs to law = ehl, mixed-solved")
    assert assumed["nodes"].endswith("belongs to model = newton, multigrid, thermal")


@pytest.mark.parametrize("distance", [92.5, 95.0, 99.0])
def test_the_centre_distance_that_is_advised_leaves_the_backlash(distance: float) -> None:
    text = SOUND.replace("91.5 mm", f"{distance} mm").replace(
        "[dynamics]", '[dynamics]\nbacklash = "0.05 mm"'
    )
    with pytest.raises(InputError) as caught:
        read_case(text)
    distance_text = re.search(r"Reduce the centre distance to ([\d.]+) mm", str(caught.value))
    assert distance_text is not None
    pair = read_case(text.replace(f"{distance} mm", f"{distance_text.group(1)} mm"))
    assert pair.gear_pair.backlash == pytest.approx(5e-5, abs=2e-6)


@pytest.mark.parametrize(
    "name",
    ["fzg-roughness", "hypoid-mixed-ehl", "two-stage-helical", "planetary-stage", "hypoid-axle"],
)
def test_numbers_in_the_place_of_numbers_make_the_case_that_reading_it_anew_makes(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    case, speed = td.load_case(name), np.linspace(90.0, 100.0, 2)  # items of an array as well
    changes = [{"operation.speed": speed[1]}, {"operation.torque": 70.0, "operation.speed": 90.0}]
    assert all(case._with_numbers(each) is not None for each in changes)
    quick = [case.replace(changes[0]), case.replace(changes[0]).replace(changes[1])]
    monkeypatch.setattr(type(case), "_with_numbers", lambda *_: None)
    reread = [case.replace(changes[0]), case.replace(changes[0]).replace(changes[1])]
    for direct, other in zip(quick, reread, strict=True):
        assert direct == other
        assert direct.to_toml() == other.to_toml()
        assert direct.user_input == other.user_input


@pytest.mark.parametrize("relief", [3.8799123456789e-06, 18e-6, 1e-5 / 3.0])
def test_a_length_is_written_in_its_usual_unit_with_the_digits_that_it_has(relief: float) -> None:
    """Exactly the same number is read again, and no length of a few um is written in m."""
    key = "gears.pinion.modification.tip_relief"
    text = td.load_case("fzg-roughness").replace({key: relief}).to_toml()
    line = next(line for line in text.splitlines() if line.startswith("tip_relief = "))
    assert line.partition("  #")[0].endswith(' um"')
    assert read_case(text).gears.pinion.modification.tip_relief == relief


def test_an_oil_of_a_data_sheet_is_used_in_a_case(case: Any) -> None:
    """Written and read again it is the same; what the sheet does not state is assumed."""
    sheet = {
        "lubricant.name": None,
        "lubricant.kinematic_viscosity_at_40": "220 cSt",
        "lubricant.viscosity_index": 95,
        "lubricant.density_at_15": "0.9071 g/cm^3",
        "lubricant.temperature": "60 degC",
    }
    other = case.replace(sheet)
    oil_of_library = case.replace(
        {"lubricant.name": "ISO VG 220", "lubricant.temperature": "60 degC"}
    )
    oil, library_oil = other.lubricant_properties, oil_of_library.lubricant_properties
    assert oil.dynamic_viscosity == pytest.approx(library_oil.dynamic_viscosity, rel=1e-4)
    assert oil.density == pytest.approx(library_oil.density, rel=1e-12)
    again = read_case(other.to_toml())
    assert again == other
    assert again.lubricant_properties == oil
    reasons = [row for row in assumptions(other) if row.key == "lubricant"]
    assert all(row.kind == "assumed" for row in reasons)
    assert any("AGMA 925" in row.reason for row in reasons)
