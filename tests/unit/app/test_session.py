"""The form follows the options, and what is typed becomes the case that the text would."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("dash", reason="the page needs Dash")

from tribodyn.app import results
from tribodyn.app.case_form import CaseForm
from tribodyn.app.jobs import Job
from tribodyn.app.session import TabSession
from tribodyn.app.workspace import Workspace
from tribodyn.cases.catalogue import case_files
from tribodyn.cases.load import load_case
from tribodyn.errors import InputError
from tribodyn.study.case.reference import case_keys


class NoJobs:
    """Jobs of a server that computes nothing."""


@pytest.fixture
def desk(tmp_path: Path) -> TabSession:
    return TabSession(Workspace(tmp_path), NoJobs(), load_case("fzg-roughness"))  # type: ignore[arg-type]


def typed(desk: TabSession, key: str, **text: Any) -> list[dict[str, str]]:
    desk.edit({"form": "case", "key": key, "number": desk.edits + 1, **text})
    return desk.faults


def fields(desk: TabSession) -> dict[str, dict[str, Any]]:
    pending = list(desk.forms()["case"]["groups"])
    for group in pending:
        pending += group["groups"]
    return {f["key"]: f for group in pending for f in (*group["fields"], *group["more"])}


def shown_parts(desk: TabSession) -> list[Any]:
    return [part.to_plotly_json()["props"] for part in results.bench(desk)]


@pytest.mark.parametrize("name", case_files())
def test_every_typed_value_has_its_field_and_the_pair_is_drawn(desk: TabSession, name: str) -> None:
    desk.take(load_case(name), "")
    displayed = fields(desk)
    typed_keys = [
        key for key in desk.case.user_input.typed if key.split(".")[0] not in ("assumed",)
    ]
    assert set(typed_keys) <= {*displayed, *(k for k in typed_keys if k.startswith("based_on"))}
    keys = {key for key, _, _ in case_keys()}
    assert set(displayed) <= keys
    assert set(displayed) == set(CaseForm(desk.case, {}, {}).options())
    (pair,) = shown_parts(desk)
    assert len(pair["children"]) >= 2


def test_a_value_becomes_the_case_that_its_text_would(desk: TabSession) -> None:
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


def test_units_are_switched_without_a_change(desk: TabSession) -> None:
    before = desk.case
    typed(desk, "gears.center_distance", unit="m")
    field = fields(desk)["gears.center_distance"]
    assert (field["value"], field["unit"]) == ("0.0915", "m")
    assert desk.case == before


def test_a_wrong_value_waits_until_all_is_in_order(desk: TabSession) -> None:
    before = desk.case
    assert typed(desk, "gears.pinion.teeth", value="3")[0]["key"] == "gears.pinion.teeth"
    assert len(typed(desk, "operation.torque", value="1e99", unit="N*m")) == 2
    assert desk.case == before
    typed(desk, "operation.torque", value="80", unit="N*m")
    assert [fault["key"] for fault in desk.faults] == ["gears.pinion.teeth"]
    typed(desk, "gears.pinion.teeth", value="16")
    assert desk.faults == []
    assert desk.case.operation.torque == 80.0


def test_an_empty_field_is_the_default(desk: TabSession) -> None:
    assert typed(desk, "gears.center_distance", value="") == []
    assert desk.case.gears.center_distance is None
    assert float(fields(desk)["gears.center_distance"]["placeholder"]) == pytest.approx(91.5, 0.01)


def test_a_late_edit_does_not_undo_a_later_one(desk: TabSession) -> None:
    desk.edit({"key": "operation.torque", "value": "70", "unit": "N*m", "number": 9})
    desk.edit({"key": "operation.torque", "value": "7", "unit": "N*m", "number": 8})
    assert desk.case.operation.torque == 70.0


def test_a_saved_case_opens_as_it_was(desk: TabSession, tmp_path: Path) -> None:
    typed(desk, "operation.torque", value="77", unit="N*m")
    desk.save("mine", force=False)
    saved, before = desk.case, fields(desk)
    desk.open("file:mine.toml")
    assert desk.case == saved
    assert {k for k, f in fields(desk).items() if f["value"]} == {
        k for k, f in before.items() if f["value"]
    }


def boxes(desk: TabSession) -> dict[str, dict[str, Any]]:
    pending = list(desk.forms()["case"]["groups"])
    for group in pending:
        pending += group["groups"]
    return {group["key"]: group for group in pending}


def test_a_box_counts_the_values_in_it(desk: TabSession) -> None:
    """Count those of the boxes inside it too; the model that it names is typed there already."""
    before = boxes(desk)
    assert before["gears.pinion.modification"]["values"] == 0
    assert before["operation"]["values"] == len(set(desk.case.user_input) & {*fields(desk)} & {
        f"operation.{name}" for name in ("speed", "torque", "speed_of", "torque_balance")
    })  # fmt: skip
    assert before["stiffness"]["note"] == desk.case.stiffness.model
    keys = [key for key in desk.case.user_input.typed if key.startswith("stiffness.")]
    assert before["stiffness"]["values"] == len(set(keys) - {"stiffness.model"})
    typed(desk, "gears.pinion.modification.tip_relief", value="18", unit="um")
    after = boxes(desk)
    assert after["gears.pinion.modification"]["values"] == 1
    assert after["gears"]["values"] == before["gears"]["values"] + 1


def test_drawing_and_figures_are_marked_while_a_value_is_not_in_order(desk: TabSession) -> None:
    assert [part["className"] for part in shown_parts(desk)] == [""]
    typed(desk, "operation.torque", value="-5", unit="N*m")
    notice, figures = shown_parts(desk)
    assert figures["className"] == "outdated"
    assert "out of date" in str(notice["children"])
    assert "correct: Torque" in str(notice["children"])
    typed(desk, "operation.torque", value="90", unit="N*m")
    assert [part["className"] for part in shown_parts(desk)] == [""]


def relief_study(folder: Path, gears: tuple[str, ...]) -> Job:
    """A finished study of the tip relief."""
    values = {"": "3.88 um", "_length": "5.752 mm", "_shape": "linear"}
    relief = {f"gears.{g}.modification.tip_relief{k}": v for g in gears for k, v in values.items()}
    job = Job(1, "study", "Tip relief", {}, folder, state="done", saved=True)
    job.content = {"relief": relief}
    return job


@pytest.mark.parametrize("gears", [("pinion", "wheel"), ("wheel",)])
def test_the_relief_of_a_study_goes_into_the_case(
    desk: TabSession, gears: tuple[str, ...], tmp_path: Path
) -> None:
    typed(desk, "operation.torque", value="77", unit="N*m")
    before, study = desk.case, relief_study(tmp_path, gears)
    desk.studies.append(study)
    desk.view = "job-1"
    assert "Take this relief into my case" in str(results.tools(desk))
    desk.take_relief(2)
    assert desk.case is before
    desk.take_relief(1)
    assert desk.case == before.replace(study.content["relief"], by="form")
    assert desk.case.operation.torque == 77.0
    for gear in ("pinion", "wheel"):
        field = fields(desk)[f"gears.{gear}.modification.tip_relief"]
        expected = ("3.88", "um") if gear in gears else ("", "um")
        assert (field["value"], field["unit"]) == expected
    assert "3.88 um over 5.752 mm" in desk.notice
    assert desk.view == "pair"


def test_the_relief_of_a_study_waits_for_a_case_in_order(desk: TabSession, tmp_path: Path) -> None:
    desk.studies.append(relief_study(tmp_path, ("pinion",)))
    typed(desk, "operation.torque", value="-5", unit="N*m")
    with pytest.raises(InputError, match="invalid"):
        desk.take_relief(1)
