"""Figures of solved line contacts: curves are the numbers of the solution, marks stand right."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import plotly.graph_objects as go
import pytest

from tribodyn.ehl import solve_line_contact, solve_line_contact_moes, solve_line_contacts
from tribodyn.errors import InputError
from tribodyn.lubricant import Lubricant
from tribodyn.plot import (
    compare_line_contacts,
    film_along_path,
    film_over_time,
    film_response,
    film_transient,
    line_contact,
)
from tribodyn.plot.film.line_contact import thinned

OIL = Lubricant(0.082, 880.0, 2.19e-8)
LOADS = (49267.5, 147802.0, 295604.0)  # N/m


class LineContactSolution(SimpleNamespace):
    """Stand-in of that name."""


class TransientLineContact(SimpleNamespace):
    """Stand-in of that name."""


@pytest.fixture(scope="module")
def contacts() -> list[Any]:
    return [solve_line_contact(w, 8e-3, 3.0722, OIL, 2.2e11, nodes=513) for w in LOADS]


@pytest.fixture(scope="module")
def bare() -> Any:
    return solve_line_contact_moes(20.0, 10.0, nodes=257)


def trace(figure: go.Figure, start: str, axis: str = "y") -> Any:
    """The one trace on an axis whose name begins so."""
    (curve,) = (
        each for each in figure.data if each.name.startswith(start) and (each.yaxis or "y") == axis
    )
    return curve


def labels(figure: go.Figure) -> set[str]:
    layout = figure.layout
    titles = [layout[key].title.text for key in layout if key.startswith(("xaxis", "yaxis"))]
    return {label for label in titles if label}


def test_curves_are_those_of_the_solution_in_display_units(contacts: list[Any]) -> None:
    solution = contacts[1]
    figure = line_contact(solution)
    np.testing.assert_allclose(trace(figure, "oil film").x, 1e6 * solution.position)
    np.testing.assert_allclose(trace(figure, "oil film").y, 1e-9 * solution.pressure)
    np.testing.assert_allclose(trace(figure, "film", "y2").y, 1e6 * solution.film)
    assert labels(figure) == {"Position [µm]", "Pressure [GPa]", "Film [µm]"}


def test_dry_pressure_carries_the_load(contacts: list[Any]) -> None:
    dry = trace(line_contact(contacts[1]), "dry")
    assert dry.line.dash == "dash"
    # N/m: GPa times um is N/mm
    assert 1e3 * np.trapezoid(dry.y, dry.x) == pytest.approx(LOADS[1], rel=1e-3)
    assert dry.y.max() == pytest.approx(0.8043, abs=1e-4)
    assert dry.x[-1] == pytest.approx(116.99, abs=0.01)


def test_marks_stand_on_the_film(contacts: list[Any]) -> None:
    solution = contacts[1]
    figure = line_contact(solution)
    central, least = trace(figure, "central", "y2"), trace(figure, "minimum", "y2")
    assert (central.x[0], central.y[0]) == (0.0, pytest.approx(1e6 * solution.central_film))
    assert least.y[0] == pytest.approx(1e6 * solution.minimum_film)
    # the constriction lies between the centre and the outlet
    assert 0.0 < least.x[0] < 1e6 * solution.outlet
    assert least.y[0] == pytest.approx(
        np.interp(least.x[0], 1e6 * solution.position, 1e6 * solution.film), 1e-3
    )
    places = {note.text: note.x for note in figure.layout.annotations}
    assert places == {"centre": 0.0, "outlet": pytest.approx(1e6 * solution.outlet)}
    spike = trace(figure, "spike")
    assert spike.x[0] == pytest.approx(1e6 * solution.spike_position)
    assert spike.y[0] == pytest.approx(1e-9 * solution.spike_pressure)


def test_title_names_both_films(contacts: list[Any]) -> None:
    title = line_contact(contacts[1]).layout.title.text
    assert title == "The film is 1.02 µm thick in the centre and 0.894 µm at its thinnest"


def test_dimensionless_form(contacts: list[Any], bare: Any) -> None:
    figure = line_contact(bare)
    assert labels(figure) == {"Position [b]", "Pressure [p<sub>h</sub>]", "Film [b²/R]"}
    np.testing.assert_allclose(trace(figure, "oil film").x, bare.position)
    solution = contacts[1]
    dimensionless = line_contact(solution, dimensionless=True)
    assert labels(dimensionless) == labels(figure)
    film = trace(dimensionless, "film", "y2")
    np.testing.assert_allclose(film.y, solution.film * 8e-3 / solution.half_width**2)
    assert trace(dimensionless, "dry").y.max() == pytest.approx(1.0)


def test_a_pressure_without_spike_has_no_mark(bare: Any) -> None:
    smooth = LineContactSolution(
        **{name: getattr(bare, name) for name in ("position", "pressure", "film", "central_film")},
        **{name: getattr(bare, name) for name in ("minimum_film", "hertz_pressure", "half_width")},
        **{name: getattr(bare, name) for name in ("film_unit", "outlet", "lubricant")},
        spike_position=None,
        spike_pressure=None,
    )
    assert all("spike" not in each.name for each in line_contact(smooth).data)


def test_solution_has_its_plot(contacts: list[Any]) -> None:
    assert contacts[0].plot().to_dict() == line_contact(contacts[0]).to_dict()


def test_thinning_preserves_the_curves(contacts: list[Any]) -> None:
    fine = solve_line_contact(LOADS[2], 8e-3, 3.0722, OIL, 2.2e11, nodes=4097)
    thin = thinned(fine, 200)
    assert len(thin) <= 200
    assert (thin[0], thin[-1]) == (0, 4096)
    assert np.all(np.diff(thin) > 0)
    assert fine.pressure[thin].max() == fine.pressure.max()
    for values, size in ((fine.pressure, fine.hertz_pressure), (fine.film, fine.central_film)):
        between = np.interp(fine.position, fine.position[thin], values[thin])
        near_contact = fine.film < 3.0 * fine.central_film
        assert np.abs(between - values)[near_contact].max() < 0.01 * size
    assert len(thinned(contacts[0], 5000)) == 513


def test_comparison_names_the_thinnest(contacts: list[Any]) -> None:
    names = ("50 N·m", "150 N·m", "300 N·m")
    figure = compare_line_contacts(contacts, names)
    assert figure.layout.title.text.startswith("The thinnest film, 0.83")
    assert figure.layout.title.text.endswith(" µm, is that of 300 N·m")
    for solution, name in zip(contacts, names, strict=True):
        assert trace(figure, name).y.max() == pytest.approx(1e-9 * solution.pressure.max())
    looks = [(trace(figure, name).line.color, trace(figure, name).line.dash) for name in names]
    assert len({color for color, _ in looks}) == len({dash for _, dash in looks}) == 3


def test_dimensionless_comparison_has_one_dry_pressure(contacts: list[Any], bare: Any) -> None:
    names = ("a", "b", "c")
    in_units = compare_line_contacts(contacts, names)
    assert sum(each.name == "dry (Hertz)" for each in in_units.data) == 3
    shapes = compare_line_contacts([*contacts, bare], (*names, "d"), dimensionless=True)
    assert sum(each.name == "dry (Hertz)" for each in shapes.data) == 1
    # the spike moves to the outlet with the load
    peaks = [trace(shapes, name) for name in names]
    places = [each.x[np.argmax(np.where(each.x > 0.2, each.y, 0.0))] for each in peaks]
    assert places == sorted(places)


def test_comparisons_that_make_no_sense_are_refused(contacts: list[Any], bare: Any) -> None:
    with pytest.raises(InputError, match="3 contacts and 2 labels"):
        compare_line_contacts(contacts, ("a", "b"))
    with pytest.raises(InputError, match=r"1 of 4 contacts have no unit.*dimensionless=True"):
        compare_line_contacts([*contacts, bare], "abcd")
    with pytest.raises(InputError, match="no contact"):
        compare_line_contacts([], [])


PATH = np.array([10e-3, 12e-3, 15e-3])
LETTERS = SimpleNamespace(A=9e-3, B=11e-3, C=12e-3, D=13e-3, E=16e-3)


def test_animation_moves_profile_and_marks(contacts: list[Any]) -> None:
    figure = film_along_path(contacts, PATH, path_of_contact=LETTERS)
    assert [frame.name for frame in figure.frames] == ["0", "1", "2"]
    for solution, at, frame in zip(contacts, PATH, figure.frames, strict=True):
        moved = [figure.data[number] for number in frame.traces]
        assert [each.name for each in frame.data] == [each.name for each in moved]
        assert [each.yaxis for each in frame.data] == [each.yaxis for each in moved]
        pressure, film, load, least, dry = frame.data
        assert max(pressure.y) == pytest.approx(1e-9 * solution.pressure.max(), rel=1e-6)
        assert np.interp(0.0, film.x, film.y) == pytest.approx(
            1e6 * solution.central_film, rel=1e-3
        )
        assert (load.x[0], load.y[0]) == pytest.approx((1e3 * at, 1e-3 * solution.load_per_width))
        assert (least.x[0], least.y[0]) == pytest.approx((1e3 * at, 1e6 * solution.minimum_film))
        assert len(pressure.x) <= 200
        assert max(dry.y) == pytest.approx(1e-9 * solution.hertz_pressure, rel=1e-6)
    assert {note.text for note in figure.layout.annotations} == set("ABCDE")
    steps = figure.layout.sliders[0].steps
    assert [step.args[0][0] for step in steps] == ["0", "1", "2"]
    assert steps[1].label.startswith("12.0 mm: 148 N/mm, film 0.894 µm at its")


def test_animation_runs_from_left_to_right(contacts: list[Any]) -> None:
    back = film_along_path(contacts, PATH[::-1])
    assert back.layout.xaxis3.autorange == "reversed"
    assert film_along_path(contacts, PATH).layout.xaxis3.autorange is True
    assert not back.layout.annotations


def test_animation_is_a_small_file(contacts: list[Any]) -> None:
    solutions = [contacts[number % 3] for number in range(30)]
    text = film_along_path(solutions, np.linspace(9e-3, 16e-3, 30)).to_json()
    assert len(text) < 500_000


def test_animation_refuses_wrong_input(contacts: list[Any]) -> None:
    with pytest.raises(InputError, match="3 contacts and 2 positions"):
        film_along_path(contacts, PATH[:2])
    with pytest.raises(InputError, match="1 contacts and 1 positions"):
        film_along_path(contacts[:1], PATH[:1])
    with pytest.raises(InputError, match="keep_solutions=True"):
        film_along_path(solve_line_contacts(LOADS, 8e-3, 3.0722, OIL, 2.2e11, nodes=129), PATH)


@pytest.mark.slow
def test_response_over_the_frequency(contacts: list[Any], bare: Any) -> None:
    at = np.array([100.0, 1e3, 1e4])
    figure = film_response(contacts[1], [*at, 1e5], length=0.02)
    stiffness, damping = contacts[1].frequency_response(at, 0.02)
    np.testing.assert_allclose(trace(figure, "stiffness", "y2").y[:3], 1e-6 * stiffness)
    np.testing.assert_allclose(trace(figure, "damping", "y3").y[:3], damping)
    # um/kN is 1e-9 m/N
    response = np.abs(stiffness + 2j * np.pi * at * damping)
    np.testing.assert_allclose(trace(figure, "compliance").y[:3], 1e9 / response)
    (note,) = figure.layout.annotations
    # u_e over twice the half width, on an axis of powers of ten
    assert note.x == pytest.approx(math.log10(3.0722 / (2.0 * 116.989e-6)), abs=1e-4)
    with pytest.raises(InputError, match="dimensionless"):
        film_response(bare)


def test_response_states_where_the_static_stiffness_ends() -> None:
    def spring(frequencies: Any, length: float) -> tuple[Any, Any]:
        f = np.asarray(frequencies)
        return length * 1e9 * (1.0 - (f / 1e4) ** 2), length * np.ones_like(f)

    contact = SimpleNamespace(
        lubricant=OIL, entrainment_speed=2.0, half_width=1e-4, frequency_response=spring
    )
    # 10 % are lost where the square of f/10 kHz is 0.1; transit is at 10 kHz
    figure = film_response(contact)
    assert (
        figure.layout.title.text
        == "The film stiffness is within 10 % of its static value up to 3.2 kHz"
    )
    assert max(trace(figure, "compliance").x) == pytest.approx(1e4)
    slow = film_response(contact, [10.0, 1000.0]).layout.title.text
    assert slow.endswith("within 10 % of its static value up to at least 1.0 kHz")
    fast = film_response(contact, [5e3, 6e3]).layout.title.text
    assert fast == "The film stiffness is not within 10 % of its static value at 5.0 kHz"


def transient(impose: str = "load") -> Any:
    """A contact whose load doubles within 1 ms, as a result of the solver."""
    time = np.linspace(0.0, 1e-3, 101)
    times = np.arange(0, 101, 10)
    position = np.linspace(-4e-4, 2e-4, 61)
    pressure = 1e9 * np.sqrt(np.maximum(1.0 - (position / 1e-4) ** 2, 0.0))
    film = 1e-6 + np.maximum(np.abs(position) - 1e-4, 0.0) ** 2 / 16e-3
    return TransientLineContact(
        time=time,
        central_film=1e-6 - 1e-4 * time,
        minimum_film=0.9e-6 - 1e-4 * time,
        load_per_width=1e5 * (1.0 + 1e3 * time),
        equivalent_radius=np.full(101, 8e-3),
        maximum_pressure=0.7e9 * np.sqrt(1.0 + 1e3 * time),
        outlet=np.full(101, 1.2e-4),
        position=position,
        stored_instants=times,
        pressure=np.tile(pressure, (11, 1)),
        film=np.tile(film, (11, 1)),
        half_width=1e-4,
        hertz_pressure=2.0 * 2e5 / (math.pi * 1e-4),
        impose=impose,
    )


def test_films_over_time() -> None:
    moving = transient()
    figure = film_transient(moving, steady=moving.central_film + 1e-8)
    assert figure.layout.title.text == "The film is thinnest, 0.800 µm, after 1.00 ms"
    assert labels(figure) == {"Time [ms]", "Load [N/mm]", "Film [µm]", "Maximum pressure [GPa]"}
    np.testing.assert_allclose(trace(figure, "at its thinnest", "y2").y, 1e6 * moving.minimum_film)
    steady = trace(figure, "in the centre, steady", "y2")
    np.testing.assert_allclose(steady.y, 1e6 * moving.central_film + 0.01)
    assert trace(figure, "Load").y[-1] == pytest.approx(200.0)
    with pytest.raises(InputError, match="3 steady films and 101 instants"):
        film_transient(moving, steady=[1e-6] * 3)


def test_animation_over_time() -> None:
    figure = film_over_time(transient())
    assert len(figure.frames) == 11
    assert figure.layout.xaxis3.title.text == "Time [ms]"
    # the dry contact widens with the root of the load: from 1/sqrt(2) of the widest one
    first, last = (figure.frames[number].data[4] for number in (0, -1))
    assert max(last.x) == pytest.approx(100.0, rel=1e-6)
    assert max(first.x) == pytest.approx(100.0 / math.sqrt(2.0), rel=1e-6)
    for dry, load in ((first, 100.0), (last, 200.0)):
        assert np.trapezoid(dry.y, dry.x) == pytest.approx(load, rel=5e-3)
    profile = figure.data[0]
    assert len(profile.x) == 101
    assert profile.y[-1] == pytest.approx(200.0)
    assert all("dry" not in each.name for each in film_over_time(transient("approach")).data)
    bare = transient()
    bare.stored_instants = bare.stored_instants[:1]
    with pytest.raises(InputError, match="keep_every"):
        film_over_time(bare)
