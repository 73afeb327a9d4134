"""A planetary stage in motion: harmonics that symmetry suppresses."""

import numpy as np
import pytest

from known_planetary import LIN_PARKER
from tribodyn.dynamics import harmonic_balance, steady_state
from tribodyn.machine import load_shares, mesh_phases, planetary_plane_model


def stiffness(phase):
    waves = (0.1, 0.0), (0.05, 0.4), (0.03, -1.0), (0.02, 0.7)
    return 5e8 * (
        1 + sum(a * np.cos(2 * np.pi * (i + 1) * phase + s) for i, (a, s) in enumerate(waves))
    )


def amplitudes(sun, ring, planets, **changes):
    """Amplitudes of the harmonics 0 to 8 of every coordinate by its name."""
    data = LIN_PARKER | {"sun_mesh_stiffness": stiffness, "ring_mesh_stiffness": stiffness}
    phases = mesh_phases(sun_teeth=sun, ring_teeth=ring, planets=planets, sun_to_ring=0.3)
    stage = planetary_plane_model(
        planets=planets, phases=phases, damping_ratio=0.02, force_per_planet=3000.0,
        **{**data, **changes},
    )  # fmt: skip
    motion = harmonic_balance(stage, 700.0, steps=240)
    lines = np.abs(np.fft.rfft(np.asarray(motion.position), axis=0))[:9] / 240
    return dict(zip(stage.names, lines.T, strict=True))


CENTRAL = ("carrier", "ring", "sun")


def largest(lines, axes):
    return np.max([lines[f"{name}_{axis}"] for name in CENTRAL for axis in axes], axis=0)


@pytest.mark.parametrize(("sun", "ring", "planets"), [(17, 61, 3), (28, 62, 5)])
def test_a_harmonic_moves_members_only_in_the_modes_that_its_phases_excite(sun, ring, planets):
    lines = amplitudes(sun, ring, planets)
    phases = mesh_phases(sun_teeth=sun, ring_teeth=ring, planets=planets)
    translation, rotation = largest(lines, "xy")[1:], largest(lines, "u")[1:]
    planet = np.max([lines[f"planet{i + 1}_u"] for i in range(planets)], axis=0)[1:]
    types = [phases.excitation(i).types for i in range(1, 9)]
    for moves, letter in ((translation, "T"), (rotation, "R")):
        excited = np.array([letter in each for each in types])
        assert moves[~excited].max() < 1e-9 * moves[excited].max()
        assert moves[excited].min() > 1e-9 * moves[excited].max()
    assert planet[:4].min() > 1e-4 * planet.max()  # planets move with every harmonic


def test_planets_in_phase_do_not_move_the_sun_until_one_pin_or_planet_differs():
    perfect = amplitudes(18, 60, 3)
    assert largest(perfect, "xy").max() < 1e-9 * largest(perfect, "u").max()
    for change in (
        {"pin_errors": [30e-6, 0.0, 0.0]},
        {"planet_mass": [0.66, 0.66, 0.70]},
        {"thickness_errors": [0.0, 10e-6, 0.0]},
    ):
        lines = amplitudes(18, 60, 3, **change)
        assert largest(lines, "xy")[1:].max() > 1e-3 * largest(lines, "u")[1:].max()


def test_time_integration_gives_the_same_motion():
    data = LIN_PARKER | {"sun_mesh_stiffness": stiffness, "ring_mesh_stiffness": stiffness}
    phases = mesh_phases(sun_teeth=17, ring_teeth=61, planets=3)
    stage = planetary_plane_model(
        planets=3, phases=phases, damping_ratio=0.02, force_per_planet=3000.0, mesh_gap=1e-6,
        pin_errors=[30e-6, 0.0, 0.0], **data,
    )  # fmt: skip
    balance = harmonic_balance(stage, 700.0, steps=480)
    orbit = steady_state(stage, 700.0, steps=480)
    assert orbit.engine != balance.engine
    force = np.asarray(balance.contact_force)
    np.testing.assert_allclose(orbit.contact_force, force, rtol=0, atol=1e-4 * force.mean())


@pytest.mark.parametrize(
    "errors", [[60e-6, 0.0, 20e-6, 0.0, 0.0], [400e-6, 0.0, 60e-6, -20e-6, 0.0]]
)
def test_loads_at_rest_are_those_of_the_motion_with_constant_stiffness(errors):
    """Harmonic balance with dead zones finds the planets that lose contact by other equations."""
    data = {"planets": 5, "pin_errors": errors, "force_per_planet": 3000.0, **LIN_PARKER}
    stage = planetary_plane_model(mesh_gap=200e-6, damping_ratio=0.05, **data)
    force = np.asarray(harmonic_balance(stage, 500.0).contact_force).mean(axis=0)
    shares = load_shares(**data)
    np.testing.assert_allclose(force, np.tile(shares.force, 2), rtol=0, atol=1e-4)
    assert (shares.unloaded == (1,)) == (max(errors) > 1e-4)
