"""A motion is bit for bit the same alone and in any batch, on any number of threads."""

import os
from dataclasses import replace

import numpy as np
import pytest

from known_random_machines import random_machine
from known_systems import everything_varies, hysteresis_system, reference_system
from tribodyn.analysis import basins, bifurcation, parameter_map
from tribodyn.dynamics import LaneParameters, simulate_ensemble

TURN = 2.0 * np.pi
PARTS = dict.fromkeys(("friction", "turning", "load_friction", "gyroscopic", "jumps"), True)
FACTORS = ("stiffness", "damping", "friction", "error", "gap", "force")


def numbers(ensemble, lane):
    """All figures of one trajectory."""
    kinds = ensemble.deflection, ensemble.contact_force, ensemble.acceleration
    parts = [np.ravel(each[lane]) for kind in kinds for each in vars(kind).values()]
    return np.concatenate([ensemble.position[lane], ensemble.velocity[lane], *parts])


@pytest.mark.parametrize("method", ["rk4", "dormand-prince", "newmark"])
@pytest.mark.parametrize("system", [everything_varies(), random_machine(5, gap=0.2, **PARTS)])
def test_a_trajectory_is_that_of_an_ensemble(system, method):
    generator = np.random.default_rng(2)
    lanes, options = 17, {"steps": 64, "averaged": 1, "method": method}
    frequency = generator.uniform(0.08, 0.2, lanes)
    start = 0.3 * generator.normal(size=(2, lanes, system.size))
    extra = 0.1 * generator.normal(size=(lanes, system.size))
    scales = generator.uniform(0.8, 1.2, (len(FACTORS), lanes))
    scales[:, ::3] = 1.0

    def march(index, threads=None):
        factors = {f"{name}_scale": row[index] for name, row in zip(FACTORS, scales, strict=True)}
        return simulate_ensemble(
            system, frequency[index], 3, tuple(start[:, index]), extra_force=extra[index],
            parameters=LaneParameters(**factors), threads=threads, **options,
        )  # fmt: skip

    whole = march(np.arange(lanes), threads=1)
    for index in ([0], [1], [4, 9], [2, 3, 5, 7, 11], np.arange(lanes)[::-1]):
        part = march(np.asarray(index))
        for place, lane in enumerate(index):
            np.testing.assert_array_equal(numbers(part, place), numbers(whole, lane))


def test_a_motion_of_a_map_is_that_alone():
    # A free rotation, whose torques friction unbalances, and teeth that separate.
    pair = replace(
        reference_system(0.05, gap=20e-6, damping=100.0), balance=[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    )
    frequency, scales = np.array([1500.0, 2400.0, 3300.0]), np.array([0.05, 0.3, 1.0])
    options = {"transient": 64, "cycles": 2}

    def figures(rows, columns):
        over = (("mesh_frequency", frequency[rows]), ("force_scale", scales[columns]))
        result = parameter_map(pair, over=over, **options)
        assert result.complete
        return np.stack([result.rms, result.contact_loss_share, result.period])

    whole = figures([0, 1, 2], [0, 1, 2])
    assert whole[1].max() > 0.01
    for rows, columns in (([0], [0]), ([2], [1]), ([1], [0, 1, 2]), ([0, 2], [2, 1])):
        np.testing.assert_array_equal(figures(rows, columns), whole[:, rows][:, :, columns])


@pytest.mark.parametrize("threads", [1, 3])
def test_diagrams_and_basins_do_not_depend_on_threads(threads, monkeypatch):
    frequency = np.linspace(0.06, 0.11, 40)

    def figures():
        diagram = bifurcation(
            hysteresis_system(), frequency, transient=64, cycles=8, keep=8, verdict=False
        )
        plane = basins(
            hysteresis_system(), 0.6 / TURN, between=((-3.0, 3.0), (-3.0, 3.0)), points=(6, 6)
        )
        rows = [value for value in vars(diagram).values() if isinstance(value, np.ndarray)]
        return [*rows, plane.attractor, *(each.position for each in plane.attractors)]

    reference = figures()
    monkeypatch.setattr(os, "cpu_count", lambda: threads)
    for one, other in zip(figures(), reference, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_system_of_an_ensemble_moves_as_alone_with_adaptive_steps():
    systems = [
        reference_system(friction, gap=2e-5, damping=300.0) for friction in (0.1, 0.04, 0.07)
    ]
    systems.append(replace(systems[0], contacts=[replace(systems[0].contacts[0], gap=1e-5)]))
    generator = np.random.default_rng(6)
    start = 2e-5 * generator.normal(size=(2, 8, 6))

    def march(index, threads=None):
        return simulate_ensemble(
            [systems[lane % 4] for lane in index], 2600.0, 3, tuple(start[:, index]),
            steps=64, method="dormand-prince", threads=threads,
        )  # fmt: skip

    together = march(np.arange(8), threads=1)
    assert together.contact_loss_share.max() > 0.01
    for index in ([0], [3], [5, 2], [7, 6, 1, 0, 3]):
        part = march(np.asarray(index), threads=2)
        for place, lane in enumerate(index):
            np.testing.assert_array_equal(numbers(part, place), numbers(together, lane))
