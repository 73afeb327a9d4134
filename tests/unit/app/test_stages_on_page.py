"""Planetary stages on the page: form, moving front view, run, overlay, files of the folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("dash", reason="the page needs Dash")

from tests.unit.app.test_machines_on_page import fields, texts, typed
from tests.unit.study.test_planetary_studies import FAST

from tribodyn.app import results, worker
from tribodyn.app.session import TabSession
from tribodyn.app.studies import STUDIES, first_names, offered
from tribodyn.app.workspace import Workspace
from tribodyn.cases.load import load_case


@pytest.fixture
def desk(tmp_path: Path) -> TabSession:
    return TabSession(Workspace(tmp_path), None, load_case("planetary-stage"))  # type: ignore[arg-type]


def test_every_value_of_a_stage_has_its_field(desk: TabSession) -> None:
    displayed = fields(desk)
    given = [key for key, _ in desk.case.values() if desk.case.option_of(key) is not None]
    assert {key for key in given if not key.startswith("load_cases")} <= set(displayed)
    assert displayed["planets.low.count"]["value"] == "3"
    assert "gears.sun.shaft" not in displayed
    kinds = {kind for kind in STUDIES if offered(kind, desk.case)}
    assert kinds == {*STUDIES}
    assert {*first_names("basins", desk.case).values()} == {"sun"}


def test_typed_values_change_the_stage_and_planets_that_do_not_fit_are_marked(
    desk: TabSession,
) -> None:
    assert typed(desk, "planets.low.pin_errors", value="20 um, 0 um, 0 um") == []
    assert desk.case.stages["low"].table.pin_errors == pytest.approx((20e-6, 0.0, 0.0))
    fault = typed(desk, "planets.low.count", value="4")[0]
    assert fault["key"] == "planets.low.pin_errors"  # a list of three for four planets
    assert typed(desk, "planets.low.pin_errors", value="")[0]["key"] == "planets.low.count"
    assert "out of date" in texts(results.bench(desk))
    assert typed(desk, "planets.low.count", value="3") == []


def test_the_stage_moves_in_front_view_before_it_is_computed(desk: TabSession) -> None:
    text = texts(results.bench(desk))
    for part in ("The stage in front view", '"frames"', "Ratio", "Assumed"):
        assert part in text
    desk.save("stage", force=False)
    desk.open("file:stage.toml")
    assert desk.case.to_toml() == load_case("planetary-stage").to_toml()
    desk.open("case:planetary-stage")


def test_the_worker_computes_and_overlays_stages(tmp_path: Path) -> None:
    messages: list[dict[str, Any]] = []
    case = load_case("planetary-stage").replace(FAST, by="test")
    for number, torque in enumerate(("600 N*m", "500 N*m")):
        folder = tmp_path / str(number)
        folder.mkdir()
        text = case.replace({"operation.torque": torque}, by="test").to_toml()
        order = {"kind": "run", "case": text, "folder": str(folder)}
        worker._carry_out(order, lambda **message: messages.append(message))
    content = next(each["content"] for each in messages if each.get("state") == "done")
    assert {block["name"] for block in content["blocks"]} >= {"stage", "forces", "machine_campbell"}
    assert all(len(row) == len(head) for _, head, rows, *_ in content["tables"] for row in rows)
    places = [str(tmp_path / str(number) / "result") for number in range(2)]
    order = {"kind": "overlay", "results": places, "names": ["a", "b"], "folder": str(tmp_path)}
    worker._carry_out(order, lambda **message: messages.append(message))
    assert messages[-1]["state"] == "done"
    assert messages[-1]["content"]["blocks"][0]["name"] == "machine_comparison"
