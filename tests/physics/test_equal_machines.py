"""Machines that are the same by their physics have the same figures, however they are written."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.study import MachineCase, read_case
from tribodyn.study.machine.run import balanced_machine

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

Tables = dict[str, Any]
#: Accuracy of a motion, of whose residual Newton's method leaves 1e-9.
_SAME = 3e-8
#: Teeth of two stages whose meshes repeat together after a few cycles.
TEETH = [(16, 24, 18, 27), (20, 30, 21, 35), (18, 45, 20, 32), (24, 36, 17, 34)]


def drawn(seed: int) -> Tables:
    """A reducer of two stages on elastic shafts with bearings of given stiffness."""
    random = np.random.default_rng(seed)
    teeth = TEETH[seed % len(TEETH)]
    modules = random.uniform(2.0, 3.0), random.uniform(3.0, 4.0)
    shafts, bearings, gears = {}, {}, {}
    for shaft, thick in (("in", 30), ("middle", 45), ("out", 60)):
        length = random.uniform(150.0, 200.0)
        shafts[shaft] = {"sections": [[f"{length!r} mm", f"{thick} mm"]]}
        for end, place in (("left", 10.0), ("right", length - 10.0)):
            bearings[f"{shaft}_{end}"] = {
                "shaft": shaft, "position": f"{place!r} mm",
                "radial_stiffness": f"{random.uniform(150.0, 400.0)!r} N/um",
                "axial_stiffness": "100 N/um" if end == "left" else "0 N/m",
            }  # fmt: skip
    places = {"in": 50.0, "middle": 45.0, "behind": 100.0, "out": 90.0}
    for name, shaft, place, count, width in zip(
        "abcd", ("in", "middle", "middle", "out"), places, teeth, (22, 20, 30, 28), strict=True
    ):
        gears[name] = {
            "shaft": shaft, "position": f"{places[place]} mm", "teeth": count,
            "face_width": f"{width} mm",
        }  # fmt: skip
    meshes = {
        name: {
            "gears": list(pair),
            "normal_module": f"{module!r} mm",
            "angle": f"{random.uniform(-80.0, 80.0)!r} deg",
        }
        for name, pair, module in zip(("first", "second"), ("ab", "cd"), modules, strict=True)
    }
    if seed % 2:
        meshes["first"] |= {"helix_angle": "12 deg", "hand": "left"}
    return {
        "shafts": shafts, "bearings": bearings, "gears": gears, "meshes": meshes,
        "stiffness": {"model": "iso6336"},
        "dynamics": {"backlash": "0.12 mm"},
        "operation": {
            "input": "in", "output": "out", "speed": f"{random.uniform(900.0, 2500.0)!r} rpm",
            "torque": f"{random.uniform(30.0, 60.0)!r} N*m",
        },
    }  # fmt: skip


def written(tables: Tables) -> str:
    """Text of a case file."""
    lines: list[str] = []
    for name, table in tables.items():
        parts = table.items() if all(isinstance(v, dict) for v in table.values()) else [("", table)]
        for part, values in parts:
            lines.append(f"[{name}.{part}]" if part else f"[{name}]")
            lines += [f"{key} = {json.dumps(value)}" for key, value in values.items()]
    return "\n".join(lines) + "\n"


@cache
def summary_of(text: str) -> dict[str, float]:
    """Summary of the run of a case file."""
    return td.run(read_case(text)).summary()


def figures(tables: Tables) -> dict[str, float]:
    """Summary of the run of a case."""
    return dict(summary_of(written(tables)))


def renamed(tables: Tables, new: Callable[[str], str]) -> Tables:
    """The same with other names of all parts, in the order of the new names."""
    groups = "shafts", "bearings", "gears", "meshes"
    named = {name for group in groups for name in tables[group]}

    def value(item: Any) -> Any:
        if isinstance(item, list):
            return [value(each) for each in item]
        return new(item) if isinstance(item, str) and item in named else item

    changed = {}
    for group, table in tables.items():
        if group in groups:
            parts = {new(n): {k: value(v) for k, v in t.items()} for n, t in table.items()}
            changed[group] = dict(sorted(parts.items()))
        else:
            changed[group] = {key: value(v) for key, v in table.items()}
    return changed


def turned(name: str) -> str:
    """Name with its letters in reverse order, after another letter."""
    return f"q{name[::-1]}"


def assert_same(left: dict[str, float], right: dict[str, float]) -> None:
    """Equal but for the accuracy of the motion."""
    assert left.keys() == right.keys()
    for name, value in left.items():
        kind = name.rpartition("_")[2]  # force, stiffness, ratio, ...
        size = max(abs(v) for key, v in left.items() if key.endswith(kind))
        assert right[name] == pytest.approx(value, rel=_SAME, abs=_SAME * size), name


def mirrored(tables: Tables) -> Tables:
    """The mirror image in the plane of x and z: other senses, hands and angles."""
    change = copy.deepcopy(tables)
    for mesh in change["meshes"].values():
        mesh["angle"] = (
            mesh["angle"].removeprefix("-") if mesh["angle"][0] == "-" else f"-{mesh['angle']}"
        )
        if "hand" in mesh:
            mesh["hand"] = {"left": "right", "right": "left"}[mesh["hand"]]
    change["operation"]["speed"] = f"-{change['operation']['speed']}"
    return change


@pytest.mark.parametrize("seed", range(4))
def test_names_and_order_of_parts_change_no_figure(seed: int) -> None:
    tables = drawn(seed)
    other = {}
    for key, value in figures(renamed(tables, turned)).items():
        group, *part, name = key.split(".")
        other[".".join([group, *(old[1:][::-1] for old in part), name])] = value
    assert_same(figures(tables), other)


@pytest.mark.parametrize("seed", range(4))
def test_a_mirror_image_has_the_same_figures(seed: int) -> None:
    tables = drawn(seed)
    first, second = (figures(each) for each in (tables, mirrored(tables)))
    # Speeds are those about x, against which a mirror image turns.
    image = {key: -value if key.endswith(".speed") else value for key, value in second.items()}
    assert_same(first, image)


TEETH_OF_PAIR = """
[{pinion}]
{shaft_1}
teeth = 19
face_width = "22 mm"
roughness_ra = "0.4 um"
[{wheel}]
{shaft_2}
teeth = 31
face_width = "20 mm"
roughness_ra = "0.3 um"
[{mesh}]
{gears}
normal_module = "4 mm"
normal_pressure_angle = "20 deg"
center_distance = "{distance} mm"
helix_angle = "{helix} deg"
[dynamics]
{model}
mesh_law = "force-law"
[operation]
{shafts}
speed = "1400 rpm"
torque = "90 N*m"
[lubricant]
name = "ISO VG 220"
temperature = "60 degC"
[stiffness]
model = "iso6336"
[film]
model = "moes"
[friction]
law = "xu-2007"
"""
AS_PAIR = {
    "pinion": "gears.pinion", "wheel": "gears.wheel", "mesh": "gears", "gears": 'driver = "pinion"',
    "shaft_1": "", "shaft_2": "", "model": 'model = "torsional"', "shafts": "",
}  # fmt: skip
AS_MACHINE = {
    "pinion": "gears.p", "wheel": "gears.w", "mesh": "meshes.m", "gears": 'gears = ["p", "w"]',
    "shaft_1": 'shaft = "one"', "shaft_2": 'shaft = "two"', "model": "",
    "shafts": 'input = "one"\noutput = "two"',
}  # fmt: skip


@pytest.mark.parametrize(("distance", "helix"), [(100.2, 0), (103.7, 15)])
def test_a_pair_and_a_machine_of_two_gears_have_one_mesh(
    distance: float, helix: int, tmp_path: Path
) -> None:
    results = []
    for words in (AS_PAIR, AS_MACHINE):
        path = tmp_path / "case.toml"
        path.write_text(TEETH_OF_PAIR.format(distance=distance, helix=helix, **words))
        results.append(td.run(td.load_case(path)))
    pair, machine = results
    table = machine.operation.tables["m"]
    for name in ("stiffness", "friction_coefficient", "sliding_speed", "hertz_pressure",
                 "static_transmission_error", "central_film", "load_share"):  # fmt: skip
        np.testing.assert_allclose(
            getattr(table, name), getattr(pair.mesh, name), rtol=1e-9, atol=1e-18
        )
    alone, joined = pair.summary(), machine.summary()
    assert joined["meshes.m.static_mesh_force"] == pytest.approx(
        alone["static_mesh_force"], rel=1e-9
    )
    # Their motions have other steps.
    for name in ("mean_mesh_force", "peak_mesh_force", "minimum_mesh_force"):
        assert joined[f"meshes.m.{name}"] == pytest.approx(
            alone[name], abs=3e-3 * alone["mean_mesh_force"]
        )


def with_idle_shaft(tables: Tables) -> Tables:
    """The same with a shaft whose gear meshes with one of the middle shaft and carries nothing."""
    change, mesh = copy.deepcopy(tables), tables["meshes"]["second"]
    change["shafts"]["idle"] = {"sections": [["120 mm", "25 mm"]]}
    for end, place in (("left", 10), ("right", 110)):
        change["bearings"][f"idle_{end}"] = {
            "shaft": "idle", "position": f"{place} mm", "radial_stiffness": "200 N/um",
            "axial_stiffness": "100 N/um",
        }  # fmt: skip
    teeth = tables["gears"]["c"]["teeth"] + 3
    place = {"shaft": "idle", "position": "60 mm", "face_width": "20 mm"}
    change["gears"]["e"] = {**place, "teeth": teeth}
    change["meshes"]["idle"] = {
        "gears": ["c", "e"], "normal_module": mesh["normal_module"], "angle": "130 deg",
        "stiffness": "2e8 N/m",
    }  # fmt: skip
    return change


def at_rest(case: Any) -> tuple[Tables, Any]:
    """Figures of all parts at rest, and the tooth contact."""
    rest = balanced_machine(case, case.operating_point)
    static, values = rest.static, {}
    for name, mesh in static.meshes.items():
        values[f"meshes.{name}"] = [mesh.force, mesh.compression, mesh.misalignment]
    values |= {f"bearings.{n}": [*b.load, *b.displacement] for n, b in static.bearings.items()}
    values |= {f"gears.{n}": moved for n, moved in static.gears.items()}
    return values, rest.tables


def assert_same_at_rest(first: Any, second: Any) -> None:
    """Statics of the parts of the first case, which the second has too."""
    (values, tables), (others, other_tables) = at_rest(first), at_rest(second)
    for name, each in values.items():
        if name in others:
            np.testing.assert_allclose(
                others[name], each, rtol=1e-9, atol=1e-9 * np.abs(each).max()
            )
    for name, table in tables.items():
        for column in ("stiffness", "friction_coefficient", "load_share", "hertz_pressure"):
            value = getattr(table, column)
            np.testing.assert_allclose(
                getattr(other_tables[name], column), value, rtol=1e-9, atol=1e-12
            )


@pytest.mark.parametrize("seed", range(4))
def test_a_shaft_that_carries_nothing_changes_nothing_at_rest(seed: int) -> None:
    tables = drawn(seed)
    assert_same_at_rest(MachineCase(**tables), MachineCase(**with_idle_shaft(tables)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "change", "close"),
    [
        *((5, change, 2e-3) for change in (0.0, 1e-12, 1e-8, 1e-2)),
        *((0, 1e-9, 1e-2), (1, 1e-6, 2e-3), (2, 0.0, 2e-3)),
    ],
)
def test_a_shaft_that_carries_nothing_changes_the_motion_by_its_modes_alone(
    seed: int, change: float, close: float
) -> None:
    """Means are those of the torques; modal damping, and so peaks, know the idle shaft a little."""
    tables = drawn(seed)
    speed = float(tables["operation"]["speed"].removesuffix(" rpm")) * (1.0 + change)
    tables["operation"]["speed"] = f"{speed!r} rpm"
    alone, joined = (figures(each) for each in (tables, with_idle_shaft(tables)))
    assert joined["meshes.idle.contact_loss_share"] == pytest.approx(1.0, abs=1e-12)
    assert joined["meshes.idle.mean_mesh_force"] == joined["meshes.idle.peak_mesh_force"] == 0.0
    for mesh in ("first", "second"):
        key = f"meshes.{mesh}."
        static = alone[f"{key}static_mesh_force"]
        assert joined[f"{key}static_mesh_force"] == pytest.approx(static, rel=1e-9)
        mean = alone[f"{key}mean_mesh_force"]
        assert joined[f"{key}mean_mesh_force"] == pytest.approx(mean, rel=1e-4)
        for name in ("peak_mesh_force", "minimum_mesh_force", "alternating_rms_mesh_force"):
            assert joined[key + name] == pytest.approx(alone[key + name], abs=close * mean), name


def in_a_machine(stage: Any) -> MachineCase:
    """A stage by itself with a pair of gears behind its carrier, of the same mesh frequency."""
    kept = {k: copy.deepcopy(v) for k, v in stage.data.items() if k not in ("based_on", "assumed")}
    stiff = {"radial_stiffness": "1e9 N/m", "tilting_stiffness": "1e7 N*m/rad"}
    del kept["planets"]["low"]["carrier_support"]  # the carrier has a bearing there
    kept["gears"] |= {
        "x": {"shaft": "carrier", "teeth": 61, "face_width": "40 mm"},
        "y": {"shaft": "out", "teeth": 83, "face_width": "40 mm"},
    }
    kept["meshes"] = {
        "last": {"gears": ["x", "y"], "normal_module": "5 mm", "stiffness": "5e8 N/m"}
    }
    kept["bearings"] = {
        name: {"shaft": name, "position": "0 mm", "axial_stiffness": "1e9 N/m", **stiff}
        for name in ("carrier", "out")
    }
    kept["operation"] = {**kept["operation"], "output": "out"}
    return MachineCase(**kept)


def test_a_stage_in_a_machine_is_that_stage() -> None:
    """At rest; in motion its carrier turns in space where the stage alone turns with it."""
    stage = td.load_case("planetary-stage").replace(
        {"load_cases": None, "stiffness.model": "iso6336"}
    )
    machine = in_a_machine(stage)
    (values, tables), (others, other_tables) = at_rest(stage), at_rest(machine)
    for name in stage.meshes:
        assert others[f"meshes.{name}"][0] == pytest.approx(values[f"meshes.{name}"][0], rel=1e-9)
        for column in ("stiffness", "friction_coefficient", "load_share", "central_film"):
            np.testing.assert_allclose(
                getattr(other_tables[name], column),
                getattr(tables[name], column), rtol=1e-9, atol=1e-18,
            )  # fmt: skip
    alone, joined = (td.run(case).operation for case in (stage, machine))
    for name in stage.meshes:
        mean = joined.figures[f"meshes.{name}.mean_mesh_force"]
        assert mean == pytest.approx(alone.figures[f"meshes.{name}.mean_mesh_force"], rel=5e-3)
    assert joined.stage("low").shares.load_factor == pytest.approx(1.0, abs=1e-9)
