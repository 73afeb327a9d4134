"""The hypoid pair with fourteen coordinates: statics, modes, energy, momentum and power."""

import math
from dataclasses import replace

import numpy as np
import pytest

from known_hypoids import contact_rows, h1043
from tribodyn.dynamics import (
    HYPOID14_NAMES,
    STRUCTURES,
    energy_audit,
    fzg12,
    hypoid14,
    natural_modes,
    simulate,
    spur6,
    steady_state,
    torsional,
)
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.errors import InputError
from tribodyn.gear import EaseOff
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks
from tribodyn.mesh import MeshFunctions

RATIO, TORQUE, BACKLASH = 10 / 43, 500.0, 150e-6
GEARS = {"mass": (11.4, 49.5), "moment_of_inertia": (0.0125, 0.9),
         "torque": (TORQUE, TORQUE / RATIO)}  # fmt: skip
#: Unit normal and moment of the pair 10 x 43 at 500 N*m, mean over the cycle, in both gears.
H_PINION = (-0.633321, 0.760835, -0.141528, 0.0519107, 0.0264771, -0.0897330)
H_WHEEL = (-0.633321, 0.141528, 0.760835, 0.0519107, 0.1138515, 0.0219907)
SPEED = 3000.0 * math.pi / 30.0
BEAT = SPEED * 10 / (2.0 * math.pi)
FLANKS = ConjugateFlanks(h1043(), "drive", EaseOff())


def places(phase):
    angle = 2.0 * np.pi * np.asarray(phase, dtype=float)
    return np.stack([5e-3 * np.cos(angle), 1e-3 * np.sin(angle)], axis=-1)


def mesh(friction_coefficient=0.0, swing=0.15, error=2e-6, stopped=None):
    """Contacts that move over the flanks, with a stiffness and an error that vary, or stand."""

    def at(phase):
        phase = np.asarray(phase, dtype=float)
        return phase if stopped is None else np.full_like(phase, stopped)

    def wave(mean, part):
        return lambda p: mean * (1.0 + part * np.cos(2.0 * np.pi * at(p)))

    def rows(number, factor):
        return lambda p: factor * contact_rows(FLANKS, places(at(p)))[number]

    return MeshFunctions(
        stiffness=wave(5.697e8, swing),
        friction_sum=None,
        friction_moment_pinion=None,
        friction_moment_wheel=None,
        event_phases=(0.0,),
        direction=rows(0, 1.0),
        friction=rows(1, friction_coefficient),
        error=wave(error, 0.5),
    )


def constant_mesh():
    row = np.concatenate((H_PINION, -np.array(H_WHEEL)))
    return replace(
        mesh(swing=0.0),
        direction=lambda p: np.tile(row, (np.size(p), 1)),
        friction=None,
        error=lambda p: 0.0 * p,
    )


def drift():
    """Motion of the free drive."""
    out = np.zeros(14)
    for name, part in zip(("engine", "pinion", "wheel", "load"), (1, 1, RATIO, RATIO), strict=True):
        out[HYPOID14_NAMES.index(f"{name}_theta")] = part
    return out


def test_natural_frequencies_of_the_default_pair():
    # Written down by another program from the same matrices [Hz].
    expected = (
        292.3,
        359.0,
        380.1,
        452.4,
        509.4,
        705.5,
        711.8,
        756.4,
        864.4,
        942.8,
        1139.6,
        1591.6,
        2739.5,
    )
    modes = natural_modes(hypoid14(constant_mesh(), **GEARS))
    assert modes.rigid == 1
    assert modes.frequency[1:] == pytest.approx(expected, abs=0.06)


def test_the_free_drive_moves_nothing_else():
    system = hypoid14(mesh(), **GEARS)
    (contact,) = system.contacts
    moved = drift()
    assert np.abs(system.stiffness @ moved).max() < 1e-9
    assert np.abs(system.damping @ moved).max() < 1e-12
    along = contact.direction(np.linspace(0.0, 1.0, 33))
    # The levers about both axes are in the ratio of the teeth wherever the flanks touch.
    assert np.abs(along @ moved).max() < 1e-15
    assert np.linalg.matrix_rank(system.stiffness + np.outer(along[3], along[3]) * 1e8) == 13


