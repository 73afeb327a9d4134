"""The benchmarks of the film run, on contacts that are what they say, against an equal rival."""

from __future__ import annotations

import importlib
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plain.film_newton import solve_plain

_FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Modules of the film benchmarks by name."""
    monkeypatch.syspath_prepend(str(_FOLDER))
    names = ("film_contacts", "film_speed", "film_batch")
    return SimpleNamespace(**{name: importlib.import_module(name) for name in names})


def test_random_contacts_are_those_promised(bench: Any) -> None:
    contacts = bench.film_contacts.random_contacts(300)
    load = np.array([contact.load for contact in contacts])
    assert load.min() >= 1.0
    assert load.max() <= 300.0
    assert np.median(np.log(load)) == pytest.approx(math.log(17.3), abs=0.3)
    assert max(contact.viscosity for contact in contacts) <= 25.0
    assert max(contact.hertz_pressure for contact in contacts) <= 2e9
    assert contacts[:5] == bench.film_contacts.random_contacts(5)


def test_hertz_pressure_follows_from_the_numbers(bench: Any) -> None:
    contact = bench.film_contacts.random_contacts(1)[0]
    solution = contact.solve(129)
    law, scale, reference, index = solution._grid.oil[:4]
    assert law == 2.0
    slope = scale * index / reference
    assert slope == pytest.approx(contact.coefficient * contact.hertz_pressure, rel=1e-9)


def test_rival_solves_the_same_equations(bench: Any) -> None:
    for contact in bench.film_contacts.random_contacts(3, seed=7):
        solution = contact.solve(257, tolerance=1e-9, flux_tolerance=1e-8)
        plain = solve_plain(bench.film_contacts.twin(solution))
        np.testing.assert_allclose(plain.H, solution.film, rtol=1e-8)


def test_study_is_the_pair_of_the_test_rig(bench: Any) -> None:
    study = bench.film_contacts.study(30)
    assert study.load_per_width.shape == (18, 30)
    # at the pitch point both surfaces run equally fast, and the radius is 8.38 mm
    pitch = int(np.argmin(np.abs(study.equivalent_radius[0] - 8.383e-3)))
    assert study.entrainment_speed[6, pitch] == pytest.approx(
        1400 * math.pi / 30 * 20.956e-3, rel=0.02
    )
    load = 300 / (50.7434e-3 * 20e-3)
    assert study.load_per_width.max() == pytest.approx(load)
    # two pairs share the load at both ends of the path, and at the pitch point of this pair
    for place in (0, pitch, -1):
        assert study.load_per_width[:, place].max() == pytest.approx(load / 2)


@pytest.mark.parametrize(
    ("script", "expected"), [("film_speed", "plain NumPy"), ("film_batch", "contacts/CPU-s")]
)
def test_quick_run_of_a_film_race(
    bench: Any, capsys: pytest.CaptureFixture[str], script: str, expected: str
) -> None:
    getattr(bench, script).main(["--quick"])
    assert expected in capsys.readouterr().out
