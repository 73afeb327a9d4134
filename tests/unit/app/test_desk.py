"""The form follows the options, and what is typed becomes the case that the text would."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("dash", reason="the page needs Dash")

from tribodyn.app import results
from tribodyn.app.desk import Desk
from tribodyn.app.folder import Folder
from tribodyn.app.form import CaseForm
from tribodyn.cases.catalogue import case_files
from tribodyn.cases.load import load_case
from tribodyn.study.case.reference import case_keys


class NoJobs:
    """Jobs of a server that computes nothing."""


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(Folder(tmp_path), NoJobs(), load_case("fzg-roughness"))  # type: ignore[arg-type]


def typed(desk: Desk, key: str, **told: Any) -> list[dict[str, str]]:
    desk.edit({"form": "case", "key": key, "number": desk.edits + 1, **told})
    return desk.faults


def fields(desk: Desk) -> dict[str, dict[str, Any]]:
    pending = list(desk.forms()["case"]["groups"])
    for group in pending:
        pending += group["groups"]
    return {f["key"]: f for group in pending for f in (*group["fields"], *group["more"])}


@pytest.mark.parametrize("name", case_files())
def test_every_given_value_has_its_field_and_the_pair_is_drawn(desk: Desk, name: str) -> None:
    desk.take(load_case(name), "")
    shown = fields(desk)
    given = [key for key in desk.case.given.typed if key.split(".")[0] not in ("assumed",)]
    assert set(given) <= {*shown, *(k for k in given if k.startswith("based_on"))}
    known = {key for key, _, _ in case_keys()}
    assert set(shown) <= known
    assert set(shown) == set(CaseForm(desk.case, {}, {}).options())
    assert len(results.bench(desk)) >= 2


def test_a_value_becomes_the_case_that_its_text_would(desk: Desk) -> None:
    assert typed(desk, "operation.torque", value="0.12", unit="kN*m") == []
    assert typed(desk, "gears.addendum_coefficient", value="0.95") == []
    assert typed(desk, "operation.speed", value="1000 rpm", unit="rad/s") == []
    expected = load_case("fzg-roughness").replace(
        {
            "operation.torque": "0.12 kN*m",
            "gears.addendum_coefficient": 0.95,
            "operation.speed": "1000 rpm",
        },
        by="form",
    )
    assert desk.case == expected
    assert fields(desk)["operation.torque"]["value"] == "0.12"


def test_units_are_switched_without_a_change(desk: Desk) -> None:
    before = desk.case
    typed(desk, "gears.center_distance", unit="m")
    field = fields(desk)["gears.center_distance"]
    assert (field["value"], field["unit"]) == ("0.0915", "m")
    assert desk.case == before


def test_a_wrong_value_waits_until_all_is_in_order(desk: Desk) -> None:
    before = desk.case
    assert typed(desk, "gears.pinion.teeth", value="3")[0]["key"] == "gears.pinion.teeth"
    assert len(typed(desk, "operation.torque", value="1e99", unit="N*m")) == 2
    assert desk.case == before
    typed(desk, "operation.torque", value="80", unit="N*m")
    assert [fault["key"] for fault in desk.faults] == ["gears.pinion.teeth"]
    typed(desk, "gears.pinion.teeth", value="16")
    assert desk.faults == []
    assert desk.case.operation.torque == 80.0


def test_an_empty_field_is_the_default(desk: Desk) -> None:
    assert typed(desk, "gears.center_distance", value="") == []
    assert desk.case.gears.center_distance is None
    assert float(fields(desk)["gears.center_distance"]["placeholder"]) == pytest.approx(91.5, 0.01)


def test_a_late_edit_does_not_undo_a_later_one(desk: Desk) -> None:
    desk.edit({"key": "operation.torque", "value": "70", "unit": "N*m", "number": 9})
    desk.edit({"key": "operation.torque", "value": "7", "unit": "N*m", "number": 8})
    assert desk.case.operation.torque == 70.0


def test_a_saved_case_opens_as_it_was(desk: Desk, tmp_path: Path) -> None:
    typed(desk, "operation.torque", value="77", unit="N*m")
    desk.save("mine", force=False)
    kept, before = desk.case, fields(desk)
    desk.open("file:mine.toml")
    assert desk.case == kept
    assert {k for k, f in fields(desk).items() if f["value"]} == {
        k for k, f in before.items() if f["value"]
    }
