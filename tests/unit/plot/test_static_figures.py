"""Figures of the mesh at rest: their curves are the numbers of the result, in display units."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from known_figures import curve, marks
from tribodyn.errors import InputError
from tribodyn.gear import FlankModification, SpurPair, spur_pair
from tribodyn.plot import FIGURES, Drawing, flank_modification
from tribodyn.plot.mesh.loaded_contact import pair_letters, roll_angle_of
from tribodyn.plot.mesh.table import life_with_corners


@pytest.fixture(scope="module")
def result(drawable: Any) -> Any:
    return drawable()


def pair_with(driver: str = "pinion", **modifications: Any) -> SpurPair:
    return spur_pair(
        pinion_teeth=20,
        wheel_teeth=30,
        normal_module=4e-3,
        normal_pressure_angle=math.radians(20.0),
        pinion_face_width=20e-3,
        driver=driver,
        **modifications,
    )


def test_static_transmission_error_is_force_over_stiffness(result: Any) -> None:
    figure = FIGURES["static_transmission_error"](result)
    error = curve(figure, "under load")
    alone = 1e6 * result.mesh.total_normal_force / 2e8
    assert max(error.y) == pytest.approx(alone, rel=1e-12)
    assert min(error.y) == pytest.approx(0.5 * alone, rel=1e-12)
    assert max(error.x) == 2.0
    mean = curve(figure, "mean").y[0]
    share = result.mesh.transverse_contact_ratio - 1.0
    assert mean == pytest.approx(alone * (1.0 - 0.5 * share), rel=1e-9)


def test_bars_are_the_harmonics_of_a_square_wave(result: Any) -> None:
    bars = curve(FIGURES["static_transmission_error"](result), "amplitude", "y2")
    share = result.mesh.transverse_contact_ratio - 1.0
    step = 0.5e6 * result.mesh.total_normal_force / 2e8
    orders = np.arange(1, 9)
    expected = 2.0 * step * np.abs(np.sin(np.pi * orders * share)) / (np.pi * orders)
    assert list(bars.x) == orders.tolist()
    # knots in finite number: the phase factor is interpolated between them
    assert bars.y == pytest.approx(expected, abs=0.02 * step)


def test_load_share_of_two_equal_springs(result: Any) -> None:
    figure = FIGURES["load_sharing"](result)
    share = curve(figure, "load share")
    place = marks(figure)
    x, y = np.asarray(share.x), np.asarray(share.y)
    assert y[(x > place["A"] + 1e-8) & (x < place["B"] - 1e-8)] == pytest.approx(0.5)
    assert y[(x > place["B"] + 1e-8) & (x < place["D"] - 1e-8)] == pytest.approx(1.0)
    assert share.customdata.max() == pytest.approx(result.mesh.total_normal_force)
    assert "100 %" in figure.layout.title.text


def test_tip_corners_extend_the_life_of_a_pair(result: Any) -> None:
    mesh, corner = result.mesh, np.zeros((result.mesh.phase.size, 2))
    ratio = mesh.transverse_contact_ratio
    corner[mesh.phase > 0.95, 0] = 0.1
    corner[(mesh.phase > ratio - 1.0) & (mesh.phase < ratio - 0.9), 1] = 0.2
    changed = replace(mesh, corner_share=corner)
    age, share = life_with_corners(changed)
    assert np.all(np.diff(age) >= 0.0)
    assert -0.05 < age[0] < -0.03
    assert ratio + 0.08 < age[-1] < ratio + 0.1
    assert np.all(share[age < 0.0] == 0.1)
    assert np.all(share[age > ratio + 1e-9] == 0.2)
    figure = FIGURES["load_sharing"](changed)
    grey = [shape for shape in figure.layout.shapes if shape.type == "rect"]
    assert grey[0].x1 == pytest.approx(marks(figure)["A"])
    assert grey[1].x0 == pytest.approx(marks(figure)["E"])
    draw = FIGURES["load_sharing"]
    assert isinstance(draw, Drawing)
    assert "tip corner" in draw.caption_of(changed)
    assert "tip corner" not in draw.caption_of(result)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_letters_stand_at_the_roll_angles_of_the_driving_gear(driver: str) -> None:
    pair = pair_with(driver)
    places = dict(pair_letters(pair))
    assert sorted(places, key=places.__getitem__) == ["A", "B", "C", "D", "E"]
    tip = pair.driving.roll_angle(pair.driving.tip_radius)
    assert places["E"] == pytest.approx(tip, rel=1e-12)
    assert roll_angle_of(pair, 0.0) == pytest.approx(places["A"])
    assert places["D"] - places["A"] == pytest.approx(2.0 * math.pi / pair.driving.teeth)


def test_stiffness_over_the_roll_angle(result: Any) -> None:
    figure = FIGURES["static_stiffness"](result)
    secant = curve(figure, "all pairs, secant")
    place = marks(figure)
    x, y = np.asarray(secant.x), np.asarray(secant.y)
    assert y[(x > place["B"] + 1e-8) & (x < place["D"] - 1e-8)] == pytest.approx(200.0)
    assert y[(x > place["D"] + 1e-8) & (x < place["E"] - 1e-8)] == pytest.approx(400.0)
    pair = curve(figure, "one tooth pair")
    assert (min(pair.x), max(pair.x)) == pytest.approx((place["A"], place["E"]))
    assert max(pair.y) == pytest.approx(200.0)


def test_force_law_goes_through_the_working_load(result: Any) -> None:
    figure = FIGURES["force_law"](result)
    load = result.mesh.total_normal_force
    marked = curve(figure, "deflection under it")
    assert marked.y == pytest.approx(np.full(len(marked.x), load))
    alone = 1e6 * load / 2e8
    assert sorted(marked.x) == pytest.approx([0.5 * alone, 0.5 * alone, alone, alone], rel=1e-6)
    single = next(trace for trace in figure.data if trace.name.endswith("1 pair"))
    assert np.interp(0.5 * alone, single.x, single.y) == pytest.approx(0.5 * load, rel=1e-3)
    assert np.interp(-0.05 * alone, single.x, single.y) == 0.0


def test_a_message_replaces_the_figure_of_perfect_flanks(result: Any) -> None:
    with pytest.raises(InputError, match="perfect involutes"):
        FIGURES["flank_modification"](result)


@pytest.mark.parametrize(("driver", "end"), [("pinion", -1), ("wheel", 0)])
def test_tip_relief_of_the_pinion_lies_where_its_tip_touches(driver: str, end: int) -> None:
    pair = pair_with(driver, pinion_modification=FlankModification(tip_relief=12e-6))
    figure = flank_modification(pair)
    pinion, wheel, combined = (curve(figure, name) for name in ("pinion", "wheel", "both"))
    assert pinion.y[end] == pytest.approx(12.0)
    assert pinion.y[-1 - end] == pytest.approx(0.0)
    assert np.all(np.asarray(wheel.y) == 0.0)
    assert combined.y == pytest.approx(np.asarray(pinion.y))
    assert "12.0 µm" in figure.layout.title.text
    assert {trace.yaxis for trace in figure.data} == {"y"}


def test_lead_pitch_and_run_out_have_panels_of_their_own() -> None:
    pitch = (5e-6,) + (0.0,) * 19
    pair = pair_with(
        pinion_modification=FlankModification(cumulative_pitch_deviation=pitch, run_out=8e-6),
        wheel_modification=FlankModification(crowning=6e-6, tip_relief=10e-6),
        misalignment=4e-6,
    )
    figure = flank_modification(pair)
    assert curve(figure, "wheel", "y2").y[[0, 100, 200]] == pytest.approx([6.0, 0.0, 6.0])
    # half of the misalignment at each end of the face
    assert curve(figure, "both", "y2").y[[0, 100, 200]] == pytest.approx([4.0, 0.0, 8.0])
    assert curve(figure, "both", "y2").x[[0, 200]] == pytest.approx([-10.0, 10.0])
    bars = curve(figure, "pinion", "y3")
    assert (len(bars.y), bars.y[0], max(bars.y[1:])) == (20, pytest.approx(5.0), 0.0)
    run_out = curve(figure, "pinion", "y4")
    assert (run_out.y[0], max(run_out.y)) == pytest.approx((-4.0, 4.0))
    assert max(run_out.x) == pytest.approx(360.0)


def test_titles_without_a_gap_name_the_modification() -> None:
    pitch = FlankModification(cumulative_pitch_deviation=(5e-6,) + (0.0,) * 19)
    figure = flank_modification(pair_with(pinion_modification=pitch))
    assert "5.00 µm" in figure.layout.title.text
    run_out = FlankModification(run_out=8e-6)
    figure = flank_modification(pair_with(wheel_modification=run_out))
    assert figure.layout.title.text == "Run-out of the toothing of 8.00 µm"
