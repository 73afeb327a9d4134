"""Sweeps of a case: grids, recorded failures, interruption, files and figures."""

from __future__ import annotations

import csv
import io
import threading
import warnings

import numpy as np
import pytest
import xarray

import tribodyn as td
from tribodyn.errors import InputError, OutputExistsError
from tribodyn.study import Sweep
from tribodyn.study.studies.study_axes import read_axes
from tribodyn.study.studies.sweep_result import SweepPoint

FIGURE = "rms_mesh_force"


@pytest.fixture(scope="module")
def case():
    return td.load_case("fzg-roughness").replace(
        {"film.model": "none", "solver.steps_per_mesh_cycle": 512}
    )


@pytest.fixture(scope="module")
def grid(case):
    over = {"operation.speed": ("1000 rpm", "1500 rpm", 3), "operation.torque": ["50 N*m", 90.0]}
    return td.sweep(case, over)


def test_every_value_is_a_run_of_its_own(case, grid):
    assert grid.shape == (3, 2)
    assert grid.complete
    alone = case.replace({"operation.speed": "1250 rpm", "operation.torque": 50.0})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", td.ModelWarning)
        figures = td.run(alone).summary()
    assert grid[FIGURE][1, 0] == pytest.approx(figures[FIGURE], rel=1e-12)
    assert np.all(grid["static_mesh_force"][:, 1] == pytest.approx(2660.444, rel=1e-6))
    assert not np.any(grid.failed != "")
    assert repr(grid) == (
        "Sweep(3 values of operation.speed from 1000 rpm to 1500 rpm x 2 values of "
        "operation.torque from 50 N*m to 90 N*m)"
    )


def test_data_set_has_units_and_reasons(grid):
    data = grid.to_xarray()
    assert data[FIGURE].dims == ("speed", "torque")
    assert data[FIGURE].attrs["units"] == "N"
    assert data.speed.attrs == {"units": "rad/s", "key": "operation.speed"}
    assert data.speed.values[0] == pytest.approx(1000.0 * np.pi / 30.0)
    assert data.failed.shape == (3, 2)
    assert "thin-tip" in str(data.warnings.values[0, 0])


def test_a_failed_value_is_reported_and_the_others_go_on(case):
    over = {"friction.law": ["none", "constant"], "operation.torque": [50.0, 90.0]}
    result = td.sweep(case, over)
    assert (result.failed == "").tolist() == [[True, True], [False, False]]
    assert "coefficient is missing" in result.failed[1, 0]
    assert np.isnan(result[FIGURE][1]).all()
    assert np.isfinite(result[FIGURE][0]).all()
    assert ", 2 failed)" in repr(result)
    rows = list(csv.DictReader(io.StringIO(result.to_csv())))
    assert rows[2][f"{FIGURE} [N]"] == ""
    assert "coefficient is missing" in rows[2]["failed"]
    names = [trace.name for trace in result.plot().data]
    assert names.count("failed") == 2
    assert result.plot().data[1].text[0] == result.failed[1, 0]


def test_interruption_preserves_finished_points(case, monkeypatch, tmp_path):
    import tribodyn.study.studies.sweep as module

    prepare_run, figures = module.prepare_run, module._figures
    ready = [threading.Event(), threading.Event()]

    def third_is_interrupted(changed, **options):
        speed = round(changed.operation.speed * 30.0 / np.pi)
        if speed == 1250:
            assert all(event.wait(300.0) for event in ready)
            raise KeyboardInterrupt
        return prepare_run(changed, **options)

    def signalled_figures(point):
        result = figures(point)
        place = round((point.case.operation.speed * 30.0 / np.pi - 1000.0) / 125.0)
        if place < 2:
            # The point counts as finished a moment after this.
            threading.Timer(0.2, ready[place].set).start()
        return result

    monkeypatch.setattr(module, "prepare_run", third_is_interrupted)
    monkeypatch.setattr(module, "_figures", signalled_figures)
    result = td.sweep(case, between=("1000 rpm", "1500 rpm"), points=5, partial=True)
    assert not result.complete
    assert repr(result).endswith("2 of 5 done)")
    assert np.isfinite(result[FIGURE]).tolist() == [True, True, False, False, False]
    assert result.failed[2].startswith("not computed")
    result.save(tmp_path / "part")
    assert len((tmp_path / "part" / "sweep.csv").read_text().splitlines()) == 3
    assert "2 of 5" in (tmp_path / "part" / "report.html").read_text()
    with pytest.raises(KeyboardInterrupt):
        td.sweep(case, between=("1000 rpm", "1500 rpm"), points=5)


