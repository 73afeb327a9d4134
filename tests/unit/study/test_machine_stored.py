"""Results of machines, written to a directory and read back."""

import json
import re

import numpy as np
import pytest
from tests.unit.study.test_machine_run import GEARED
from tests.unit.study.test_summary_names import QUICK

import tribodyn as td
from tribodyn.errors import ModelWarning
from tribodyn.exchange import write_tables
from tribodyn.report import render_machine_report
from tribodyn.study import read_case
from tribodyn.study.pipeline.cautions import MeshWarning, warn_of_meshes


@pytest.fixture(scope="module")
def result():
    return td.run(read_case(GEARED))


@pytest.fixture
def folder(result, tmp_path):
    return result.save(tmp_path / "out")


def untimed(report: str) -> str:
    """A report without the time at which it was written."""
    return re.sub(r"\d{4}-\d\d-\d\d \d\d:\d\d UTC", "", report)


def same(first, second):
    """Whether two machine results are equal to the last bit."""
    texts = [[str(warning) for warning in each.warnings] for each in (first, second)]
    loads = [(each.operation, *each.load_cases) for each in (first, second)]
    return (
        repr(first) == repr(second)
        and texts[0] == texts[1]
        and first.summary() == second.summary()
        and first.to_xarray().identical(second.to_xarray())
        and all(
            a.motion == b.motion
            and a.figures == b.figures
            and dict(a.tables) == dict(b.tables)
            and np.array_equal(a.structure.stiffness, b.structure.stiffness)
            and np.array_equal(a.static.housing, b.static.housing)
            for a, b in zip(*loads, strict=True)
        )
        and untimed(render_machine_report(first)) == untimed(render_machine_report(second))
    )


def test_a_machine_reads_back_to_the_last_bit(result, folder, tmp_path):
    stored = td.load_result(folder)
    assert same(result, stored)
    assert stored.operation.response == result.operation.response
    again = stored.save(tmp_path / "again")
    for path in folder.iterdir():
        assert path.read_bytes() == (again / path.name).read_bytes(), path.name


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:\\[friction-range\\]")
def test_computed_teeth_and_a_housing_read_back_to_the_last_bit(tmp_path):
    case = td.load_case("two-stage-spur")
    result = td.run(case.replace({"load_cases": None, "stiffness.model": "analytic"}))
    assert same(result, td.load_result(result.save(tmp_path / "out")))


@pytest.mark.slow
def test_a_stage_reads_back_to_the_last_bit(tmp_path):
    result = td.run(td.load_case("planetary-stage").replace(QUICK, by="test"))
    stored = td.load_result(result.save(tmp_path / "out"))
    assert same(result, stored)
    assert stored.operation.stage().motion == result.operation.stage().motion


@pytest.mark.parametrize("name", ["case.toml", "summary.json", "motion.nc", "load-1-motion.nc"])
def test_a_damaged_or_missing_file_is_named(folder, name):
    path = folder / name
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(bytes(content))
    with pytest.raises(td.errors.InputError, match=f"{name}.* (damaged|cannot be read)"):
        td.load_result(folder)
    path.unlink()
    with pytest.raises(td.errors.InputError, match="this is no result"):
        td.load_result(folder)


def test_tables_of_a_stored_machine_are_exported(result, folder, tmp_path):
    write_tables(td.load_result(folder), tmp_path / "tables")
    rows = (tmp_path / "tables" / "summary.csv").read_text(encoding="utf-8").splitlines()
    force = result.summary()["meshes.first.static_mesh_force"]
    assert f"meshes.first.static_mesh_force,{force!r},N," in "\n".join(rows)
    names = {path.name for path in (tmp_path / "tables").iterdir()}
    assert {"motion_over_clock_and_mesh.csv", "load_1_motion_over_clock_and_mesh.csv"} <= names


def test_files_of_another_result_are_refused(result, folder):
    text = json.dumps(result.summary() | {"machine.input_power": 1.0})
    (folder / "summary.json").write_text(text, encoding="utf-8")
    with pytest.raises(td.errors.InputError, match="different results"):
        td.load_result(folder)


@pytest.mark.filterwarnings("error")
def test_a_reason_is_said_once_with_all_its_places():
    texts = "pressure 0.3 GPa, fitted for 0.5 to 2.5 GPa.", "speed 0.8 m/s, fitted for 1 m/s."
    places = [("first", "operation"), ("second", "operation"), ("first", "slow")]
    warnings = [MeshWarning(*place, ModelWarning("range", texts[0])) for place in places]
    warnings.insert(1, MeshWarning("second", "slow", ModelWarning("range", texts[1])))
    warnings[-1] = warnings[-1]._replace(warning=ModelWarning("range", texts[0].replace("3", "41")))
    with td.errors.collected() as caught:
        warn_of_meshes(warnings)
    assert [str(warning) for warning in caught] == [
        f"[range] mesh first, operation: {texts[0]} The same in mesh second, operation; "
        "mesh first, slow.",
        f"[range] mesh second, slow: {texts[1]}",
    ]


def test_a_long_period_names_its_teeth_and_its_cost(monkeypatch):
    teeth = {"z1": 23, "z2": 57, "z3": 22, "z4": 61, "z5": 19, "z6": 71}
    shafts = ("in", "a", "a", "b", "b", "out")
    places = (0.0, 0.0, 0.1, 0.0, 0.1, 0.0)
    rows = zip(teeth.items(), shafts, places, strict=True)
    gears = {
        name: {"shaft": shaft, "position": place, "teeth": count, "face_width": 0.03}
        for (name, count), shaft, place in rows
    }
    names = list(teeth)
    meshes = {
        f"{a}{b}": {"gears": [a, b], "normal_module": 3e-3, "stiffness": 4e8}
        for a, b in zip(names[::2], names[1::2], strict=True)
    }
    run = {"input": "in", "output": "out", "speed": "1000 rpm", "torque": 100.0}
    clock = {"phases": "off"}
    case = td.study.MachineCase(gears=gears, meshes=meshes, operation=run, solver=clock)
    from tribodyn.study.machine.first_look import warn_of_period

    with td.errors.collected() as caught:
        warn_of_period(case.machine())
    message = str(caught[0])
    assert f"{57 * 61} cycles of mesh z1z2" in message
    assert "z3z4 22 : 61" in message
    assert "GB" in message
    assert 'solver.phases = "auto"' in message
    with monkeypatch.context() as small:
        small.setattr("tribodyn.study.machine.first_look.machine_memory", lambda: 1e8)
        with pytest.raises(td.ComputationError, match=r"at least 0\.\d+ GB.* has 0\.1 GB"):
            td.run(case)
    gears["z3"]["teeth"], gears["z5"]["teeth"] = 19, 61
    with td.errors.collected() as caught:
        warn_of_period(td.study.MachineCase(gears=gears, meshes=meshes, operation=run).machine())
    assert not caught
