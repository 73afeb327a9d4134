"""Every figure: it draws, its axes carry units, its curves are the numbers of the result."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import plotly.graph_objects as go
import pytest

from known_figures import caption, curve
from tribodyn.drawing import Sketch
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES, Drawing
from tribodyn.study.pipeline import response_series

NAMES = (
    "gear_pair",
    "path_of_contact",
    "mesh_stiffness",
    "static_stiffness",
    "load_sharing",
    "static_transmission_error",
    "force_law",
    "friction",
    "film",
    "lubrication",
    "film_stiffness",
    "mesh_force",
    "friction_force",
    "transmission_error",
    "acceleration",
    "spectrum",
    "bearing_force",
    "bearing_spectrum",
    "mode_shapes",
)
#: Axes that are pure numbers.
UNITLESS = {
    "Mesh cycles",
    "Mesh harmonic",
    "Slide to roll ratio",
    "Friction coefficient",
    "Film ratio",
    "Load share of a pair",
    "Share of the load",
}


@pytest.fixture(scope="module")
def result(drawable: Any) -> Any:
    return drawable(film_model="dowson-higginson")


@pytest.fixture(scope="module")
def figures(result: Any) -> dict[str, go.Figure]:
    return {name: FIGURES[name](result) for name in NAMES}


def frictionless(result: Any) -> Any:
    """The same result without a friction coefficient."""
    result.mesh = replace(
        result.mesh, friction_coefficient=np.zeros_like(result.mesh.friction_coefficient)
    )
    return result


@pytest.mark.parametrize("name", list(FIGURES))
def test_a_figure_without_its_data_is_refused(result: Any, name: str) -> None:
    if name in NAMES:
        return
    with pytest.raises(InputError, match=r"\w"):
        FIGURES[name](result)


@pytest.mark.parametrize("name", NAMES)
def test_reports_need_no_plotly_to_write_the_same(
    result: Any, figures: dict[str, go.Figure], name: str
) -> None:
    figure = FIGURES[name]
    assert isinstance(figure, Drawing)
    sketch = figure.sketch(result)
    assert isinstance(sketch, Sketch)
    written = json.loads(sketch.to_json())
    # Plotly leaves out lists of no marks.
    written["layout"] = {key: each for key, each in written["layout"].items() if each != []}
    assert written == json.loads(figures[name].to_json())


@pytest.mark.parametrize("name", NAMES)
def test_every_axis_has_a_unit(figures: dict[str, go.Figure], name: str) -> None:
    layout = figures[name].layout
    labels = [layout[key].title.text for key in layout if key.startswith(("xaxis", "yaxis"))]
    labels = [label for label in labels if label]
    assert len(labels) >= 2
    for label in labels:
        assert label in UNITLESS or label.endswith("]")


@pytest.mark.parametrize("name", NAMES)
def test_every_figure_is_finite_and_has_its_result_in_the_title(
    figures: dict[str, go.Figure], name: str
) -> None:
    figure = figures[name]
    assert any(character.isdigit() for character in figure.layout.title.text)
    assert "nan" not in figure.layout.title.text
    for trace in figure.data:
        assert len(trace.x) == len(trace.y) > 1
        assert np.all(np.isfinite(np.asarray(trace.y, dtype=float)))


@pytest.mark.parametrize("name", NAMES)
def test_hover_text_has_the_unit(figures: dict[str, go.Figure], name: str) -> None:
    if name == "gear_pair":
        return
    for trace in figures[name].data:
        label = figures[name].layout[trace.yaxis.replace("y", "yaxis")].title.text
        unit = label[label.rindex("[") + 1 : -1] if "[" in label else ""
        assert f" {unit}".rstrip() in trace.hovertemplate


def test_mesh_force_is_that_of_the_response(figures: dict[str, go.Figure], result: Any) -> None:
    fine = result.response.fine
    force = curve(figures["mesh_force"], "dynamic")
    for cycle in range(2):
        at = np.interp(fine.phase + cycle, force.x, force.y)
        np.testing.assert_allclose(at[::3], fine.contact_force[::3, 0], rtol=1e-12)
    static = curve(figures["mesh_force"], "static")
    assert static.y[0] == pytest.approx(90.0 / result.case.gear_pair.pinion.base_radius)


def test_transmission_error_counts_from_first_contact(
    figures: dict[str, go.Figure], result: Any
) -> None:
    error = curve(figures["transmission_error"], "dynamic")
    deflection = result.response.fine.deflection[0, 0]
    assert error.y[0] == pytest.approx(1e6 * (deflection - result.half_backlash))


@pytest.mark.slow
def test_quasi_static_error_includes_the_gap_of_relieved_flanks(drawable: Any) -> None:
    relief = {
        f"gears.{gear}.modification.{key}": value
        for gear in ("pinion", "wheel")
        for key, value in (("tip_relief", "20 um"), ("tip_relief_length", "7 mm"))
    }
    result = drawable(changes=relief)
    mesh = result.mesh
    deflection = mesh.total_normal_force / mesh.mesh_stiffness
    error = np.asarray(curve(FIGURES["transmission_error"](result), "quasi-static").y, dtype=float)
    assert np.nanmax(error) == pytest.approx(1e6 * mesh.static_transmission_error.max(), rel=1e-6)
    # The rigid mesh already has an error of its own: force over stiffness alone is too little.
    assert mesh.static_transmission_error.max() > deflection.max() + 3e-6


def test_quasi_static_error_is_force_over_stiffness(
    figures: dict[str, go.Figure], result: Any
) -> None:
    # 2e8 N/m each: one pair alone bends twice as far as two together
    error = curve(figures["transmission_error"], "quasi-static")
    alone = 1e6 * result.mesh.total_normal_force / 2e8
    assert max(error.y) == pytest.approx(alone, rel=1e-12)
    assert min(error.y) == pytest.approx(0.5 * alone, rel=1e-12)


def test_bars_are_the_amplitudes(
    figures: dict[str, go.Figure], amplitudes: tuple[float, ...]
) -> None:
    bars = curve(figures["spectrum"], "transmission error")
    assert list(bars.x[:4]) == [1, 2, 3, 4]
    assert bars.y[:4] == pytest.approx(amplitudes, abs=1e-4)
    assert np.max(bars.y[4:12]) < 1e-3
    assert bars.customdata[1] == pytest.approx(2.0 * bars.customdata[0])
    # coordinates are scaled by powers of ten in the order of their names: pinion y is the second
    along = curve(figures["spectrum"], "pinion", "y2")
    assert along.y[:4] == pytest.approx([10.0 * size for size in amplitudes], abs=1e-3)


def test_bearing_force_is_spring_force(figures: dict[str, go.Figure], result: Any) -> None:
    across = curve(figures["bearing_force"], "wheel", "y2")
    position = result.response.fine.position[:, result.response.names.index("wheel_x")]
    assert across.y[0] == pytest.approx(1e9 * position[0], rel=1e-12)
    assert np.ptp(across.y) == pytest.approx(1e9 * np.ptp(position), rel=1e-2)


def test_friction_force_turns_round_at_the_pitch_point(figures: dict[str, go.Figure]) -> None:
    figure = figures["friction"]
    (pitch_point,) = (note.x for note in figure.layout.annotations if note.text == "C")
    force = curve(figure, "friction force", "y2")
    angle, values = np.asarray(force.x), np.asarray(force.y)
    assert np.all(values[angle < pitch_point - 1e-9] < 0.0)
    assert np.all(values[angle > pitch_point + 1e-9] > 0.0)


def test_mesh_table_alone_draws_its_own_figures(result: Any) -> None:
    assert len(result.mesh.plot_stiffness().data) == 4
    assert len(result.mesh.plot_friction().data) == 3


def test_equal_scales_in_the_drawing_of_the_gears(figures: dict[str, go.Figure]) -> None:
    layout = figures["gear_pair"].layout
    assert (layout.yaxis.scaleanchor, layout.yaxis2.scaleanchor) == ("x", "x2")


def test_drawing_shows_all_teeth(figures: dict[str, go.Figure], result: Any) -> None:
    pair = result.case.gear_pair
    for gear, center, name in (
        (pair.pinion, 0.0, "pinion, 16 teeth, drives"),
        (pair.wheel, pair.center_distance, "wheel, 24 teeth, is driven"),
    ):
        outline = next(trace for trace in figures["gear_pair"].data if trace.name == name)
        radius = np.hypot(np.asarray(outline.x) - 1e3 * center, outline.y) * 1e-3
        on_tip = np.abs(radius - gear.tip_radius) < 1e-9
        tips = np.sum(np.diff(np.append(on_tip, on_tip[0]).astype(int)) == 1)
        assert tips == gear.teeth
        assert radius.min() == pytest.approx(gear.root_radius, abs=1e-6)


def test_figures_without_meaning_say_why(drawable: Any) -> None:
    plain = drawable(names=("pinion_theta", "wheel_theta"))
    for name in ("acceleration", "bearing_force", "bearing_spectrum"):
        figure = FIGURES[name]
        assert isinstance(figure, Drawing)
        assert "centres" in figure.missing(plain)
        with pytest.raises(InputError, match="centres are fixed"):
            figure(plain)
    assert len(FIGURES["spectrum"](plain).data) == 1
    with pytest.raises(InputError) as refused:
        FIGURES["film"](plain)
    lack = 'No film model was chosen, so no oil film was computed. Choose film.model = "newton".'
    assert lack in str(refused.value)


def test_a_message_replaces_the_figure_without_friction(drawable: Any) -> None:
    smooth = frictionless(drawable())
    with pytest.raises(InputError, match=r"friction coefficient is zero.*friction\.law"):
        FIGURES["friction"](smooth)
    assert "friction" not in caption("transmission_error", smooth)
    assert "friction" not in caption("mesh_force", smooth)
    assert "without friction" in caption("transmission_error", drawable())
    rubbing = drawable()
    fine, static = rubbing.response.fine, rubbing.mesh.total_normal_force
    for factor, text in ((1.02, "2 % above the static force"), (0.97, "3 % below the static")):
        mean = float(fine.weight @ response_series.mesh_force(fine))
        fine.contact_force[:] *= factor * static / mean
        assert text in caption("mesh_force", rubbing)
        assert "friction carries a part" in caption("mesh_force", rubbing)
    fine.contact_force[:] /= 0.97
    assert "friction" not in caption("mesh_force", rubbing)  # which moves the mean by nothing


def test_a_transient_is_drawn_over_time(drawable: Any) -> None:
    transient = drawable(periods=60, steady=False)
    figure = FIGURES["mesh_force"](transient)
    force, fine = curve(figure, "dynamic"), transient.response.fine
    assert figure.layout.xaxis.title.text == "Time [ms]"
    assert max(force.x) == pytest.approx(1e3 * fine.time[-1])
    assert len(force.x) <= 4000 < len(fine.time)
    # the whole run at first, the last two of its 60 mesh cycles by a button
    full, zoom = figure.layout.updatemenus[0].buttons
    end = 1e3 * fine.time[-1]
    assert figure.layout.xaxis.range == pytest.approx((0.0, end))
    assert full.args[0]["xaxis.range"] == pytest.approx((0.0, end))
    assert zoom.args[0]["xaxis.range"] == pytest.approx((end * 58 / 60, end))
    # thinning keeps the peaks
    assert max(force.y) == fine.contact_force.max()
    assert min(force.y) == fine.contact_force.min()
    with pytest.raises(InputError, match="steady state"):
        FIGURES["spectrum"](transient)


@pytest.mark.parametrize("name", ["mesh_force", "transmission_error", "acceleration"])
def test_titles_of_a_transient_leave_its_first_half_out(drawable: Any, name: str) -> None:
    transient = drawable(periods=60, steady=False)
    title = FIGURES[name](transient).layout.title.text
    assert title.endswith("in the last 30 of 60 mesh cycles")
    fine = transient.response.fine
    for values in (fine.contact_force, fine.deflection, fine.acceleration):
        values[fine.phase < 29.0] *= 3.0
    assert FIGURES[name](transient).layout.title.text == title


def test_a_transient_reports_whether_it_has_settled(drawable: Any) -> None:
    transient = drawable(periods=60, steady=False)
    assert "has settled: " in caption("mesh_force", transient)
    assert caption("mesh_force", transient).endswith("changes by less than 0.01 %.")
    assert "dashed" not in caption("transmission_error", transient)
    force = transient.response.fine.contact_force
    mean = transient.mesh.total_normal_force
    last = transient.response.fine.phase >= 45.0
    force[last] = mean + 0.8 * (force[last] - mean)
    assert "has not settled: " in caption("mesh_force", transient)
    assert caption("mesh_force", transient).endswith("changes by 20 %.")
    assert "too short" in caption("mesh_force", drawable(periods=3, steady=False))
    assert "settled" not in caption("mesh_force", drawable())


def test_negative_force_is_explained(drawable: Any) -> None:
    result = drawable()
    assert "negative" not in caption("mesh_force", result)
    fine = result.response.fine
    fine.contact_force[5] = -1.0
    assert "contact damping pulls" in caption("mesh_force", result)
    fine.deflection[5] = -2e-6
    assert "back flanks touch" in caption("mesh_force", result)
    result.half_backlash = 0.0
    assert "no backlash" in caption("mesh_force", result)
    assert FIGURES["mesh_force"](result).layout.yaxis.rangemode == "tozero"


def test_captions_follow_the_pairs_under_load(drawable: Any) -> None:
    result = drawable()
    two = f"{100.0 * (result.mesh.contact_ratio_under_load - 1.0):.3g} %"
    for name in ("friction", "path_of_contact", "load_sharing", "mesh_stiffness"):
        assert f"two pairs carry during {two} of the mesh cycle" in caption(name, result)


def test_spectra_end_where_the_lines_vanish(figures: dict[str, go.Figure]) -> None:
    # the known motion has four harmonics
    assert tuple(figures["spectrum"].layout.xaxis.range) == (0.4, 4.6)
    menu = figures["spectrum"].layout.updatemenus[0]
    assert (menu.x, menu.xanchor) == (0.0, "left")


@pytest.mark.parametrize(("driver", "senses"), [("pinion", [1, -1]), ("wheel", [-1, 1])])
def test_arrows_turn_as_the_gears_do(drawable: Any, driver: str, senses: list[int]) -> None:
    figure = FIGURES["gear_pair"](drawable(driver))
    arcs = [trace for trace in figure.data if trace.name == "sense of rotation"]
    assert [int(np.sign(arc.x[0] - arc.x[-1])) for arc in arcs] == senses
    roles = [note.text for note in figure.layout.annotations if note.text.startswith("dri")]
    assert roles == (["drives", "driven"] if driver == "pinion" else ["driven", "drives"])


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_letters_do_not_overlap_in_either_picture(drawable: Any, driver: str) -> None:
    notes = FIGURES["gear_pair"](drawable(driver)).layout.annotations
    for axis in ("x", "x2"):
        letters = [note for note in notes if note.xref == axis and note.text in "ABCDE"]
        assert sorted(note.text for note in letters) == list("ABCDE")
        # both the points and their offsets on the screen rise, so the letters keep apart
        assert np.all(np.diff([note.y for note in letters]) > 0.0)
        assert np.all(np.diff([note.ay for note in letters]) <= -14)


def test_a_subharmonic_orbit_is_drawn_once_and_whole(drawable: Any) -> None:
    figure = FIGURES["mesh_force"](drawable(periods=3))
    assert tuple(figure.layout.xaxis.range) == (0, 3)
    assert max(curve(figure, "dynamic").x) == pytest.approx(3.0)
    error = FIGURES["transmission_error"](drawable(periods=3))
    assert max(curve(error, "quasi-static").x) == 3.0


def test_a_subharmonic_shows_between_the_mesh_harmonics(drawable: Any) -> None:
    result = drawable(periods=2)
    fine = result.response.fine
    fine.deflection[:, 0] += 2e-6 * np.cos(np.pi * fine.phase)
    bars = curve(FIGURES["spectrum"](result), "transmission error")
    assert list(bars.x[:3]) == [0.5, 1.0, 1.5]
    assert bars.y[0] == pytest.approx(2.0, rel=1e-6)


def test_an_unknown_figure_names_the_nearest() -> None:
    with pytest.raises(InputError, match='"spectrum"'):
        FIGURES["spectra"]