def test_compression_at_rest_is_the_load_over_the_stiffness():
    system = hypoid14(constant_mesh(), **GEARS, backlash=BACKLASH)
    state = static_start(compile_for(system, BEAT, 64))
    pressed = np.asarray(system.contacts[0].direction(np.zeros(1)))[0] @ state[:14]
    assert pressed - 0.5 * BACKLASH == pytest.approx(33.1478e-6, rel=1e-5)


def test_rest_at_every_phase_is_the_loaded_transmission_error():
    for phase in (0.0, 0.21, 0.62):
        stopped_mesh = mesh(stopped=phase)
        state = static_start(
            compile_for(hypoid14(stopped_mesh, **GEARS, backlash=BACKLASH), BEAT, 64)
        )
        row, zero = stopped_mesh.direction(np.zeros(1))[0], np.zeros(1)
        force = TORQUE / row[4]
        loaded = force / stopped_mesh.stiffness(zero)[0] + stopped_mesh.error(zero)[0]
        assert row @ state[1:13] - 0.5 * BACKLASH == pytest.approx(loaded, abs=1e-15)


def test_energy_adds_up_through_the_play():
    system = hypoid14(
        mesh(0.06, swing=0.3, error=20e-6), **GEARS, backlash=BACKLASH, mesh_damping=800.0,
        torque_balance="both",
    )  # fmt: skip
    state = static_start(compile_for(system, BEAT, 1024))
    kick = np.zeros(14)
    kick[HYPOID14_NAMES.index("pinion_theta")] = -60.0
    response = simulate(system, BEAT, 4, (state[:14], kick), steps=1024)
    force = response.contact_force[:, 0]
    assert np.count_nonzero(np.diff((force == 0.0).astype(int))) >= 8
    assert energy_audit(system, response).imbalance < 1e-8


def test_momentum_of_the_free_drive():
    system = replace(hypoid14(mesh(swing=0.3), **GEARS, backlash=BACKLASH), force=np.zeros(14))
    state, kick = static_start(compile_for(hypoid14(mesh(), **GEARS), BEAT, 512)), drift()
    kick[3] = 0.02
    system = replace(system, balance=None)
    response = simulate(system, BEAT, 2, (state[:14], kick), steps=512)
    momentum = response.velocity @ system.mass @ drift()
    assert momentum == pytest.approx(momentum[0], rel=1e-12)


@pytest.mark.parametrize("balance", ["drive", "load"])
def test_power_in_is_power_out_and_power_of_friction(balance):
    system = hypoid14(mesh(0.08), **GEARS, backlash=BACKLASH, torque_balance=balance)
    orbit = steady_state(system, BEAT, steps=512)
    torque = np.asarray(system.force) + orbit.extra_force
    fed = SPEED * torque[0] + SPEED * RATIO * torque[-1]
    fine = orbit.fine
    _, _, sliding = contact_rows(FLANKS, places(fine.phase))
    lost = 0.08 * SPEED * sliding * fine.contact_force[:, 0]
    # Force and velocity of the sliding itself, in the fixed frame: friction takes power.
    assert fed == pytest.approx(float(fine.weight @ lost), rel=1e-6)
    assert fed > 0.01 * TORQUE * SPEED
    torque_in = torque[0] if balance == "drive" else -torque[-1] * RATIO
    assert torque_in == pytest.approx(TORQUE, rel=1e-12)


def test_wrong_meshes_are_refused():
    flat = replace(constant_mesh(), direction=None)
    with pytest.raises(InputError, match="no directions in space"):
        hypoid14(flat, **GEARS)
    for build in (spur6, fzg12):
        with pytest.raises(InputError, match="directions"):
            build(constant_mesh(), **_planar(build))
    turning = torsional(constant_mesh(), **_planar(torsional))
    assert turning.contacts[0].direction(np.zeros(1))[0] == pytest.approx(
        (H_PINION[4], -H_WHEEL[4])
    )


def _planar(build):
    if build is fzg12:
        return {}
    more = {"base_radius": (0.03, 0.1), "torque": (1.0, 4.0), "moment_of_inertia": 1.0}
    return more if build is torsional else {**more, "mass": 1.0, "bearing_stiffness": 1e8}


def test_options_of_a_case_are_those_of_the_class():
    declared = STRUCTURES["hypoid-14dof"].options
    assert declared["axial_bearing_stiffness"] == (2e8, 2.5e8)
    assert declared["bearing_stiffness"] == 4e8
    assert declared["bearing_damping_ratio"] == 0.03
