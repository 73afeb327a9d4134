"""The equations of motion written out on the page on dynamics are those of the structures."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from tribodyn.dynamics import fzg12, spur6

MU, L1, L2, R1, R2, N, T1, T2 = 0.05, 0.001, 0.0007, 0.03, 0.05, 1000.0, 90.0, 150.0
MESH = SimpleNamespace(
    stiffness=lambda phase: 3e8 + 0 * phase,
    friction_sum=lambda phase: MU + 0 * phase,
    friction_moment_pinion=lambda phase: L1 + 0 * phase,
    friction_moment_wheel=lambda phase: L2 + 0 * phase,
    event_phases=(0.0,),
)
PHASE = np.array([0.3])


def _forces(system, coordinates: str) -> list[float]:
    """Forces of the mesh under N newtons on named coordinates."""
    (contact,) = system.contacts
    at = [system.names.index(name) for name in coordinates.split()]
    direction = contact.direction(PHASE)[0] if callable(contact.direction) else contact.direction
    return list(-(np.asarray(direction) + contact.friction(PHASE)[0])[at] * N)


def test_six_coordinates() -> None:
    system = spur6(
        MESH, mass=1.0, moment_of_inertia=1e-3, base_radius=(R1, R2), torque=(T1, T2),
        bearing_stiffness=(1e8, 2e8), bearing_damping=(3e3, 4e3),
    )  # fmt: skip
    names = "pinion_x pinion_y pinion_theta wheel_x wheel_y wheel_theta"
    written = [-MU * N, -N, -(R1 + L1) * N, MU * N, N, (R2 + L2) * N]
    assert _forces(system, names) == pytest.approx(written, rel=1e-14)
    assert list(system.force) == [0.0, 0.0, T1, 0.0, 0.0, -T2]
    assert list(np.diag(system.stiffness)) == [1e8, 1e8, 0.0, 2e8, 2e8, 0.0]
    assert list(np.diag(system.damping)) == [3e3, 3e3, 0.0, 4e3, 4e3, 0.0]


def test_twelve_coordinates() -> None:
    system = fzg12(MESH, base_radius=(R1, R2), torque=T1, shaft_stiffness=(7e4, 8e4))
    names = "pinion_v pinion_w pinion_theta wheel_v wheel_w wheel_theta shaft1_v shaft2_w"
    written = [-MU * N, N, (R1 - L1) * N, MU * N, -N, -(R2 - L2) * N, 0.0, 0.0]
    assert _forces(system, names) == pytest.approx(written, rel=1e-14)
    turning = [system.names.index(f"{body}_theta") for body in ("shaft1", "wheel")]
    shaft = system.stiffness[np.ix_(turning, turning)]
    np.testing.assert_array_equal(shaft, 7e4 * np.array([[1.0, -1.0], [-1.0, 1.0]]))
    assert system.force[turning[0]] == pytest.approx(T1 * R2 / R1)
    assert system.force[system.names.index("shaft2_theta")] == -T1
