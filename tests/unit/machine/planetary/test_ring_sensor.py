"""Sensor on the ring: sidebands of equally and unequally spaced planets."""

import numpy as np
import pytest

from known_planetary import LIN_PARKER
from tribodyn.errors import InputError
from tribodyn.machine import mesh_phases, ring_sensor_signal
from tribodyn.study import load_share_statistics

STEPS = 48


def forces(phases, harmonics, *, backwards=False):
    """Equal forces of all ring meshes with their phases."""
    offset = phases.ring if backwards else phases.ring_offset
    phase = np.arange(STEPS)[:, None] / STEPS + offset
    return 1.0 + sum(a * np.cos(2 * np.pi * k * phase + k) for k, a in harmonics.items())


def weight(angle):
    """Smooth weight with the Fourier coefficients 1/2^|m|."""
    return 1.0 + 2.0 * sum(0.5**m * np.cos(m * angle) for m in range(1, 8))


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize(("sun", "ring", "planets"), [(17, 61, 3), (18, 60, 3), (28, 62, 5)])
def test_equally_spaced_planets_leave_the_orders_that_are_multiples_of_their_number(
    sun, ring, planets, backwards
):
    phases = mesh_phases(sun_teeth=sun, ring_teeth=ring, planets=planets, sun_to_ring=0.3)
    harmonics = {1: 0.4, 2: 0.1}
    signal = ring_sensor_signal(
        ring_mesh_force=forces(phases, harmonics, backwards=backwards), ring_teeth=-ring,
        window=weight, sensor_angle=0.7, backwards=backwards,
    )  # fmt: skip
    for harmonic, amplitude in harmonics.items():
        for m, value in signal.sidebands(harmonic, 6).items():
            whole = (harmonic * ring + m) % planets == 0
            assert value == pytest.approx(planets * amplitude * 0.5 ** abs(m) * whole, abs=1e-9)


def test_sidebands_are_asymmetric_unless_the_teeth_of_the_ring_are_a_multiple():
    one = ring_sensor_signal(
        ring_mesh_force=forces(mesh_phases(sun_teeth=17, ring_teeth=61, planets=3), {1: 1.0}),
        ring_teeth=61, window=2 * np.pi / 3,
    ).sidebands(reach=2)  # fmt: skip
    assert one[0] < 1e-9  # McFadden and Smith: the mesh frequency itself is missing
    # Coefficients of a window of Hann over a third of a turn: sin(x)/x/(1 - x^2/pi^2), x = m pi/3.
    assert one[-1] / one[2] == pytest.approx(1.25, rel=1e-3)
    other = ring_sensor_signal(
        ring_mesh_force=forces(mesh_phases(sun_teeth=18, ring_teeth=60, planets=3), {1: 1.0}),
        ring_teeth=60, window=2 * np.pi / 3,
    ).sidebands(reach=3)  # fmt: skip
    assert other[0] > other[3] > 0.0
    assert other[3] == pytest.approx(other[-3], rel=1e-9)


def test_unequally_spaced_planets_add_up_with_the_phases_of_their_angles():
    angles = 2 * np.pi / 78 * np.array([0, 20, 39, 59])
    phases = mesh_phases(sun_teeth=17, ring_teeth=61, planets=4, angles=angles)
    bands = ring_sensor_signal(
        ring_mesh_force=forces(phases, {1: 1.0}), ring_teeth=61, angles=angles, window=weight
    ).sidebands(reach=5)
    for m, value in bands.items():
        # Each planet has the phase z_r psi by its mesh and m psi by its place.
        total = np.abs(np.exp(1j * (61 + m) * angles).sum())
        assert value == pytest.approx(0.5 ** abs(m) * total, abs=1e-9)


def test_wrong_forces_are_refused():
    with pytest.raises(InputError, match="ring_mesh_force"):
        ring_sensor_signal(ring_mesh_force=np.ones(5), ring_teeth=61)


def test_load_sharing_over_tolerances():
    stage = {**LIN_PARKER, "force_per_planet": 3000.0, "samples": 64, "seed": 1}
    spread = {"pin_errors": "normal 0 um +- 10 um"}
    four = load_share_statistics(planets=4, **spread, **{**stage, "sun_support": 0.0})
    floating = load_share_statistics(planets=3, **spread, **{**stage, "sun_support": 0.0})
    np.testing.assert_allclose(floating.load_factor, 1.0, atol=1e-9)
    assert four.load_factor.min() > 1.0
    assert four.quantile(0.95) > four.quantile(0.5) > 1.0
    # Shares answer linearly while all planets carry: twice the errors, twice the deviation.
    double = {"pin_errors": "normal 0 um +- 20 um"}
    wide = load_share_statistics(planets=4, **double, **{**stage, "sun_support": 0.0})
    carrying = (wide.share > 0.0).all(axis=1)
    expected = 2.0 * (four.share - 1.0)[carrying]
    np.testing.assert_allclose((wide.share - 1.0)[carrying], expected, atol=1e-6)
