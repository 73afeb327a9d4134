"""Power and torque balance of the spur gear pair: identities that a wrong sign breaks."""

import numpy as np
import pytest

from known_systems import BASE_RADIUS, DOUBLE, EVENTS, LINE, friction_vector, pairs_in_contact
from tribodyn.dynamics import energy_audit, spur6, steady_state, torsional
from tribodyn.errors import InputError

FREQUENCY, RATIO = 240.0, 1.5
SPEED = 2 * np.pi * FREQUENCY / 16  # rad/s of the pinion


class Mesh:
    """Stiffness and friction of the reference pair; ``turn`` = -1 for the wheel driving."""

    def __init__(self, coefficient, turn=1):
        self.coefficient, self.turn = coefficient, turn
        jumps = {(turn * event) % 1.0 for event in EVENTS}
        # With the wheel driving the cycle runs backwards; it begins where a pair enters.
        self.shift = DOUBLE if turn < 0 else 0.0
        self.event_phases = tuple(sorted((jump + self.shift) % 1.0 for jump in jumps))

    def _mesh_phase(self, phase):
        return (self.turn * (np.asarray(phase) - self.shift)) % 1.0

    def stiffness(self, phase):
        return 2e8 * pairs_in_contact(self._mesh_phase(phase))

    def _vector(self, phase):
        return friction_vector(np.atleast_1d(self._mesh_phase(phase)), self.coefficient)

    def friction_sum(self, phase):
        return self._vector(phase)[:, 0]

    def friction_moment_pinion(self, phase):
        return self._vector(phase)[:, 2]

    def friction_moment_wheel(self, phase):
        return -self._vector(phase)[:, 5]


def _spur(coefficient, driver="pinion", **changes):
    options = {
        "mass": (0.676, 1.084),
        "moment_of_inertia": (407e-6, 1168e-6),
        "base_radius": BASE_RADIUS,
        "torque": (90.0, 135.0),
        "bearing_stiffness": 3.5e9,
        "bearing_damping": 4e3,
        "mesh_damping": 900.0,
        "driver": driver,
    } | changes
    return spur6(Mesh(coefficient, 1 if driver == "pinion" else -1), **options)


def _friction_power(system, motion):
    """Power of friction on both surfaces, rotation of the whole drive included."""
    fine = motion.fine
    phase = fine.phase.reshape(-1, 3) + np.array([1e-9, 0.0, -1e-9])
    vector = system.contacts[0].friction((phase % 1.0).reshape(-1))
    rigid_rotation = np.array([0.0, 0.0, SPEED, 0.0, 0.0, SPEED / RATIO])
    return -fine.contact_force[:, 0] * (vector * (fine.velocity + rigid_rotation)).sum(axis=1)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("balance", ["drive", "load", "both"])
def test_friction_power_is_never_positive(driver, balance):
    system = _spur(0.1, driver, torque_balance=balance)
    power = _friction_power(system, steady_state(system, FREQUENCY))
    assert power.max() <= 0.0
    assert power.min() < -100.0


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("balance", ["drive", "load"])
def test_power_in_equals_power_out_and_losses(driver, balance):
    system = _spur(0.1, driver, torque_balance=balance)
    motion = steady_state(system, FREQUENCY, steps=2048)
    torque = (np.asarray(system.force) + motion.extra_force)[[2, 5]]
    shafts = torque @ [SPEED, SPEED / RATIO]
    fine = motion.fine
    friction = fine.mean(_friction_power(system, motion))
    damping = np.diag(system.damping)
    supports = fine.mean((fine.velocity**2 * damping).sum(axis=1))
    rate = fine.velocity @ np.asarray(system.contacts[0].direction)
    mesh = fine.mean(900.0 * rate**2)
    # The prescribed stiffness pumps a little: parametric work over the cycle.
    pumped = energy_audit(system, motion).parametric / motion.duration
    jump = 0.5 * fine.deflection[0, 0] ** 2 * 2e8 / motion.duration  # closing the cycle at phase 0
    assert shafts > 0.0
    assert shafts + friction + pumped + jump - supports - mesh == pytest.approx(
        0.0, abs=1e-7 * shafts
    )
    assert -friction == pytest.approx(shafts, rel=0.05)
    balanced, given_torque = (
        (0, 90.0) if (driver == "pinion") == (balance == "drive") else (1, 135.0)
    )
    assert abs(torque[balanced]) == pytest.approx(given_torque, rel=1e-12)


