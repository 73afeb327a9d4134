"""A saved result comes back: the same figures, the same numbers; what is damaged is refused."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from broken import SOUND

import tribodyn as td
from tribodyn.drawing import figures_of
from tribodyn.study import read_case
from tribodyn.study.pipeline import stored_motion

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_SOUND = read_case(SOUND, "pair.toml").replace({"solver.steps_per_mesh_cycle": 256})
_LAW = {"stiffness.model": "analytic", "stiffness.reference": "rim",
        "stiffness.pair_stiffness": None, "dynamics.backlash": "0.05 mm"}  # fmt: skip
CASES = {
    "steady": {},
    "torsional": {"dynamics.model": "torsional", "dynamics.bearing_stiffness": None},
    "force-law": _LAW,
    "loss-of-contact": {**_LAW, "operation.speed": "4200 rpm", "operation.torque": "20 N*m"},
    "load-friction": {"dynamics.friction_load": "dynamic", "friction.coefficient": None,
                      "friction.law": "xu-2007"},
    "newmark": {"solver.engine": "newmark"},
    "transient": {"solver.method": "transient", "solver.cycles": 6},
}  # fmt: skip


SLOW = {"newmark": pytest.mark.slow}  # compiles an engine of its own


@pytest.fixture(
    scope="module",
    params=[pytest.param(name, marks=SLOW.get(name, ())) for name in CASES],
)
def saved_and_loaded(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Any:
    result = td.run(_SOUND.replace(CASES[request.param]))
    place = result.save(tmp_path_factory.mktemp("saved") / "out")
    return result, td.load_result(place), place


def test_summary_case_and_warnings_are_those_saved(saved_and_loaded: Any) -> None:
    result, loaded, place = saved_and_loaded
    assert loaded.summary() == result.summary() == json.loads((place / "summary.json").read_text())
    assert loaded.case == result.case
    assert list(map(str, loaded.warnings)) == list(map(str, result.warnings))


def test_every_array_and_file_comes_back_to_the_last_bit(
    saved_and_loaded: Any, tmp_path: Path
) -> None:
    result, loaded, place = saved_and_loaded
    assert loaded.mesh == result.mesh
    assert loaded.response == result.response
    assert loaded.nominal_friction_response == result.nominal_friction_response
    if result.friction is not None:
        for name, values in vars(result.friction).items():
            if isinstance(values, np.ndarray | float):
                np.testing.assert_array_equal(getattr(loaded.friction, name), values)
    assert loaded.assumptions == result.assumptions
    assert loaded.case.to_toml() == result.case.to_toml()
    again = loaded.save(tmp_path / "again")
    for path in place.iterdir():
        if path.suffix != ".html":  # it has the time of writing
            assert path.read_bytes() == (again / path.name).read_bytes(), path.name
    with xarray.open_dataset(place / "response.nc", engine="h5netcdf") as data:
        assert data.attrs["version"] == td.__version__


def test_the_summary_computed_anew_is_the_one_saved(saved_and_loaded: Any) -> None:
    result, loaded, _ = saved_and_loaded
    del vars(loaded)["_summary"], vars(loaded)["figures"]
    again = loaded.summary()
    assert again.keys() == result.summary().keys()
    for name, value in result.summary().items():
        assert again[name] == pytest.approx(value, rel=1e-12, abs=1e-15), name


def test_every_figure_is_drawn_from_equal_numbers(saved_and_loaded: Any) -> None:
    result, loaded, _ = saved_and_loaded
    assert figures_of(loaded) == figures_of(result)
    for name in figures_of(result):
        if not td.plot.FIGURES[name].missing(result):
            figure, again = (getattr(each, f"plot_{name}")() for each in (result, loaded))
            for trace, other in zip(figure.data, again.data, strict=True):
                if trace.y is not None and np.asarray(trace.y).dtype.kind == "f":
                    scale = float(np.nanmax(np.abs(trace.y), initial=0.0))
                    np.testing.assert_allclose(other.y, trace.y, rtol=1e-12, atol=1e-12 * scale)


def test_plotted_series_are_saved_with_units(saved_and_loaded: Any) -> None:
    result, _, place = saved_and_loaded
    with xarray.open_dataset(place / "response.nc", engine="h5netcdf") as data:
        force = np.asarray(result.response.contact_force).sum(axis=1)
        assert np.array_equal(data["mesh_force"], force)
        touch = data["deflection"][:, 0] - data.attrs["half_backlash"]
        if result.case.dynamics.transmission_error_amplitude == 0.0:
            np.testing.assert_allclose(data["dynamic_transmission_error"], touch, atol=1e-18)
        assert data.sizes["contact"] == 1
        for name, series_of in data.data_vars.items():
            assert series_of.attrs["long_name"], name
            assert " or " not in series_of.attrs.get("units", "")
        units = dict(zip(data["coordinate"].values, data["velocity_unit"].values, strict=True))
        assert units["pinion_theta"] == "rad/s"
        if "order" in data.sizes:
            harmonic = float(data["dynamic_transmission_error_spectrum"].sel(order=1.0))
            value = result.summary()["dynamic_transmission_error_harmonic_1"]
            assert harmonic == pytest.approx(value, rel=1e-12)
        if "pinion_y" in result.response.names:
            bearing = data["bearing_force_loa_pinion"]
            assert bearing.attrs["units"] == "N"
            spring = 3.5e9 * data["position"].sel(coordinate="pinion_y")
            assert float(bearing.mean()) == pytest.approx(float(spring.mean()), rel=1e-4)


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return td.run(_SOUND).save(tmp_path_factory.mktemp("one") / "out", csv=True)


def test_friction_force_balances_the_bearings_across(saved: Path) -> None:
    with xarray.open_dataset(saved / "response.nc", engine="h5netcdf") as data:
        # across the line of action nothing else acts on the pinion
        mean = float(data["bearing_force_oloa_pinion"].mean())
        assert abs(mean) == pytest.approx(abs(float(data["friction_force"].mean())), rel=2e-3)


def test_the_motion_as_comma_separated_values(saved: Path) -> None:
    lines = (saved / "response.csv").read_text().splitlines()
    head = lines[0].split(",")
    assert head[0] == "time [s]"
    assert {"position_pinion_theta [rad]", "mesh_force [N]",
            "dynamic_transmission_error [m]"} <= set(head)  # fmt: skip
    rows = np.genfromtxt(saved / "response.csv", delimiter=",", skip_header=1)
    with xarray.open_dataset(saved / "response.nc", engine="h5netcdf") as data:
        assert rows.shape == (data.sizes["time"], len(head))
        force = rows[:, head.index("mesh_force [N]")]
        np.testing.assert_allclose(force, data["mesh_force"], rtol=1e-8)


def test_a_long_run_is_stored_by_its_last_mesh_cycles(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    result = td.run(_SOUND.replace({"solver.method": "transient", "solver.cycles": 40}))
    full_size = sum(v.nbytes for v in result.to_xarray().variables.values() if "time" in v.dims)
    monkeypatch.setattr(stored_motion, "LARGEST", full_size // 4)
    place = result.save(tmp_path / "out")
    loaded = td.load_result(place)
    assert loaded.response.periods == 10
    assert loaded.summary() == result.summary()
    np.testing.assert_array_equal(loaded.response.position, result.response.position[-10 * 256 :])
    np.testing.assert_allclose(loaded.response.time, result.response.time[-10 * 256 :], rtol=1e-12)
    assert "the last 10 of 40 mesh cycles" in (place / "report.html").read_text()


def test_a_very_long_run_stores_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    from tribodyn.study.pipeline import motion

    case = _SOUND.replace({"solver.method": "transient", "solver.cycles": 70})
    full = td.run(case)
    monkeypatch.setattr(motion, "_MOST_ROWS", 256 * 12)
    shortened = td.run(case)
    assert "transient-kept" in [warning.code for warning in shortened.warnings]
    np.testing.assert_array_equal(shortened.response.position, full.response.position[-12 * 256 :])
    assert shortened.response.time[0] == pytest.approx(58 / shortened.response.mesh_frequency)


def _broken(saved: Path, place: Path, name: str) -> Path:
    shutil.copytree(saved, place)
    if name == "foreign":
        other = td.run(_SOUND.replace(CASES["torsional"])).save(place.parent / "other")
        shutil.copy(other / "response.nc", place / "response.nc")
    elif name == "earlier":
        with xarray.open_dataset(saved / "response.nc", engine="h5netcdf") as data:
            data.load().drop_vars("end_position").to_netcdf(place / "response.nc",
                                                            engine="h5netcdf")  # fmt: skip
    elif name.endswith(" gone"):
        (place / name.removesuffix(" gone")).unlink()
    else:
        (place / name).write_bytes((place / name).read_bytes()[:100])
    return place


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("summary.json gone", r"holds no summary\.json"),
        ("response.nc gone", r"holds no response\.nc"),
        ("summary.json", r"summary\.json"),
        ("response.nc", r"response\.nc cannot be read"),
        ("mesh.nc", r"mesh\.nc"),
        ("case.toml", r"case\.toml"),
        ("foreign", "different results"),
        ("earlier", "an earlier version wrote it"),
    ],
)
def test_incomplete_results_are_refused(saved: Path, tmp_path: Path, name: str, says: str) -> None:
    with pytest.raises(td.InputError, match=says) as caught:
        td.load_result(_broken(saved, tmp_path / "broken", name))
    assert all(problem.remedy for problem in caught.value.problems)
