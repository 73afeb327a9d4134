"""Tables and figures of a result for other programs."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import tribodyn as td
from tribodyn.cli import call
from tribodyn.errors import InputError
from tribodyn.exchange import write_tables


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_tables_and_figures_hold_the_data_of_the_result(tmp_path: Path, capsys) -> None:
    result = td.run("time-varying-friction")
    result.save(tmp_path / "run")
    assert call(["export", str(tmp_path / "run"), "--tables", str(tmp_path / "all")]) == 0
    place = tmp_path / "all"
    with (place / "summary.csv").open() as file:
        read = {row["figure"]: float(row["value"]) for row in csv.DictReader(file)}
    assert read == result.summary()
    with (place / "motion_over_time.csv").open() as file:
        rows = list(csv.DictReader(file))
    motion = result.to_xarray()
    for name, unit in (("mesh_force", "N"), ("dynamic_transmission_error", "m")):
        values = [float(row[f"{name} [{unit}]"]) for row in rows]
        np.testing.assert_allclose(values, motion[name].values, rtol=1e-12)
    mesh = json.loads((place / "mesh_over_knot.json").read_text(encoding="utf-8"))
    np.testing.assert_array_equal(mesh["mesh_stiffness [N/m]"], result.mesh.mesh_stiffness)
    curve = result.plot_mesh_force().data[0]
    stored = json.loads((place / "figure_mesh_force.json").read_text(encoding="utf-8"))
    assert stored["layout"]["title"]["text"] == result.plot_mesh_force().layout.title.text
    with (place / "figure_mesh_force.csv").open() as file:
        points = [row for row in csv.DictReader(file) if row["curve"] == "dynamic"]
    np.testing.assert_array_equal([float(row["y"]) for row in points], curve.y)
    with pytest.raises(InputError, match="exists already"):
        write_tables(result, place)
    capsys.readouterr()
    assert call(["export", str(tmp_path / "run")]) == 2
    assert "--rexs FILE for a case, or --tables FOLDER" in capsys.readouterr().err


def test_results_of_studies_are_written_too(tmp_path: Path) -> None:
    case = td.load_case("fzg-roughness")
    modes = td.natural_modes(case)
    place = write_tables(modes, tmp_path / "modes")
    with (place / "table_over_mode.csv").open() as file:
        rows = list(csv.DictReader(file))
    np.testing.assert_allclose([float(row["frequency [Hz]"]) for row in rows], modes.frequency)
    stored_figure = json.loads((place / "figure_mode_shapes.json").read_text(encoding="utf-8"))
    assert len(stored_figure["data"]) == len(modes.plot().data)
    harris = td.harris_map(case, torque=["60 N*m", "90 N*m"])
    place = write_tables(harris, tmp_path / "harris")
    stored_table = json.loads((place / "table_over_torque.json").read_text(encoding="utf-8"))
    measured = stored_table["peak_to_peak_transmission_error [m]"]
    np.testing.assert_array_equal(measured, harris.peak_to_peak_transmission_error)
