"""Friction that follows the dynamic load: a constant law, a slow mesh, the power it takes."""

from dataclasses import replace

import numpy as np
import pytest

from known_pairs import pair_of
from tribodyn.dynamics import System, energy_audit, follow_load, spur6, steady_state, torsional
from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import LOADS, build, mesh_friction

pytestmark = pytest.mark.filterwarnings(r"ignore:\[friction-range\]:tribodyn.errors.ModelWarning")

TORQUE = 90.0


def _meshes(law, options=None, driver="pinion"):
    def mesh(load):
        return build(
            pair_of(driver=driver),
            material=Material(),
            stiffness_model="rectangular",
            stiffness_options={"pair_stiffness": 2e8},
            lubricant=Lubricant(0.082, 880.0, 2e-8),
            friction_law=law,
            friction_options=options or {},
            composite_roughness=0.53e-6,
            pinion_speed=94.2478,
            pinion_torque=TORQUE * load,
            steps=256,
        )

    nominal = mesh(1.0)
    return nominal, mesh_friction([mesh(load) for load in LOADS], nominal)


def _spur6(mesh, driver="pinion", **changes):
    return spur6(
        mesh.functions(),
        **{
            "mass": (0.676, 1.084),
            "moment_of_inertia": (407e-6, 1168e-6),
            "base_radius": (mesh.base_radius_pinion, mesh.base_radius_wheel),
            "torque": (TORQUE, 1.5 * TORQUE),
            "bearing_stiffness": 3.5e9,
            "bearing_damping": 4e3,
            "mesh_damping": 900.0,
            "driver": driver,
            **changes,
        },
    )


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("model", ["spur6", "torsional"])
def test_a_constant_coefficient_gives_the_motion_of_the_table(driver, model):
    mesh, friction = _meshes("constant", {"coefficient": 0.1}, driver)
    system = _spur6(mesh, driver)
    if model == "torsional":
        system = torsional(
            mesh.functions(),
            moment_of_inertia=(407e-6, 1168e-6),
            base_radius=(mesh.base_radius_pinion, mesh.base_radius_wheel),
            torque=(TORQUE, 1.5 * TORQUE),
            mesh_damping=900.0,
            driver=driver,
        )
    table = steady_state(system, 240.0)
    loop = steady_state(follow_load(system, friction), 240.0)
    scale = np.abs(table.acceleration).max(axis=0)
    np.testing.assert_allclose(loop.acceleration / scale, table.acceleration / scale, atol=1e-6)
    np.testing.assert_allclose(loop.extra_force, table.extra_force, atol=1e-6)


def test_friction_at_the_nominal_load_equals_the_table():
    # Of a constant stiffness the load stays at the nominal one, but for what friction adds.
    mesh, friction = _meshes("xu-2007")
    system = _spur6(mesh)
    (contact,) = system.contacts
    even = replace(system, contacts=[replace(contact, stiffness=3e8)])
    table, loop = steady_state(even, 240.0), steady_state(follow_load(even, friction), 240.0)
    assert np.ptp(table.contact_force[:, 0]) < 0.2 * table.contact_force[:, 0].mean()
    rub = np.array(even.balance) @ table.extra_force
    assert abs(rub) > 1.0
    assert np.array(even.balance) @ loop.extra_force == pytest.approx(rub, rel=0.01)


def test_the_dynamic_load_changes_friction_as_in_the_law():
    mesh, friction = _meshes("xu-2007")
    system = _spur6(mesh)
    loop = steady_state(follow_load(system, friction), 240.0)
    fine = loop.fine
    force = fine.contact_force[:, 0]
    assert force.max() > 1.5 * force.mean()
    # Newton's law across the line of action, with friction from its definition.
    phase = fine.phase % 1.0
    inside = np.all([np.abs(phase - event) > 1e-9 for event in (*mesh.event_phases, 1.0)], axis=0)
    across = friction.value("friction_sum", phase, force) * force
    x, v = fine.position[:, 0], fine.velocity[:, 0]
    expected = -across - 3.5e9 * x - 4e3 * v
    inertia = 0.676 * fine.acceleration[:, 0]
    np.testing.assert_allclose(inertia[inside], expected[inside], atol=1e-6 * abs(across).max())
    # A table at the nominal load is wrong by much more than the fit.
    nominal = mesh.at("friction_sum", phase) * force
    assert np.abs(across - nominal)[inside].max() > 0.05 * abs(nominal).max()


def test_the_energy_is_accounted_for():
    mesh, friction = _meshes("xu-2007")
    system = follow_load(_spur6(mesh), friction)
    audit = energy_audit(system, steady_state(system, 240.0, steps=2048))
    assert abs(audit.imbalance) < 1e-6


def test_a_structure_without_gears_is_refused():
    _, friction = _meshes("constant", {"coefficient": 0.1})
    with pytest.raises(InputError, match="no coordinate is named pinion_theta"):
        follow_load(System([[1.0]], [[0.0]], [[1.0]], [0.0]), friction)
