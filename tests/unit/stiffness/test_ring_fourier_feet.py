"""Feet on an elastic ring: resultants, series against sums over the rim, reciprocity, order."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.stiffness.teeth.analytic import foot_compliance, foot_stresses, ring_compliance

INNER, OUTER, FOOT = 0.015, 0.034, 0.17


@pytest.fixture(scope="module")
def ring(steel):
    return ring_compliance(INNER, OUTER, steel, 600)


def patterns(angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Radial and tangential stress of the three unit patterns at angles from the tooth axis."""
    on = (np.abs(angle) <= FOOT).astype(float)
    zero = np.zeros_like(on)
    return np.stack([zero, on, on * angle / FOOT]), np.stack([on, zero, zero])


def test_stresses_have_the_force_and_the_torque_of_the_load():
    load_angle, base = 0.3, 0.032
    amplitude = foot_stresses(load_angle, base, OUTER, FOOT)[:, 0]
    points, weights = np.polynomial.legendre.leggauss(20)
    angle = FOOT * points
    radial, tangential = (amplitude @ pattern for pattern in patterns(angle))
    # Counter-clockwise from the tooth axis y: outwards is (-sin, cos), onwards (-cos, -sin).
    force = np.stack(
        [
            -radial * np.sin(angle) - tangential * np.cos(angle),
            radial * np.cos(angle) - tangential * np.sin(angle),
        ]
    )
    total = OUTER * FOOT * force @ weights
    assert total == pytest.approx([-np.cos(load_angle), -np.sin(load_angle)], rel=1e-12)
    torque = OUTER**2 * FOOT * tangential @ weights
    assert torque == pytest.approx(base, rel=1e-12)


@pytest.mark.parametrize("turn", [0.0, 0.39, -0.39, 1.9])
def test_series_is_the_work_summed_over_the_rim(ring, turn):
    # Displacement of the whole rim from a discrete transform of the loads, then work on a foot.
    samples = 1200 * 9
    angle = 2.0 * np.pi * (np.arange(samples) + 0.5) / samples - np.pi
    radial, tangential = patterns(angle)
    expected = np.empty((3, 3))
    for loaded in range(3):
        p, q = np.fft.rfft(radial[loaded]), np.fft.rfft(tangential[loaded])
        u, v = np.zeros_like(p), np.zeros_like(q)
        u[0], v[0] = ring.expansion * p[0], ring.torsion * q[0]
        for k, wave in enumerate(ring.waves, start=1):
            # q sin(k phi) is the real part of -i q exp(i k phi).
            u[k] = wave[0, 0] * p[k] + wave[0, 1] * 1j * q[k]
            v[k] = -1j * (wave[1, 0] * p[k] + wave[1, 1] * 1j * q[k])
        moves = np.fft.irfft(u, samples), np.fft.irfft(v, samples)
        pattern = patterns((angle - turn + np.pi) % (2.0 * np.pi) - np.pi)
        expected[:, loaded] = (
            (pattern[0] @ moves[0] + pattern[1] @ moves[1]) * OUTER * 2.0 * np.pi / samples
        )
    compliance = foot_compliance(ring, FOOT, turn)
    assert compliance == pytest.approx(expected, rel=2e-3, abs=2e-4 * np.abs(expected).max())


def test_compliances_ahead_and_behind_are_reciprocal(ring):
    ahead, behind = (foot_compliance(ring, FOOT, turn) for turn in (0.7, -0.7))
    assert ahead == pytest.approx(behind.T, rel=1e-12)
    assert np.abs(ahead - ahead.T).max() > 0.01 * np.abs(ahead).max()


def test_a_loaded_foot_gives_way(ring):
    assert np.all(np.linalg.eigvalsh(foot_compliance(ring, FOOT, 0.0)) > 0.0)


def test_the_error_falls_with_the_square_of_the_waves(steel):
    def at(waves: int) -> np.ndarray:
        ring = ring_compliance(INNER, OUTER, steel, waves)
        return np.diag(foot_compliance(ring, FOOT, 0.0))

    exact = at(12_000)
    errors = np.array([np.abs(at(waves) / exact - 1.0) for waves in (100, 200, 400, 800)])
    assert np.all(errors[-1] < 1e-4)
    orders = np.log2(errors[:-1] / errors[1:]).mean(axis=0)
    assert orders == pytest.approx(np.full(3, 2.0), abs=0.15)


def test_an_even_torque_on_all_teeth_turns_the_rim(steel):
    # Summed over the feet all around, only the torsion and waves of the number of teeth remain.
    teeth = 24
    half = np.pi / teeth
    ring = ring_compliance(INNER, OUTER, steel, 4000)
    total = sum(
        foot_compliance(ring, half, 2.0 * np.pi * tooth / teeth)[0, 0] for tooth in range(teeth)
    )
    assert total == pytest.approx(2.0 * OUTER * half * ring.torsion, rel=1e-9)


@pytest.mark.parametrize("name", ["base_radius", "root_radius", "half_angle"])
def test_lengths_and_the_foot_must_be_positive(name):
    values = {"base_radius": 0.03, "root_radius": 0.032, "half_angle": 0.1, name: 0.0}
    with pytest.raises(InputError, match=name):
        foot_stresses(0.3, **values)
