"""The figures of the references come out when they are computed anew."""

from __future__ import annotations

import numpy as np
import pytest

from references import (
    backlash_orbits,
    film_cases,
    friction_table,
    gear_pair_orbits,
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("guess", "rms", "touches"),
    [((1.5, 0.0), backlash_orbits.LOW, False), ((2.2, 0.3), backlash_orbits.HIGH, True)],
)
def test_backlash_orbits(guess: tuple[float, float], rms: float, touches: bool) -> None:
    orbit = backlash_orbits.orbit(guess)
    assert orbit.rms == pytest.approx(rms, abs=6e-7)
    assert (orbit.least < 1.0) is touches
    np.testing.assert_allclose(
        np.abs(orbit.multipliers), backlash_orbits.MULTIPLIER, atol=6e-7, rtol=0.0
    )


@pytest.mark.slow
@pytest.mark.parametrize("friction", gear_pair_orbits.ORBITS)
def test_gear_pair_orbits(friction: float) -> None:
    computed = gear_pair_orbits.figures(friction)
    assert computed["orbit"] == pytest.approx(gear_pair_orbits.ORBITS[friction], rel=1e-6)
    assert computed["harmonics"] == pytest.approx(gear_pair_orbits.HARMONICS[friction], abs=6e-7)
    if friction:
        across = list(gear_pair_orbits.ACROSS.values())
        assert computed["across"] == pytest.approx(across, abs=6e-4)
        assert computed["multiplier"][0] == pytest.approx(gear_pair_orbits.MULTIPLIER, abs=6e-7)


@pytest.mark.parametrize("stated", friction_table.TABLE)
def test_friction_table(stated: tuple[float, ...]) -> None:
    angles = friction_table.roll_angles()
    places = (*(angles[name] for name in "ABE"), 0.5 * (angles["B"] + angles["D"]))
    roll = min(places, key=lambda place: abs(place - stated[0]))
    assert friction_table.row(roll, stated[1]) == pytest.approx(stated, abs=6e-7)


@pytest.mark.slow
@pytest.mark.parametrize("name", film_cases.KNOWN)
def test_films_of_moes(name: str) -> None:
    *_, central, minimum, outlet = film_cases.MOES[name]
    expected = film_cases.moes_film(name, 1000)
    assert expected.central == pytest.approx(central, rel=2e-4)
    assert expected.minimum == pytest.approx(minimum, rel=2e-4)
    assert expected.X[-1] == pytest.approx(outlet, abs=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("torque", film_cases.FZG)
def test_films_of_the_gear_pair(torque: int) -> None:
    _, *stated = film_cases.FZG[torque]
    hertz, half_width, central, minimum = film_cases.gear_film(torque, 800)
    assert (hertz, half_width) == pytest.approx(stated[:2], rel=1e-4)
    assert central == pytest.approx(stated[2], rel=4e-4)
    assert minimum == pytest.approx(stated[3], rel=1e-3)
