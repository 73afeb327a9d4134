"""Bearings with a clearance over two phases: as on one clock, and as time integration moves."""

from __future__ import annotations

import re
import warnings
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.known_systems import plain_slope

from tribodyn.dynamics import Contact, RadialClearance, System, clearance_motion
from tribodyn.errors import ComputationError

ON_CLOCK, OVER_PHASES = (3, 2), ((1, 0), (0, 1))
GAP = 20e-6


def two_stages(cycles: Any, load: float, supports: int = 1) -> tuple[System, list[RadialClearance]]:
    """Three gears, the first of which, or two, move in bearings with a clearance."""
    rows = np.zeros((2, 8))
    rows[0, :6] = np.cos(0.3), np.sin(0.3), 1.0, -np.cos(0.3), -np.sin(0.3), 1.0
    rows[1, 3:7] = np.cos(1.2), np.sin(1.2), -0.6, 1.0
    contacts = [
        Contact(
            row, lambda x, k=k, a=a: k * (1 + a * np.cos(2 * np.pi * x + a)), 1000.0,
            lambda x, a=a: 2e-6 * np.cos(2 * np.pi * x + 4 * a), 10e-6, cycles=of_mesh, offset=a,
        )
        for row, k, a, of_mesh in zip(rows, (3e8, 2e8), (0.15, 0.1), cycles, strict=True)
    ]  # fmt: skip
    springs = np.zeros((8, 8))
    springs[6:, 6:] = 4e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    pins = [RadialClearance(np.eye(8)[:2], 1e8, GAP)]
    if supports == 2:
        pins.append(RadialClearance(np.eye(8)[3:5], 1.5e8, 8e-6, offset=(1e-6, -2e-6)))
    else:
        springs[[3, 4], [3, 4]] = 1.8e8
    damping = np.diag([400.0, 400.0, 20.0, 3000.0, 3000.0, 30.0, 15.0, 20.0])
    mass, force = np.diag([2.0, 2.0, 1.2, 5.0, 5.0, 2.5, 1.5, 3.0]), np.zeros(8)
    force[2], force[7] = load, load / 0.6
    return System(mass, damping, springs, force, contacts), pins


def felt(system: System, pins: list[RadialClearance], position: Any) -> Any:
    """Motion along the meshes and in the bearings: all but the free rotation."""
    rows = [[each.direction for each in system.contacts], *(pin.directions for pin in pins)]
    return position @ np.concatenate(rows).T


def growing(cycles: Any, frequency: Any, *case: Any, **options: Any) -> tuple[Any, float]:
    """A motion, and the growth of its disturbances that is warned of; 0 without a warning."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        motion = clearance_motion(*two_stages(cycles, *case), frequency, **options)
    grown = [str(each.message) for each in caught if "unstable-orbit" in str(each.message)]
    assert len(caught) == len(grown) <= 1
    return motion, float(re.findall(r"(\S+), limit", grown[0])[0]) if grown else 0.0


@pytest.mark.parametrize(("load", "supports"), [(3000.0, 1), (3000.0, 2), (300.0, 1)])
def test_two_phases_are_one_clock(load: float, supports: int) -> None:
    system, pins = two_stages(OVER_PHASES, load, supports)
    motion, growth = growing(OVER_PHASES, (900.0, 600.0), load, supports)
    whole, multiplier = growing(ON_CLOCK, 300.0, load, supports, steps=400)
    assert (multiplier > 1.0) == (growth > 1.0) == (load < 1000.0)
    assert growth == pytest.approx(multiplier ** (1 / 3), rel=1e-3)  # three cycles of the first
    clock = whole.fine
    at = motion.at(clock.time)
    expected = felt(system, pins, clock.position)
    difference = np.abs(felt(system, pins, at.position) - expected).max()
    assert difference < 2e-7 * np.linalg.norm(expected, axis=1).max()
    force = np.hypot(*at.contact_force[:, 2:4].T)
    pushed = np.hypot(*pins[0].force(pins[0].displacement(clock.position)).T)
    np.testing.assert_allclose(force, pushed, atol=2e-5 * pushed.max())


def slope_of(system: System, pins: list[RadialClearance], frequencies: Any) -> Any:
    """Rates of the motion and its velocity with supports that have their exact law."""
    inverse, free = np.linalg.inv(system.mass), plain_slope(system, frequencies)

    def slope(time: float, state: Any) -> Any:
        rates = free(time, state)
        for pin in pins:
            held = np.asarray(pin.directions).T @ pin.force(pin.displacement(state[:8]))
            rates[8:] -= inverse @ held
        return rates

    return slope


@pytest.mark.slow
def test_a_disturbance_in_a_loose_bearing_grows_as_its_warning_says() -> None:
    system, pins = two_stages(OVER_PHASES, 300.0)
    frequencies = np.array([900.0, 600.0])
    motion, growth = growing(OVER_PHASES, frequencies, 300.0)
    times = np.arange(9) / 300.0
    at = motion.at(times)
    start = np.concatenate((at.position[0], at.velocity[0]))
    start[:8] += 1e-9 * np.random.default_rng(1).standard_normal(8)
    options = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-16, "t_eval": times}
    slope = slope_of(system, pins, frequencies)
    path = solve_ivp(slope, (0.0, times[-1]), start, **options).y[:8].T
    away = np.linalg.norm(felt(system, pins, path) - felt(system, pins, at.position), axis=1)
    assert away[-1] / away[-2] == pytest.approx(growth**3, rel=3e-3)
    _, multiplier = growing(ON_CLOCK, 300.0, 300.0, 1, steps=400)
    assert away[-1] / away[-2] == pytest.approx(multiplier, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("load", "supports"), [(3000.0, 2), (300.0, 1)])
def test_a_march_that_starts_on_the_motion_stays_on_it(load: float, supports: int) -> None:
    system, pins = two_stages(OVER_PHASES, load, supports)
    frequencies = np.array([900.0, 900.0 / np.sqrt(2.3)])
    motion, growth = growing(OVER_PHASES, frequencies, load, supports)
    assert (growth > 1.0) == (load < 1000.0)
    times = np.linspace(0.0, 40.0 / 900.0, 161)
    at, slope = motion.at(times), slope_of(system, pins, frequencies)
    begin = np.concatenate((at.position[0], at.velocity[0]))
    marched = solve_ivp(slope, times[[0, -1]], begin, "DOP853", times, rtol=1e-9, atol=1e-14)
    moved = felt(system, pins, at.position)
    left = felt(system, pins, marched.y[:8].T) - moved
    assert np.abs(left).max() < 2e-7 * np.linalg.norm(moved, axis=1).max()
    states = zip(times, np.hstack((at.position, at.velocity)), strict=True)
    rates = [slope(time, state)[8:] for time, state in states]
    np.testing.assert_allclose(
        felt(system, pins, at.acceleration), felt(system, pins, np.array(rates)), rtol=1e-6,
        atol=1e-6 * np.abs(rates).max(),
    )  # fmt: skip


@pytest.mark.slow
def test_a_body_that_jumps_in_its_clearance_is_refused_in_words() -> None:
    system, pins = two_stages(OVER_PHASES, 300.0, 2)
    with pytest.raises(ComputationError, match="no motion in the clearances of 2 supports"):
        clearance_motion(system, pins, (900.0, 600.0))
