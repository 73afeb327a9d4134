"""Machines on the page: form, drawing, run, studies, and files of the folder."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

pytest.importorskip("dash", reason="the page needs Dash")

from tests.unit.study.test_machine_case import SMALL
from tests.unit.study.test_machine_run import GEARED

from tribodyn.app import results, worker
from tribodyn.app.session import TabSession
from tribodyn.app.studies import STUDIES, compute, first_values, form_of, with_paths
from tribodyn.app.workspace import Workspace
from tribodyn.cases.load import load_case
from tribodyn.errors import InputError
from tribodyn.progress import SILENT
from tribodyn.study import bifurcation, read_case
from tribodyn.study.faults.sensors import sensors_of

MACHINE = GEARED.partition("[[load_cases]]")[0]


@pytest.fixture
def desk(tmp_path: Path) -> TabSession:
    return TabSession(Workspace(tmp_path), None, load_case("two-stage-spur"))  # type: ignore[arg-type]


def fields(desk: TabSession) -> dict[str, dict[str, Any]]:
    pending = list(desk.forms()["case"]["groups"])
    for group in pending:
        pending += group["groups"]
    return {f["key"]: f for group in pending for f in (*group["fields"], *group["more"])}


def typed(desk: TabSession, key: str, **text: Any) -> list[dict[str, str]]:
    desk.edit({"form": "case", "key": key, "number": desk.edits + 1, **text})
    return desk.faults


def texts(part: Any) -> str:
    return json.dumps(part, default=lambda each: each.to_plotly_json())


def test_every_number_of_a_machine_has_its_field(desk: TabSession) -> None:
    displayed = fields(desk)
    options = {key: desk.case.option_of(key) for key, _ in desk.case.values()}
    given = {key for key, option in options.items() if option and option.kind != "list"}
    assert {"load_cases.slow.torque", "housing.mass_file", "load_cases.slow.share"} <= given
    assert given <= set(displayed)
    assert {"gears.z2.modification.profile_slope", "solver.phases"} <= set(displayed)
    assert set(displayed) == set(desk.form.options())
    assert (displayed["gears.z1.face_width"]["value"], displayed["friction.law"]["value"]) == (
        "32",
        "xu-2007",
    )


def test_a_typed_value_changes_the_machine_and_a_wrong_one_is_marked(desk: TabSession) -> None:
    assert typed(desk, "operation.torque", value="0.1", unit="kN*m") == []
    assert desk.case.operating_point.torque == 100.0
    faults = typed(desk, "bearings.A.position", value="5", unit="m")
    assert faults[0]["key"] == "bearings.A.position"
    assert "out of date" in texts(results.bench(desk))
    assert typed(desk, "bearings.A.position", value="40", unit="mm") == []
    assert typed(desk, "friction.law", value="constant")[0]["key"] == "friction.coefficient"
    assert typed(desk, "friction.coefficient", value="0.05") == []
    desk.take(read_case(MACHINE), "")
    assert typed(desk, "bearings.A.radial_stiffness", value="4e8 N/m, 3e8 N/m") == []
    assert desk.case.bearings["A"].radial_stiffness == (4e8, 3e8)


def test_the_machine_is_drawn_with_speeds_and_assumptions(desk: TabSession) -> None:
    text = texts(results.bench(desk))
    for part in ("The machine", "Mesh frequency, mesh second", "Assumed", "Output torque"):
        assert part in text
    assert "two-stage-spur" in texts(results.files(desk))
    kinds = {kind for kind, study in STUDIES.items() if study.title in texts(results.studies(desk))}
    assert kinds == {*STUDIES}
    desk.choose_study("experiment")  # no study of the page
    assert desk.study == ""


def test_studies_of_one_mesh_list_the_meshes_that_they_take(desk: TabSession) -> None:
    desk.choose_study("harris")
    mesh = desk.forms()["study"]["groups"][0]["fields"][0]
    assert (mesh["value"], mesh["names"]) == ("first", [["first", "first"], ["second", "second"]])
    desk.choose_study("recording")
    sensor = desk.forms()["study"]["groups"][0]["fields"][0]
    assert sensor["names"] == [[name, name] for name in sensors_of(desk.case).names]
    desk.take(load_case("fzg-roughness"), "")
    desk.choose_study("harris")
    assert [f["key"] for f in desk.forms()["study"]["groups"][0]["fields"]] == ["torque"]
    desk.take(load_case("hypoid-axle"), "")
    assert desk.values["harris"]["mesh"] == desk.case.meshes[0]
    desk.choose_study("relief")  # flanks of hypoid gears are relieved by their cutter
    assert desk.study == "harris"


@pytest.mark.parametrize("kind", ["bifurcation", "continuation", "basins"])
def test_motions_are_those_of_the_chosen_mesh(kind: str, tmp_path: Path) -> None:
    """Meshes of constant springs have no computed teeth, but move."""
    case = read_case(SMALL, "small.toml")
    first = first_values(kind, case)
    assert first["mesh"] == "first"
    fields = form_of(kind, first, case, ())["groups"][0]["fields"]
    assert fields[0]["names"] == [["first", "first"], ["second", "second"]]
    with pytest.raises(InputError, match='no mesh "third"'):
        compute(kind, case, first | {"mesh": "third"}, SILENT, tmp_path / "result")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_a_diagram_of_the_page_is_that_of_the_command(tmp_path: Path) -> None:
    case = read_case(SMALL, "small.toml")
    values = {"values": "1200..1234 rpm:2", "cycles": "4", "transient": "2", "mesh": "second"}
    compute("bifurcation", case, first_values("bifurcation", case) | values, SILENT, tmp_path / "b")
    names = {"mesh": "second", "cycles": 4, "transient": 2, "keep": 4}
    diagram = bifurcation(case, between=("1200 rpm", "1234 rpm"), points=2, **names)
    with xarray.open_dataset(tmp_path / "b" / "bifurcation.nc", engine="h5netcdf") as data:
        assert data.attrs["signal"] == "mesh second"
        np.testing.assert_array_equal(data["rms"], diagram.rms)


def test_a_relief_of_a_mesh_is_that_of_its_gears(tmp_path: Path) -> None:
    case = load_case("two-stage-spur").replace({"stiffness.model": "analytic"}, by="test")
    values = {"mesh": "second", "torque": "150 N*m", "gears": "wheel"}
    shown = compute("relief", case, values, SILENT, tmp_path / "result")
    assert {key.split(".")[1] for key in shown["relief"]} == {"z4"}
    best = load_case(tmp_path / "result" / "best.toml")
    relief = best.data["gears"]["z4"]["modification"]
    assert relief["tip_relief"] == shown["relief"]["gears.z4.modification.tip_relief"]


def test_files_of_a_study_are_those_of_the_folder(desk: TabSession, tmp_path: Path) -> None:
    values = {"file": "losses.csv", "mesh": "first"}
    paths = with_paths("friction-from-loss", values, desk.folder)
    assert paths == {"file": str(tmp_path / "losses.csv"), "mesh": "first"}
    built_in = {"file": "fzg-wheel-driven"}
    assert with_paths("friction-from-loss", built_in, desk.folder) == built_in
    for place in ("/etc/passwd", "../losses.csv"):
        with pytest.raises(InputError):
            with_paths("friction-from-loss", {"file": place}, desk.folder)


def test_a_saved_machine_takes_its_housing_along(desk: TabSession, tmp_path: Path) -> None:
    desk.save("gearbox", force=False)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"gearbox.toml", *(f"gearbox-two-stage-spur-housing-{k}.mtx" for k in "KM")}
    desk.open("file:gearbox.toml")
    assert load_case(tmp_path / "gearbox.toml").to_toml() == desk.case.to_toml()
    desk.save("gearbox", force=True)
    assert {path.name for path in tmp_path.iterdir()} == names


def test_a_housing_outside_of_the_folder_is_refused(desk: TabSession, tmp_path: Path) -> None:
    text = MACHINE + '[housing]\nmatrices = "/etc/passwd"\n'
    (tmp_path / "bad.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="lies outside"):
        desk.open("file:bad.toml")


def test_the_worker_computes_and_overlays_machines(tmp_path: Path) -> None:
    messages: list[dict[str, Any]] = []
    orders = []
    for number, torque in enumerate(("600 N*m", "500 N*m")):
        folder = tmp_path / str(number)
        folder.mkdir()
        text = MACHINE.replace("600 N*m", torque)
        orders.append({"kind": "run", "case": text, "folder": str(folder)})
        worker._carry_out(orders[-1], lambda **message: messages.append(message))
    content = next(each["content"] for each in messages if each.get("state") == "done")
    assert {block["name"] for block in content["blocks"]} >= {"machine", "machine_orders"}
    assert {topic for topic, *_ in content["tables"]} == {"Natural modes", "All numbers"}
    assert all(len(row) == len(head) for _, head, rows, *_ in content["tables"] for row in rows)
    places = [str(tmp_path / str(number) / "result") for number in range(2)]
    assert (Path(places[0]) / "report.html").is_file()
    order = {"kind": "overlay", "results": places, "names": ["a", "b"], "folder": str(tmp_path)}
    worker._carry_out(order, lambda **message: messages.append(message))
    assert messages[-1]["state"] == "done"
    assert messages[-1]["content"]["blocks"][0]["name"] == "machine_comparison"


#: Few points, to be quick.
FEW = {
    "sweep": {"values": "2900..3000 rpm:2"},
    "run-up": {"speeds": "2900..2950 rpm", "duration": "0.1"},
    "harris": {"torque": "60 N*m, 90 N*m"},
    "losses": {"torque": "60, 90 N*m", "speed": "900 rpm"},
    "recording": {"duration": "0.1", "format": "wav"},
    "friction-from-loss": {"file": "fzg-wheel-driven"},
}


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")  # the page lists them
@pytest.mark.parametrize("kind", ["modes", *FEW])
def test_studies_of_machines_display_and_save_their_result(kind: str, tmp_path: Path) -> None:
    case = read_case(MACHINE)
    if kind in ("harris", "losses", "friction-from-loss"):  # of meshes with computed teeth
        case = load_case("two-stage-spur").replace({"friction.law": "schlenk"}, by="test")
    values = first_values(kind, case) | FEW.get(kind, {})
    shown = compute(kind, case, values, SILENT, tmp_path / "result")
    assert shown["sentences"]
    assert shown["figures"]
    assert all(figure.data for _, figure, _ in shown["figures"])
    assert (tmp_path / "result" / "report.html").is_file()


def test_flanks_of_the_gears_of_a_machine_are_modified_on_the_page(desk: TabSession) -> None:
    key = "gears.z1.modification.tip_relief"
    assert fields(desk)[key]["unit"] == "um"
    assert typed(desk, key, value="12", unit="um") == []
    assert dict(desk.case.values())[key] == pytest.approx(12e-6)
    assert typed(desk, key, value="-3 m")[0]["key"] == key
