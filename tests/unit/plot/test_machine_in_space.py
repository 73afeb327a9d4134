"""The view of a machine in space: closed bodies to scale, power that adds up, modes that bend."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn import plot

CASES = ("two-stage-spur", "hypoid-axle", "planetary-stage", "wind-turbine-gearbox")


def _run(name: str) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", td.ModelWarning)
        return td.run(name)


def _sketch(machine: Any) -> Any:
    return plot.machine_space.sketch(machine)


def _volume(trace: dict[str, Any]) -> float:
    """Volume inside a closed surface of triangles, by the divergence theorem [mm3]."""
    points = np.array([trace[axis] for axis in "xyz"], dtype=float).T
    points = points - points.mean(axis=0)
    a, b, c = (points[trace[corner]] for corner in "ijk")
    return abs(float(np.einsum("na,na->", a, np.cross(b, c)))) / 6.0


def _part(sketch: Any, text: str) -> dict[str, Any]:
    return next(t for t in sketch.data if str(t.get("text", "")).startswith(text))


@pytest.mark.parametrize("name", CASES)
def test_the_bodies_are_closed_and_where_the_parts_are(name: str) -> None:
    machine = td.load_case(name).machine()
    bodies = [t for t in _sketch(machine).data if t["type"] == "mesh3d" and t.get("visible", True)]
    parts = len(machine.shafts) + len(machine.bearings) + len(machine.gears)
    assert len(bodies) == parts
    for body in bodies:
        points = np.array([body[axis] for axis in "xyz"], dtype=float).T
        a, b, c = (points[body[corner]] for corner in "ijk")
        areas = np.cross(b - a, c - a)  # those of a closed surface add up to nothing
        assert np.abs(areas.sum(axis=0)).max() < 1e-4 * np.abs(areas).sum()
    for gear, middle in machine.placement.gears.items():
        if machine.gears[gear].teeth > 0 and name != "hypoid-axle":
            body = _part(_sketch(machine), f"{gear}: ")
            centre = [float(np.ptp(body[axis])) / 2 + float(np.min(body[axis])) for axis in "xyz"]
            assert centre == pytest.approx([1e3 * at for at in middle], abs=0.35)


def test_a_long_machine_is_seen_from_further_away() -> None:
    def distance(length: str) -> float:
        case = td.Case(
            shafts={name: {"sections": [[length, "40 mm"]]} for name in ("in", "out")},
            bearings={f"{n}{x}": {"shaft": n, "position": x, "radial_stiffness": 1e9}
                      for n in ("in", "out") for x in (0.0, 0.1)},
            gears={"z1": {"shaft": "in", "teeth": 20, "face_width": "50 mm", "position": "50 mm"},
                   "z2": {"shaft": "out", "teeth": 41, "face_width": "50 mm", "position": "50 mm"}},
            meshes={"first": {"gears": ["z1", "z2"], "normal_module": "4 mm", "stiffness": 5e8}},
            operation={"input": "in", "output": "out", "speed": "9 rpm", "torque": "9 N*m"},
        )  # fmt: skip
        eye = _sketch(case.machine()).layout["scene"]["camera"]["eye"]
        return float(np.linalg.norm([eye[axis] for axis in "xyz"]))

    assert distance("3 m") > 1.5 * distance("1 m") > distance("0.2 m") > 2.0


def test_a_gear_has_the_volume_of_its_reference_cylinder() -> None:
    machine = td.load_case("two-stage-spur").machine()
    sketch = _sketch(machine)
    for name, gear in machine.gears.items():
        mesh = next(m for m in machine.meshes.values() if name in m.gears)
        radius = 0.5e3 * gear.teeth * mesh.transverse_module
        polygon = 24.0 * np.sin(2.0 * np.pi / 48.0)  # area over the square of the radius
        volume = polygon * radius**2 * 1e3 * gear.face_width
        assert _volume(_part(sketch, f"{name}: ")) == pytest.approx(volume, rel=1e-4)


def test_lines_of_power_are_as_wide_as_their_power() -> None:
    machine = td.load_case("wind-turbine-gearbox").machine()
    lines = [t for t in _sketch(machine).data if str(t.get("text", "")).endswith(" W")]
    power = np.array([float(t["text"].rpartition(": ")[2].removesuffix(" W")) for t in lines])
    width = np.array([t["line"]["width"] for t in lines])
    total = machine.operation.torque * machine.operation.speed
    assert width / 14.0 == pytest.approx(power / total, rel=1e-4)
    into = [p for t, p in zip(lines, power, strict=True) if t["text"].startswith("carrier ")]
    assert sum(into) == pytest.approx(total, rel=1e-4)  # the arms carry all that comes in


def test_a_mode_bends_the_axes_by_its_displacement() -> None:
    result = _run("two-stage-spur")
    sketch = _sketch(result)
    modes, machine = result.modes, result.machine
    menu = sketch.layout["updatemenus"][0]["buttons"]
    number = next(k for k, b in enumerate(menu) if b["label"].startswith("1: "))
    flags = menu[number]["args"][0]["visible"]
    shown = [t for t, flag in zip(sketch.data, flags, strict=True) if flag and "opacity" not in t]
    axes, circles = shown
    gaps = np.flatnonzero(np.isnan(axes["x"]))
    first = np.array([axes[axis][: gaps[0]] for axis in "xyz"]).T.astype(float)
    name, shaft = next(iter(machine.shafts.items()))
    along = np.linspace(0.0, shaft.length, len(first))
    moved = np.array([modes.structure.at(name, at)[:3] @ modes.shape[0].real for at in along])
    rest = np.zeros_like(first)
    rest[:, 0] = 1e3 * along
    drawn = (first - rest - 1e3 * np.array(machine.placement.shafts[name])).ravel()
    scale = float(drawn @ moved.ravel()) / float(np.sum(moved**2))
    assert scale > 0.0
    assert drawn == pytest.approx(scale * moved.ravel(), abs=1e-4 * np.abs(drawn).max() + 1e-4)
    assert np.isnan(circles["x"]).sum() == len(machine.gears)


def test_a_stage_and_a_machine_are_drawn_from_their_results() -> None:
    sketch = _sketch(_run("planetary-stage"))
    labels = [b["label"] for b in sketch.layout["updatemenus"][0]["buttons"]]
    assert labels[:2] == ["The machine", "Flow of power"]
    assert labels[2].endswith("Hz")
    with pytest.raises(td.InputError, match="machine_space"):
        plot.machine_space(_run("fzg-roughness"))
