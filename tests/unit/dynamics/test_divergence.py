"""What is said of a motion that runs away, and of systems that cannot move."""

import numpy as np
import pytest

from known_systems import MESH_FREQUENCY, reference_system
from tribodyn.dynamics import (
    Contact,
    LaneParameters,
    LoadFriction,
    System,
    simulate,
    simulate_ensemble,
    steady_state,
)
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.equations.divergence import probable_cause
from tribodyn.errors import ComputationError, InputError

NAMES = ("pinion_x", "wheel_x")


def _pair(damping=(1.0, 1.0), stiffness=(100.0, 400.0), **parts):
    return System(np.eye(2), np.diag(damping), np.diag(stiffness), [0.0, 0.0], names=NAMES, **parts)


def _message(system, frequency=1.0, **options):
    with pytest.raises(ComputationError) as caught:
        simulate(system, frequency, 200, ([1.0, 1.0], [0.0, 0.0]), **({"steps": 256} | options))
    return str(caught.value)


def _time(text):
    return float(text.split("at the time ")[1].split(" s")[0])


def test_negative_damping_names_time_coordinate_and_cause():
    """The velocity grows with exp(150 t) and overflows at 1.8e308, so the time is known."""
    text = _message(_pair(damping=(1.0, -300.0)))
    assert "coordinate wheel_x of the body wheel" in text
    assert "damping matrix has a negative eigenvalue, in a motion of wheel_x" in text
    root = 150.0 + np.sqrt(150.0**2 - 400.0)
    assert _time(text) == pytest.approx(709.8 / root, rel=0.02)
    twice = _message(_pair(damping=(1.0, -300.0)), frequency=0.5, steps=1024)
    assert _time(twice) == pytest.approx(_time(text), rel=0.02)


def test_negative_stiffness():
    text = _message(_pair(stiffness=(-4e4, 400.0)), steps=512)
    assert "coordinate pinion_x" in text
    assert "stiffness matrix has a negative eigenvalue, in a motion of pinion_x" in text
    contact = Contact([1.0, 0.0], lambda phase: np.where(phase < 0.5, 1.0, -9e4), events=(0, 0.5))
    text = _message(_pair(contacts=[contact]), steps=512)
    assert "stiffness of contact 0 is negative: -90000 N/m at the mesh phase 0.5" in text


def test_friction_that_feeds_energy_in():
    """Friction couples two motions of the same frequency with opposite signs: flutter."""
    direction, rub = np.array([1.0, 1.0]), np.array([2.0, -2.0])
    for kind in ({"friction": rub}, {}):
        contact = Contact(direction, 4e4, **kind)
        frictions = () if kind else [LoadFriction(rub, [0.9, 0.1], 1e9, limit=1.0)]
        system = System(np.eye(2), 0.1 * np.eye(2), np.diag([1e3, 1.61e5]), [1.0, 0.0], [contact],
                        names=NAMES, frictions=frictions)  # fmt: skip
        text = _message(system, 0.2, steps=2048)
        assert "Friction feeds energy in" in text


def test_parametric_resonance_and_a_step_at_the_limit():
    contact = Contact([1.0, 0.0], lambda phase: 4e4 * (1 + 0.6 * np.cos(2 * np.pi * phase)))
    system = _pair(damping=(0.01, 1.0), contacts=[contact])
    nodes = compile_for(system, 64.0, 256).nodes
    text, _ = probable_cause(system, nodes, 0.1, np.ones(6))
    assert "parametric resonance" in text
    text, remedy = probable_cause(system, nodes, 2.6, np.ones(6))
    assert "near the stability limit" in text
    assert "twice as many steps" in remedy


def test_the_diverged_lane_is_named():
    damping = np.ones(20)
    damping[13] = -400.0
    system = _pair(contacts=[Contact([1.0, 0.0], 10.0, damping=1.0)])
    with pytest.raises(ComputationError) as caught:
        simulate_ensemble(system, 1.0, 60, ([1.0, 1.0], [0.0, 0.0]), steps=512,
                          parameters=LaneParameters(damping_scale=damping))  # fmt: skip
    text = str(caught.value)
    assert "in lane 13" in text
    assert "damping of contact 0 is negative: -400" in text
    assert "coordinate pinion_x" in text


def test_an_unconnected_coordinate_is_refused():
    stiffness = np.diag([100.0, 0.0])
    system = System(np.eye(2), np.diag([1.0, 0.0]), stiffness, [1.0, 1.0], names=NAMES)
    with pytest.raises(InputError, match="wheel_x is not connected to anything"):
        steady_state(system, 1.0)
    connected = System(np.eye(2), np.diag([1.0, 0.1]), stiffness, [1.0, 0.0], names=NAMES)
    assert steady_state(connected, 1.0).converged


@pytest.mark.parametrize(
    ("mass", "part"),
    [
        ([[1.0, 0.0], [0.0, 0.0]], "coordinate 1 has no inertia (wheel_x)"),
        ([[1.0, 1.0], [1.0, 1.0]], "it is singular, a motion of pinion_x and wheel_x"),
        ([[1.0, 0.0], [0.0, -2.0]], "positive definite, a motion of wheel_x has no kinetic"),
        ([[1.0, 0.5], [0.0, 2.0]], "not symmetric and positive definite"),
        ([[1.0, 3.0], [3.0, 2.0]], "not symmetric and positive definite"),
    ],
)
def test_masses_without_kinetic_energy(mass, part):
    with pytest.raises(InputError) as caught:
        System(mass, np.eye(2), np.eye(2), [0.0, 0.0], names=NAMES)
    assert part in str(caught.value)


@pytest.mark.parametrize("name", ["direction", "stiffness", "damping", "error", "gap", "friction"])
def test_a_table_with_nan_is_named_with_its_phase(name):
    def broken(phase):
        values = np.where((phase > 0.25) & (phase < 0.3), np.nan, 1.0)
        return values[:, None] * np.ones(6) if name in ("direction", "friction") else values

    with pytest.raises(InputError) as caught:
        simulate(reference_system(0.1, **{name: broken}), MESH_FREQUENCY, 1,
                 (np.zeros(6), np.zeros(6)))  # fmt: skip
    text = str(caught.value)
    assert f"contacts[0].{name} is NaN or infinite at the mesh phase 0.25" in text


def test_strong_friction_is_reported_as_first_cause():
    """With a coefficient of 3 neither a parametric resonance nor a sign is the first suspect."""
    rub = 3.0 * np.array([0.0, 1.0])
    contact = Contact([1.0, 0.0], lambda phase: 4e4 * (1 + 0.6 * np.cos(2 * np.pi * phase)),
                      friction=rub)  # fmt: skip
    system = _pair(damping=(0.01, 1.0), contacts=[contact])
    nodes = compile_for(system, 64.0, 256).nodes
    text, remedy = probable_cause(system, nodes, 0.1, np.ones(6))
    assert text.startswith("Friction accelerates the coordinates 3 times as much")
    assert "friction coefficient" in remedy
    weak = np.ones(6)
    weak[2] = 0.05
    assert "parametric resonance" in probable_cause(system, nodes, 0.1, weak)[0]
