"""The compiled contact solver against the plain one, which tries every set of touching pairs."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numba
import numpy as np
import pytest

from plain.loaded_contact import plain_approach, plain_loads
from tribodyn.errors import ComputationError, InputError
from tribodyn.stiffness import ContactProblem
from tribodyn.stiffness.loaded.kernel import solve_deflections, solve_loads
from tribodyn.stiffness.loaded.problem import Compliance

WIDTH = 0.02
NOWHERE = SimpleNamespace(contact=None)


def problem(seed: int, *, phases: int = 6, pairs: int = 4, slices: int = 1) -> ContactProblem:
    """Random compliances of the size of gear teeth; neighbours push or pull each other."""
    random = np.random.default_rng(seed)
    mixed = 0.3 * random.normal(size=(phases, pairs, pairs))
    structure = 1e-10 * (np.eye(pairs) + mixed @ mixed.transpose(0, 2, 1))
    logarithm = 2.0 * 0.91 / (np.pi * 206e9)
    local = logarithm * random.uniform(15.0, 20.0, (phases, pairs))
    gaps = 5e-6 * np.abs(random.normal(size=(phases, slices, pairs)))
    gaps[:, 0, 0] = 0.0
    compliance = Compliance(structure, local, logarithm)
    return ContactProblem(NOWHERE, compliance, gaps, np.full((1, slices, 1), WIDTH / slices))


@pytest.mark.parametrize("seed", range(6))
def test_loads_and_approach_are_those_of_the_plain_solver(seed):
    contact_problem = problem(seed)
    totals = np.array([50.0, 700.0, 9000.0])
    solution = contact_problem.at_loads(totals)
    parts = contact_problem.compliance
    for p in range(contact_problem.gaps.shape[0]):
        for t, total in enumerate(totals):
            arguments = parts.structure[p], parts.local[p], parts.logarithm
            approach = plain_approach(
                *arguments, contact_problem.gaps[p], contact_problem.widths[0, :, 0], total
            )
            assert solution.approach[t, p] == pytest.approx(approach, rel=1e-10)
            loads = plain_loads(*arguments, contact_problem.gaps[p, 0], solution.approach[t, p])
            assert solution.load[t, p, 0] == pytest.approx(loads, abs=1e-9 * loads.max())


def test_slices_together_carry_the_load():
    contact_problem = problem(1, slices=5, phases=3)
    solution = contact_problem.at_loads(np.array([4000.0]))
    total = contact_problem.forces(solution.load[0]).sum(axis=1)
    assert total == pytest.approx(4000.0, rel=1e-11)
    parts = contact_problem.compliance
    for p in range(3):
        arguments = parts.structure[p], parts.local[p], parts.logarithm
        approach = plain_approach(
            *arguments, contact_problem.gaps[p], contact_problem.widths[0, :, 0], 4000.0
        )
        assert solution.approach[0, p] == pytest.approx(approach, rel=1e-10)


def test_no_pair_pulls_and_no_flank_sinks_into_another():
    contact_problem = problem(7, phases=40)
    solution = contact_problem.at_loads(np.array([2000.0]))
    load, parts = solution.load[0, :, 0], contact_problem.compliance
    assert np.all(load >= 0.0)
    assert 0 < (load == 0.0).sum() < load.size
    pressed = load * (parts.local - parts.logarithm * np.log(np.maximum(load, 1e-300)))
    inner = np.einsum("pij,pj->pi", parts.structure, load) + pressed
    distance = contact_problem.gaps[:, 0] + inner - solution.approach[0][:, None]
    assert np.abs(distance[load > 0.0]).max() < 1e-15
    assert distance[load == 0.0].min() > -1e-15


def test_force_at_an_approach_is_the_inverse_and_its_slope_the_tangent():
    contact_problem = problem(3)
    totals = np.array([300.0, 1000.0, 5000.0])
    solution = contact_problem.at_loads(totals)
    force, slope = contact_problem.at_approach(solution.approach)
    assert force == pytest.approx(np.broadcast_to(totals[:, None], force.shape), rel=1e-10)
    assert slope == pytest.approx(solution.tangent, rel=1e-9)
    step = 1e-10
    above, below = (
        contact_problem.at_approach(solution.approach + sign * step)[0] for sign in (1.0, -1.0)
    )
    assert (above - below) / (2.0 * step) == pytest.approx(solution.tangent, rel=1e-4)
    assert contact_problem.tangent_at(solution.load[1, :, 0]) == pytest.approx(
        solution.tangent[1], rel=1e-10
    )


def test_approaches_of_another_number_of_phases_never_reach_a_kernel():
    contact_problem = problem(4)
    for ask, name in ((contact_problem.at_approach, "approach"), (contact_problem.pickups, "most")):
        for wrong in (np.zeros(2), np.zeros((1, 2)), np.zeros((2, 2, 2))):
            with pytest.raises(InputError, match=rf"{name} has the shape \({wrong.shape[0]},"):
                ask(wrong)
    for ask, shape in ((contact_problem.at_approach, (1, 6)), (contact_problem.pickups, 6)):
        with pytest.raises(InputError, match="= -inf m"):
            ask(np.full(shape, -np.inf))


def test_below_the_smallest_gap_there_is_no_force():
    contact_problem = problem(4)
    force, slope = contact_problem.at_approach(contact_problem.least_gap[None] - 1e-9)
    assert not force.any()
    assert not slope.any()


def test_a_pair_begins_to_carry_at_its_stated_gap():
    contact_problem = problem(5, phases=20)
    most = contact_problem.at_loads(np.array([300.0])).approach[0]
    begin = contact_problem.pickups(most)
    inside = begin < most[:, None] * (1.0 - 1e-9)
    assert 20 < inside.sum() < inside.size
    for p, i in np.argwhere(inside):
        parts = contact_problem.compliance
        arguments = parts.structure[p], parts.local[p], parts.logarithm, contact_problem.gaps[p, 0]
        later = plain_loads(*arguments, begin[p, i] * (1.0 + 1e-5) + 1e-12)
        earlier = plain_loads(*arguments, begin[p, i] * (1.0 - 1e-5) - 1e-12)
        assert later[i] > 0.0
        assert earlier[i] == 0.0


def test_stored_energy_is_the_integral_of_the_force():
    contact_problem = problem(8)
    most = contact_problem.at_loads(np.array([4000.0])).approach[0]
    nodes, weights = np.polynomial.legendre.leggauss(400)
    reach = 0.5 * (nodes[:, None] + 1.0) * most
    work = 0.5 * most * (weights @ contact_problem.at_approach(reach)[0])
    parts, load = (
        contact_problem.compliance,
        contact_problem.at_loads(np.array([4000.0])).load[0, :, 0],
    )
    bent = 0.5 * np.einsum("pi,pij,pj->p", load, parts.structure, load)
    bracket = parts.local - parts.logarithm * np.log(np.maximum(load, 1e-300))
    pressed = 0.5 * load**2 * bracket - 0.25 * parts.logarithm * load**2
    lifted = (contact_problem.gaps[:, 0] * load).sum(axis=1)
    # Work done on flanks that had a gap to close is done without force: gaps store nothing.
    stored = WIDTH * (bent + pressed.sum(axis=1))
    assert lifted.max() > 0.0
    assert work == pytest.approx(stored, rel=2e-5)


def test_a_contact_as_wide_as_the_teeth_is_reported():
    contact_problem = problem(9)
    with pytest.raises(ComputationError, match="as wide as the teeth are thick"):
        contact_problem.at_loads(np.array([1e12]))


def test_a_soft_pair_that_is_touched_first_does_not_lead_astray():
    structure = np.diag([1e-4, 1e-10])[None]
    logarithm = 2.0 * 0.91 / (np.pi * 206e9)
    compliance = Compliance(structure, logarithm * np.full((1, 2), 17.0), logarithm)
    contact_problem = ContactProblem(
        NOWHERE, compliance, np.array([[[0.0, 3e-6]]]), np.array([[[WIDTH]]])
    )
    solution = contact_problem.at_loads(np.array([1e-3, 4000.0]))
    load = solution.load[1, 0, 0]
    assert WIDTH * load.sum() == pytest.approx(4000.0, rel=1e-11)
    assert load[1] > 1e4 * load[0] > 0.0
    arguments = structure[0], compliance.local[0], logarithm
    approach = plain_approach(
        *arguments, contact_problem.gaps[0], contact_problem.widths[0, :, 0], 4000.0
    )
    assert solution.approach[1, 0] == pytest.approx(approach, rel=1e-9)


def test_an_approach_far_from_the_first_gap_carries_the_whole_load():
    """There the force of stiff pairs changes by more than rounding within its own limit."""
    contact_problem = problem(3, phases=20_000)
    # A soft film that begins to carry millimetres before the others, and stiff ones.
    contact_problem.compliance.structure[:, 0, 0] += 5e-5
    contact_problem.gaps[:, :, 1:] += np.linspace(1e-5, 7e-3, 20_000)[:, None, None]
    solution = contact_problem.at_loads(np.array([100.0, 1900.0]))
    total = contact_problem.forces(solution.load).sum(axis=2)
    assert total == pytest.approx(np.array([[100.0], [1900.0]]) * np.ones(20_000), rel=1e-8)


@pytest.mark.parametrize("kernel", [solve_loads, solve_deflections])
def test_one_compiled_function_serves_widths_of_every_shape(kernel):
    few = problem(2, phases=3, slices=2)
    every = replace(few, widths=np.broadcast_to(few.widths, few.gaps.shape))
    of_each = replace(few, widths=every.widths.copy())
    solved = [each.at_loads(np.array([900.0])) for each in (few, every, of_each)]
    forces = [each.at_approach(solved[0].approach)[0] for each in (few, every, of_each)]
    assert solved[0].load.tolist() == solved[1].load.tolist() == solved[2].load.tolist()
    assert forces[0].tolist() == forces[1].tolist() == forces[2].tolist()
    for signature in kernel.signatures:
        assert all(kind.mutable for kind in signature if isinstance(kind, numba.types.Array))
