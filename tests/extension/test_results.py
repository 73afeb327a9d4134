"""Figures and summary figures of third parties, one file each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from own_case import CASE

import tribodyn as td
from tribodyn.cli import call
from tribodyn.errors import InputError
from tribodyn.study import summary_figure

Load = Callable[[str], dict[str, object]]


def test_figure_is_a_method_of_the_result(load: Load, tmp_path: Path) -> None:
    load("figure")
    path = tmp_path / "my.toml"
    path.write_text(CASE, encoding="utf-8")
    result = td.run(path)
    figure = result.plot_force_over_compression()
    assert len(figure.data[0].x) == result.response.time.size
    report = result.save(tmp_path / "r") / "report.html"
    assert "force_over_compression" in report.read_text(encoding="utf-8")


def test_summary_figure_is_in_every_summary(
    load: Load, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    load("summary_figure")
    path = tmp_path / "my.toml"
    path.write_text(CASE, encoding="utf-8")
    result = td.run(path)
    figures = result.summary()
    ratio = figures["peak_mesh_force"] / figures["static_mesh_force"]
    assert figures["dynamic_load_factor"] == pytest.approx(ratio, rel=1e-2)
    assert call(["explain", "dynamic_load_factor"]) == 0
    assert "greatest mesh force over that at rest" in capsys.readouterr().out


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize(
    "name",
    ["planetary-stage", "hypoid-axle", pytest.param("two-stage-helical", marks=pytest.mark.slow)],
)
def test_summary_figure_of_parts_is_in_every_summary_of_machines(
    load: Load, name: str, tmp_path: Path
) -> None:
    load("summary_figure")
    summary_figure("none", meaning="nothing", part="machine")(lambda load: None)
    summary_figure("largest_force", meaning="peak", of="bearing_force", part="bearings")(
        lambda load, name: load.motion.radial_force[:, load.motion.bearing.index(name)].max()
    )
    case = td.load_case(name)
    if name != "planetary-stage":
        case = case.replace({f"meshes.{mesh}.stiffness": 5e8 for mesh in case.meshes})
    rows = case.data.get("load_cases", [])
    case = case.replace({"load_cases": rows[:1] or None})
    result = td.run(case)
    figures = result.summary()
    for place, each in enumerate(result.loads.values()):
        start = f"load_cases.{each.load.name}." if place else ""
        for mesh in case.meshes:
            ratio = figures[f"{start}meshes.{mesh}.peak_mesh_force"]
            ratio /= figures[f"{start}meshes.{mesh}.static_mesh_force"]
            value = figures[f"{start}meshes.{mesh}.dynamic_load_factor"]
            assert value == pytest.approx(ratio, rel=1e-12)
        for bearing in each.machine.bearings:
            peak = figures[f"{start}bearings.{bearing}.peak_radial_force"]
            assert figures[f"{start}bearings.{bearing}.largest_force"] == peak
    assert not any(key.endswith(".none") for key in figures)  # none is left out
    saved = td.load_result(result.save(tmp_path / "saved")).summary()
    assert saved == figures


def test_names_of_the_package_and_unknown_parts_are_refused() -> None:
    for name, part in (
        ("peak_mesh_force", ""), ("friction_power", "meshes"), ("mesh_frequency", "meshes"),
        ("own", "gearbox"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=part if part == "gearbox" else name):
            summary_figure(name, meaning="own", part=part)
