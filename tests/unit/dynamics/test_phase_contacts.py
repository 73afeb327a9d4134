"""Forces on the lines of a grid of phases, integrated between their breaks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System, harmonic_balance
from tribodyn.dynamics.harmonic import phase_contacts
from tribodyn.dynamics.harmonic.newton import tangents
from tribodyn.dynamics.harmonic.phase_balance import _Search, work_of
from tribodyn.dynamics.harmonic.phase_contacts import Cut, Pieces
from tribodyn.dynamics.harmonic.phase_grid import Follower, PhaseGrid


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


def searched(contact, size=(40, 10)):
    """A contact over two phases, its residual on a grid and the motion with closed contacts."""
    system = System(np.diag([1.0, 2.0]), 20.0 * np.eye(2), np.zeros((2, 2)), [3e3, -3e3], [contact])
    search = _Search.of(system, np.array([900.0, 91.0]))
    residual = search.residual((size,))
    return residual, search.linear(residual)


def jumping(**changes):
    """A contact whose stiffness jumps, with ramps and an error that turns with a shaft."""
    return Contact(
        [1.0, -1.0], lambda x: 2e8 * (1.0 + 0.4 * (np.asarray(x) % 1.0 < 0.6)), 3e3, 0.0, 2e-5,
        ramp_stiffness=lambda x: np.tile([3e7, 2e8], (np.size(x), 1)),
        ramp_gap=lambda x: 1e-6 * np.tile([29.0, 31.0], (np.size(x), 1)), events=(0.0, 0.6),
        cycles=(1, 0), turning_error=lambda x: 2e-6 * np.cos(2 * np.pi * x), turning_cycles=(0, 1),
        **changes,
    )  # fmt: skip


def swaying():
    """The same with a direction that changes along the mesh cycle."""
    return replace(jumping(), direction=lambda x: np.stack(
        (1.0 + 0.1 * np.cos(2 * np.pi * x), -1.0 + 0.05 * np.sin(2 * np.pi * x)), axis=-1
    ))  # fmt: skip


def test_forces_do_not_depend_on_the_blocks_in_which_they_are_evaluated(monkeypatch):
    residual, y = searched(jumping())
    y = 1.2 * y - 0.2 * y.mean(axis=0) - 0.3 * np.abs(y).max() * np.cos(np.arange(len(y)))[:, None]
    whole = residual.at(y)
    assert whole.law.open.any()  # the flank parts, so that pieces are cut
    monkeypatch.setattr(phase_contacts, "_BLOCK", 16)
    residual, _ = searched(jumping())
    blocks = residual.at(y)
    np.testing.assert_allclose(blocks.force, whole.force, rtol=0, atol=1e-14 * whole.force.max())
    np.testing.assert_array_equal(blocks.pieces.at.place, whole.pieces.at.place)
    for mine, other in zip(blocks.law.tangent[3:5], whole.law.tangent[3:5], strict=True):
        np.testing.assert_allclose(mine, other, rtol=1e-13)


@pytest.mark.parametrize(("contact", "unknowns"), [(jumping(), 1), (swaying(), 2)])
def test_the_stated_unknowns_are_those_of_the_grid(contact, unknowns):
    """A contact whose direction changes is compressed by motions of two coordinates."""
    frequency = np.array([900.0, 91.0])
    residual, _ = searched(contact)
    assert residual.ends[-1] == unknowns * 40 * 10
    work = work_of(residual.parts[0].structure.rows.system, frequency)
    follower = Follower(3, (1, 0), 1, ((0, 1),))
    assert work.wide(follower, frequency).contacts == 3 * unknowns


def test_teeth_of_many_cycles_are_sampled_on_fewer_steps():
    contact = Contact([1.0, -1.0], lambda x: 2e8 + 1e7 * np.cos(2 * np.pi * np.asarray(x)), 3e3)
    memory = []
    for period in (100, 200, 400, 800):
        residual, _ = searched(replace(contact, cycles=(1, 0), period=period), (8, 4))
        memory.append(residual.parts[0].structure.rows.memory)
    assert memory[1] == pytest.approx(2.0 * memory[0], rel=1e-3)
    assert memory[3] == pytest.approx(memory[2], rel=0.05)


@pytest.mark.parametrize("contact", [jumping(), swaying()], ids=["fixed", "turning"])
def test_derivative_is_the_limit_of_differences(contact):
    residual, y = searched(contact)
    grid = residual.parts[0].grid
    phase = 2 * np.pi * grid.points
    move = np.cos(phase @ [1, 2])[:, None] + np.sin(phase @ [3, -1])[:, None] * np.ones(y.shape[1])
    small = 1e-7 * np.abs(y).max()
    ahead, back = (residual.at(y + sign * small * move).residual for sign in (1, -1))
    expected = (ahead - back) / (2 * small)
    product = residual.derivative(residual.at(y))(move)
    np.testing.assert_allclose(product, expected, rtol=0, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("contact", [jumping(), swaying()], ids=["fixed", "turning"])
def test_tangents_on_the_grid_are_those_of_the_forces(contact):
    """A motion that is the same everywhere is felt with the tangent on the grid."""
    residual, y = searched(contact)
    (part,) = residual.parts
    state = residual.at(y)
    move = np.tile(np.arange(1.0, 1.0 + y.shape[1]), (len(y), 1))
    (change,) = residual.changes(state)
    stiffness, _ = tangents(part.structure, state)
    expected = (stiffness @ move[..., None])[..., 0]
    np.testing.assert_allclose(change(move), expected, rtol=0, atol=1e-11 * np.abs(stiffness).max())
