"""Lyapunov exponents of structures that turn freely: the free rotation is named and left out.

Closed forms: a pair of inertias whose only spring is the tooth contact vibrates like one mass,
that of both in series; a damping matrix proportional to the mass brakes its free rotation at
exactly that rate; the eigenvalues of a linear structure are its exponents.
"""

from __future__ import annotations

import numpy as np
import pytest

from known_systems import hysteresis_system
from tribodyn.analysis import lyapunov_exponents
from tribodyn.dynamics import Contact, System

SHORT = {"cycles": 40, "transient": 60, "steps": 128}
#: Moments of inertia and base radii of a torsional pair, stiffness and frequency of its contact.
INERTIA, RADIUS, STIFFNESS, FREQUENCY = (2.0, 6.0), (1.0, 1.5), 8.0, 0.9
SERIES = 1.0 / sum(r * r / j for r, j in zip(RADIUS, INERTIA, strict=True))
NAMES = ["pinion_theta", "wheel_theta"]


def pair(damping=0.0, brake=((0.0, 0.0), (0.0, 0.0)), ripple=0.0, **contact):
    """Torsional pair: two inertias, joined by the tooth contact alone."""
    mesh = Contact(
        [RADIUS[0], -RADIUS[1]],
        stiffness=lambda p: STIFFNESS * (1.0 + ripple * np.cos(2.0 * np.pi * p)),
        damping=damping,
        **contact,
    )
    force = [RADIUS[0], -RADIUS[1]]
    return System(np.diag(INERTIA), brake, np.zeros((2, 2)), force, [mesh], names=NAMES)


def eigenvalues(system):
    """Real parts of the eigenvalues of a linear structure whose contacts stay closed."""
    mass, damping, stiffness = (
        np.array(each) for each in (system.mass, system.damping, system.stiffness)
    )
    for contact in system.contacts:
        along = np.asarray(contact.direction)
        stiffness = stiffness + float(contact.stiffness(0.0)) * np.outer(along, along)
        damping = damping + float(contact.damping) * np.outer(along, along)
    inverse, size = np.linalg.inv(mass), len(mass)
    first = np.hstack((np.zeros((size, size)), np.eye(size)))
    second = np.hstack((-inverse @ stiffness, -inverse @ damping))
    values, vectors = np.linalg.eig(np.vstack((first, second)))
    return values, vectors


def test_largest_exponent_of_a_free_pair_is_that_of_its_vibration():
    damping = 0.3
    result = lyapunov_exponents(pair(damping, ripple=0.1), FREQUENCY, **SHORT)
    rate = -0.5 * damping / SERIES
    assert result.largest == pytest.approx(rate, rel=1e-9)
    assert result.vibrating == pytest.approx([rate, rate], rel=1e-9)
    assert result.exponents == pytest.approx([0.0, 0.0, rate, rate], rel=1e-9)
    assert result.free_rotation.tolist() == [True, True, False, False]
    assert result.rotating == ("pinion_theta", "wheel_theta")
    rate_text = f"{rate:.4g} 1/s"
    assert f"largest {rate:.5g} +-" in repr(result)
    assert "free rotation of pinion_theta, wheel_theta left out: 2 exponents, 0, 0 1/s" in repr(
        result
    )
    figure = result.plot()
    assert rate_text in figure.layout.title.text
    assert "free rotation, left out" in [trace.name for trace in figure.data]
    table = result.to_xarray()
    assert table.attrs["largest"] == result.largest
    assert table.free_rotation.values.tolist() == result.free_rotation.tolist()
    assert table.attrs["rotating"] == "pinion_theta, wheel_theta"


@pytest.mark.parametrize("rate", [0.02, 0.9])
def test_free_rotation_that_is_braked_in_proportion_to_the_mass(rate):
    """The braked rotation is left out whether it dies away slower or faster than the vibration."""
    brake, damping = rate * np.diag(INERTIA), 0.3
    result = lyapunov_exponents(pair(damping, brake, ripple=0.1), FREQUENCY, **SHORT)
    vibration = -0.5 * (damping / SERIES + rate)
    assert result.free == 1
    assert result.exponents[result.free_rotation] == pytest.approx([0.0, -rate], rel=1e-8)
    assert result.largest == pytest.approx(vibration, rel=1e-8)
    assert result.vibrating_growth.shape[1] == 2
    assert f"2 exponents, 0, {-rate:.4g} 1/s" in repr(result)


