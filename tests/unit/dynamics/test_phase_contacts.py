"""Forces on the lines of a grid of phases, integrated between their breaks."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System, harmonic_balance
from tribodyn.dynamics.harmonic.phase_contacts import Cut, Pieces
from tribodyn.dynamics.harmonic.phase_grid import PhaseGrid


@pytest.mark.parametrize(("shape", "axis"), [((20, 6), 0), ((5, 16), 1), ((4, 13, 6), 1)])
def test_steps_have_the_lines_of_the_closed_form(shape, axis):
    grid = PhaseGrid(shape, np.ones(len(shape)))
    lines = grid.size // shape[axis]
    high = 0.35 + 0.4 * np.linspace(0.0, 1.0, lines)  # where each line jumps from 1 to 0
    cut = Cut(np.tile(np.arange(lines), 2), np.concatenate((np.full(lines, 0.1), high)))
    pieces = Pieces.of(grid, axis, cut)
    at = pieces.at
    step = ((at.place > 0.1) & (at.place < high[at.line])).astype(float)
    values = pieces.gather((pieces.weight * step)[:, None])
    table = np.moveaxis(values.reshape(shape), axis, -1).reshape(lines, -1)
    k = np.arange(1, (shape[axis] + 1) // 2)
    exact = (np.exp(-2j * np.pi * k * 0.1) - np.exp(-2j * np.pi * np.outer(high, k))) / (
        2j * np.pi * k
    )
    spectrum = np.fft.rfft(table, axis=1)[:, : k.size + 1] / shape[axis]
    assert spectrum[:, 0].real == pytest.approx(high - 0.1, abs=1e-9)
    assert np.abs(spectrum[:, 1:] - exact).max() < 2e-6


def test_a_motion_is_the_same_at_the_points_and_back():
    grid = PhaseGrid((16, 10), np.ones(2))
    first, second = grid.points.T * 2.0 * np.pi

    def wave(first, second):
        return np.cos(3 * first + second + 0.2) + 0.5 * np.sin(2 * second) + 0.1

    values = np.stack((wave(first, second), np.ones(grid.size)), axis=1)
    pieces = Pieces.of(grid, 0, Cut(np.array([2, 7]), np.array([0.31, 0.96])))
    at = pieces.sample(values)
    assert at[:, 0] == pytest.approx(wave(*(pieces.points.T * 2.0 * np.pi)), abs=1e-7)
    assert pieces.gather(pieces.weight[:, None] * at) == pytest.approx(values, abs=1e-7)


@pytest.mark.parametrize("teeth", [5, 7])
def test_teeth_that_are_alike_have_no_sidebands(teeth):
    """Whatever bends and jumps in their forces, and whatever their shaft's points are."""

    def law(x):
        return 3e8 * (1.0 + 0.05 * (teeth * np.asarray(x) % 1.0 < 0.6))

    events = tuple((np.arange(teeth)[:, None] + [0.0, 0.6]).ravel() / teeth)
    contact = Contact(
        [1.0, -1.0], law, 3e3, lambda x: 1e-6 * np.cos(2 * np.pi * teeth * x), 2e-5,
        ramp_stiffness=lambda x: np.tile([3e7, 2e8], (np.size(x), 1)),
        ramp_gap=lambda x: 1e-6 * np.tile([29.0, 31.0], (np.size(x), 1)), events=events,
        cycles=(1, 0), period=teeth, turning_error=lambda x: 1e-6 * np.cos(2 * np.pi * x),
        turning_cycles=(0, 1),
    )  # fmt: skip
    system = System(np.diag([1.0, 2.0]), 20.0 * np.eye(2), np.zeros((2, 2)), [3e3, -3e3], [contact])
    motion = harmonic_balance(system, (40.0, 91.0), steps=(32 * teeth, 8))
    assert motion.converged
    lines = motion.lines()
    alike = lines.numbers[:, 0] % teeth == 0
    size = np.abs(lines.amplitude[:, 0])
    assert size[~alike].max(initial=0.0) < 1e-9 * size[1:].max()
