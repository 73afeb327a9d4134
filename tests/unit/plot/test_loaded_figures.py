"""Figures of the loaded tooth contact and of its studies."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import plotly.graph_objects as go
import pytest

from known_figures import marks
from tribodyn.errors import InputError
from tribodyn.gear import FlankModification, cylindrical_pair, spur_pair
from tribodyn.plot import FIGURES, Drawing
from tribodyn.plot.gear.gear_pair import bent_mesh, loads_at, on_line_of_action
from tribodyn.plot.mesh.loaded_contact import Life, roll_angle_of, span
from tribodyn.stiffness import loaded_contact, optimize_tip_relief

STUDIES = ("loaded_contact", "loaded_sharing", "mesh_deformation", "harris_map", "tip_relief_map")


def loaded(torque: Any, driver: str = "pinion", phases: Any = 32, **more: Any) -> Any:
    pair = spur_pair(
        pinion_teeth=16,
        wheel_teeth=24,
        normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0),
        center_distance=91.5e-3,
        pinion_profile_shift_coefficient=0.8635,
        wheel_profile_shift_coefficient=-0.5103,
        pinion_face_width=20e-3,
        pinion_bore_diameter=30e-3,
        wheel_bore_diameter=30e-3,
        driver=driver,
        **more,
    )
    return loaded_contact(pair, torque, provider="analytic", phases=phases)


@pytest.fixture(scope="module")
def contact() -> Any:
    return loaded([90.0, 200.0])


def on_axis(figure: go.Figure, axis: str) -> list[Any]:
    return [trace for trace in figure.data if (trace.yaxis or "y") == axis]


def test_curves_are_the_numbers_in_display_units(contact: Any) -> None:
    figure = contact.plot()
    light, heavy = on_axis(figure, "y")
    assert (light.name, heavy.name) == ("90 N·m", "200 N·m")
    angle = float(roll_angle_of(contact.gear_pair, contact.phase[10]))
    for trace, row in ((light, 0), (heavy, 1)):
        expected = 1e6 * contact.transmission_error[row, 10]
        assert np.interp(angle, trace.x, trace.y) == pytest.approx(expected, rel=1e-9)
    secant = on_axis(figure, "y2")[0]
    assert max(secant.y) == pytest.approx(1e-6 * contact.mesh_stiffness_secant[0].max())
    tangent = on_axis(figure, "y2")[2]
    assert (tangent.name, tangent.line.dash) == ("tangent", "dash")
    assert max(tangent.y) == pytest.approx(1e-6 * contact.mesh_stiffness_tangent[0].max())
    share = on_axis(figure, "y3")[1]
    assert max(share.y) == pytest.approx(1.0)


def test_title_names_the_swing(contact: Any) -> None:
    low, high = 1e6 * contact.peak_to_peak_transmission_error
    title = contact.plot().layout.title.text
    assert f"{low:.2f} µm to {high:.1f} µm" in title
    single = loaded(90.0)
    assert f"varies by {low:.2f} µm" in single.plot().layout.title.text
    assert not any(trace.showlegend for trace in on_axis(single.plot(), "y"))


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_a_pair_follows_from_before_a_to_after_e(driver: str) -> None:
    contact = loaded(200.0, driver)
    life = Life.of(contact, contact.load_share)
    first, last = span(contact)
    ratio = contact.gear_pair.transverse_contact_ratio
    assert first < -0.05 < ratio + 0.05 < last
    # pairs one base pitch apart carry everything together
    ages = np.linspace(0.0, 1.0, 9)
    total = sum(np.interp(ages + k, life.age, life.mean[0]) for k in range(-1, 3))
    assert total == pytest.approx(1.0, abs=0.02)
    figure = contact.plot_load_sharing()
    (force,) = on_axis(figure, "y")
    place = marks(figure)
    assert min(force.x) < place["A"] < place["D"] < place["E"] < max(force.x)
    assert place["E"] - place["A"] == pytest.approx(
        ratio * 2.0 * math.pi / contact.gear_pair.driving.teeth
    )
    assert max(force.y) == pytest.approx(float(contact.total_normal_force))
    assert [shape.type for shape in figure.layout.shapes].count("rect") == 2


def test_teeth_that_differ_are_drawn_over_all_mesh_cycles() -> None:
    late = FlankModification(cumulative_pitch_deviation=(5e-6,) + (0.0,) * 15)
    contact = loaded([90.0], phases=16, pinion_modification=late)
    figure = contact.plot()
    assert tuple(figure.layout.xaxis.range) == (0.0, 48)
    error = on_axis(figure, "y")[0]
    assert error.x[-1] == pytest.approx(48.0)
    assert error.y[-1] == error.y[0] == pytest.approx(1e6 * contact.transmission_error[0, 0])
    band, mean = on_axis(contact.plot_load_sharing(), "y")
    assert band.fill == "toself"
    assert max(band.y) >= max(mean.y)
    life = Life.of(contact, contact.normal_force)
    assert np.all(life.least <= life.mean + 1e-6)
    assert np.all(life.mean <= life.greatest + 1e-6)
    assert np.max(life.greatest - life.least) > 100.0


def in_a_ring(torque: float, driver: str) -> Any:
    pair = cylindrical_pair(
        pinion_teeth=21,
        wheel_teeth=-72,
        normal_module=2e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=0.0,
        pinion_profile_shift_coefficient=0.2,
        wheel_profile_shift_coefficient=-0.1,
        wheel_tip_diameter=141e-3,
        pinion_face_width=25e-3,
        pinion_bore_diameter=20e-3,
        driver=driver,
    )
    return loaded_contact(pair, torque, provider="fe2d", phases=32)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("load", [loaded, in_a_ring])
def test_bent_teeth_touch_where_the_loads_are(driver: str, load: Any) -> None:
    contact = load(200.0 if load == loaded else 60.0, driver)
    pair, phase = contact.gear_pair, 4
    module, axis = pair.pinion.normal_module, pair.wheel.sign * pair.center_distance
    mesh = bent_mesh(contact, phase)
    loads = loads_at(contact, phase)
    assert len(loads) == 2
    assert sum(load.force for load in loads) == pytest.approx(float(contact.total_normal_force))
    for place, load in zip(mesh.contact, loads, strict=True):
        x, y = on_line_of_action(pair, load.path)
        assert abs(place - complex(x, y)) < 2e-6
        for name in ("pinion", "wheel"):
            assert np.abs(mesh.outline[name] - place).min() < 0.03 * module
    # the driven gear deflects in the direction in which it is driven
    sense = 1.0 if driver == "pinion" else -1.0
    normal = sense * complex(*np.diff(on_line_of_action(pair, np.array([0.0, 1.0])))[:, 0])
    along = (mesh.shift * normal.conjugate()).real
    assert np.all(along > 1e-6)
    error = float(contact.transmission_error[phase])
    assert np.all(along < error)
    # far from the mesh the driving gear only turns, by about the transmission error
    turned = mesh.displacement[driver][[0, -1]]
    radius = np.abs(mesh.outline[driver][[0, -1]] - (0.0 if driver == "pinion" else axis))
    assert np.abs(turned) / radius * pair.driving.base_radius == pytest.approx(error, rel=0.4)


def test_deformation_is_plotted_with_its_factor_and_its_loads(contact: Any) -> None:
    figure = FIGURES["mesh_deformation"]
    assert isinstance(figure, Drawing)
    drawing = figure(contact, phase=0.125, torque=0)
    assert "90 N·m" in drawing.layout.title.text
    assert len(drawing.frames) == 0
    factor = float(drawing.layout.title.text.split("magnified ")[1].split()[0])
    bent = next(trace for trace in drawing.data if trace.name == "wheel, loaded")
    undeformed = [trace for trace in drawing.data if trace.name == "without load"][1]
    moved = np.hypot(
        bent.x[: len(undeformed.x)] - undeformed.x, bent.y[: len(undeformed.x)] - undeformed.y
    )
    mesh = bent_mesh(contact, 4, 0)
    assert moved.max() == pytest.approx(
        1e3 * factor * np.abs(mesh.displacement["wheel"]).max(), rel=1e-3
    )
    values = next(trace for trace in drawing.data if trace.name == "values")
    printed = [float(text.strip("<b>/").split()[0]) for text in values.text]
    assert printed == pytest.approx([load.force for load in loads_at(contact, 4, 0)], rel=1e-3)
    assert (drawing.layout.yaxis.scaleanchor, drawing.layout.hovermode) == ("x", False)


def test_slider_runs_over_a_mesh_cycle() -> None:
    contact = loaded(90.0, phases=np.array([0.0, 0.33, 0.67]))
    drawing = FIGURES["mesh_deformation"](contact)
    steps = drawing.layout.sliders[0].steps
    assert len(drawing.frames) == len(steps) == 3
    assert [step.label.split(":")[0] for step in steps] == [
        "Mesh phase 0",
        "Mesh phase 0.33",
        "Mesh phase 0.67",
    ]
    # the same number of traces in each frame, whatever the number of pairs
    assert {len(frame.data) for frame in drawing.frames} == {len(drawing.data)}
    assert len(drawing.to_json()) < 1.5e6


@pytest.mark.parametrize("name", [*STUDIES, "comprehensive_stiffness"])
def test_a_figure_of_a_study_names_its_call(drawable: Any, name: str) -> None:
    with pytest.raises(InputError, match=r"Call tribodyn\."):
        FIGURES[name](drawable())


class HarrisMap(SimpleNamespace):
    """Stand-in of that name."""

    def curves(self):
        return self.phase, self.transmission_error


class TipReliefOptimum(SimpleNamespace):
    """Stand-in of that name."""


class ComprehensiveStiffness(SimpleNamespace):
    """Stand-in of that name."""


def study(kind: type[Any], **more: Any) -> Any:
    contact = loaded([50.0, 100.0, 150.0])
    return kind(gear_pair=contact.gear_pair, torque=contact.torque, **more)


def test_harris_map_shows_each_torque_and_the_quietest() -> None:
    phase = np.arange(4) / 4.0
    swing = np.array([3e-6, 1e-6, 2e-6])
    error = 10e-6 + swing[:, None] * np.array([0.0, 1.0, 0.0, 0.0])
    figure = FIGURES["harris_map"](
        study(
            HarrisMap,
            phase=phase,
            mesh_cycles=1,
            transmission_error=error,
            unloaded_transmission_error=np.zeros(4),
            harmonics=swing[:, None] * np.array([0.5, 0.25]),
            peak_to_peak_transmission_error=swing,
            quietest_torque=100.0,
        )
    )
    assert [trace.name for trace in on_axis(figure, "y")] == ["150 N·m", "100 N·m", "50 N·m"]
    assert on_axis(figure, "y")[0].y == pytest.approx([10, 12, 10, 10] * 2 + [10])
    peak, first, second = on_axis(figure, "y2")
    assert (peak.x, peak.y) == (pytest.approx([50, 100, 150]), pytest.approx([3, 1, 2]))
    assert (first.name, second.name) == ("harmonic 1", "harmonic 2")
    assert second.y == pytest.approx([0.75, 0.25, 0.5])
    assert marks(figure)["least"] == 100.0
    assert "1.00 µm" in figure.layout.title.text
    assert "100 N·m" in figure.layout.title.text


def relief(**more: Any) -> Any:
    amount, length = np.array([0.0, 5e-6, 10e-6]), np.array([1e-3, 2e-3])
    flat = np.full((3, 4), 10e-6)
    fields = {
        "phase": np.arange(4) / 4.0,
        "map_amount": amount,
        "map_length": length,
        "map_objective": amount[:, None] + 1e-3 * length,
        "amount": 5e-6,
        "length": 1.5e-3,
        "objective": 2e-6,
        "objective_before": 6e-6,
        "objective_kind": "largest",
        "shape": "linear",
        "on_edge": False,
        "peak_to_peak_before": np.array([4e-6, 5e-6, 6e-6]),
        "peak_to_peak_after": np.array([2e-6, 1e-6, 2e-6]),
        "transmission_error_before": flat,
        "transmission_error_after": 2.0 * flat,
    }
    return study(TipReliefOptimum, **{**fields, **more})


def test_tip_relief_map_has_amount_across_and_length_upwards() -> None:
    figure = FIGURES["tip_relief_map"](relief())
    surface, star = on_axis(figure, "y")
    assert np.shape(surface.z) == (2, 3)
    assert surface.z[1][2] == pytest.approx(10.0 + 2.0)
    assert surface.z[0][1] == pytest.approx(5.0 + 1.0)
    assert (star.x[0], star.y[0]) == pytest.approx((5.0, 1.5))
    before, after = on_axis(figure, "y2")
    assert before.y == pytest.approx([4, 5, 6])
    assert after.y == pytest.approx([2, 1, 2])
    courses = on_axis(figure, "y3")
    assert [trace.name for trace in courses] == [
        "50 N·m, without relief",
        "50 N·m, with the best relief",
        "150 N·m, without relief",
        "150 N·m, with the best relief",
    ]
    assert courses[1].y[0] == pytest.approx(20.0)
    assert "6.00 µm to 2.00 µm" in figure.layout.title.text


def test_a_relief_without_effect_is_not_said_to_lower_the_variation() -> None:
    title = FIGURES["tip_relief_map"](relief(objective=6e-6)).layout.title.text
    assert title.endswith("does not lower the variation of 6.00 µm")


def test_an_optimum_at_the_edge_is_reported() -> None:
    figure = FIGURES["tip_relief_map"]
    assert isinstance(figure, Drawing)
    assert "widen the range" in figure.caption_of(relief(on_edge=True))
    assert "widen the range" not in figure.caption_of(relief())


@pytest.mark.parametrize(
    ("torques", "speeds", "names"),
    [
        ((50.0, 100.0), (100.0,), ["50 N·m", "100 N·m"]),
        ((50.0,), (100.0, 200.0), ["955 rpm", "1910 rpm"]),
        ((50.0, 100.0), (100.0, 200.0), ["50 N·m, 955 rpm", "50 N·m, 1910 rpm"]),
    ],
)
def test_film_and_teeth_have_a_curve_for_each_point(
    torques: tuple[float, ...], speeds: tuple[float, ...], names: list[str]
) -> None:
    shape = (len(torques), len(speeds), 3)
    size = np.arange(np.prod(shape), dtype=float).reshape(shape)
    figure = FIGURES["comprehensive_stiffness"](
        ComprehensiveStiffness(
            gear_pair=loaded(90.0).gear_pair,
            kind="tangent",
            pinion_torque=np.array(torques),
            pinion_speed=np.array(speeds),
            roll_angle=np.array([0.3, 0.5, 0.8]),
            film_stiffness=1e9 + 1e6 * size,
            tooth_stiffness=2e8 + 1e6 * size,
            pair_stiffness=1.7e8 + 1e6 * size,
            film_mesh_stiffness=None,
            face_position=None,
            path=np.array([0.01, 0.015, 0.02]),
            mean_mesh_stiffness=np.full(shape[:2], 2e8),
            mean_tooth_stiffness=np.full(shape[:2], 3e8),
        )
    )
    film = on_axis(figure, "y")
    assert [trace.name for trace in film][: len(names)] == names
    assert film[0].y == pytest.approx([1000.0, 1001.0, 1002.0])
    assert on_axis(figure, "y3")[-1].y[-1] == pytest.approx(170.0 + size.max())
    looks = {(trace.line.color, trace.line.dash) for trace in film}
    assert len(looks) == len(film)
    assert "from 300 N/µm to 200 N/µm" in figure.layout.title.text


def test_many_torques_stay_readable() -> None:
    figure = loaded(np.linspace(20.0, 300.0, 12)).plot()
    errors, stiffness = on_axis(figure, "y"), on_axis(figure, "y2")
    assert len(errors) == 12
    assert sum(bool(trace.showlegend) for trace in errors) == 8
    assert len(stiffness) == 2 * 4
    assert [trace.name for trace in stiffness if trace.showlegend] == ["secant", "tangent"]
    assert len({trace.line.color for trace in errors}) == 12


def test_without_tip_corners_the_load_begins_and_ends_at_once() -> None:
    pair = loaded(90.0).gear_pair
    contact = loaded_contact(pair, 90.0, provider="iso6336", phases=32)
    life = Life.of(contact, contact.load_share)
    assert (life.age[0], life.mean[0, 0]) == (0.0, 0.0)
    assert life.mean[0, 1] > 0.1
    figure = contact.plot_load_sharing()
    assert not [shape for shape in figure.layout.shapes if shape.type == "rect"]


def test_the_phase_of_a_hunting_pair_counts_all_mesh_cycles() -> None:
    late = FlankModification(cumulative_pitch_deviation=(0.0, 9e-6) + (0.0,) * 14)
    contact = loaded(90.0, phases=16, pinion_modification=late)
    draw = FIGURES["mesh_deformation"]
    assert isinstance(draw, Drawing)
    texts = [
        next(trace for trace in draw(contact, phase=phase).data if trace.name == "values").text
        for phase in (0.25, 1.25)
    ]
    assert texts[0] != texts[1]


@pytest.mark.parametrize(("relief", "name"), [(18e-6, "before"), (0.0, "without relief")])
def test_the_pair_before_a_search_has_the_right_label(relief: float, name: str) -> None:
    """One that has a relief already is not a pair without."""
    pair = loaded(90.0).gear_pair
    wheel = FlankModification(tip_relief=relief)
    pair = replace(pair, wheel=replace(pair.wheel, modification=wheel))
    study = optimize_tip_relief(pair, 90.0, provider="analytic", phases=8, grid=(2, 2))
    names = [trace.name for trace in study.plot().data]
    assert names[2:] == [
        name,
        "with the best relief",
        f"90 N·m, {name}",
        "90 N·m, with the best relief",
    ]
