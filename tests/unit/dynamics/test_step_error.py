"""Figures of an orbit besides its certified error: the cost of the step, and a lost balance."""

import warnings

import numpy as np
import pytest

from known_systems import MESH_FREQUENCY, reference_system
from tribodyn.dynamics import Contact, System, fzg12, steady_state
from tribodyn.dynamics.equations.nodes import evaluate_nodes, halved_nodes
from tribodyn.dynamics.equations.program import compile_system
from tribodyn.errors import ModelWarning

FULL = 2.0 * np.pi


def _impacting():
    """One mass whose contact opens and closes in every mesh cycle."""
    contact = Contact([1.0], lambda phase: 9e6 * (1 + 0.3 * np.cos(FULL * phase)), 60.0, gap=2e-4)
    return System([[1.0]], [[0.0]], [[0.0]], [1000.0], [contact])


def _quiet(*arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return steady_state(*arguments, **options)


@pytest.mark.parametrize(
    ("system", "frequency", "steps"),
    [(_impacting(), 200.0, 16), (_impacting(), 200.0, 32), (_impacting(), 200.0, 64),
     (reference_system(0.1), MESH_FREQUENCY, 512)],
)  # fmt: skip
def test_the_step_error_is_the_distance_to_the_equations(system, frequency, steps):
    """Against thirty-two times as many steps: fourth order leaves 1/16 of it at half the step."""
    orbit, fine = (_quiet(system, frequency, steps=count) for count in (steps, 32 * steps))
    lower = np.linalg.cholesky(np.asarray(system.mass))
    beat = FULL * frequency

    def states(motion):
        parts = [beat * motion.position @ lower] * (system.size == 1) + [motion.velocity @ lower]
        rows = np.hstack(parts)
        return np.stack([np.interp(orbit.time, motion.time, column) for column in rows.T], axis=1)

    truth = states(fine)
    distance = np.linalg.norm(states(orbit) - truth, axis=1).max()
    true = distance / np.linalg.norm(truth, axis=1).max()
    assert 0.5 * true < orbit.step_error < 2.0 * true
    assert orbit.error < 1e-8
    assert "step error" in repr(orbit)
    assert orbit.to_xarray().attrs["step_error"] == orbit.step_error


def test_a_coarse_step_is_reported():
    """Near the limit of the integrator an orbit is certified that is not that of the equations."""
    with pytest.warns(ModelWarning, match=r"\[step-size\].*Use 256 steps"):
        orbit = steady_state(reference_system(0.1), MESH_FREQUENCY, steps=128)
    assert orbit.converged
    assert orbit.step_error > 0.1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert steady_state(_impacting(), 200.0, steps=256).step_error < 1e-6


def test_the_step_error_costs_few_periods(monkeypatch):
    from tribodyn.dynamics.orbits.orbit_map import OrbitMap

    marched, follow = [], OrbitMap.follow

    def counted(mapping, y):
        marched.append(mapping.compiled.grid.steps)
        return follow(mapping, y)

    monkeypatch.setattr(OrbitMap, "follow", counted)
    steady_state(_impacting(), 200.0, steps=128)
    assert marched.count(256) <= 5


def _three_gears(torque):
    inertia, radius = np.array([1e-3, 2e-3, 3e-3]), (0.03, 0.05, 0.04)
    contacts = [Contact([radius[0], -radius[1], 0.0], 3e8, 1e3),
                Contact([0.0, radius[1], -radius[2]], 3e8, 1e3)]  # fmt: skip
    return System(np.diag(inertia), np.zeros((3, 3)), np.zeros((3, 3)), torque, contacts)


@pytest.mark.parametrize("last", [-50.0, 66.67, -66.0])
def test_an_unbalanced_drive_is_reported(last):
    """Rigid gears: the sum of the torques over their ratios is the inertia times acceleration."""
    ratio = np.array([1.0, 0.03 / 0.05, 0.03 / 0.04])
    turned = (50.0 + last * ratio[2]) / (np.array([1e-3, 2e-3, 3e-3]) @ ratio**2) * ratio
    with pytest.warns(ModelWarning, match=r"\[unbalanced-drive\]") as caught:
        steady_state(_three_gears([50.0, 0.0, last]), 500.0, steps=64)
    text = str(caught[0].message)
    name, value = text.split("speeds up, ")[1].split(" rad/s^2")[0].split(" by ")
    assert float(value) == pytest.approx(turned[int(name[1])], rel=1e-3)


def test_balanced_drives_are_not_reported():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert steady_state(_three_gears([50.0, 0.0, -66.67]), 500.0, steps=64).converged
        assert steady_state(fzg12(), 266.0, steps=512).converged


def test_rows_at_half_the_step_are_those_of_the_halved_grid():
    system = reference_system(0.1)
    grid, nodes, _ = compile_system(system, 64)
    fine, rows = halved_nodes(system, grid, nodes)
    assert fine.steps == 2 * grid.steps
    assert fine.left[::2] == pytest.approx(grid.left, abs=1e-15)
    for halved, expected in zip(rows, evaluate_nodes(system, fine), strict=True):
        assert halved == pytest.approx(
            expected, rel=1e-12, abs=1e-9 * np.abs(expected).max(initial=0.0)
        )
