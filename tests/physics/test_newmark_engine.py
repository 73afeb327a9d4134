"""Newmark's scheme keeps its second order over events, separations and impacts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from known_marches import compile_newmark, march_newmark
from known_systems import EVENTS, MESH_FREQUENCY, friction_vector, reference_system
from plain.newmark import newmark_plain
from tribodyn.analysis import mesh_harmonics
from tribodyn.dynamics import (
    FZG12_MESH_FREQUENCY,
    Contact,
    LoadFriction,
    System,
    fzg12,
    steady_state,
)
from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.time.response import build_response
from tribodyn.errors import InputError


def end_states(system, frequency, start, cycles, numbers):
    period = np.array([1.0 / frequency])
    return [
        march_newmark(compile_newmark(system, frequency, steps), period, start, cycles)[0]
        for steps in numbers
    ]


def errors(system, frequency, start, cycles, numbers, reference_steps=8192):
    start = np.asarray(start, dtype=float)[None]
    compiled = compile_for(system, frequency, reference_steps)
    exact = march(compiled, np.array([1.0 / frequency]), start, cycles)[0]
    ends = end_states(system, frequency, start, cycles, numbers)
    return np.array([np.abs((end - exact) / np.abs(exact)).max() for end in ends])


def rectangular(events):
    contact = Contact(
        [1.0], stiffness=lambda phase: np.where(phase < 1 / 3, 1.6, 0.8), events=events
    )
    return System([[1.0]], [[0.02]], [[0.0]], [0.5], [contact])


def test_order_with_jumps_of_the_stiffness():
    numbers = (128, 256, 512, 1024)
    orders = errors(rectangular((1 / 3,)), 0.15, [1.0, 0.2], 8, numbers)
    assert np.log2(orders[:-1] / orders[1:]) == pytest.approx(2.0, abs=0.05)
    with pytest.raises(InputError, match=r"jumps by 0.8 at the mesh phase 0.33333"):
        compile_for(rectangular((0.0,)), 0.15, 512)


@pytest.mark.parametrize(("damping", "in_gap"), [(0.0, False), (0.4, False), (0.4, True)])
def test_order_with_separations_and_impacts(damping, in_gap):
    contact = Contact(
        [1.0],
        stiffness=lambda phase: 1.0 + 0.2 * np.cos(2 * np.pi * phase),
        damping=damping,
        gap=1.0,
        damping_in_gap=in_gap,
    )
    system = System([[1.0]], [[0.05]], [[0.0]], [0.3], [contact])
    start = [2.8, 0.0]
    period = np.array([1.0 / 0.14])
    record = np.empty((6 * 512 + 1, 2, 1))
    compiled = compile_for(system, 0.14, 512)
    march(compiled, period, np.array([start]), 6, record=record)
    crossings = np.count_nonzero(np.diff(record[:, 0, 0] > 1.0))
    assert crossings >= 2
    orders = errors(system, 0.14, start, 6, (256, 512, 1024, 2048))
    assert np.log2(orders[:-1] / orders[1:]) == pytest.approx(2.0, abs=0.1)


def test_gear_pair_with_friction_equals_runge_kutta_in_the_limit():
    start = 1e-5 * np.random.default_rng(1).standard_normal(12)
    system = reference_system(0.1, gap=1e-5)
    orders = errors(system, 900.0, start, 2, (2048, 4096, 8192), 16384)
    assert np.log2(orders[:-1] / orders[1:]) == pytest.approx(2.0, abs=0.2)


def marched(system, frequency, steps, cycles, first):
    compiled = compile_newmark(system, frequency, steps)
    period, state = np.array([1.0 / frequency]), np.concatenate(first)[None]
    state = march_newmark(compiled, period, state, cycles)
    record = np.empty((steps + 1, 2 * system.size, 1))
    march_newmark(compiled, period, state, 1, record=record)
    return build_response(compiled, frequency, record[:, :, 0], np.zeros(system.size))


def test_marched_to_the_end_it_is_the_steady_state():
    system = reference_system(0.1)
    orbit = steady_state(system, MESH_FREQUENCY, steps=4096)
    exact = mesh_harmonics(orbit, orbit.fine.deflection[:, 0], 3)
    assert np.abs(exact) == pytest.approx([3.377101e-6, 1.734764e-6, 0.070281e-6], rel=2e-5)
    distances = []
    for steps in (1024, 2048, 4096):
        motion = marched(system, MESH_FREQUENCY, steps, 6, (orbit.position[0], orbit.velocity[0]))
        harmonics = mesh_harmonics(motion, motion.fine.deflection[:, 0], 3)
        distances.append(np.abs(harmonics - exact).max() / np.abs(exact[0]))
    assert np.log2(distances[1] / distances[2]) == pytest.approx(2.0, abs=0.1)
    assert distances[2] < 1e-4


def test_third_harmonic_of_the_rig():
    rig = fzg12()
    orbit = steady_state(rig, FZG12_MESH_FREQUENCY, steps=1024)
    motion = marched(rig, FZG12_MESH_FREQUENCY, 1024, 60, (orbit.position[0], orbit.velocity[0]))
    exact, computed = (
        np.abs(mesh_harmonics(each, each.fine.deflection[:, 0], 5)) for each in (orbit, motion)
    )
    assert computed[2] == pytest.approx(exact[2], rel=6e-4)
    assert computed == pytest.approx(exact, rel=2e-3)


def test_load_dependent_friction_preserves_the_order():
    friction = LoadFriction(
        direction=lambda phase: friction_vector(phase, 1.0),
        coefficients=[0.08, 0.03, -0.01],
        load=2500.0,
        limit=1.5,
        events=EVENTS,
    )
    system = replace(reference_system(0.0, gap=1e-5), frictions=(friction,))
    start = 1e-5 * np.random.default_rng(0).standard_normal(12)
    start[2] += 1.5e-3
    compiled = compile_newmark(system, MESH_FREQUENCY, 192)
    record, period = np.empty((193, 12, 1)), np.array([1.0 / MESH_FREQUENCY])
    march_newmark(compiled, period, start[None], 1, record=record)
    plain = newmark_plain(system, compiled.grid, compiled.nodes, MESH_FREQUENCY, 1, start)
    assert np.abs((record[:, :, 0] - plain) / np.abs(plain).max(axis=0)).max() < 1e-11
    orders = errors(system, MESH_FREQUENCY, start, 2, (4096, 8192, 16384), 16384)
    assert np.log2(orders[:-1] / orders[1:]) == pytest.approx(2.0, abs=0.15)
