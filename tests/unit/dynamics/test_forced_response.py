"""Harmonic response and Campbell diagram against closed forms and the marched steady state."""

import math

import numpy as np
import pytest

from known_systems import reference_system
from tribodyn.analysis import mesh_harmonics
from tribodyn.dynamics import (
    Contact,
    GearMesh,
    System,
    assemble,
    campbell,
    forced_response,
    law_contacts,
    natural_modes,
    shaft_chain,
    steady_state,
)
from tribodyn.errors import InputError
from tribodyn.mesh import MeshForceLaw, phase_grid

INERTIA, RADIUS = (5e-4, 1.3e-3), (0.03, 0.05)
MASS = INERTIA[0] * INERTIA[1] / (INERTIA[0] * RADIUS[1] ** 2 + INERTIA[1] * RADIUS[0] ** 2)
STIFFNESS, DAMPING, ERROR = 3e8, 1500.0, 1e-6


def pair():
    contact = Contact([RADIUS[0], -RADIUS[1]], STIFFNESS, DAMPING)
    return System(np.diag(INERTIA), np.zeros((2, 2)), np.zeros((2, 2)), [90, -150], [contact])


def test_torsional_pair_in_closed_form():
    hertz = np.array([10.0, 3000.0, 5000.0, 8000.0, 20000.0])
    response = forced_response(pair(), hertz)
    omega = 2.0 * np.pi * hertz
    spring = STIFFNESS + 1j * omega * DAMPING
    approach = ERROR * spring / (spring - omega**2 * MASS)
    np.testing.assert_allclose(response.transmission_error[:, 0], approach, rtol=1e-11)
    np.testing.assert_allclose(response.mesh_force, spring * (approach - ERROR), rtol=1e-7)


def test_limits_of_slow_and_fast_errors():
    slow, fast = 1.0, 1e7
    response = forced_response(pair(), [slow, fast])
    # slow: the gears follow and the teeth push the effective mass; fast: the teeth yield
    mass_line = MASS * (2.0 * math.pi * slow) ** 2 * ERROR
    assert response.mesh_force[0].real == pytest.approx(mass_line, rel=1e-5)
    assert response.transmission_error[0, 0] == pytest.approx(ERROR, rel=1e-6)
    rigid = STIFFNESS + 2j * math.pi * fast * DAMPING
    assert response.mesh_force[1] == pytest.approx(-rigid * ERROR, rel=1e-3)
    # a slow error on a wheel that cannot turn presses the teeth: nothing can follow
    grounded = System(np.eye(1), [[0.0]], [[2e8]], [1.0], [Contact([1.0], 2e8)])
    assert forced_response(grounded, 1e-3).mesh_force[0].real == pytest.approx(-100.0, rel=1e-9)


@pytest.mark.parametrize("mesh_frequency", [5000.0, 5276.0, 9000.0])
def test_marched_steady_state_has_the_same_amplitudes(mesh_frequency):
    rub = np.array([0.05, 0.0, 0.002, -0.05, 0.0, -0.003])
    system = reference_system(
        stiffness=3e8,
        error=lambda phase: 2e-6 * np.cos(2.0 * np.pi * phase),
        friction=rub,
        events=(0.0,),
    )
    orbit = steady_state(system, mesh_frequency, steps=512)
    response = forced_response(system, mesh_frequency, error=2e-6)
    for signal, exact in (
        (orbit.fine.contact_force[:, 0], response.contact_force[0, 0]),
        (orbit.fine.deflection[:, 0], response.deflection[0, 0]),
        (orbit.fine.position[:, 0], response.position[0, 0]),
        (orbit.fine.position[:, 1], response.position[0, 1]),
    ):
        # The rotation of the whole drive does not enter any of these.
        assert mesh_harmonics(orbit, signal, 1)[0] == pytest.approx(exact, rel=1e-6)
    support = 3.5e9 * orbit.fine.position[:, 1] + 4e3 * orbit.fine.velocity[:, 1]
    assert mesh_harmonics(orbit, support, 1)[0] == pytest.approx(
        response.structure_force[0, 1], rel=1e-6
    )


