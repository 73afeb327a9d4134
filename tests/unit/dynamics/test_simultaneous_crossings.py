"""Contacts that cross together: every search ends, and an independent code agrees."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from known_marches import march_newmark
from tribodyn.dynamics import Contact, System
from tribodyn.dynamics._engine.blocks import LaneBlock, Run, march
from tribodyn.dynamics._engine.marching import CHATTERING
from tribodyn.dynamics._engine.method import RungeKutta4
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.errors import ComputationError

FREQUENCY, MASS, DAMPING, STIFFNESS = 2400.0, 0.2, 300.0, 3e7
CYCLES, COPIES = 4, 3


class Ramps:
    """One mass against ramps that begin together in threes, far from the origin of its place.

    Far away the compression is known to fewer digits, so that the three cross at places that
    differ by rounding.
    """

    def __init__(self, seed: int, offset: float = 0.0) -> None:
        random = np.random.default_rng(seed)
        self.far = 10.0 ** random.uniform(-4.0, -1.0)
        self.wave = random.uniform(0.0, 0.3)
        self.force = random.uniform(100.0, 2000.0)
        self.places = 2e-5 + 1e-6 * np.arange(4)
        self.start = np.array(
            [self.places[1] + random.uniform(-1e-5, 1e-5), random.uniform(-0.3, 0.3)]
        )
        contacts = [
            Contact(
                [1.0],
                0.0 if j == copy == 0 else STIFFNESS,
                damping=DAMPING if j == copy == 0 else 0.0,
                gap=lambda p, j=j, copy=copy: self.gap(j, p) * (1.0 + offset * copy),
                error=self.far,
            )
            for j in range(4)
            for copy in range(COPIES)
        ]
        self.system = System([[MASS]], [[50.0]], [[0.0]], [self.force], contacts)

    def gap(self, j, phase):
        return self.places[j] * (1.0 + self.wave * np.cos(2.0 * np.pi * np.asarray(phase)))

    def march(self, steps):
        compiled = compile_for(self.system, FREQUENCY, steps)
        start = self.start[None] + [self.far, 0.0]
        return march(compiled, np.array([1.0 / FREQUENCY]), start, CYCLES)[0] - [self.far, 0.0]

    def reference(self):
        """DOP853 from event to event, each of the four places being one contact."""
        sides = [self._side(k, self.start[0]) for k in range(4)]
        time, state, end = 0.0, self.start, CYCLES / FREQUENCY
        while time < end:
            events, changes = self._events(sides)
            solution = solve_ivp(
                lambda t, y: self._rate(t, y, sides), (time, end), state, "DOP853", events=events,
                rtol=1e-11, atol=[1e-15, 1e-11], max_step=end / 200,
            )  # fmt: skip
            time, state = float(solution.t[-1]), solution.y[:, -1]
            if solution.status != 1:
                break
            for (k, side), when in zip(changes, solution.t_events, strict=True):
                if len(when):
                    sides[k] = side
        return state

    def _side(self, k, place):
        return float(np.sign(place)) * (abs(place) > self.gap(k, 0.0))

    def _events(self, sides):
        events, changes = [], []
        for k in range(4):
            for flank in (1.0, -1.0) if sides[k] == 0.0 else (sides[k],):

                def event(t, y, k=k, flank=flank):
                    return flank * y[0] - self.gap(k, FREQUENCY * t)

                event.terminal, event.direction = True, 1.0 if sides[k] == 0.0 else -1.0
                events.append(event)
                changes.append((k, flank if sides[k] == 0.0 else 0.0))
        return events, changes

    def _rate(self, t, y, sides):
        total = self.force - 50.0 * y[1]
        for k, side in enumerate(sides):
            ramps = COPIES - (k == 0)
            depth = y[0] - side * self.gap(k, FREQUENCY * t)
            total -= abs(side) * ramps * STIFFNESS * depth
        return [y[1], (total - abs(sides[0]) * DAMPING * y[1]) / MASS]


@pytest.mark.parametrize("seed", range(6))
def test_coincident_ramps_follow_an_independent_code(seed):
    # The search went on for ever from the first of them on.
    ramps = Ramps(seed)
    exact = ramps.reference()
    size = np.array([1e-5, 0.3])
    coarse, fine = (np.abs((ramps.march(steps) - exact) / size).max() for steps in (256, 512))
    assert fine < 2e-6
    assert fine < coarse / 8.0


@pytest.mark.parametrize("offset", [1e-15, 1e-13, 1e-11, 1e-9])
def test_nearly_coincident_ramps_move_like_coincident_ones(offset):
    for seed in range(4):
        records = [Ramps(seed, each).march(256) for each in (0.0, offset)]
        np.testing.assert_allclose(records[1], records[0], rtol=0.0, atol=1e-10 + 100.0 * offset)


def test_newmark_ends_its_search_and_converges_to_the_same_motion():
    ramps = Ramps(0)
    start = ramps.start[None] + [ramps.far, 0.0]
    exact = ramps.reference()
    errors = []
    for steps in (512, 1024):
        compiled = compile_for(ramps.system, FREQUENCY, steps)
        end = march_newmark(compiled, np.array([1.0 / FREQUENCY]), start, CYCLES)[0]
        errors.append(np.abs((end - [ramps.far, 0.0] - exact) / [1e-5, 0.3]).max())
    assert errors[1] < 1e-2
    assert errors[1] < errors[0] / 2.5


def test_endless_chatter_within_a_step_is_reported():
    compiled = compile_for(Ramps(0).system, FREQUENCY, 64)
    period, state = np.full(40, 1.0 / FREQUENCY), np.zeros((40, 2))
    lanes, block = Run(compiled, RungeKutta4(), None, period, state, None), np.arange(16, 32)
    step, contact, lane = 5 * 64 + 16, 7, 3
    code = CHATTERING + (step * 12 + contact) * 16 + lane
    with pytest.raises(ComputationError, match="more than 64 times within one step") as caught:
        lanes.report(LaneBlock(block, 16), code, 2)
    problem = caught.value.problems[0]
    assert problem.where == (
        f"contacts[7], mesh phase 0.25 of mesh cycle 8, time {7.25 / FREQUENCY:.6g} s, in lane 19"
    )
    assert "steps" in problem.remedy


def test_a_mass_held_on_its_boundary_by_a_damper_ends_the_search():
    # Without a spring, in a gap that opens: free, the mass follows it; touching, it is thrown back.
    contact = Contact(
        [1.0], 0.0, damping=20000.0,
        gap=lambda p: 2e-5 * (2.0 - np.cos(2.0 * np.pi * np.asarray(p))),
    )  # fmt: skip
    system = System([[0.2]], [[0.0]], [[0.0]], [20.0], [contact])
    ends = []
    for steps in (1024, 2048):
        compiled = compile_for(system, 500.0, steps)
        ends.append(march(compiled, np.array([0.002]), np.array([[1.9e-5, 0.0]]), 1)[0])
    assert np.abs((ends[1] - ends[0]) / [1e-5, 0.06]).max() < 0.02
