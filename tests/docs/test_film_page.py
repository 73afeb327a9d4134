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
    peak,
    ratios,
    single,
    source_figure,
)

TEXT = PAGE.read_text("utf-8")


def disagreements(printed: str, solved: str) -> list[tuple[float, float]]:
    """Numbers of two tables that differ by more than three of their last digits."""
    pairs = zip(numbers(printed), numbers(solved), strict=True)
    return [(a, b) for (a, digit), (b, _) in pairs if abs(a - b) > 3.1 * digit]


@pytest.mark.parametrize("name", TABLES)
def test_tables_are_solved_numbers(name: str) -> None:
    printed, solved = on_page(name, TEXT), "\n".join(TABLES[name]())
    assert len(numbers(printed)) == len(numbers(solved)) > 10, "run tests/docs/film_tables.py"
    assert disagreements(printed, solved) == []


def test_a_wrong_digit_on_the_page_is_noticed() -> None:
    table = on_page("convergence", TEXT)
    first = numbers(table)[0][0]
    wrong = table.replace(f"{first:.7f}", f"{first * 1.0001:.7f}", 1)
    assert len(disagreements(wrong, table)) == 1


def test_second_order() -> None:
    for case in ("M 20, L 10", "M 5, L 5"):
        assert all(3.9 < ratio < 4.1 for ratio in ratios(case))
    # the spike of the gear contact is narrower than the spacing: fine grids gain less from it
    gear = ratios("150 N m, 1400 rpm [um]")
    assert all(3.5 < ratio < 4.5 for ratio in gear[:3])
    assert all(3.0 < ratio < 4.0 for ratio in gear[3:])


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
            films = [sign * getattr(contact, name) for contact in contacts]
            assert films == sorted(films)


def test_the_domain_of_the_source_makes_the_film_rise_with_torque() -> None:
    starved = [source_figure(torque, 1400, True).central_film for torque in TORQUES]
    full = [source_figure(torque, 1400, False).central_film for torque in TORQUES]
    assert starved == sorted(starved)
    lost = [1.0 - cut / film for cut, film in zip(starved, full, strict=True)]
    assert lost == pytest.approx([0.32, 0.14, 0.07], abs=0.01)


def test_constriction_weakens_with_torque() -> None:
    contacts = [source_figure(torque, 1400, False) for torque in TORQUES]
    depths = [contact.minimum_film / contact.central_film for contact in contacts]
    assert depths == sorted(depths)


def test_the_spike_goes_to_the_outlet_with_torque_and_to_the_inlet_with_speed() -> None:
    for cut in (False, True):
        torque = [peak(source_figure(torque, 1400, cut)) for torque in TORQUES]
        speed = [peak(source_figure(150, rpm, cut)) for rpm in SPEEDS]
        # in Hertz pressures it falls with torque and rises with speed
        assert [place for _, place in torque] == sorted(place for _, place in torque)
        assert [place for _, place in speed] == sorted((place for _, place in speed), reverse=True)
        assert torque[2][0] < torque[1][0]
        assert [height for height, _ in speed] == sorted(height for height, _ in speed)


def test_light_load_is_not_close_to_hertz() -> None:
    # the only maximum is the spike, far above the dry pressure
    contact = source_figure(50, 1400, False)
    assert single(contact)
    assert not single(source_figure(150, 1400, False))
    assert contact.pressure.max() > 1.5 * contact.hertz_pressure


def test_film_stiffness_on_the_page() -> None:
    printed = {"1.95e10": (50, 1400), "2.50e10": (150, 1400), "5.12e10": (300, 1400),
               "3.45e10": (150, 800), "1.68e10": (150, 3000)}  # fmt: skip
    for label, (torque, rpm) in printed.items():
        assert label in TEXT
        stiffness = source_figure(torque, rpm, False).film_stiffness(20e-3)
        assert stiffness == pytest.approx(float(label), rel=0.005)
    secant = source_figure(150, 1400, False).film_stiffness(20e-3, "secant")
    assert secant == pytest.approx(2.77e9, rel=0.005)
