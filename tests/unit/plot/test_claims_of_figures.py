"""Titles of figures say what the curves that they draw say, computed anew from the curves."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tribodyn import plot
from tribodyn.losses.gearbox import PARTS
from tribodyn.plot.machine.levels import _title, levels_text
from tribodyn.plot.motion.spectra import _strongest
from tribodyn.plot.motion.sweeps import _case_title
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import line
from tribodyn.study.machine.motion import MachineMotion
from tribodyn.study.planetary.stage_result import PlanetaryMotion

CLOCK = np.linspace(0.0, 1.0, 301)
WAVE = np.sin(2.0 * np.pi * 5.0 * CLOCK)


def machine(swings: tuple[float, ...], means: tuple[float, ...]) -> MachineMotion:
    """Motion of a machine whose mesh forces swing about their means."""
    force = np.array(means) + WAVE[:, None] * 0.5 * np.array(swings)
    count, nothing = len(means), np.zeros_like(force)
    weight = np.full(CLOCK.size, 1.0 / (CLOCK.size - 1))
    weight[[0, -1]] *= 0.5
    return MachineMotion(
        clock=CLOCK, weight=weight, mesh=("first", "second", "third")[:count], bearing=(), node=(),
        mesh_force=force, compression=nothing, transmission_error=nothing, open=nothing,
        bearing_force=np.zeros((CLOCK.size, 0, 6)), acceleration=np.zeros((CLOCK.size, 0, 3)),
        cycles=np.array([5, 7, 11][:count]), frequency=10.0,
    )  # fmt: skip


def panels(figure: Any) -> dict[str, dict[str, Any]]:
    """Curves of each vertical axis by name."""
    axes: dict[str, dict[str, Any]] = {}
    for trace in figure.data:
        if "lines" in (trace.mode or "") and trace.name:
            axes.setdefault(trace.yaxis or "y", {})[trace.name] = np.asarray(trace.y, dtype=float)
    return axes


@pytest.mark.parametrize(
    ("swings", "means"),
    [((90.0, 204.0), (900.0, 4000.0)), ((300.0, 204.0, 10.0), (9000.0, 100.0, -5.0))],
)
def test_mesh_that_varies_most_is_that_with_the_highest_curve(
    swings: tuple[float, ...], means: tuple[float, ...]
) -> None:
    figure = plot.machine_forces(machine(swings, means))
    names = ("first", "second", "third")[: len(swings)]
    order = sorted(range(len(swings)), key=lambda k: -swings[k])
    drawn = [trace.name for trace in figure.data]
    assert drawn == [names[k] for k in order]  # what varies most comes first
    most, title = drawn[0], figure.layout.title.text
    assert f"mesh {most} varies most" in title
    value, mean = map(float, re.findall(r"(-?[\d.]+) N", title))
    assert value == pytest.approx(np.ptp(figure.data[0].y), rel=5e-3)
    assert mean == pytest.approx(means[order[0]], rel=5e-3)
    axes = [getattr(figure.layout, f"yaxis{n + 1 if n else ''}") for n in range(len(swings))]
    for trace, k, axis in zip(figure.data, order, axes, strict=True):
        assert np.mean(trace.y[:-1]) == pytest.approx(0.0, abs=1e-9 * abs(means[k]))
        assert np.ptp(trace.y) == pytest.approx(swings[k], rel=5e-3)
        assert axis.range is None  # each to its own scale
    notes = [note.text for note in figure.layout.annotations]
    assert all(any(f"Mesh {name}:" in note for note in notes) for name in names)


def test_forces_that_only_round_do_not_vary() -> None:
    figure = plot.machine_forces(machine((3e-10, 1e-10), (900.0, 4000.0)))
    assert figure.layout.title.text == "No mesh force varies"
    flat = plot.machine_forces(machine((1e-10,), (900.0,))).layout.yaxis.range
    assert flat[1] - flat[0] > 1.0  # N: rounding is a straight line
    lines = plot.machine_orders(machine((1e-10,), (900.0,)))
    assert lines.layout.title.text == "Mesh forces: no line at a mesh harmonic"
    assert (
        "harmonic 1 of mesh first" in plot.machine_orders(machine((9.0,), (9.0,))).layout.title.text
    )


def stage(shift: float, orbit: float) -> PlanetaryMotion:
    """Motion of a stage whose sun stands aside by a shift and goes round an orbit."""
    base = machine((100.0, 80.0, 60.0), (500.0, 500.0, 500.0))
    moved = np.zeros((CLOCK.size, 3, 3))
    moved[:, :, 2] = 1e-5
    moved[:, 2, 0] = shift + orbit * WAVE
    return PlanetaryMotion(
        phase=base.clock, weight=base.weight, planet=np.arange(1.0, 4.0),
        member=("carrier", "ring", "sun"), axis=("x", "y", "u"),
        sun_mesh_force=base.mesh_force, ring_mesh_force=base.mesh_force,
        pin_force=np.zeros((CLOCK.size, 3, 2)), displacement=moved, mesh_frequency=10.0,
    )  # fmt: skip


def test_sun_has_its_displacement_and_no_orbit_of_rounding() -> None:
    figure = plot.planetary_forces(stage(3e-6, 1e-6))
    assert "3.00 µm" in figure.layout.yaxis3.title.text
    assert np.ptp(panels(figure)["y3"]["x"]) == pytest.approx(2.0, rel=1e-3)
    assert "at most" in figure.layout.title.text
    still = plot.planetary_forces(stage(0.0, 1e-20))
    assert "the sun does not move" in still.layout.title.text
    low, high = still.layout.yaxis3.range
    assert high - low > 0.01  # um


def test_curves_that_coincide_say_so() -> None:
    curves = [
        line(CLOCK, WAVE, "planet 1", "red", unit="N"),
        line(CLOCK, WAVE + 1e-4, "planet 2", "blue", unit="N"),
        line(CLOCK, 0.5 * WAVE, "planet 3", "green", unit="N"),
    ]
    (note,) = stack("title", "x", [Panel("y", curves)]).layout["annotations"]
    assert note["text"] == "planet 2 lies on planet 1"
    assert "annotations" not in stack("title", "x", [Panel("y", curves[::2])]).layout


def test_strongest_harmonic_is_that_of_all_directions() -> None:
    bars = [
        SimpleNamespace(traces=[{"x": [1.0, 2.0], "y": y, "customdata": [10.0, 20.0]}])
        for y in ([3.0, 1.0], [0.0, 7.0])
    ]
    assert _strongest(bars).startswith("2 (20")  # type: ignore[arg-type]


def test_largest_value_of_a_sweep_is_where_the_title_says() -> None:
    axis = SimpleNamespace(values=[1.0, 2.0, 3.0], show="{:g} N*m".format, numeric=True)
    points = [SimpleNamespace(failed="") for _ in range(3)]
    study: Any = SimpleNamespace(points=points, axes=[axis])
    title = _case_title(study, "peak_mesh_force", np.array([5.0, 9.0, 7.0]), "N")
    assert "is largest at 2" in title
    assert title.endswith(": 9 N")
    flat = _case_title(study, "peak_mesh_force", np.full(3, 9.0), "N")
    assert flat == "The peak mesh force does not vary: 9 N"


def test_largest_level_of_the_parts_is_where_the_title_says() -> None:
    values = np.array([[1.0, 4.0], [np.nan, 2.0], [7.0, 3.0]])
    title = _title([(("first", "second"), values)], ["10 rpm", "20 rpm", "30 rpm"])
    assert title == "Mesh first has the largest level at 30 rpm: 7.00 N"


def said(name: str, subject: Any) -> str:
    """Caption of a figure of a subject."""
    figure: Any = plot.FIGURES[name]
    return str(figure.caption if isinstance(figure.caption, str) else figure.caption(subject))


def test_captions_of_machines_name_the_parts_that_they_have() -> None:
    motion = machine((90.0, 204.0), (900.0, 4000.0))
    for name in ("machine_orders", "machine_forces"):
        assert "bearing" not in said(name, motion)
        assert "housing" not in said(name, motion)
    radial = np.zeros((CLOCK.size, 1, 6))
    held = replace(motion, bearing=("A",), bearing_force=radial)
    assert "bearings" in said("machine_orders", held)
    assert "radial force" in said("machine_forces", held)
    assert "mesh whose harmonic" not in said("machine_orders", machine((90.0,), (900.0,)))
    assert levels_text(("first",), ("first",), (), ()) == (
        "Levels without the mean: mesh forces (rms) and transmission errors (peak to peak)."
    )


def test_of_many_parts_those_that_vary_least_are_named_as_left_out() -> None:
    count = 11
    force = np.arange(1.0, count + 1.0) * WAVE[:, None]
    names = tuple(f"m{k}" for k in range(count))
    base = machine((1.0,), (0.0,))
    motion = replace(base, mesh=names, mesh_force=force, cycles=np.arange(1, count + 1))
    figure = plot.machine_forces(motion)
    drawn = [trace.name for trace in figure.data]
    assert drawn == [f"m{k}" for k in reversed(range(count - len(drawn), count))]
    left = f"Left out: {count - len(drawn)} of {count} meshes with smaller variations."
    assert left in said("machine_forces", motion)


def test_a_relief_that_lowers_nothing_is_not_said_to_lower() -> None:
    study = SimpleNamespace(
        face_position=np.linspace(-5e-3, 5e-3, 3), torque=np.array([50.0]),
        face_load_after=np.ones((1, 3)), face_load_before=np.ones((1, 3)), crowning=0.0,
        lead_slope=0.0, face_load_factor_before=np.array([1.2]),
        face_load_factor_after=np.array([1.2]),
    )  # fmt: skip
    title = plot.FIGURES["lead_optimum"].draw(study).layout["title"]["text"]
    assert title.endswith("do not lower the greatest face load factor of 1.2")
    study.face_load_factor_after = np.array([1.1])
    title = plot.FIGURES["lead_optimum"].draw(study).layout["title"]["text"]
    assert title.endswith("lower the greatest face load factor from 1.2 to 1.1")


def test_captions_of_responses_name_what_is_drawn() -> None:
    portrait = SimpleNamespace(gap=-1.0)
    assert "backlash" not in said("phase_portrait", portrait)
    assert "backlash" in said("phase_portrait", SimpleNamespace(gap=1e-4))
    fixed = SimpleNamespace(free_rotation=np.array([False, False]))
    assert "Free rotation" not in said("lyapunov", fixed)
    branch = SimpleNamespace(stable=np.array([True, True]), special=lambda kind: [])
    assert "Dashed" not in said("continuation", branch)
    assert "turns back" not in said("continuation", branch)
    sweep = SimpleNamespace(branches=("up",), verdicts=dict)
    assert "coexist" not in said("bifurcation", sweep)
    assert "Grey" not in said("bifurcation", sweep)


def test_losses_of_one_point_or_of_teeth_alone_are_described_as_such() -> None:
    parts = dict.fromkeys(PARTS, np.zeros((2, 2)))
    teeth = SimpleNamespace(
        **{**parts, "gear": np.ones((2, 2))}, total=np.ones((2, 2)), pinion_speed=np.ones(2),
        pinion_torque=np.ones(2),
    )  # fmt: skip
    assert "Only the loss of the teeth" in said("losses", teeth)
    assert "seals" not in said("losses", teeth)
    assert "Above" not in said("losses", SimpleNamespace(total=np.ones((1, 1))))