def test_saved_sweep_reads_back_and_is_replaced_only_by_force(grid, tmp_path):
    place = grid.save(tmp_path / "speeds")
    assert sorted(p.name for p in place.iterdir()) == [
        "case.toml", "report.html", "sweep.csv", "sweep.nc",
    ]  # fmt: skip
    with xarray.open_dataset(place / "sweep.nc", engine="h5netcdf") as data:
        np.testing.assert_array_equal(data[FIGURE].values, grid[FIGURE])
        assert data.failed.values[0, 0] == ""
    assert td.load_case(place / "case.toml") == grid.case
    with pytest.raises(OutputExistsError):
        grid.save(place)
    assert grid.save(place, force=True) == place
    (place / "thesis.tex").write_text("x")
    with pytest.raises(OutputExistsError, match=r"thesis\.tex"):
        grid.save(place, force=True)


def test_curves_are_in_display_units_one_for_each_torque(grid):
    figure = grid.plot("peak_to_peak_dynamic_transmission_error")
    assert [trace.name for trace in figure.data] == ["50 N·m", "90 N·m"]
    assert figure.layout.legend.title.text == "Torque"
    assert list(figure.data[0].x) == pytest.approx([1000.0, 1250.0, 1500.0])
    expected = 1e6 * grid["peak_to_peak_dynamic_transmission_error"][:, 0]
    assert list(figure.data[0].y) == pytest.approx(list(expected))
    assert figure.layout.xaxis.title.text == "Speed [rpm]"
    assert figure.layout.yaxis.title.text.endswith("[µm]")


def test_many_curves_become_a_map(case):
    over = {"operation.speed": ("1 rpm", "2 rpm", 8), "operation.torque": ("1 N*m", "2 N*m", 9)}
    axes = read_axes(case, over)
    values = [(a, b) for a in axes[0].values for b in axes[1].values]
    points = tuple(SweepPoint(v, {FIGURE: v[0] * v[1]}) for v in values)
    figure = Sweep(case, axes, points).plot()
    (heat,) = figure.data
    assert heat.type == "heatmap"
    assert heat.z.shape == (9, 8)
    assert heat.z[8, 7] == pytest.approx(values[-1][0] * values[-1][1])
    assert "2 rpm, 2 N·m" in figure.layout.title.text


def test_names_shared_with_dimensions_are_distinguished(case):
    over = {"gears.pinion.roughness_rms": [1e-7, 2e-7], "gears.wheel.roughness_rms": [1e-7, 2e-7]}
    axes = read_axes(case, over)
    points = tuple(
        SweepPoint((a, b), {FIGURE: 1.0}) for a in axes[0].values for b in axes[1].values
    )
    dims = Sweep(case, axes, points).to_xarray()[FIGURE].dims
    assert dims == ("gears_pinion_roughness_rms", "gears_wheel_roughness_rms")


def test_an_unknown_figure_names_the_nearest(grid):
    with pytest.raises(InputError, match='"rms_mesh_force"'):
        grid["rms_mesh_forc"]


@pytest.mark.parametrize(
    ("over", "message"),
    [
        ({}, "nothing varies"),
        ({"operation.sped": [1.0, 2.0]}, r"sped.*Did you mean \"speed\""),
        ({"speed": [1.0, 2.0]}, r"\[operation\]"),
        ({"operation": [1.0, 2.0]}, r"is a table.*operation\.speed"),
        ({"operation.speed": ("400", "500", 3)}, "unit"),
        ({"operation.speed": ("500 rpm", "400 rpm", 3)}, "Exchange the two ends"),
        ({"operation.speed": ("400 rpm", "500 rpm", 1)}, "at least two points"),
        (
            {"operation.speed": ("1 rpm", "2 rpm", "3 rpm")},
            "3 rpm points.*a list has single values",
        ),
        ({"operation.speed": ["400 rpm"]}, "1 value"),
        ({"operation.speed": "400 rpm"}, "a tuple, or a list"),
        ({"friction.law": ("none", "constant", 3)}, "no values in between"),
        ({"friction.law": ["none", "benedikt-kelly"]}, "benedict-kelly"),
        ({"operation.torque": ["50 N*m", "1e20 N*m"]}, "Allowed"),
    ],
)
def test_bad_input_is_refused_before_anything_runs(case, over, message, monkeypatch):
    monkeypatch.setattr(
        "tribodyn.study.studies.sweep.prepare_run", lambda *_, **__: pytest.fail("it ran")
    )
    with pytest.raises(InputError, match=message):
        td.sweep(case, over)


def test_one_key_needs_its_two_ends(case):
    with pytest.raises(InputError, match="between"):
        td.sweep(case, "operation.speed")
    with pytest.raises(InputError, match="between"):
        td.sweep(case, {"operation.speed": [1.0, 2.0]}, (1.0, 2.0))
