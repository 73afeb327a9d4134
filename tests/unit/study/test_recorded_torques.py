"""Torque histories and cutters of cases: what they give is what the functions of ratings give."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from known_ratings import ring_example
from tribodyn.errors import InputError, ModelWarning
from tribodyn.rating import GearOil, RatedGear, ShaperCutter, load_classes, rate_pair, rate_spectrum
from tribodyn.study import Case, MachineCase
from tribodyn.study.rating_summary import damage_table
from unit.study.test_rating_of_cases import MACHINE, PAIR, changed

TORQUE = np.array([0.0, 150.0, 240.0, -90.0, 260.0, 30.0, 250.0, 200.0])
SPEED = np.array([100.0, 120.0, 150.0, 150.0, 160.0, 150.0, 150.0, 140.0])


def history(folder: Path, text: str | None = None, name: str = "run.csv") -> str:
    """Recording of torque [kN*m] and speed [rpm], one sample a second."""
    rows = [f"{i},{t / 1e3},{s / (2 * np.pi) * 60}"
            for i, (t, s) in enumerate(zip(TORQUE, SPEED, strict=True))]  # fmt: skip
    path = folder / name
    path.write_text(text or "\n".join(["time [s],torque [kN*m],n [rpm]", *rows]) + "\n", "utf-8")
    return str(path)


def rated(data: dict[str, Any], **rating: Any) -> dict[str, Any]:
    return changed(data, rating=changed(data["rating"], **rating))


def test_a_pair_is_rated_under_the_classes_of_its_history(tmp_path: Path) -> None:
    keys = {"torque_history": history(tmp_path), "speed_column": "n", "load_classes": 4}
    rating = td.run(Case(**rated(PAIR, **keys))).rating
    (spectrum,) = rating.spectra
    listed = [each for each in load_classes(TORQUE, SPEED, 8.0, 4) if each.torque]
    assert [case.torque for case in spectrum.rating.cases] == pytest.approx(
        [each.torque for each in listed]
    )
    assert [case.duration / 7.2e7 * 8.0 for case in spectrum.rating.cases] == pytest.approx(
        [each.duration for each in listed]
    )
    case = Case(**PAIR)
    common = {k: v for k, v in spectrum.conditions.items() if k != "required_life"}
    by_hand = rate_spectrum(
        case.gear_pair, cases=[*map(_of_life, listed)], pinion=RatedGear(accuracy_grade=6),
        wheel=RatedGear(accuracy_grade=6), oil=_oil(), **common,
    )  # fmt: skip
    assert spectrum.rating.bending_safety == pytest.approx(by_hand.bending_safety, rel=1e-6)
    assert spectrum.rating.pitting_safety == pytest.approx(by_hand.pitting_safety, rel=3e-3)
    # the operating point is no load that it has to last, and classes have no computed motion
    verdicts = rating.verdicts()
    assert "operation" not in {verdict.load for verdict in verdicts}
    assert {v.computed for v in verdicts if v.load.startswith("class")} == {None}
    assert rating.ratings[0].load == "operation"
    table = damage_table(rating)
    assert [row[1] for row in table.rows] == [*(case.name for case in listed), "total"]
    assert [float(row[2]) for row in table.rows[:-1]] == [each.torque for each in listed]
    assert float(table.rows[-1][4]) == pytest.approx(
        7.2e7 / 3600.0 * sum(each.duration for each in listed) / 8.0, rel=1e-3
    )
    for column, mode in ((5, "pitting"), (8, "bending")):
        parts = [float(row[column]) for row in table.rows]
        gear = "pinion" if mode == "pitting" else "wheel"
        damage = getattr(getattr(spectrum.rating, gear), f"{mode}_damage")
        assert parts == pytest.approx([*damage, sum(damage)], rel=1e-3)
        assert table.head[column] == f"{mode} of {gear}"


def _of_life(each: Any) -> Any:
    from dataclasses import replace

    return replace(each, duration=each.duration / 8.0 * 7.2e7)


def _oil() -> GearOil:
    return GearOil(
        kinematic_viscosity_at_40=220e-6, temperature=353.15, scuffing_load_stage=12,
        micropitting_load_stage=9,
    )  # fmt: skip


def test_a_constant_history_is_the_operating_point(tmp_path: Path) -> None:
    text = "torque\n" + "200.0\n" * 5
    keys = {"torque_history": history(tmp_path, text), "torque_unit": "N*m"}
    rating = td.run(Case(**rated(PAIR, **keys))).rating
    first, only = (each.standard for each in rating.ratings)
    for gear in ("pinion", "wheel"):
        for name in ("pitting_safety", "bending_safety"):
            values = (getattr(getattr(each, gear), name) for each in (first, only))
            assert next(values) == pytest.approx(next(values), rel=1e-12)


def test_a_torque_of_the_wheel_is_turned_to_the_pinion(tmp_path: Path) -> None:
    operation = {"speed": "1000 rpm", "torque": 300.0, "speed_of": "wheel"}
    text = "torque [N*m]\n300.0\n-150.0\n"
    case = Case(**changed(rated(PAIR, torque_history=history(tmp_path, text)), operation=operation))
    loads = td.run(case).rating.spectra[0].rating.cases
    assert [load.torque for load in loads] == pytest.approx([200.0, -100.0])
    assert [load.speed for load in loads] == pytest.approx([case.pinion_speed] * 2)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_history_of_a_machine_is_its_load_cases(tmp_path: Path, sign: float) -> None:
    text = "torque [N*m]\n" + "".join(f"{sign * t}\n" for t in (100.0, 100.0, 100.0, 180.0, -60.0))
    operation = {**MACHINE["operation"], "torque": sign * 100.0}
    named = [
        {"name": f"class {n}", "share": share, "torque": sign * torque}
        for n, (torque, share) in enumerate([(100.0, 0.6), (180.0, 0.2), (-60.0, 0.2)], 1)
    ]
    if sign < 0.0:  # the classes of positive torques come first
        named = [{**named[(n + 2) % 3], "name": f"class {n + 1}"} for n in range(3)]
    listed = td.run(MachineCase(**changed(MACHINE, load_cases=named, operation=operation)))
    keys = {"torque_history": history(tmp_path, text), "load_classes": 9}
    body = rated(changed(MACHINE, load_cases=None, operation=operation), **keys)
    case = MachineCase(**body)
    assert [load.share for load in case.load_cases] == pytest.approx([n["share"] for n in named])
    recorded = td.run(case)
    assert recorded.summary() == pytest.approx(listed.summary(), rel=1e-12)
    spectrum, other = (each.rating.spectra[0].rating for each in (recorded, listed))
    assert spectrum.pitting_safety == other.pitting_safety
    # the flanks of the other side carry the class of the other sign alone
    torques = [case.torque for case in spectrum.cases]
    assert sorted(t < 0.0 for t in torques) == [False, False, True]


@pytest.mark.slow
def test_a_stage_takes_a_history(tmp_path: Path) -> None:
    stage = td.load_case("planetary-stage")
    torque = stage["operation.torque"]
    text = f"torque [N*m]\n{torque}\n{0.45 * torque}\n"
    keys = {"rating.torque_history": history(tmp_path, text), "rating.required_life": "1000 h",
            "rating.load_classes": 2}  # fmt: skip
    oil = {"lubricant.name": "ISO VG 220", "lubricant.temperature": "60 degC"}
    case = stage.replace({**keys, **oil, "load_cases": None, "friction.law": "none"})
    assert [load.torque for load in case.load_cases] == pytest.approx([0.45 * torque, torque])
    with pytest.warns(ModelWarning, match="relief-large"):  # under the low class
        rating = td.run(case).rating
    assert {each.load for each in rating.ratings} == {"class 1", "class 2"}


def test_a_saved_result_finds_the_history(tmp_path: Path) -> None:
    keys = {"torque_history": history(tmp_path), "load_classes": 2}
    result = td.run(Case(**rated(PAIR, **keys)))
    result.save(tmp_path / "r")
    again = td.load_result(tmp_path / "r").rating
    assert again.spectra[0].rating.bending_safety == result.rating.spectra[0].rating.bending_safety


RING = {"teeth": 25, "profile_shift_coefficient": 0.1, "tip_radius_coefficient": 0.25}


def test_a_ring_is_rated_with_the_cutter_that_made_it() -> None:
    ring = ring_example()
    gears = {
        "normal_module": 2e-3, "normal_pressure_angle": "20 deg", "driver": "pinion",
        "composite_roughness": 0.5e-6,
        "pinion": {"teeth": 25, "face_width": 25e-3, "profile_shift_coefficient": 0.2},
        "wheel": {"teeth": 72, "internal": True, "tip_diameter": 141.4e-3,
                  "profile_shift_coefficient": -0.2},
    }  # fmt: skip
    data = changed(PAIR, gears=gears, materials=None)
    plain = td.run(Case(**data)).rating.meshes["mesh"].wheel.factors
    data["gears"] = {**gears, "wheel": {**gears["wheel"], "cutter": RING}}
    cut = td.run(Case(**data)).rating.meshes["mesh"].wheel.factors
    by_hand = rate_pair(
        ring, torque=200.0, speed=157.0, oil=_oil(), wheel=RatedGear(cutter=ShaperCutter(**RING))
    ).wheel.factors
    for name in ("Y_F", "Y_S"):
        assert float(cut[name]) == pytest.approx(float(by_hand[name]), rel=1e-3)
    assert abs(float(cut["Y_F"]) / float(plain["Y_F"]) - 1.0) > 1e-3


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"torque_column": "torque"}, "torque_column has no effect.*no torque_history"),
        ({"torque_history": "F", "required_life": None}, "Add required_life"),
        ({"torque_history": "F", "torque_column": "moment"}, "no column moment.*torque"),
        ({"torque_history": "F", "torque_unit": "N*m"}, "torque_unit = N\\*m.*states kN\\*m"),
        ({"torque_history": "F", "speed_column": "n", "speed_unit": "mm"}, "speed_unit.*unit mm"),
        ({"torque_history": "absent.csv"}, "torque_history.*absent.csv"),
        ({"torque_history": "F", "load_classes": 0}, "load_classes"),
    ],
)
@pytest.mark.parametrize("kind", [Case, MachineCase])
def test_wrong_keys_of_a_history_are_refused(tmp_path: Path, kind: Any, keys: Any, message: str):
    file = history(tmp_path)
    keys = {name: file if value == "F" else value for name, value in keys.items()}
    data = PAIR if kind is Case else changed(MACHINE, load_cases=None)
    with pytest.raises(InputError, match=message):
        kind(**rated(data, **keys))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("torque\n1\n2\n", "unit of torque is not known"),
        ("torque [N*m]\n0\n0\n", "zero while the shaft turns"),
        ("time [s],torque [N*m]\n0,1\n1,2\n7,2\n", "even"),
        ("torque [N*m],n [rpm]\n1,100\n2,-100\n", "n changes its sign"),
    ],
)
def test_recordings_that_are_no_history_are_refused(tmp_path: Path, text: str, message: str):
    keys = {"torque_history": history(tmp_path, text)}
    keys |= {"speed_column": "n"} if "n [rpm]" in text else {}
    with pytest.raises(InputError, match=message) as caught:
        Case(**rated(PAIR, **keys))
    assert "rating." in str(caught.value)


def test_what_has_no_effect_is_refused(tmp_path: Path) -> None:
    keys = {"torque_history": history(tmp_path)}
    with pytest.raises(InputError, match=r"torque_history and \[\[load_cases\]\] are both"):
        MachineCase(**rated(MACHINE, **keys))
    meshes = {**MACHINE["meshes"], "first": {**MACHINE["meshes"]["first"], "rating": keys}}
    with pytest.raises(InputError, match="It is that of the whole machine"):
        MachineCase(**changed(MACHINE, meshes=meshes))
    gears = {**PAIR["gears"], "wheel": {**PAIR["gears"]["wheel"], "cutter": RING}}
    with pytest.raises(InputError, match="cutter has no effect here"):
        Case(**changed(PAIR, rating=None, materials=None, gears=gears))
    gears = {**MACHINE["gears"], "z2": {**MACHINE["gears"]["z2"], "cutter": RING}}
    with pytest.raises(InputError, match=r"gears\.z2\.cutter.*no effect|cutter has no effect"):
        MachineCase(**changed(MACHINE, gears=gears, rating=None, materials=None))
