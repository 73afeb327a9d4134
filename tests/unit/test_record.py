"""Records: what fields declare is exported, compared, shown, saved and drawn."""

import numpy as np
import pytest
import xarray

from tribodyn.drawing import FIGURES, Drawing, Need, draw, drawing, figures_of
from tribodyn.errors import InputError, OutputExistsError
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array


@record
class Level(Record):
    speed: Array = quantity("speed", unit="rad/s", axis=True)
    force: Array = quantity("speed", "gear", unit="N")
    signal: Array = quantity("speed", unit="@signal_unit")
    teeth: int = fact()
    signal_unit: str = ""

    def _parts(self) -> Parts:
        parts = super()._parts()
        parts.coordinates["gear"] = ["pinion", "wheel"]
        return parts


@record
class Line(Record):
    ARRAY = "rms"

    order: Array = quantity("order", unit="1", axis=True)
    rms: Array = quantity("order", unit="m/s^2")
    source: str = fact(name="origin")


def level(top: float = 3.0, unit: str = "um") -> Level:
    speed = np.array([1.0, 2.0])
    return Level(speed, np.array([[1.0, 2.0], [top, np.nan]]), speed * 5, 24, unit)


def test_fields_become_variables_coordinates_and_attributes_with_units() -> None:
    data = level().to_xarray()
    assert data.force.dims == ("speed", "gear")
    assert data.force.units == "N"
    assert data.signal.units == "um"
    assert level(unit="").to_xarray().signal.units == "1"
    assert "speed" in data.coords
    assert data.sel(gear="wheel").force[0] == 2.0
    assert data.attrs == {"teeth": 24}


def test_one_variable_may_be_the_whole_array() -> None:
    line = Line(np.array([1.0, 2.0]), np.array([4.0, 5.0]), "test rig").to_xarray()
    assert isinstance(line, xarray.DataArray)
    assert line.attrs == {"units": "m/s^2", "origin": "test rig"}
    assert line.sel(order=2.0) == 5.0


def test_equality_goes_by_every_field_and_knows_nan() -> None:
    assert level() == level()
    assert hash(level()) == hash(level())
    assert level() != level(3.1)
    assert level() != level(unit="m")
    assert level() != 3


def test_displayed_in_one_line_and_as_a_table() -> None:
    assert repr(level()) == "Level(speed: 2, gear: 2, teeth 24)"
    page = level()._repr_html_()
    assert "<td>rad/s</td>" in page
    assert "<td>1 to 3</td>" in page
    assert "&lt;b&gt;" in Line(np.ones(1), np.ones(1), "<b>")._repr_html_()


def test_saved_whole_and_never_over_another(tmp_path) -> None:
    path = level().save(tmp_path / "level.nc")
    assert xarray.load_dataset(path, engine="h5netcdf").identical(level().to_xarray())
    with pytest.raises(OutputExistsError, match="exists"):
        level().save(path)
    assert [each.name for each in tmp_path.iterdir()] == ["level.nc"]


@pytest.fixture
def figure():
    @drawing("level-of-test", heading="Level", caption="Look.", of=("Level", "Outer.level"),
             made_by="Call level().", missing=Need("force", "No force was computed."))  # fmt: skip
    def level_figure(subject: Level, scale: float = 1.0) -> float:
        return scale * float(np.nanmax(subject.force))

    yield level_figure
    FIGURES._items.pop("level-of-test")


class Outer:
    level = level(7.0)


def test_a_result_is_plotted_by_the_figure_of_its_class(figure: Drawing) -> None:
    assert level().plot(scale=2.0) == 6.0
    assert draw(Outer(), "level-of-test") == 7.0
    assert "level-of-test" in figures_of(level())
    assert "level-of-test" not in figures_of(Line(np.ones(1), np.ones(1), ""))


def test_a_figure_of_something_else_is_refused_with_the_way_to_it(figure: Drawing) -> None:
    line = Line(np.ones(1), np.ones(1), "")
    with pytest.raises(InputError, match=r"draws a Level or Outer. Call level\(\)"):
        figure(line)
    with pytest.raises(InputError, match="no figure draws a Line"):
        line.plot()
    empty = Level(np.ones(1), None, np.ones(1), 2)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="No force was computed"):
        figure(empty)


def test_a_report_is_written_by_whoever_registered_for_the_class(tmp_path) -> None:
    from tribodyn.drawing import REPORTS, report_of, write_report_of

    @report_of("Level")
    def text_of_level(subject: Level, path):
        path.write_text(repr(subject))
        return path

    try:
        assert write_report_of(level(), tmp_path / "level.txt").read_text() == repr(level())
    finally:
        REPORTS._items.pop("Level")
    with pytest.raises(InputError, match="there is no report of a Line"):
        write_report_of(Line(np.ones(1), np.ones(1), ""), tmp_path / "line.txt")


def test_results_within_results_are_compared_field_by_field() -> None:
    @record
    class Pair(Record):
        levels: tuple[Level, ...]

    assert Pair((level(), level(5.0))) == Pair((level(), level(5.0)))
    assert Pair((level(), level(5.0))) != Pair((level(), level(6.0)))


def test_a_plane_calls_its_dimensions_by_their_names() -> None:
    axes = {"first": ("first", np.ones(1), {}), "second": ("second", np.ones(2), {})}
    parts = Parts({"a": (("first", "second"), np.ones((1, 2)), {})}, axes, {})
    data = xarray.Dataset(*parts.over(("speed", "load"), ("rad/s", "")))
    assert data.a.dims == ("speed", "load")
    assert data.speed.units == "rad/s"
