"""Torque ripple, speed fluctuation and random load against closed forms of linear drives."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System, harmonic_balance, run_up
from tribodyn.errors import InputError
from tribodyn.faults import (
    DrivenSystem,
    RandomLoad,
    ShaftExcitation,
    SpeedFluctuation,
    TorqueRipple,
    clock_cycles,
    drive,
)
from tribodyn.signals.run_up_orders import run_up_order_map

TEETH = {"pinion": 16, "wheel": 24}
RADIUS, INERTIA = np.array([0.034, 0.051]), np.array([2e-3, 6e-3])
STIFFNESS, DAMPING, MESH = 3e7, 400.0, 240.0


def pair(**contact: Any) -> System:
    mesh = Contact(RADIUS * [1.0, -1.0], STIFFNESS, damping=DAMPING, **contact)
    torque = 90.0 * np.array([1.0, -1.5])
    return System(np.diag(INERTIA), np.zeros((2, 2)), np.zeros((2, 2)), torque, [mesh])


def driven(system: System, *excitations: ShaftExcitation, cycles: int = 1) -> DrivenSystem:
    rotation = [2.0 * math.pi / teeth for teeth in TEETH.values()]
    return drive(
        system, cycles, excitations, mesh_frequency=MESH, teeth=TEETH,
        coordinates={"pinion": 0, "wheel": 1}, rotation=rotation,
    )  # fmt: skip


def lines_of_motion(drive: DrivenSystem, rate: int = 64) -> tuple[np.ndarray, np.ndarray]:
    """Angular frequencies, and lines of both rotations with that of the whole drive."""
    steps = rate * drive.cycles // drive.system.cycles
    response = harmonic_balance(drive.system, MESH / drive.cycles, steps=steps)
    fine = response.fine
    at = np.arange(rate * drive.cycles) / (rate * drive.cycles)
    angle = np.stack([np.interp(at, fine.phase, q, period=1.0) for q in fine.position.T], axis=1)
    angle += np.multiply.outer(drive.lead(at), drive.rotation)
    lines = 2.0 * np.fft.rfft(angle, axis=0) / len(at)
    return 2.0 * np.pi * np.arange(len(lines)) * MESH / drive.cycles, lines


def compliance(omega: np.ndarray) -> np.ndarray:
    """Rotations of both gears per torque on the pinion, (k, 2)."""
    direction = RADIUS * [1.0, -1.0]
    mesh = (STIFFNESS + 1j * omega * DAMPING)[:, None, None] * np.outer(direction, direction)
    dynamic = mesh - (omega**2)[:, None, None] * np.diag(INERTIA)
    return np.linalg.solve(dynamic, np.broadcast_to([[1.0], [0.0]], (omega.size, 2, 1)))[..., 0]


def test_a_ripple_forces_the_torsional_oscillator() -> None:
    ripple = TorqueRipple(orders=(2.0, 48.0), torques=(3.0, 0.4), phases=(0.3, -1.1))
    drive = driven(pair(), ripple)
    assert drive.cycles == 8  # half a turn of the pinion
    omega, lines = lines_of_motion(drive, 512)
    for line, torque in ((1, 3.0 * np.exp(0.3j)), (24, 0.4 * np.exp(-1.1j))):
        expected = compliance(omega[[line]])[0] * torque
        np.testing.assert_allclose(lines[line], expected, rtol=2e-4)
        # amplitude and phase of m x'' + c x' + k x = m r T/J of the compression
        mass = 1.0 / (RADIUS**2 / INERTIA).sum()
        forced = mass * RADIUS[0] * torque / INERTIA[0]
        oscillator = STIFFNESS + 1j * omega[line] * DAMPING - mass * omega[line] ** 2
        compression = lines[line] @ (RADIUS * [1.0, -1.0])
        assert abs(compression / (forced / oscillator) - 1.0) < 1e-3
    others = np.delete(lines, [0, 1, 24], axis=0)
    assert np.abs(others).max() < 1e-5 * np.abs(lines[24]).max()
    # what the ripple feeds in, the damper takes
    speed = 1j * omega[:, None] * lines
    torques = np.zeros(omega.size, dtype=complex)
    torques[[1, 24]] = 3.0 * np.exp(0.3j), 0.4 * np.exp(-1.1j)
    power = 0.5 * (torques.conj() * speed[:, 0]).real.sum()
    lost = 0.5 * DAMPING * (np.abs(speed[1:] @ (RADIUS * [1.0, -1.0])) ** 2).sum()
    assert power > 0.0
    assert abs(power / lost - 1.0) < 2e-3


def test_a_speed_fluctuation_turns_the_drive_and_modulates_the_mesh() -> None:
    fluctuation = SpeedFluctuation(gear="wheel", orders=(1.0,), fluctuations=(0.02,))
    error = 2e-6
    system = pair(error=lambda phase: error * np.cos(2.0 * np.pi * phase))
    drive = driven(system, fluctuation)
    assert drive.cycles == 24
    omega, lines = lines_of_motion(drive)
    mean = omega[1] * np.array([1.5, 1.0])
    # below the natural frequency the gears turn as one, in the ratio of their speeds
    rotation = 0.02 * mean / (1j * omega[1])
    np.testing.assert_allclose(lines[1], rotation, rtol=2e-4)
    # phase modulation: a deviation of index m has the lines J_n(m) about the mesh frequency
    from scipy.special import jv

    clock = np.arange(4096) / 4096
    seen = 2.0 * np.fft.rfft(drive.system.contacts[0].error(clock)) / 4096 / error  # type: ignore[operator]
    index = 24 * 0.02
    for side in range(-3, 4):
        assert abs(abs(seen[24 + side]) - abs(jv(side, index))) < 1e-12


def test_events_stand_where_the_mesh_reaches_them() -> None:
    fluctuation = SpeedFluctuation(orders=(1.0, 3.0), fluctuations=(0.05, 0.02))

    def jumping(phase: np.ndarray) -> np.ndarray:
        return np.where(phase < 0.37, 2e7, 3e7)

    mesh = Contact(RADIUS * [1.0, -1.0], jumping, damping=DAMPING, events=(0.0, 0.37))
    system = System(np.diag(INERTIA), np.zeros((2, 2)), np.zeros((2, 2)), [90.0, -135.0], [mesh])
    drive = driven(system, fluctuation)
    events = np.array(drive.system.contacts[0].events)
    assert events.size == 2 * drive.cycles == 32
    place = drive.cycles * events + drive.lead(events) - drive.lead(0.0)
    distance = np.abs(place[:, None] % 1.0 - [0.0, 0.37, 1.0]).min(axis=1)
    assert distance.max() < 1e-12
    assert harmonic_balance(drive.system, MESH / drive.cycles, steps=8 * 64).converged


def test_a_random_load_has_its_density_and_the_drive_its_receptance() -> None:
    density = 0.01
    load = RandomLoad(frequencies=(100.0, 1100.0), densities=(density,) * 2, duration=0.5, seed=5)
    drive = driven(pair(), load)
    assert drive.cycles == 120
    omega, lines = lines_of_motion(drive)
    inside = np.flatnonzero((omega >= 2.0 * np.pi * 99.9) & (omega <= 2.0 * np.pi * 1100.1))
    receptance = compliance(omega[inside])[:, 1]
    torque = lines[inside, 1] / receptance
    spacing = omega[1] / (2.0 * np.pi)
    estimate = 0.5 * np.abs(torque) ** 2 / spacing / density  # chi squared of two degrees, mean 1
    assert abs(estimate.mean() - 1.0) < 3.0 / math.sqrt(inside.size)
    assert abs(estimate.std() - 1.0) < 0.2  # as an exponential distribution scatters
    output = 0.5 * np.abs(lines[inside, 1]) ** 2 / spacing
    expected = density * np.abs(receptance) ** 2
    for band in np.array_split(np.arange(inside.size), 10):
        ratio = (output[band] / expected[band]).mean()
        assert abs(ratio - 1.0) < 4.0 / math.sqrt(band.size)
    outside = np.setdiff1d(np.arange(1, omega.size), inside)
    assert np.abs(lines[outside, 1]).max() < 1e-3 * np.abs(lines[inside, 1]).max()


def test_orders_of_a_ripple_stand_still_in_the_order_map_of_a_run_up() -> None:
    torque, order = 5.0, 3.0
    drive = driven(pair(), TorqueRipple(orders=(order,), torques=(torque,)))
    run = run_up(
        drive.system, ([0.0, 1.0], [MESH, 2.0 * MESH]), teeth=16, cycles=drive.cycles, samples=32
    )
    turned = run_up_order_map(run, "deflection", cycles=64)
    amplitude = turned.amplitude.T  # blocks in rows; the mean leaks into two orders
    strongest = turned.order[3 + np.argmax(amplitude[:, 3:], axis=1)]
    np.testing.assert_allclose(strongest, order, atol=1e-9)
    # far below the natural frequency the teeth carry their part of the torque
    mass = 1.0 / (RADIUS**2 / INERTIA).sum()
    at_rest = mass * RADIUS[0] * torque / INERTIA[0] / STIFFNESS
    line = amplitude[:, np.argmin(np.abs(turned.order - order))]
    np.testing.assert_allclose(line, at_rest, rtol=0.02)


def test_the_clock_is_that_of_gears_and_orders() -> None:
    def cycles(*orders: float, gear: Any = "pinion", of_teeth: int = 1) -> int:
        ripple = TorqueRipple(gear=gear, orders=orders, torques=(1.0,) * len(orders))
        return clock_cycles(of_teeth, [ripple], TEETH, MESH)

    assert cycles(16.0) == 1  # once a mesh cycle
    assert cycles(1.0) == 16
    assert cycles(0.5, 1.0) == 32
    assert cycles(1.0, gear="wheel", of_teeth=16) == 48
    assert cycles(4.0 / 3.0) == 12
    with pytest.raises(InputError, match="nearest order that does is 1/3"):
        cycles(0.33333)


def test_excitations_that_do_not_fit_are_refused() -> None:
    with pytest.raises(InputError, match="1 torques for 2 orders"):
        TorqueRipple(orders=(1.0, 2.0), torques=(1.0,))
    with pytest.raises(InputError, match="has no line"):
        RandomLoad(frequencies=(10.0, 11.0), densities=(1.0, 1.0), duration=0.1)
    with pytest.raises(InputError, match="two ends"):
        RandomLoad.of_rms(3.0, (10.0, 20.0, 30.0))
    with pytest.raises(InputError, match=r"fluctuates by .* of its mean"):
        driven(pair(), TorqueRipple(orders=(1.0,), torques=(20.0,)))
    held = System(np.eye(2), np.zeros((2, 2)), np.eye(2), [0.0, 0.0], pair().contacts)
    with pytest.raises(InputError, match="cannot turn freely"):
        driven(held, SpeedFluctuation(orders=(1.0,), fluctuations=(0.01,)))
