"""What a session displays: one line for each object, tables, help of figures."""

import inspect
import warnings
from dataclasses import is_dataclass
from importlib import import_module

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES
from tribodyn.record import default_table
from tribodyn.study.case.section import Section

PAIR, STAGE = "time-varying-friction", "planetary-stage"


@pytest.fixture(scope="module")
def results() -> dict[str, td.Result]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {name: td.run(name) for name in (PAIR, STAGE)}


def one_line(thing: object) -> bool:
    text = repr(thing)
    return "\n" not in text and len(text) < 460


def public_classes() -> set[type]:
    pages = (import_module(f"tribodyn.{name}") for name in td._PACKAGES)
    members = (getattr(page, name) for page in pages for name in getattr(page, "__all__", ()))
    return {each for each in members if isinstance(each, type)}


@pytest.mark.parametrize("name", [*td.cases(machines=True)])
def test_cases_are_one_line_and_print_their_table(name: str) -> None:
    case = td.load_case(name)
    assert one_line(case)
    assert case.title[:40] in repr(case)
    assert len(str(case).splitlines()) > 20
    assert f"Case: {case.title}" in str(case)
    assert case._repr_html_().startswith("<details><summary>")
    sections = [value for value in vars(case).values() if isinstance(value, Section)]
    assert all(map(one_line, sections))


def test_no_public_class_prints_whole_fields() -> None:
    generated = [
        each.__name__
        for each in public_classes()
        if is_dataclass(each)
        and hasattr(each.__repr__, "__wrapped__")
        and each.__module__ not in ("tribodyn.errors", "tribodyn.nomenclature")
    ]
    assert not generated
    signal = td.analysis.AngularSignal(*[np.linspace(0.0, 1.0, 3000)] * 4, 8)
    assert repr(signal).startswith("AngularSignal(rotation=array(3000), signal=array(3000), ")
    racks = td.gear.BasicRack(1.0, 1.25, 0.38)
    assert eval(repr(racks), vars(td.gear)) == racks


def test_results_and_their_parts_are_one_line(results: dict[str, td.Result]) -> None:
    for result in results.values():
        names = [name for name in dir(result) if not name.startswith(("_", "plot"))]
        parts = [getattr(result, name) for name in names if name in vars(result)]
        own = [part for part in parts if type(part).__module__.startswith("tribodyn")]
        assert len(own) >= 3
        assert all(map(one_line, [result, *own]))
    assert one_line(results[STAGE].machine)
    assert one_line(next(iter(results[STAGE].machine.planets.values())))


@pytest.mark.parametrize("name", [PAIR, STAGE])
def test_table_of_a_result_is_its_summary(results: dict[str, td.Result], name: str) -> None:
    table, summary = results[name].table, results[name].summary()
    assert [*table.columns] == ["name", "value", "unit", "meaning"]
    assert dict(zip(table.name, table.value, strict=True)) == summary
    key = "mesh_frequency" if name == PAIR else table.name[table.name.str.contains("speed")].iloc[0]
    row = table[table.name == key].iloc[0]
    assert row.unit == ("Hz" if name == PAIR else "rad/s")
    assert table.meaning.str.len().min() > 3


def test_a_table_over_time_or_order_has_the_signals(results: dict[str, td.Result]) -> None:
    result = results[PAIR]
    table = result.to_dataframe()
    assert table.index.name == "time"
    np.testing.assert_array_equal(table["mesh_force"], result.to_xarray().mesh_force)
    column = result.to_xarray().position.sel(coordinate="wheel_y")
    np.testing.assert_array_equal(table["position[wheel_y]"], column)
    assert table.attrs["units"]["mesh_force"] == "N"
    orders = result.to_dataframe("order")
    assert orders.index.name == "order"
    assert "mesh_force_spectrum" in orders
    assert "mesh_force_spectrum" in table.attrs["left_out"]
    with pytest.raises(InputError, match=r'no variable over "tine".*Did you mean "time"'):
        result.to_dataframe("tine")
    meshes = results[STAGE].to_dataframe()
    forces = [name for name in meshes if name.startswith("mesh_force[")]
    np.testing.assert_array_equal(meshes[forces], results[STAGE].motion.mesh_force)
    assert default_table(result.mesh.to_xarray()).index.name == "phase"


def test_every_figure_of_a_result_has_help_and_its_options(results: dict[str, td.Result]) -> None:
    for result in results.values():
        methods = [name for name in dir(result) if name.startswith("plot_")]
        assert len(methods) > 5
        for name in methods:
            method, figure = getattr(result, name), FIGURES[name.removeprefix("plot_")]
            assert method.__name__ == name
            assert "Returns" in inspect.getdoc(method)
            options = [*inspect.signature(figure.draw).parameters][1:]
            assert [*inspect.signature(method).parameters] == options
            assert all(f"{option} : " in method.__doc__ for option in options)
            first = next(iter(inspect.signature(figure.draw).parameters))
            assert f"\n{first} : " not in method.__doc__


def test_wrong_options_and_names_of_figures_name_the_nearest(results: dict[str, td.Result]) -> None:
    result = results[PAIR]
    with pytest.raises(AttributeError, match='Did you mean "plot_mesh_force"'):
        result.plot_mesh_forc  # noqa: B018
    with pytest.raises(InputError, match='no option "lgo" of the figure "mesh_force"'):
        result.plot_mesh_force(lgo=1)
    recorded = FIGURES["speed_sweep"]
    name = [*inspect.signature(recorded.draw).parameters][-1]
    with pytest.raises(InputError, match=f'Did you mean "{name}"'):
        recorded._check_options([name[:-1]])