def test_balanced_torque_leaves_no_mean_acceleration():
    system = _spur(0.1)
    motion = steady_state(system, FREQUENCY, steps=2048)
    mean_acceleration = motion.fine.mean(motion.fine.acceleration)[[2, 5]]
    swing = np.abs(motion.fine.acceleration[:, [2, 5]]).max(axis=0)
    assert np.all(np.abs(mean_acceleration) < 1e-9 * swing)
    orbit = steady_state(_spur(0.1, torque_balance="both"), FREQUENCY, steps=2048)
    assert np.abs(orbit.fine.mean(orbit.fine.acceleration)[2]) > 1.0


def test_torque_ratio_without_friction_is_the_ratio_of_base_radii():
    for balance in ("drive", "load"):
        system = _spur(0.0, torque_balance=balance, torque=(90.0, 140.0))
        motion = steady_state(system, FREQUENCY)
        torque = (np.asarray(system.force) + motion.extra_force)[[2, 5]]
        assert -torque[1] / torque[0] == pytest.approx(RATIO, rel=1e-9)
        mean = float(motion.fine.mean(motion.fine.contact_force)[0])
        assert mean == pytest.approx(torque[0] / BASE_RADIUS[0], rel=1e-6)


def test_wheel_driving_without_friction_is_the_mirror_image():
    """Without friction the cycle runs backwards: the same forces, mirrored in y and theta."""
    system = _spur(0.0, "wheel")
    assert system.force[2] == -90.0
    motion = steady_state(system, FREQUENCY)
    plain = steady_state(_spur(0.0, "pinion"), FREQUENCY)
    assert float(motion.fine.mean(motion.fine.contact_force)[0]) == pytest.approx(
        float(plain.fine.mean(plain.fine.contact_force)[0]), rel=1e-6
    )
    assert motion.fine.contact_force.min() > 0.0
    assert motion.position[:, 1].mean() == pytest.approx(-plain.position[:, 1].mean(), rel=1e-4)


def test_friction_unloads_the_mesh_in_recess_at_constant_torques():
    """Most of FZG-A's path is recess for the pinion driving; with the wheel driving, approach."""
    for driver, sign in (("pinion", -1.0), ("wheel", 1.0)):
        mean = [
            float(motion.fine.mean(motion.fine.contact_force)[0])
            for motion in (
                steady_state(_spur(mu, driver, torque_balance="both"), FREQUENCY)
                for mu in (0.0, 0.1)
            )
        ]
        assert np.sign(mean[1] - mean[0]) == sign


@pytest.mark.filterwarnings(r"ignore:\[step-size\]")  # coarse on purpose
def test_torsional_pair_is_the_spur_pair_on_stiff_supports():
    stiff = _spur(0.1, bearing_stiffness=3e12, bearing_damping=0.0)
    mesh = Mesh(0.1)
    twist = torsional(
        mesh, moment_of_inertia=(407e-6, 1168e-6), base_radius=BASE_RADIUS,
        torque=(90.0, 135.0), mesh_damping=900.0,
    )  # fmt: skip
    orbit = steady_state(stiff, FREQUENCY, steps=8192)
    other = steady_state(twist, FREQUENCY, steps=8192)
    scale = np.ptp(other.deflection)
    np.testing.assert_allclose(orbit.deflection, other.deflection, atol=5e-3 * scale)


def test_friction_levers_add_up():
    mesh = Mesh(0.1)
    phase = np.array([0.1, 0.5, 0.8])
    levers = mesh.friction_moment_pinion(phase) + mesh.friction_moment_wheel(phase)
    np.testing.assert_allclose(levers, mesh.friction_sum(phase) * LINE, atol=1e-15)


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"driver": "gear"}, "driver"),
        ({"torque_balance": "none"}, "torque_balance"),
        ({"mass": (1.0, -1.0)}, "mass = -1 kg"),
        ({"bearing_stiffness": 0.0}, "bearing_stiffness"),
        ({"backlash": -1e-5}, "backlash"),
        ({"moment_of_inertia": (1.0, 2.0, 3.0)}, "(pinion, wheel)"),
    ],
)
def test_wrong_input_is_named(change, part):
    with pytest.raises(InputError) as caught:
        spur6(Mesh(0.0), **({
            "mass": 1.0, "moment_of_inertia": 1e-3, "base_radius": BASE_RADIUS,
            "torque": (90.0, 135.0), "bearing_stiffness": 1e9,
        } | change))  # fmt: skip
    assert part in str(caught.value)
