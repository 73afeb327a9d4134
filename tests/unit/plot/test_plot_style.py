"""The common look: panels, legends, marks."""

from __future__ import annotations

import itertools
import json

import numpy as np
import pytest

from tribodyn.drawing import Sketch
from tribodyn.plot.theme.colors import INK
from tribodyn.plot.theme.panels import Panel, event_lines, stack
from tribodyn.plot.theme.style import line


def curves(count: int) -> list[dict[str, object]]:
    return [line([0, 1], [0, number], f"curve {number}", INK) for number in range(count)]


@pytest.mark.parametrize("count", [1, 2, 3])
def test_panels_fill_the_height_from_the_top_without_overlap(count: int) -> None:
    heights = [1.0, 0.5, 2.0][:count]
    figure = stack(
        "T", "x", [Panel(f"y{n}", curves(1), height=h) for n, h in enumerate(heights)]
    ).figure()
    axes = [figure.layout[f"yaxis{'' if n == 0 else n + 1}"] for n in range(count)]
    assert axes[0].domain[1] == pytest.approx(1.0)
    assert axes[-1].domain[0] == pytest.approx(0.0, abs=1e-12)
    for upper, lower in itertools.pairwise(axes):
        assert upper.domain[0] > lower.domain[1]
    spans = [axis.domain[1] - axis.domain[0] for axis in axes]
    assert [span / spans[0] for span in spans] == pytest.approx(heights)
    assert [axis.title.text for axis in axes] == [f"y{n}" for n in range(count)]
    assert figure.layout.xaxis.anchor == ("y" if count == 1 else f"y{count}")


def test_panels_grow_the_figure() -> None:
    single, two = (stack("T", "x", [Panel("y", curves(1))] * count).figure() for count in (1, 2))
    assert two.layout.height > 1.5 * single.layout.height


def test_a_legend_is_next_to_a_panel_of_several_curves_only() -> None:
    figure = stack("T", "x", [Panel("a", curves(1)), Panel("b", curves(2))]).figure()
    assert [trace.showlegend for trace in figure.data] == [False, True, True]
    assert [trace.legend for trace in figure.data] == ["legend", "legend2", "legend2"]
    assert figure.layout.legend2.y == pytest.approx(figure.layout.yaxis2.domain[1])


def test_layout_of_the_common_axis_is_merged() -> None:
    figure = stack("T", "x", [Panel("a", curves(1))], {"xaxis": {"range": [0, 3]}}).figure()
    assert figure.layout.xaxis.title.text == "x"
    assert tuple(figure.layout.xaxis.range) == (0, 3)


def test_marks_at_one_place_share_a_line_and_a_name() -> None:
    marks = event_lines([("A", 0.5), ("D", 0.5 + 1e-12), ("E", 1.0)])
    assert [note["text"] for note in marks["annotations"]] == ["A, D", "E"]
    assert [shape["x0"] for shape in marks["shapes"]] == [0.5, 1.0]


def test_names_that_would_run_into_each_other_are_raised() -> None:
    marks = event_lines([("enters", 0.0), ("C", 0.5), ("leaves", 0.52), ("enters", 1.0)])
    assert [note["yshift"] > 0 for note in marks["annotations"]] == [False, False, True, False]


def test_marks_need_not_be_sorted() -> None:
    marks = event_lines([("E", 1.0), ("C", -0.2), ("A", 0.0)])
    assert [note["text"] for note in marks["annotations"]] == ["C", "A", "E"]


def test_no_marks() -> None:
    assert event_lines([]) == {"shapes": [], "annotations": []}


@pytest.mark.parametrize(
    "values",
    [
        [1, 2.5, None],
        [1.0, float("nan"), float("inf")],
        np.array([1.0, np.nan]),
        np.array([0.5, 1.5], dtype=np.float32),
        np.array([-3, 127]),
        np.array([-3, 128]),
        np.array([-3, 2**20]),
        np.array([-3, 2**40]),
        np.array([3, 200], dtype=np.uint64),
        np.array([True, False]),
        np.array(["a", "<b>"]),
        np.array([1.0, None, float("nan")], dtype=object),
        np.array([]),
        np.arange(6.0).reshape(2, 3),
        [np.float64(1.0), np.int64(2), np.bool_(True)],
        np.array(["2020-01-01"], dtype="datetime64[D]"),
    ],
)
def test_a_sketch_is_written_as_plotly_writes_it(values: object) -> None:
    sketch = Sketch([{"type": "scatter", "customdata": values}], {"height": 300}, [{"name": "0"}])
    written, plotly = json.loads(sketch.to_json()), json.loads(sketch.figure().to_json())
    assert written["data"] == plotly["data"]
    assert written["frames"] == plotly["frames"]


def test_every_point_of_a_curve_is_drawn() -> None:
    """By default plotly leaves points out, so that smooth curves look like polygons."""
    x = np.linspace(0.0, 1.0, 2000)
    assert line(x, x**2, "smooth", "black")["line"]["simplify"] is False
    points = np.linspace(0.0, 1.0, 200_000)
    assert "simplify" not in line(points, points, "long record", "black")["line"]