def test_peak_is_at_the_mesh_mode():
    system = reference_system()
    hertz = np.linspace(4000.0, 7000.0, 601)
    (peak,) = forced_response(system, hertz).peaks()
    assert peak == pytest.approx(natural_modes(system).damped_frequency[0], rel=0.02)


def test_error_of_one_mesh_acts_on_the_other_as_much_as_the_reverse():
    gears = [shaft_chain([name], 1e-3 * size) for name, size in (("a", 1), ("b", 3), ("c", 2))]
    meshes = [
        GearMesh("a", "b", (0.03, 0.04), 3e8, 500.0),
        GearMesh("b", "c", (0.04, 0.05), 2e8, 800.0),
    ]
    train = assemble(gears, meshes, {"a": 90.0, "c": -150.0})
    hertz = np.array([300.0, 3000.0, 7000.0])
    forward = forced_response(train, hertz, contact=0).contact_force[:, 1]
    backward = forced_response(train, hertz, contact=1).contact_force[:, 0]
    np.testing.assert_allclose(forward, backward, rtol=1e-9)
    assert np.abs(forward).min() > 0.0


def test_ramps_of_one_law_share_the_error():
    places, ramps = np.tile([0.0, 1e-5], (17, 1)), np.tile([2e8, 1e8], (17, 1))
    law = MeshForceLaw(phase_grid((0.0,), 16), places, ramps)
    contacts = law_contacts(Contact([1.0], 0.0, gap=5e-5, damping=900.0), law)
    bundle = System([[2.0]], [[0.0]], [[1e6]], [5000.0], contacts)
    single = System([[2.0]], [[0.0]], [[1e6]], [5000.0], [Contact([1.0], 3e8, 900.0)])
    bundled, plain = forced_response(bundle, 900.0), forced_response(single, 900.0)
    assert bundled.contact == (0, 1)
    assert bundled.mesh_force[0] == pytest.approx(plain.mesh_force[0], rel=1e-9)


def test_campbell_diagram_finds_every_crossing():
    speed = np.linspace(20.0, 2000.0, 34)
    diagram = campbell(pair(), speed, teeth=20, orders=(1, 2, 3))
    hertz = math.sqrt(STIFFNESS / MASS) / (2.0 * math.pi)
    exact = sorted(2.0 * math.pi * hertz / (20.0 * order) for order in (1, 2, 3))
    assert [met.speed for met in diagram.resonances] == pytest.approx(exact, rel=1e-11)
    assert {met.order for met in diagram.resonances} == {1, 2, 3}
    for met in diagram.resonances:
        assert met.order * met.mesh_frequency == pytest.approx(hertz, rel=1e-11)
        assert (met.mode, met.contact_share) == (1, pytest.approx(1.0))
        ratio = DAMPING / (2.0 * math.sqrt(STIFFNESS * MASS))
        assert met.damping_ratio == pytest.approx(ratio, rel=1e-11)
    assert diagram.to_xarray().frequency.attrs["units"] == "Hz"
    assert repr(diagram) == "Campbell(1 elastic mode, 3 orders, 3 resonances)"


def test_campbell_diagram_of_a_stiffness_that_grows_with_speed():
    def system(speed):
        return System([[1.0]], [[0.0]], [[(2.0 * math.pi * (50.0 + speed)) ** 2]], [0.0])

    (met,) = campbell(system, np.linspace(5.0, 115.0, 12), teeth=10, orders=(1,)).resonances
    assert met.speed == pytest.approx(50.0 / (10.0 / (2.0 * math.pi) - 1.0), rel=1e-9)
    assert met.frequency == pytest.approx(50.0 + met.speed, rel=1e-9)


def test_refusals():
    with pytest.raises(InputError, match="frequency"):
        forced_response(pair(), 0.0)
    with pytest.raises(InputError, match="contact = 1"):
        forced_response(pair(), 10.0, contact=1)
    with pytest.raises(InputError, match="order"):
        campbell(pair(), [1.0, 2.0], teeth=10, orders=())
    with pytest.raises(InputError, match="rise"):
        campbell(pair(), [2.0, 1.0], teeth=10)
