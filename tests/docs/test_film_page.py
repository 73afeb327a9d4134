"""The page on the film: its tables are solved anew, its statements hold in these numbers."""

from __future__ import annotations

import pytest
from film_tables import (
    CASES,
    NODES,
    PAGE,
    SPEEDS,
    TABLES,
    TORQUES,
    central_film,
    extrapolated,
    numbers,
    on_page,
    ratios,
    source_figure,
)

TEXT = PAGE.read_text("utf-8")


@pytest.mark.parametrize("name", TABLES)
def test_tables_are_solved_numbers(name: str) -> None:
    printed, solved = on_page(name, TEXT), "\n".join(TABLES[name]())
    assert len(numbers(printed)) == len(numbers(solved)) > 10, "run tests/docs/film_tables.py"
    # the last digits of a spike and of a ratio of small differences depend on the processor
    assert numbers(printed) == pytest.approx(numbers(solved), rel=2e-6, abs=0.02)
    fine = {"convergence": 1e-6, "order": 1.0, "torque": 2e-4, "speed": 2e-4}[name]
    if name != "order":
        films = [each for each in numbers(printed) if each < 2.0]
        assert films == pytest.approx([each for each in numbers(solved) if each < 2.0], abs=fine)


def test_a_wrong_digit_on_the_page_is_noticed() -> None:
    table = on_page("convergence", TEXT)
    first = numbers(table)[0]
    wrong = table.replace(f"{first:.7f}", f"{first * 1.0001:.7f}", 1)
    assert numbers(wrong) != pytest.approx(numbers(table), rel=2e-6)


@pytest.mark.parametrize("case", CASES)
def test_second_order(case: str) -> None:
    assert all(3.5 < ratio < 4.5 for ratio in ratios(case))


@pytest.mark.parametrize("case", CASES)
def test_engines_agree_on_every_grid(case: str) -> None:
    for nodes in NODES:
        newton, multigrid = (central_film(case, nodes, name) for name in ("newton", "multigrid"))
        assert multigrid == pytest.approx(newton, rel=1e-6)


def test_extrapolated_films_are_those_of_the_literature() -> None:
    # two independent schemes
    for case, film in (("M 20, L 10", 0.085232), ("M 5, L 5", 0.301073)):
        assert extrapolated(case, 1025) == pytest.approx(film, rel=5e-4)
        assert extrapolated(case, 4097) == pytest.approx(film, rel=2e-5)


def test_film_falls_with_torque_and_rises_with_speed() -> None:
    over_torque = [source_figure(torque, 1400, False) for torque in TORQUES]
    over_speed = [source_figure(150, rpm, False) for rpm in SPEEDS]
    for contacts, sign in ((over_torque, -1.0), (over_speed, 1.0)):
        for name in ("central_film", "minimum_film"):
            films = [sign * getattr(one, name) for one in contacts]
            assert films == sorted(films)


def test_the_domain_of_the_source_makes_the_film_rise_with_torque() -> None:
    starved = [source_figure(torque, 1400, True).central_film for torque in TORQUES]
    full = [source_figure(torque, 1400, False).central_film for torque in TORQUES]
    assert starved == sorted(starved)
    lost = [1.0 - cut / film for cut, film in zip(starved, full, strict=True)]
    assert lost == pytest.approx([0.32, 0.14, 0.07], abs=0.01)
