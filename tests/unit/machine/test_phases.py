"""Independent phases of the meshes of a machine."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from tribodyn.dynamics import harmonic_balance
from tribodyn.dynamics.harmonic.phase_grid import Follower, points_of
from tribodyn.machine import Bearing, Gear, Machine, Mesh, Operation, Section, Shaft, system
from tribodyn.machine.graph.clock import clock_of, phases_of
from tribodyn.machine.mesh import Turn


def waving(k, part):
    """Stiffness that varies smoothly over the mesh cycle."""
    return lambda phase: k * (1.0 + part * np.cos(2 * np.pi * phase))


def machine(*teeth: int) -> Machine:
    """Two stages on elastic shafts, with these numbers of teeth."""
    middle = Shaft([Section(0.12, 0.03)])
    gears = {
        "z1": Gear("input", 0.0, teeth[0], 0.03),
        "z2": Gear("middle", 0.03, teeth[1], 0.03),
        "z3": Gear("middle", 0.09, teeth[2], 0.04),
        "z4": Gear("output", 0.0, teeth[3], 0.04),
    }
    meshes = {
        "first": Mesh(("z1", "z2"), normal_module=2e-3, stiffness=waving(3e8, 0.15), gap=5e-5,
                      error=lambda phase: 2e-6 * np.cos(2 * np.pi * phase), damping_ratio=0.06),
        "second": Mesh(("z3", "z4"), normal_module=3e-3, stiffness=waving(5e8, 0.1), gap=6e-5,
                       offset=0.3, damping_ratio=0.06),
    }  # fmt: skip
    bearings = {
        "A": Bearing("middle", 0.0, radial_stiffness=3e8, axial_stiffness=1e8),
        "B": Bearing("middle", 0.12, radial_stiffness=3e8),
    }
    shafts = {"input": Shaft(), "middle": middle, "output": Shaft()}
    return Machine(
        shafts=shafts, gears=gears, meshes=meshes, bearings=bearings,
        operation=Operation("input", "output", speed=80.0, torque=100.0),
    )  # fmt: skip


@pytest.mark.parametrize("phases", [False, True])
def test_contacts_have_the_names_of_their_meshes(phases: bool) -> None:
    train = machine(19, 23, 17, 31)
    names = [contact.name for contact in system(train, phases=phases).contacts]
    assert names == [f"mesh {name}" for name in train.meshes]


def test_hunting_teeth_have_the_motion_of_their_period_in_few_points() -> None:
    train = machine(19, 23, 17, 31)
    assert train.clock.cycles == {"first": 23, "second": 17}
    assert train.phases.cycles == {"first": (1, 0), "second": (0, 1)}
    turns = 80.0 / (2 * np.pi)
    assert train.phases.frequency == pytest.approx((19 * turns, 19 / 23 * 17 * turns), rel=1e-14)
    clock = harmonic_balance(system(train), train.clock.frequency)
    phases = harmonic_balance(system(train, phases=True), train.phases.frequency)
    assert np.prod(phases.points) < len(clock.time)
    at = phases.at(clock.time)
    assert at.contact_force == pytest.approx(clock.contact_force, rel=2e-6)


def test_teeth_without_a_common_factor_cost_no_more() -> None:
    near, far = (
        harmonic_balance(system(each, phases=True), each.phases.frequency)
        for each in (machine(19, 23, 17, 31), machine(190, 229, 171, 311))
    )
    assert np.prod(far.points) <= 4 * np.prod(near.points)
    assert far.converged


def test_meshes_of_equal_or_simply_related_frequency_share_a_phase() -> None:
    rates = {"a": Fraction(27), "b": Fraction(27), "c": Fraction(81, 2), "d": Fraction(620, 51)}
    phases = phases_of(clock_of(rates, {}, 10.0), dict.fromkeys(rates, 1))
    assert phases.cycles == {"a": (2, 0), "b": (2, 0), "c": (3, 0), "d": (0, 1)}
    assert phases.frequency == pytest.approx((135.0, 6200 / 51))


def test_teeth_that_differ_repeat_after_their_period() -> None:
    rates = {"a": Fraction(27), "b": Fraction(13)}
    phases = phases_of(clock_of(rates, {}, 1.0).with_whole_periods({"a": 27}), {"a": 27, "b": 1})
    assert phases.frequency == pytest.approx((1.0, 13.0))


def test_meshes_of_one_frequency_share_a_phase_where_the_teeth_of_one_differ() -> None:
    """Otherwise the grids have both the phase of the teeth and that of the turning gear."""
    rates = {"sun": Fraction(21), "ring": Fraction(21), "other": Fraction(100, 7)}
    clock = clock_of(rates, {}, 1.0).with_whole_periods({"sun": 21})
    waves = [clock.cycles["ring"] * Fraction(2, 21), clock.cycles["ring"] * Fraction(1, 87)]
    phases = phases_of(clock, {"sun": 21, "ring": 1, "other": 1}, waves)
    assert phases.cycles == {"sun": (1, 0, 0), "ring": (21, 0, 0), "other": (0, 1, 0)}
    assert phases.frequency == pytest.approx((1.0, 100 / 7, 21 / 87))
    assert phases.turns == {waves[0]: (2, 0, 0), waves[1]: (0, 0, 1)}


def test_one_phase_is_the_clock() -> None:
    train = machine(20, 40, 20, 40)
    assert train.phases.cycles == {"first": (2,), "second": (1,)}
    phased = harmonic_balance(system(train, phases=True), train.phases.frequency)
    clock = harmonic_balance(system(train), train.clock.frequency)
    assert np.array_equal(phased.contact_force, clock.contact_force)


def deviating(*teeth: int, wave: bool = False) -> Machine:
    """Gears 15:21 before another stage, with deviations of the teeth of the first, second or both.

    A wave turns with the second gear.
    """
    train, period = machine(15, 21, 97, 31), math.lcm(*teeth)

    def error(phase):
        turned = 2 * np.pi * period * np.asarray(phase)
        return 2e-6 * np.cos(turned) + sum(1e-7 * z * np.sin(26 * turned / z + z) for z in teeth)

    turn = Turn(lambda phase: 3e-5 * np.cos(2 * np.pi * phase), Fraction(5, 21), "z2")
    first = replace(
        train.meshes["first"], period=period, error=error, turning=(turn,) if wave else (),
        stiffness=lambda phase: 3e8 * (1.0 + 0.15 * np.cos(2 * np.pi * period * phase)),
    )  # fmt: skip
    operation = replace(train.operation, speed=1500.0)
    return train._with(meshes={**train.meshes, "first": first}, operation=operation)


def test_a_gear_that_turns_with_teeth_that_differ_on_both_gears_has_no_phase_of_its_own() -> None:
    both = deviating(15, 21, wave=True).phases
    assert (both.cycles["first"], *both.turns.values()) == ((1, 0), (25, 0))


def test_grids_that_are_too_large_get_coarser_over_the_phases_of_others_alone() -> None:
    def points(period: int) -> list[list[int]]:
        stages = [Follower(6, (1, 0, 0), period), Follower(6, (0, 1, 0)), Follower(1, (0, 0, 1))]
        return points_of(stages, 0).tolist()

    assert points(22) == [[528, 12, 12], [88, 24, 12], [88, 12, 24]]
    assert points(638) == [[15312, 4, 4], [2552, 24, 4], [2552, 4, 24]]


@pytest.mark.slow
def test_deviations_of_both_gears_and_a_wave_add_up() -> None:
    """Flanks in contact are linear in their errors, whatever phases these are computed over."""
    time = np.linspace(0.0, 0.04, 400)

    def force(*teeth, wave=False):
        train = deviating(*teeth, wave=wave)
        motion = harmonic_balance(system(train, phases=True), train.phases.frequency)
        return motion.at(time).contact_force

    sound, all_errors = force(), force(15, 21, wave=True)
    parts = [force(15), force(21), force(wave=True)]
    assert all(np.abs(part - sound).max() > 0.01 * sound.mean() for part in parts)
    assert all_errors == pytest.approx(sum(parts) - 2 * sound, abs=2e-6 * sound.max())
