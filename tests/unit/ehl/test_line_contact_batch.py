"""Many contacts at once: shapes, threads, progress, failures and interrupts."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.ehl import solve_line_contact, solve_line_contacts
from tribodyn.ehl.steady import batch as batches
from tribodyn.errors import ComputationError, ModelWarning, Problem
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
LOADS = np.linspace(1e5, 3e5, 4)
SPEEDS = np.array([[2.0], [3.0], [4.0]])


class Told:
    def __init__(self):
        self.events = []

    def start(self, task, total=None):
        self.events.append(total)

    def advance(self, steps=1):
        self.events.append("one")

    def finish(self):
        self.events.append("end")


@pytest.mark.parametrize("threads", [1, 2])
def test_batch_equals_single_contacts(threads):
    progress = Told()
    batch = solve_line_contacts(
        LOADS, 8e-3, SPEEDS, OIL, 2.2e11, nodes=257, threads=threads, keep_solutions=True,
        progress=progress, length=0.02,
    )  # fmt: skip
    assert batch.central_film.shape == batch.solutions.shape == (3, 4)
    for place in ((0, 0), (2, 1), (1, 3)):
        single = solve_line_contact(
            LOADS[place[1]], 8e-3, SPEEDS[place[0], 0], OIL, 2.2e11, nodes=257
        )
        assert batch.central_film[place] == single.central_film
        assert batch.minimum_film[place] == single.minimum_film
        assert batch.outlet[place] == single.outlet
        assert batch.hertz_pressure[place] == single.hertz_pressure
        assert batch.half_width[place] == single.half_width
        assert batch.flux_error[place] == single.flux_error
        assert batch.central_film_error[place] == single.central_film_error
        assert batch.solutions[place].film == pytest.approx(single.film, rel=0)
        assert batch.film_stiffness[place] == pytest.approx(single.film_stiffness(0.02), rel=1e-6)
    assert progress.events == [12, *["one"] * 12, "end"]
    assert np.all(np.diff(batch.central_film, axis=0) > 0.0)  # speed
    assert np.all(np.diff(batch.central_film, axis=1) < 0.0)  # load
    assert "12 contacts" in repr(batch)


def test_stiffness_and_solutions_are_optional():
    batch = solve_line_contacts(LOADS[0], 8e-3, 2.0, OIL, 2.2e11, nodes=129, stiffness=False)
    assert batch.central_film.shape == ()
    assert batch.film_stiffness.size == batch.solutions.size == 0


def test_rising_films_are_reported_once():
    with pytest.warns(ModelWarning, match=r"of 2 of 3 contacts, the first of them \[0\]") as caught:
        batch = solve_line_contacts([3e4, 3.5e4, 2e5], 8e-3, 3.0, OIL, 2.2e11, nodes=257)
    assert len(caught) == 1
    assert list(batch.film_stiffness < 0.0) == [True, True, False]


@pytest.mark.parametrize("threads", [1, 2])
def test_failure_names_its_index_and_stops_the_rest(monkeypatch, threads):
    done = []

    def solve(case, options):
        done.append(case.load_per_width)
        if case.load_per_width == LOADS[2]:
            raise ComputationError(Problem(what="no solution", remedy="Take more nodes"))
        return solve_line_contact(case.load_per_width, 8e-3, 3.0, OIL, 2.2e11, nodes=65)

    monkeypatch.setattr(batches, "solve_case", solve)
    loads = np.concatenate((LOADS, np.full(500, LOADS[0])))
    with pytest.raises(ComputationError, match=r"contact \[2\] with 233333 N/m.*no solution"):
        solve_line_contacts(loads, 8e-3, 3.0, OIL, 2.2e11, threads=threads, stiffness=False)
    assert len(done) < 100


def test_interrupt_leaves_no_work_behind(monkeypatch):
    done = []
    real = batches.solve_case
    monkeypatch.setattr(
        batches, "solve_case", lambda case, options: done.append(1) or real(case, options)
    )

    class Impatient(Told):
        def advance(self, steps=1):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        solve_line_contacts(
            np.full(500, 1e5), 8e-3, 3.0, OIL, 2.2e11, nodes=65, threads=2, stiffness=False,
            progress=Impatient(),
        )  # fmt: skip
    assert len(done) < 100
