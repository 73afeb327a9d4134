"""Studies of many motions of large structures in modal coordinates, against other methods."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from test_continuation import hill
from test_lyapunov_exponents import CHAOTIC, INDEPENDENT, chaotic_system
from test_pair_as_machine import SPEED, TEETH, machine, pair

from known_systems import everything_varies, hysteresis_system
from tribodyn.analysis import basins, bifurcation, lyapunov_exponents
from tribodyn.dynamics import Contact, LoadFriction, System, continuation, harmonic_balance
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.modal.modal_march import compile_modal, is_modal
from tribodyn.dynamics.orbits.modal_tangent import ModalTangent
from tribodyn.dynamics.orbits.orbit_map import OrbitMap
from tribodyn.errors import ComputationError
from tribodyn.nonlinear.attractors import Motions, settle

TURN = 2.0 * np.pi


def beside_others(system: System, others: int = 24) -> System:
    """The same structure beside masses that nothing of it moves: the large one of a machine."""
    size = system.size + others

    def wide(matrix, rest):
        out = rest * np.eye(size)
        out[: system.size, : system.size] = matrix
        return out

    contacts = [
        Contact(
            np.append(each.direction, np.zeros(others)), each.stiffness, each.damping, each.error,
            each.gap,
        )
        for each in system.contacts
    ]  # fmt: skip
    pushed = system.force
    force = (
        (lambda p: np.hstack((pushed(p), np.zeros((p.size, others)))))
        if callable(pushed)
        else np.append(pushed, np.zeros(others))
    )
    large = System(
        wide(system.mass, 1.0),
        wide(system.damping, 1.0),
        wide(system.stiffness, 900.0),
        force,
        contacts,
    )
    assert is_modal(large)
    return large


def with_ramps() -> System:
    """A contact of two ramps with friction that follows its load, and a torque that balances."""
    contact = Contact(
        [1.0, -1.0], lambda p: 6.0 + np.cos(TURN * p), 0.2, gap=0.1,
        error=lambda p: 0.2 * np.sin(TURN * p), ramp_stiffness=[3.0], ramp_gap=[0.25],
    )  # fmt: skip
    friction = LoadFriction([0.05, 0.02], [0.5, 0.2], 1.0)
    return System(
        np.diag([1.0, 2.0]), np.zeros((2, 2)), np.zeros((2, 2)), [1.0, -1.0], [contact],
        balance=[1.0, 0.0], frictions=[friction],
    )  # fmt: skip


@pytest.mark.parametrize("periods", [1, 2])
@pytest.mark.parametrize("make", [hysteresis_system, everything_varies])
def test_the_tangent_is_the_derivative_of_the_motion_by_runge_kutta(make, periods) -> None:
    system, frequency = make(), 0.2
    modal = OrbitMap(compile_modal(system, frequency, 512), frequency, periods)
    classical = OrbitMap(compile_for(system, frequency, 512), frequency, periods)
    y = np.linspace(0.4, -1.1, modal.coordinates.reducing.shape[1])  # contacts open and close
    image, matrix = modal.matrix(y, 1.0)
    exact, slope = classical.matrix(y, 1e-5, central=True)
    assert np.linalg.norm(image - exact) <= 1e-5 * np.linalg.norm(exact)
    assert np.linalg.norm(matrix - slope) <= 1e-4 * np.linalg.norm(slope)


def test_the_tangent_holds_with_ramps_friction_and_a_balancing_torque() -> None:
    mapping = OrbitMap(compile_modal(with_ramps(), 0.3, 256), 0.3, 1)
    assert mapping.balance is not None
    y = mapping.start(np.array([0.2, -0.2, 0.1, -0.1]))
    _, matrix = mapping.matrix(y, 1.0)
    moves = 1e-6 * np.eye(y.size)
    slope = np.stack([(mapping(y + move) - mapping(y - move)) / 2e-6 for move in moves], axis=1)
    assert matrix == pytest.approx(slope, abs=1e-4)  # what a step errs depends on where it divides


def test_period_doubling_is_that_of_the_structure_alone() -> None:
    contact = Contact([1.0], lambda p: 1.0 + 0.3 * np.cos(TURN * p), damping=0.05, gap=1.0)
    alone = System([[1.0]], [[0.05]], [[0.0]], [0.3], [contact])
    beats, options = np.array([1.2, 2.0]) / TURN, {"steps": 64, "cycles": 8, "keep": 8}
    first = bifurcation(alone, beats, start=([1.3], [0.1]), **options)
    start = np.append(1.3, np.zeros(24)), np.append(0.1, np.zeros(24))
    second = bifurcation(beside_others(alone), beats, start=start, **options)
    assert second.period.tolist() == first.period.tolist() == [[1, 2]]
    assert second.rms == pytest.approx(first.rms, rel=1e-4)
    assert second.contact_loss_share == pytest.approx(first.contact_loss_share, abs=2e-3)
    assert np.sort(second.section[0, 1, -2:]) == pytest.approx(
        np.sort(first.section[0, 1, -2:]), rel=1e-3
    )
    assert second.verdicts() == {"physical": 2}


def test_a_linear_structure_doubles_nothing_and_decays_by_its_damping() -> None:
    alone = System([[1.0]], [[0.2]], [[4.0]], [1.0], [Contact([1.0], 1.0)])
    large = beside_others(alone)
    diagram = bifurcation(large, np.array([0.2, 0.4]), steps=64, cycles=4, keep=4, verdict=False)
    assert diagram.period.tolist() == [[1, 1]]
    spectrum = lyapunov_exponents(large, 0.3, steps=64, transient=40, cycles=40, verdict=False)
    assert spectrum.vibrating[:2] == pytest.approx([-0.1, -0.1], rel=1e-8)
    assert spectrum.vibrating[2:] == pytest.approx(-0.5, rel=1e-6)
    assert spectrum.divergence == pytest.approx(-np.trace(large.damping), rel=1e-6)


@pytest.mark.slow
def test_the_exponent_of_chaos_is_the_independent_one() -> None:
    large = beside_others(chaotic_system())
    start = np.append(1.3, np.zeros(24)), np.zeros(25)
    spectrum = lyapunov_exponents(
        large, CHAOTIC["W"] / TURN, start=start, steps=64, transient=50, cycles=600, verdict=False
    )
    assert spectrum.chaotic
    exact, error = INDEPENDENT
    assert abs(spectrum.largest - exact) <= 4.0 * np.hypot(spectrum.largest_error, error)


def test_branch_loses_stability_at_the_edges_of_the_mathieu_tongue() -> None:
    swing, damping = 0.2, 0.04
    contact = Contact([1.0], lambda p: 1.0 + swing * np.cos(TURN * p))
    alone = System([[1.0]], [[damping]], [[0.0]], [1.0], [contact])
    branch = continuation(
        beside_others(alone), between=(1.8 / TURN, 1.96 / TURN), steps=64, longest_step=0.2
    )
    (doubling,) = branch.special("period-doubling")
    exact = brentq(hill, 1.85, 1.99, args=(swing, damping))
    assert TURN * doubling.parameter == pytest.approx(exact, rel=1e-5)
    balanced = harmonic_balance(beside_others(alone), 1.8 / TURN, steps=256)
    assert branch.rms[0, 0] == pytest.approx(np.std(balanced.deflection[:, 0]), rel=1e-4)


def test_exponents_of_a_motion_that_repeats_need_its_disturbances_over_two_periods(
    monkeypatch,
) -> None:
    size, frequency, calls = 30, 0.05, []
    links = np.diff(np.eye(size), axis=0)
    stiffness = 0.1 * np.eye(size) + 3.0 * links.T @ links
    contact = Contact(links[4], lambda p: 9.0 + np.cos(TURN * p), gap=0.02)
    damping = 0.2 * stiffness + 0.05 * np.eye(size)  # decay from 0.03 to 1.2: 1e10 in a period
    chain = System(np.eye(size), damping, stiffness, links[4], [contact])
    at = ModalTangent.at

    def counted(self, state, sections):
        calls.append(sections)
        return at(self, state, sections)

    monkeypatch.setattr(ModalTangent, "at", counted)
    spectrum = lyapunov_exponents(chain, frequency, steps=64, transient=200, verdict=False)
    assert len(calls) == 2
    assert spectrum.repeats == 1
    assert spectrum.divergence == pytest.approx(-np.trace(damping), rel=1e-5)
    assert spectrum.exponents.sum() == pytest.approx(spectrum.divergence, rel=1e-9)
    assert np.all(spectrum.standard_error < 2e-3)
    motion = harmonic_balance(chain, frequency, stability=True)
    growth = frequency * np.log(np.abs(motion.floquet_multipliers))
    assert spectrum.vibrating[: growth.size] == pytest.approx(np.sort(growth)[::-1], rel=1e-3)


def test_a_motion_that_settles_within_a_period_is_looked_at_after_each(monkeypatch) -> None:
    contact = Contact([1.0], lambda p: 9.0 + np.cos(TURN * p), damping=0.5, gap=0.1)
    alone = System([[1.0]], [[0.5]], [[0.0]], [1.0], [contact])
    large, counts = beside_others(alone), []
    compiled = compile_modal(large, 0.02, 512)
    motions = Motions(compiled, np.array([0.02]), static_start(compiled)[None] + 0.05)
    march = Motions.march

    def counted(self, index, state, cycles, force, **options):
        counts.append(cycles)
        return march(self, index, state, cycles, force, **options)

    monkeypatch.setattr(Motions, "march", counted)
    settle(motions, [0], 160, width=1)
    assert motions.period.tolist() == [1]
    assert sum(counts) < 8
    exact = motions.march(np.array([0]), motions.start, 40, motions.force)
    assert motions.state == pytest.approx(exact, abs=1e-7 * np.abs(exact).max())


def test_both_basins_behind_a_backlash_are_found() -> None:
    alone, beat = hysteresis_system(), 0.87 / TURN
    options = {"points": (3, 3), "steps": 64, "verdict": False}
    ends = ((0.0, 4.0), (-2.0, 2.0))
    first = basins(alone, beat, between=ends, **options)
    large = beside_others(alone)
    names = (large.names[0], large.names[0] + "_velocity")
    second = basins(large, beat, between=ends, coordinates=names, **options)
    np.testing.assert_array_equal(first.attractor, second.attractor)
    for one_of, other in zip(first.attractors, second.attractors, strict=True):
        assert other.rms == pytest.approx(one_of.rms, rel=1e-3)
        assert other.largest_multiplier == pytest.approx(one_of.largest_multiplier, rel=1e-3)


def test_a_pair_has_the_diagram_of_its_machine() -> None:
    beats = SPEED * TEETH[0] / TURN * np.array([0.6, 1.0])
    options = {"steps": 512, "cycles": 4, "keep": 4, "verdict": False}
    diagrams = [bifurcation(each(True), beats, **options) for each in (pair, machine)]
    for name in ("section", "rms", "period"):
        first, second = (getattr(diagram, name) for diagram in diagrams)
        assert first == pytest.approx(second, rel=1e-6)


def test_a_motion_that_grows_is_reported() -> None:
    contact = Contact([1.0], lambda p: 1.0 + 0.9 * np.cos(TURN * p))
    large = beside_others(System([[1.0]], [[0.0]], [[0.0]], [0.0], [contact]))
    start = np.append(1.0, np.zeros(24)), np.zeros(25)
    with pytest.raises(ComputationError, match="grows"):
        lyapunov_exponents(large, 2.0 / TURN, start=start, steps=64, transient=2000, cycles=2)
