"""Forces on the lines of a grid of phases, integrated between their breaks."""

from __future__ import annotations

import numpy as np
import pytest

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
