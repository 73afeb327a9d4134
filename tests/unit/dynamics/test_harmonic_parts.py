"""Parts of harmonic balance: Krylov solution, receptances, derivative of the residual, sampling."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from known_machines import two_mesh_system
from known_random_machines import random_machine
from tribodyn.dynamics import Contact, System, harmonic_balance
from tribodyn.dynamics.equations.grid import PointEvaluator, system_events
from tribodyn.dynamics.equations.nodes import evaluate_rows
from tribodyn.dynamics.equations.orbit_coordinates import direction_basis
from tribodyn.dynamics.harmonic.harmonic_balance import prepare
from tribodyn.dynamics.harmonic.newton import newton, solve_linear
from tribodyn.dynamics.harmonic.orbit_response import series
from tribodyn.dynamics.harmonic.tangent_march import TangentMarch, with_own_motion
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.errors import quiet
from tribodyn.mesh import phase_grid
from tribodyn.mesh.grid import MonotonePhaseFunction, PhaseFunction


def test_krylov_solution_is_that_of_the_matrix():
    generator = np.random.default_rng(1)
    matrix = np.eye(30) + 0.1 * generator.normal(size=(30, 30))
    right = generator.normal(size=(15, 2))
    product = lambda x: (matrix @ x.reshape(-1)).reshape(15, 2)  # noqa: E731
    solution, count = solve_linear(product, right, 1e-12)
    assert product(solution) == pytest.approx(right, abs=1e-10)
    assert count <= 30
    assert solve_linear(product, 0.0 * right, 1e-3)[1] == 0


def test_directions_of_few_rows_are_in_the_basis():
    generator = np.random.default_rng(4)
    inverse = np.triu(generator.normal(size=(9, 9))) + 3.0 * np.eye(9)
    flat = generator.normal(size=(2000, 3)) @ generator.normal(size=(3, 9))
    flat[1234] += 1e-6 * generator.normal(size=9)  # rows between those that are looked at first
    flat[777] = generator.normal(size=9)
    parts = [(flat.reshape(500, 4, 9), inverse.T), (np.zeros((1, 9)), inverse.T)]
    basis = direction_basis(parts)[0]
    rows = flat @ inverse.T
    assert basis.T @ basis == pytest.approx(np.eye(5), abs=1e-12)
    assert rows @ basis @ basis.T == pytest.approx(rows, abs=1e-9)


def test_rounding_of_a_derivative_is_no_direction():
    wave = np.sin(2.0 * np.pi * np.arange(3000) / 3000)[:, None]
    base, moved = np.random.default_rng(2).normal(size=(2, 9))
    # A numerical derivative is exact against the directions, also where it is small itself.
    noise = 1e-11 * np.random.default_rng(3).normal(size=(3000, 9))
    slope = np.roll(wave, 750, axis=0) * moved + noise
    part = base + wave * moved, np.eye(9)
    basis, some = direction_basis([part], slope)
    assert basis.shape == (9, 2)
    assert np.linalg.matrix_rank(np.concatenate(some), 1e-9) == 2
    assert direction_basis([part, (slope, np.eye(9))])[0].shape == (9, 9)


@pytest.mark.parametrize(("gap", "depth", "enough"), [(None, 0.02, True), (0.2, 0.3, False)])
def test_plain_products_solve_as_those_of_a_time_integration(gap, depth, enough):
    machine = random_machine(18, gap=gap, depth=depth)
    frequency = 2.0 / machine.cycles
    residual = prepare(machine).residual(128 * machine.cycles, frequency)
    state = residual.at(0.5 * random_response(residual, np.random.default_rng(0), 0.5, 0.2))
    steps = {}
    for plain in (False, True):
        residual.plain = plain
        steps[plain], _ = residual.correction(state, 1e-9)
    assert residual.plain is enough  # where few do not suffice they are not tried again
    size = np.abs(steps[False]).max()
    assert steps[True] == pytest.approx(steps[False], abs=1e-6 * size)


def test_derivatives_of_a_table_over_many_coordinates_are_those_of_a_function():
    grid = phase_grid((0.0, 0.3), 64)
    table = PhaseFunction(grid, np.stack((np.sin(grid.phase), grid.phase**2), axis=1))
    onto = np.random.default_rng(5).normal(size=(2, 7))
    wide = PhaseFunction(grid, table.values, onto)
    rows = PointEvaluator(np.linspace(0.0, 0.99, 40), (0.0, 0.3))
    plain = rows.derivatives("direction", lambda x: table(x) @ onto, 7)
    assert rows.derivatives("direction", wide, 7) == pytest.approx(plain, rel=1e-9, abs=1e-10)


@pytest.mark.parametrize("direct", [False, True])
def test_receptances_are_those_of_the_matrices(direct, monkeypatch):
    if direct:
        monkeypatch.setattr(ClosedStructure, "modes", None)
    machine = random_machine(3, gyroscopic=True, friction=True)
    residual = prepare(machine).residual(64, 0.1)
    structure, contacts = residual.structure, residual.contacts
    along = np.array([c.direction for c in machine.contacts])
    push = along + np.array([c.friction for c in machine.contacts])
    nodes = contacts.rows.nodes
    spring = machine.stiffness + push.T @ np.diag(nodes.stiffness.mean(axis=0)) @ along
    damper = machine.rate_matrix + push.T @ np.diag(nodes.damping.mean(axis=0)) @ along
    omega = np.array([0.0, 0.7, 40.0])
    exact = [
        along @ np.linalg.solve(spring + 1j * w * damper - w**2 * machine.mass, push.T)
        for w in omega
    ]
    matrices = contacts.rows.along[0] @ structure.receptances(omega) @ contacts.rows.push[0].T
    assert matrices == pytest.approx(np.array(exact), rel=1e-4, abs=1e-8)


def random_response(residual, generator, mean, spread):
    """Response to random contact forces, whatever basis the equations have."""
    shape = residual.contacts.steps, len(residual.structure.push)
    force = (mean + spread * generator.normal(size=shape)) @ residual.structure.push
    return residual.responses([force])[0]


@pytest.mark.processor
@pytest.mark.parametrize("gap", [None, 0.2])
def test_derivative_of_the_residual_is_that_by_differences(gap):
    parts = dict.fromkeys(("friction", "turning", "load_friction", "gyroscopic"), True)
    machine = random_machine(18, gap=gap, depth=0.3, **parts)
    frequency = 0.4 / machine.cycles
    residual = prepare(machine).residual(64 * machine.cycles, frequency)
    generator = np.random.default_rng(0)
    point = 0.5 * random_response(residual, generator, 0.5, 0.2)
    state = residual.at(point)
    assert bool(state.breaks.step.size) == (gap is not None)
    move = random_response(residual, generator, 0.0, 1.0)
    step = 1e-7 / np.abs(move).max()
    ahead, behind = residual.at(point + step * move), residual.at(point - step * move)
    slope = (ahead.residual - behind.residual) / (2.0 * step)
    exact = residual.derivative(state)(move)
    # The derivative leaves out how the size of a jump changes: of the order of a step.
    assert np.linalg.norm(slope - exact) < (1e-7 if gap is None else 2e-2) * np.linalg.norm(slope)


@pytest.mark.parametrize("gap", [None, 0.2])
def test_few_products_solve_the_linear_equations_of_a_long_period(gap):
    parts = dict.fromkeys(("friction", "turning", "load_friction", "gyroscopic"), True)
    machine = random_machine(18, gap=gap, depth=0.3, **parts)
    frequency = 0.1 / machine.cycles
    residual = prepare(machine).residual(128 * machine.cycles, frequency)
    state = residual.at(0.5 * random_response(residual, np.random.default_rng(0), 0.5, 0.2))
    step, count = residual.correction(state, 1e-9)
    size = np.abs(state.residual).max()
    assert residual.derivative(state)(step) == pytest.approx(-state.residual, abs=1e-7 * size)
    assert count <= 8  # more than 120 without time integration


def test_a_spring_begins_to_touch_without_a_jump():
    contact = Contact([1.0], 9.0, gap=0.1, error=lambda x: 0.2 * np.cos(2.0 * np.pi * x))
    system = System([[1.0]], [[0.1]], [[1.0]], [0.0], [contact])
    residual = prepare(system).residual(64, 0.2)

    def corrections(highest: float) -> float:
        # compression -error + y, whose single crest is at the sample in the middle
        breaks = residual.at(np.full((64, 1), highest - 0.1)).breaks
        at_crest = (breaks.step == 31) | (breaks.step == 32)
        return float(np.abs(breaks.correction[at_crest]).sum())

    crest = 0.2 * (1.0 - np.cos(2.0 * np.pi / 64))
    small, large = corrections(1e-6 * crest), corrections(0.5 * crest)
    assert 0.0 < small < 1e-4 * large


def test_entries_at_an_event_are_those_of_its_sides():
    contact = Contact([1.0], lambda x: np.where(x < 0.5, 1.0, 3.0), events=(0.5,), cycles=2)
    system = System([[1.0]], [[0.1]], [[1.0]], [1.0], [contact])
    events, phase = (0.0, 0.25, 0.5, 0.75), np.array([0.0, 0.25, 0.5])
    sides = [
        evaluate_rows(system, PointEvaluator(phase, events, before=before)).stiffness[:, 0, 0]
        for before in (True, False)
    ]
    assert sides[0].tolist() == [3.0, 1.0, 3.0]
    assert sides[1].tolist() == [1.0, 3.0, 1.0]


def test_tables_of_several_contacts_are_looked_up_at_once(monkeypatch):
    generator, grid = np.random.default_rng(5), phase_grid((0.0, 0.4), 16)
    ramps, gaps, stiffness = (
        MonotonePhaseFunction(grid, generator.random((grid.phase.size, *shape)))
        for shape in ((2,), (2,), ())
    )
    along = PhaseFunction(grid, generator.random((grid.phase.size, 3)))
    turns = [np.eye(3)[:, [1, 2, 0]], generator.random((3, 3)), np.eye(3)]
    clocks = [(1, 0.0), (1, 0.3), (2, 0.7)]
    contacts = [
        Contact(
            PhaseFunction(grid, along.values, turn), stiffness, cycles=cycles, offset=offset,
            ramp_stiffness=ramps, ramp_gap=gaps, events=grid.event_phases,
        )
        for turn, (cycles, offset) in zip(turns, clocks, strict=True)
    ]  # fmt: skip
    system = System(np.eye(3), np.eye(3), np.eye(3), np.zeros(3), contacts)
    clock, calls, call = np.array([0.05, 0.33, 0.8]), [], MonotonePhaseFunction.__call__
    monkeypatch.setattr(
        MonotonePhaseFunction, "__call__", lambda *inputs: calls.append(inputs) or call(*inputs)
    )
    nodes = evaluate_rows(system, PointEvaluator(clock, system_events(system)))
    assert len(calls) == 1
    for j, (turn, (cycles, offset)) in enumerate(zip(turns, clocks, strict=True)):
        phase = (cycles * clock + offset) % 1.0
        np.testing.assert_array_equal(nodes.stiffness[:, 0, j], stiffness(phase))
        np.testing.assert_array_equal(nodes.ramp_gap[:, 0, j], gaps(phase))
        np.testing.assert_array_equal(nodes.ramp_stiffness[:, 0, j], ramps(phase))
        np.testing.assert_allclose(nodes.direction[:, 0, j], along(phase) @ turn, rtol=1e-13)


def test_every_other_row_of_finer_steps_is_that_of_the_steps():
    machine = random_machine(18, gap=0.2, depth=0.3, friction=True, turning=True)
    steps = 64 * machine.cycles
    alone = prepare(machine).residual(steps, 0.1).contacts
    again = prepare(random_machine(18, gap=0.2, depth=0.3, friction=True, turning=True))
    finer = again.residual(2 * steps, 0.1).contacts
    halved = again.residual(steps, 0.1).contacts
    assert finer.steps == 2 * halved.steps == 2 * alone.steps
    assert halved.before is finer.before
    for part, same in zip(alone.rows.nodes, halved.rows.nodes, strict=True):
        np.testing.assert_allclose(*np.broadcast_arrays(part, same), rtol=1e-12, atol=1e-12)


def test_series_is_exact_between_the_samples():
    amplitudes = np.zeros((9, 1), dtype=complex)
    amplitudes[0], amplitudes[2] = 1.5, 0.5 - 0.25j
    phase = np.array([0.0, 0.1234, 0.77])
    exact = 1.5 + 2.0 * ((0.5 - 0.25j) * np.exp(4j * np.pi * phase)).real
    assert series(amplitudes, 16, phase)[:, 0] == pytest.approx(exact, abs=1e-7)
    assert series(amplitudes, 16, np.array([0.25]))[0, 0] == pytest.approx(0.5, abs=1e-14)


def test_order_is_second_where_the_contact_opens():
    machine = random_machine(16, gap=0.2, depth=0.8)
    frequency = 0.4 / machine.cycles
    with quiet():
        errors = [
            harmonic_balance(machine, frequency, steps=steps).step_error
            for steps in (128, 256, 512)
        ]
    rates = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert rates.mean() > 1.6


def test_a_system_is_evaluated_once():
    machine = two_mesh_system()
    assert prepare(machine) is prepare(machine)
    assert prepare(two_mesh_system()) is not prepare(machine)


@pytest.mark.parametrize("seed", [18, 3, 5])
def test_leading_multiplier_is_that_of_all(seed):
    machine = random_machine(seed, depth=0.3)
    frequency = 0.7 / machine.cycles
    residual = prepare(machine).residual(64 * machine.cycles, frequency)
    start = prepare(machine).equilibrium.position @ (
        residual.structure.coordinates.lower @ residual.structure.along
    )
    march = TangentMarch.of(residual, residual.at(np.tile(start, (64 * machine.cycles, 1))))
    modes = np.eye(march._parts[0].size)
    values = np.linalg.eigvals(np.stack([march.moved(row) for row in modes], axis=1))
    largest = np.abs(values).max()
    assert march.leading_multiplier() == pytest.approx(largest, rel=1e-4)
    # Of one that is far below a limit that much is certain.
    assert march.leading_multiplier(largest + 0.5) == pytest.approx(largest, abs=0.02)


def test_forces_of_a_step_contain_those_of_their_own_motion():
    generator = np.random.default_rng(5)
    direct, tangents = 0.05 * generator.normal(size=(4, 7)), generator.normal(size=(6, 7, 4))
    closed, motion = with_own_motion(direct, tangents), generator.normal(size=4)
    for whole, of_step in zip(closed, tangents, strict=True):
        force = np.linalg.solve(np.eye(7) - of_step @ direct, of_step @ motion)
        assert whole @ motion == pytest.approx(force, rel=1e-10, abs=1e-12)


@pytest.mark.parametrize(("preload", "friction"), [(4.0, True), (0.2, False)])
def test_directions_over_few_coordinates_have_the_motion_of_all(preload, friction):
    """Tables of 2 columns over 9 coordinates, against functions of all 9; some teeth separate."""
    generator = np.random.default_rng(7)
    grid, onto = phase_grid((0.0,), 64), generator.normal(size=(2, 9))
    angle = 2.0 * np.pi * grid.phase
    table = np.stack((1.0 + 0.1 * np.cos(angle), 0.2 * np.sin(angle)), axis=1)
    narrow = PhaseFunction(grid, table, onto)
    rub = PhaseFunction(grid, 0.05 * table[:, ::-1].copy(), onto)
    law = {"damping": 0.02, "gap": 0.1, "error": lambda p: 0.2 * np.cos(2 * np.pi * p)}
    contact = Contact(narrow, 5.0, friction=rub if friction else None, **law)
    wide = {name: (lambda p, entry=entry: np.asarray(entry(p)))
            for name in ("direction", "friction") if (entry := getattr(contact, name))}  # fmt: skip
    matrices = np.eye(9), 0.4 * np.eye(9), np.diag(np.arange(1.0, 10.0))
    load = preload * onto[0] / (onto[0] @ onto[0])
    motions = []
    for each in (contact, replace(contact, **wide)):
        system = System(*matrices, load, [each])
        assert (system._narrow is not None) == (each is contact)
        motions.append(harmonic_balance(system, 0.21, steps=128))
    few, every = motions
    assert few.converged
    assert (few.contact_force == 0.0).any() == (preload < 1.0)
    for name in ("position", "velocity", "acceleration", "contact_force"):
        size = np.abs(getattr(every, name)).max()
        assert getattr(few, name) == pytest.approx(getattr(every, name), abs=1e-9 * size)
        fine = getattr(few.fine, name)
        assert fine == pytest.approx(getattr(every.fine, name), abs=1e-9 * size)


def test_a_newton_step_that_is_not_finite_ends_the_search_without_a_warning():
    """As where an integration of the linearized equations grows beyond all numbers."""
    state = SimpleNamespace(y=np.ones((4, 1)), residual=np.ones((4, 1)), size=1.0)
    growing = SimpleNamespace(
        at=lambda y: state,
        accuracy=lambda norms: 1e-4,
        correction=lambda state, accuracy, most: solve_linear(
            lambda x: 1e200 * x, -1e200 * state.residual, accuracy, 5
        ),
    )
    solution = newton(growing, state.y, 1e-8)
    assert solution.error == np.inf
    assert solution.state is state
