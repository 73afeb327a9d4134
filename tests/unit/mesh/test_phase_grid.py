"""The phase grid: knots on the events, quadrature, one-sided interpolation."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.mesh import PhaseFunction, phase_grid

EVENTS = (0.0, 0.22593, 0.32695)


def jumping(phase, segment):
    """Smooth within a segment, with jumps between them."""
    return np.sin(3.0 * phase + segment) + 2.0 * segment


def sampled(steps):
    grid = phase_grid(EVENTS, steps)
    values = np.concatenate(
        [jumping(grid.phase[part], number) for number, part in enumerate(grid.segments)]
    )
    return grid, PhaseFunction(grid, values)


def test_each_event_is_a_knot_twice_and_the_ends_once():
    grid = phase_grid(EVENTS, 512)
    for event in EVENTS[1:]:
        assert np.sum(grid.phase == event) == 2
    assert (grid.phase[0], grid.phase[-1]) == (0.0, 1.0)
    assert np.sum(grid.phase == 0.0) == 1
    assert abs(sum(grid.intervals) - 512) <= 3
    assert all(count % 2 == 0 and count >= 4 for count in grid.intervals)
    assert sum(part.stop - part.start for part in grid.segments) == grid.phase.size


def test_a_very_short_segment_still_has_its_knots():
    grid = phase_grid((0.0, 0.5, 0.5 + 1e-9), 64)
    assert grid.intervals[1] == 4
    assert np.all(np.diff(grid.phase[grid.segments[1]]) > 0.0)


def test_the_middle_lies_in_the_segment_of_its_knot():
    grid = phase_grid(EVENTS, 64)
    edges = np.array((*EVENTS, 1.0))
    for number, part in enumerate(grid.segments):
        assert np.all(grid.middle[part] == 0.5 * (edges[number] + edges[number + 1]))


def test_the_mean_is_exact_for_cubics_with_jumps():
    grid = phase_grid(EVENTS, 16)
    edges = np.array((*EVENTS, 1.0))
    values = grid.phase**3 + 5.0 * (grid.middle > EVENTS[1])
    exact = 0.25 + 5.0 * (1.0 - edges[1])
    assert grid.mean(values) == pytest.approx(exact, rel=1e-14)


def test_an_event_belongs_to_the_right_and_what_is_below_it_to_the_left():
    _, function = sampled(64)
    for number, event in enumerate(EVENTS):
        before = jumping(event if number else 1.0, (number - 1) % 3)
        assert function(event) == pytest.approx(jumping(event, number), abs=1e-12)
        assert function(event + 1e-10) == pytest.approx(jumping(event, number), abs=1e-8)
        assert function(event - 1e-10) == pytest.approx(before, abs=1e-8)
        assert function(event - 1e-15 if number else -1e-18) == pytest.approx(before, abs=1e-8)


def test_phases_are_taken_modulo_one_in_any_shape():
    _, function = sampled(64)
    phase = np.array([[0.1, 0.25], [0.4, 0.99]])
    assert function(phase).shape == (2, 2)
    assert function(phase + 3.0) == pytest.approx(function(phase), rel=1e-12)
    assert function(phase - 2.0) == pytest.approx(function(phase), rel=1e-12)
    assert float(function(1.0)) == float(function(0.0))


def test_grid_values_are_met_and_columns_are_independent():
    grid = phase_grid(EVENTS, 32)
    values = np.stack([np.cos(grid.phase), grid.phase**2], axis=1)
    inner = slice(grid.segments[1].start, grid.segments[1].stop - 1)
    interpolated = PhaseFunction(grid, values)(grid.phase[inner])
    assert interpolated == pytest.approx(values[inner], rel=1e-14)


@pytest.mark.parametrize("phase", [0.37, np.linspace(0.0, 2.0, 101), np.full((2, 3), 0.6)])
def test_many_columns_are_those_of_single_functions(phase):
    grid = phase_grid(EVENTS, 32)
    values = np.sin(np.outer(grid.phase, np.arange(30))).reshape(-1, 10, 3)
    interpolated = PhaseFunction(grid, values)(phase)
    assert interpolated.shape == (*np.shape(phase), 10, 3)
    for column in np.ndindex(10, 3):
        single = PhaseFunction(grid, values[:, *column])(phase)
        np.testing.assert_allclose(interpolated[..., *column], single, rtol=1e-14, atol=1e-16)


def test_cubics_are_interpolated_exactly():
    grid = phase_grid(EVENTS, 16)
    function = PhaseFunction(grid, grid.phase**3)
    phase = np.linspace(0.0, 1.0, 777, endpoint=False)
    assert function(phase) == pytest.approx(phase**3, abs=1e-14)


def test_the_error_falls_with_the_fourth_power():
    phase = (np.arange(4001) + 0.5) / 4001
    number = np.searchsorted(EVENTS, phase, side="right") - 1
    errors = []
    for steps in (32, 64, 128, 256):
        _, function = sampled(steps)
        errors.append(np.abs(function(phase) - jumping(phase, number)).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    # Segments have whole numbers of intervals, so single steps scatter; the whole span does not.
    assert orders.mean() > 3.8


@pytest.mark.parametrize("events", [(0.1, 0.5), (0.0, 0.5, 0.4), (0.0, 1.0), (0.0, 0.3, 0.3)])
def test_events_out_of_order_are_refused(events):
    with pytest.raises(InputError, match="They start with 0"):
        phase_grid(events, 64)


def test_too_few_steps_are_refused():
    with pytest.raises(InputError, match="at least 16"):
        phase_grid(EVENTS, 8)


@pytest.mark.parametrize("columns", [1, 3, 30])
def test_many_phases_are_evaluated_like_single_ones(columns):
    grid = phase_grid(EVENTS, 32)
    values = np.sin(np.outer(grid.phase, np.arange(1, columns + 1)))
    onto = np.random.default_rng(4).standard_normal((columns, 5))
    phase = np.linspace(-0.5, 1.5, 200).reshape(20, 10)
    for function in (PhaseFunction(grid, values), PhaseFunction(grid, values, onto)):
        each = np.array([[function(phase_) for phase_ in row] for row in phase])
        assert function(phase) == pytest.approx(each, rel=1e-13, abs=1e-14)