def test_free_rotation_that_one_damper_to_the_ground_brakes():
    """A damper of the wheel alone also damps the vibration: eigenvectors say which is which."""
    system = pair(0.3, [[0.0, 0.0], [0.0, 0.1]])
    result = lyapunov_exponents(system, FREQUENCY, **SHORT)
    values, _ = eigenvalues(system)
    real = np.abs(values.imag) < 1e-9
    assert np.sort(result.exponents[result.free_rotation]) == pytest.approx(
        np.sort(values.real[real]), abs=1e-9
    )
    assert result.vibrating == pytest.approx(values.real[~real], rel=1e-8)


def test_two_free_rotations_of_a_machine():
    """Two drives in one structure, and a shaft in the first of them."""
    inertia = np.diag([3.0, *INERTIA, 1.0, 4.0])
    shaft = np.zeros((5, 5))
    shaft[:2, :2] = 5.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    meshes = [
        Contact([0.0, 1.0, -1.5, 0.0, 0.0], stiffness=lambda p: 8.0 + 0.0 * p, damping=0.3),
        Contact([0.0, 0.0, 0.0, 1.0, -2.0], stiffness=lambda p: 3.0 + 0.0 * p, damping=0.2),
    ]
    force = [1.0, 0.0, -1.5, 1.0, -2.0]
    names = ["motor_theta", "pinion_theta", "wheel_theta", "small_theta", "large_theta"]
    system = System(inertia, 0.02 * shaft, shaft, force, meshes, names=names)
    result = lyapunov_exponents(system, FREQUENCY, **SHORT)
    values = np.sort(eigenvalues(system)[0].real)[::-1]
    assert result.free == 4
    assert int(result.free_rotation.sum()) == 4
    assert result.rotating == tuple(names)
    # The double zeros of a defective matrix come to the square root of rounding.
    assert result.vibrating == pytest.approx(values[np.abs(values) > 1e-6], rel=1e-6)
    assert result.largest < -0.01


def test_nothing_is_left_out_where_nothing_turns_freely():
    result = lyapunov_exponents(hysteresis_system(), 0.14, cycles=40, transient=200, steps=128)
    assert not result.free_rotation.any()
    assert result.rotating == ()
    assert result.left_out == ""
    assert result.largest == result.exponents[0]
    assert "free rotation" not in repr(result)
    assert "free rotation, left out" not in [trace.name for trace in result.plot().data]


def test_exponent_of_zero_without_a_free_rotation_stays():
    """An undamped vibration has exponents of zero, as a motion at a bifurcation has."""
    spring = System([[2.0]], [[0.0]], [[18.0]], [0.0], names=["x"])
    result = lyapunov_exponents(spring, 1.3, start=([1.0], [0.0]), **SHORT)
    assert result.exponents == pytest.approx([0.0, 0.0], abs=1e-9)
    assert result.largest == result.exponents[0]
    free = lyapunov_exponents(pair(0.0), FREQUENCY, start=([0.5, 0.0], [0.0, 0.0]), **SHORT)
    assert int(free.free_rotation.sum()) == 2
    assert free.vibrating == pytest.approx([0.0, 0.0], abs=1e-9)


def chaotic_pair():
    """Two masses whose relative motion is that of `test_lyapunov_exponents.chaotic_system`."""
    along = np.array([1.0, -1.0])
    c, f, wave, turn = 0.04, 0.05, 0.15, 0.7

    def force(phase):
        return (f + wave * np.cos(2.0 * np.pi * phase))[:, None] * along

    play = Contact(along, stiffness=1.0, gap=1.0)
    damping = c * np.outer(along, along)
    return System(2.0 * np.eye(2), damping, np.zeros((2, 2)), force, [play]), turn / (2.0 * np.pi)


def test_chaos_of_a_free_pair_is_that_of_the_mass_in_series():
    """The largest exponent stays that of an independent computation, 0.0962 +- 0.0004 1/s."""
    system, frequency = chaotic_pair()
    start = ([0.65, -0.65], [0.05, -0.05])
    result = lyapunov_exponents(
        system, frequency, start=start, cycles=800, transient=200, steps=96, verdict=False
    )
    assert result.chaotic
    assert abs(result.largest - 0.096214) < 3.5 * np.hypot(0.00036, result.largest_error)
    assert result.free_rotation.tolist() == [False, True, True, False]
    assert 1.6 < result.kaplan_yorke_dimension < 1.8
