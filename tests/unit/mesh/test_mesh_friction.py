"""Friction over phase and load: against meshes built at that load, a constant law, bad input."""

import numpy as np
import pytest

from known_pairs import pair_of
from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import LOADS, build, mesh_friction
from tribodyn.mesh.functions import CHANNELS

# The regression is continued to the lightest and heaviest loads.
pytestmark = pytest.mark.filterwarnings(r"ignore:\[friction-range\]:tribodyn.errors.ModelWarning")

TORQUE = 90.0
PHASES = np.random.default_rng(3).random(400)


def _mesh(torque, law="xu-2007", speed=94.0, options=None):
    return build(
        pair_of(),
        material=Material(),
        stiffness_model="rectangular",
        stiffness_options={"pair_stiffness": 2e8},
        lubricant=Lubricant(0.082, 880.0, 2e-8),
        friction_law=law,
        friction_options=options or {},
        composite_roughness=0.53e-6,
        pinion_speed=speed,
        pinion_torque=torque,
        steps=64,
    )


def _friction(law="xu-2007", options=None):
    tables = [_mesh(TORQUE * load, law, options=options) for load in LOADS]
    return mesh_friction(tables, tables[LOADS.index(1.0)])


@pytest.mark.parametrize("load", [0.2, 0.6, 1.0, 1.45, 2.8])
def test_it_is_the_friction_of_the_mesh_at_that_load(load):
    friction, mesh = _friction(), _mesh(TORQUE * load)
    for name in CHANNELS:
        expected = mesh.at(name, PHASES)
        value = friction.value(name, PHASES, np.full(PHASES.size, mesh.total_normal_force))
        np.testing.assert_allclose(value * load, expected * load, atol=4e-3 * abs(expected).max())
    # The load matters: pressure, and with it friction, grows with its square root.
    nominal = _mesh(TORQUE).at("friction_sum", PHASES)
    if load != 1.0:
        assert np.abs(mesh.at("friction_sum", PHASES) - nominal).max() > 0.05 * nominal.max()


def test_a_constant_coefficient_does_not_follow_the_load():
    friction = _friction("constant", {"coefficient": 0.07})
    assert friction.fit_error < 1e-10
    nominal = _mesh(TORQUE, "constant", options={"coefficient": 0.07})
    for name in CHANNELS:
        expected = nominal.at(name, PHASES)
        for force in (100.0, 7000.0):
            value = friction.value(name, PHASES, np.full(PHASES.size, force))
            np.testing.assert_allclose(value, expected, atol=1e-9 * abs(expected).max())


def test_coefficient_is_constant_beyond_the_table_of_loads():
    friction = _friction()
    last = friction.value("friction_sum", 0.6, 3.0 * friction.load)
    assert friction.value("friction_sum", 0.6, 9.0 * friction.load) == pytest.approx(
        last, rel=1e-12
    )
    assert friction.value("friction_sum", 0.6, -9.0 * friction.load) == pytest.approx(
        last, rel=1e-12
    )


def test_fit_reports_its_quality():
    assert "loads to 3 times 2660.4 N, fitted within 0." in repr(_friction())


def test_too_few_loads_and_other_meshes_are_refused():
    nominal = _mesh(TORQUE)
    with pytest.raises(InputError, match="2 different loads"):
        mesh_friction([nominal, _mesh(2 * TORQUE)], nominal)
    others = [_mesh(TORQUE * load, speed=50.0) for load in LOADS]
    with pytest.raises(InputError, match="another speed"):
        mesh_friction(others, nominal)
