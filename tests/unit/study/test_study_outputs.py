"""Outputs of studies: best cases, data frames, coordinates, figures, tables of notebooks."""

from __future__ import annotations

import html.parser
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.cli import call

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")


@pytest.fixture(scope="module")
def case() -> Any:
    return td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})


@pytest.fixture(scope="module")
def swept(case: Any) -> Any:
    soon = case.replace({"solver.steps_per_mesh_cycle": 256})
    return td.sweep(soon, {"film.model": ["none", "moes"], "operation.torque": ["60 N*m", 90.0]})


class _Cells(html.parser.HTMLParser):
    """Rows and cells of a table."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, _: Any) -> None:
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_data(self, data: str) -> None:
        if self.rows and self.rows[-1]:
            self.rows[-1][-1] += data


def test_the_best_relief_is_a_case_with_the_predicted_error(case: Any) -> None:
    best = td.optimize_tip_relief(case, ("60 N*m", "120 N*m"), phases=16, grid=(5, 5))
    assert best.case.gears.pinion.modification.tip_relief == best.amount
    assert best.case.gears.wheel.modification.tip_relief_length == best.length
    again = td.harris_map(best.case, list(best.torque), phases=16)
    np.testing.assert_allclose(
        again.peak_to_peak_transmission_error, best.peak_to_peak_after, rtol=1e-6
    )
    assert best.plot().data


def test_a_speed_sweep_of_a_case_meets_its_single_runs(case: Any) -> None:
    soon = case.replace({"friction.law": "none", "friction.variant": None})
    sweep = td.speed_sweep(soon, ("2000 rpm", "2400 rpm"), 3, tables=1)
    run = td.run(soon.replace({"operation.speed": "2200 rpm"}))
    column = sweep.signals.index("bearing_force_pinion_y")
    figure = run.summary()["rms_bearing_force_loa_pinion"]
    assert sweep.rms[0, 1, column] == pytest.approx(figure, rel=1e-4)
    assert (sweep.speed * 30 / np.pi).tolist() == pytest.approx([2000.0, 2200.0, 2400.0])
    title = sweep.plot().layout.xaxis.title.text
    assert title == "Speed [rpm]"


def test_films_over_operation_have_coordinates_and_a_figure() -> None:
    case = td.load_case("fzg-film").replace({"film.model": "moes", "operation.speed_of": "pinion"})
    films = td.film_over_operation(case, torque=[50.0, 150.0], speed=[90.0, 180.0, 360.0])
    data = films.to_xarray()
    assert data["central_film"].sel(torque=150.0, speed=180.0).shape == (films.path.size,)
    frame = data["central_film"].to_dataframe()
    assert set(frame.index.get_level_values("torque")) == {50.0, 150.0}
    figure = films.plot()
    least = np.nanmin(films.central_film, axis=2)
    np.testing.assert_allclose(figure.data[1].y, 1e6 * least[1])
    np.testing.assert_allclose(figure.data[1].x, films.pinion_speed * 30.0 / np.pi)


def test_a_sweep_is_a_frame(swept: Any) -> None:
    frame = swept.to_pandas()
    assert len(frame) == 4
    np.testing.assert_array_equal(
        frame["rms_mesh_force"].to_numpy().reshape(2, 2), swept["rms_mesh_force"]
    )
    assert frame["operation.torque"].tolist() == [60.0, 90.0, 60.0, 90.0]


def test_a_varied_film_shows_its_columns(swept: Any) -> None:
    assert "central_film" in swept.displayed_figures()
    assert swept.displayed_figures(["efficiency"]) == ["efficiency"]
    with pytest.raises(td.InputError, match="efficiency"):
        swept.displayed_figures(["eficiency"])
    title = swept.plot("rms_bearing_force_loa_pinion").layout.title.text
    assert title.startswith("The rms bearing force along the line of action of the pinion is ")


def test_columns_of_a_sweep_are_chosen(
    tmp_path: Any, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    arguments = [
        "sweep",
        "fzg-roughness",
        "operation.torque=60,90 N*m",
        "--set",
        "stiffness.model=analytic",
        "--set",
        "solver.steps_per_mesh_cycle=256",
    ]
    assert call([*arguments, "--show", "efficiency, minimum_film_ratios"]) == 2
    assert 'Did you mean "minimum_film_ratio"?' in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
    assert call([*arguments, "--show", "efficiency,line_load"]) == 0
    assert capsys.readouterr().out.splitlines()[1].split() == ["torque", "efficiency", "line_load"]


def test_case_result_and_sweep_are_tables_in_notebooks(case: Any, swept: Any) -> None:
    odd = case.replace({"title": "A <b> & C"})
    rows = _Cells(odd._repr_html_()).rows
    assert ["operation.torque", "90 N*m", "given"] in rows
    assert "A &lt;b&gt; &amp; C" in odd._repr_html_()
    result = td.run(case.replace({"solver.steps_per_mesh_cycle": 256}))
    figures = {row[1] for row in _Cells(result._repr_html_()).rows}
    assert {"Pitch line velocity", "Efficiency", "Mesh natural frequency"} <= figures
    assert len(figures) == 1 + len(result.summary())
    table = _Cells(swept._repr_html_()).rows
    assert table[0][:2] == ["film.model", "operation.torque"]
    assert [row[:2] for row in table[1:3]] == [["none", "60 N*m"], ["none", "90 N*m"]]


def test_without_teeth_a_speed_sweep_is_over_the_mesh_frequency() -> None:
    from tribodyn.dynamics import Contact, System, speed_sweep

    pair = Contact([1.0], stiffness=lambda p: 1.0 + 0.2 * np.cos(2 * np.pi * p), gap=1.0)
    system = System([[1.0]], [[0.1]], [[0.0]], [0.5], [pair])
    frequency = np.linspace(0.82, 0.92, 11) / (2 * np.pi)
    plain, geared = (
        speed_sweep(system, frequency, **teeth).plot() for teeth in ({}, {"teeth": 20})
    )
    assert plain.layout.xaxis.title.text == "Mesh frequency [Hz]"
    assert "rpm" not in plain.layout.title.text
    assert "Hz" in plain.layout.title.text
    np.testing.assert_allclose(plain.data[0].x, frequency)
    assert geared.layout.xaxis.title.text == "Speed [rpm]"
    np.testing.assert_allclose(geared.data[0].x, frequency * 60.0 / 20.0)
