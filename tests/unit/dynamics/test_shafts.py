"""Shafts as chains, and drives with several meshes."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from tribodyn.analysis import mesh_harmonics
from tribodyn.dynamics import (
    Contact,
    GearMesh,
    assemble,
    natural_modes,
    shaft_chain,
    spur6,
    steady_state,
    torsional_stiffness,
)
from tribodyn.errors import InputError

RADIUS = (0.03, 0.04, 0.025, 0.06)


def train(**second):
    """Two stages: a on b, whose shaft carries c, c on d."""
    shafts = [
        shaft_chain(["a"], 6e-4),
        shaft_chain(["b", "c"], [2e-3, 5e-4], 8e4, damping=2.0),
        shaft_chain(["d"], 6e-3),
    ]
    meshes = [
        GearMesh("a", "b", RADIUS[:2], 3e8, 1500.0),
        GearMesh("c", "d", RADIUS[2:], **{"stiffness": 4e8, "damping": 2500.0, **second}),
    ]
    return assemble(shafts, meshes, {"a": 90.0}, balance="d")


def test_torsional_stiffness_of_a_round_shaft():
    solid = torsional_stiffness(0.03, 0.1)
    assert solid == pytest.approx(math.pi * 0.03**4 * 79.3e9 / 3.2, rel=1e-12)
    assert torsional_stiffness(0.03, 0.2) == pytest.approx(0.5 * solid)
    assert torsional_stiffness(0.03, 0.1, bore=0.015) == pytest.approx(solid * 15.0 / 16.0)


def test_chain_of_discs_has_the_frequencies_of_a_free_shaft():
    count, inertia, spring = 12, 2e-3, 9e5
    shaft = shaft_chain([f"disc{i}" for i in range(count)], inertia, spring)
    modes = natural_modes(assemble([shaft], [], {}))
    exact = np.sqrt(spring / inertia) / np.pi * np.sin(np.arange(count) * np.pi / (2 * count))
    np.testing.assert_allclose(modes.frequency, exact, rtol=1e-10, atol=1e-9)


def test_shaft_of_many_discs_tends_to_the_bar():
    # f = c/(2 L) of a free uniform bar; discs at the middles of equal pieces are off by O(h^2)
    length, diameter, density, modulus = 0.5, 0.04, 7850.0, 79.3e9
    exact = math.sqrt(modulus / density) / (2.0 * length)
    errors = []
    for count in (8, 16):
        inertia = density * math.pi * diameter**4 / 32.0 * length / count
        spring = torsional_stiffness(diameter, length / count)
        shaft = shaft_chain([f"d{i}" for i in range(count)], inertia, spring)
        errors.append(natural_modes(assemble([shaft], [], {})).frequency[1] / exact - 1.0)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_gears_reflect_inertia_with_the_square_of_the_ratio():
    ratio, spring = RADIUS[1] / RADIUS[0], (4e4, 7e4)
    shafts = [
        shaft_chain(["motor", "pinion"], [5e-3, 6e-4], spring[0]),
        shaft_chain(["wheel", "load"], [2e-3, 9e-3], spring[1]),
    ]
    stiff = assemble(shafts, [GearMesh("pinion", "wheel", RADIUS[:2], 1e13)], {})
    shaft = shaft_chain(
        ["motor", "gears", "load"],
        [5e-3, 6e-4 + 2e-3 / ratio**2, 9e-3 / ratio**2],
        [spring[0], spring[1] / ratio**2],
    )
    reflected = natural_modes(assemble([shaft], [], {})).frequency
    np.testing.assert_allclose(natural_modes(stiff).frequency[:3], reflected, rtol=1e-5, atol=1e-3)


def test_torque_passes_both_stages():
    def second(phase):
        return 4e8 + 1e8 * np.cos(2.0 * np.pi * phase)

    orbit = steady_state(train(stiffness=second, cycles=3, lag=0.2), 900.0)
    force = orbit.fine.mean(orbit.fine.contact_force)
    ratio = RADIUS[1] / RADIUS[0]
    assert force[0] == pytest.approx(90.0 / RADIUS[0], rel=1e-9)
    assert force[1] == pytest.approx(90.0 * ratio / RADIUS[2], rel=1e-7)
    assert orbit.extra_force[-1] == pytest.approx(-90.0 * ratio * RADIUS[3] / RADIUS[2], rel=1e-7)
    assert orbit.converged


def test_mesh_with_three_cycles_in_the_common_one_shakes_at_three_times_its_frequency():
    def second(phase):
        return np.where(phase < 0.4, 5e8, 4e8)

    drive = train(stiffness=second, cycles=3, lag=0.25, events=(0.4,))
    events = drive.clocked_contacts[1].events
    assert events == pytest.approx(sorted({(k + at) / 3 for k in range(3) for at in (0.15, 0.75)}))
    orbit = steady_state(drive, 900.0)
    sizes = np.abs(mesh_harmonics(orbit, orbit.fine.contact_force[:, 0], 6))
    assert sizes[[0, 1, 3, 4]].max() < 1e-6 * sizes[2]
    alone = train(stiffness=second, events=(0.4,))
    other = steady_state(alone, 2700.0)
    np.testing.assert_allclose(
        sizes[[2, 5]],
        np.abs(mesh_harmonics(other, other.fine.contact_force[:, 0], 2)),
        rtol=1e-5,
    )


def test_idler_transmits_the_force_between_both_meshes():
    gears = [
        shaft_chain([name], inertia, mass=1.0, bearing_stiffness=1e9, bearing_damping=3e3)
        for name, inertia in (("a", 6e-4), ("idler", 2e-3), ("b", 3e-3))
    ]
    meshes = [
        GearMesh("a", "idler", (0.03, 0.05), lambda p: 3e8 + 1e7 * np.sin(2 * np.pi * p), 1500.0),
        GearMesh("idler", "b", (0.05, 0.06), 3e8, 1500.0, line_angle=0.0),
    ]
    drive = assemble(gears, meshes, {"a": 90.0, "b": -180.0})
    orbit = steady_state(drive, 900.0)
    force = orbit.fine.mean(orbit.fine.contact_force)
    assert force == pytest.approx([3000.0, 3000.0], rel=1e-9)
    # pushed along y by the first gear and back along x by the second
    place = orbit.fine.mean(orbit.fine.position)
    x, y = orbit.index("idler_x"), orbit.index("idler_y")
    assert place[[x, y]] == pytest.approx([-3e-6, 3e-6], rel=1e-9)
    assert natural_modes(drive).rigid == 1


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_one_pair_equals_the_reference_model(driver):
    mesh = SimpleNamespace(
        stiffness=lambda p: 3e8 + 0.0 * p,
        friction_sum=lambda p: 0.05 + 0.01 * p,
        friction_moment_pinion=lambda p: 0.001 * p,
        friction_moment_wheel=lambda p: 0.002 - 0.001 * p,
        event_phases=(0.0, 0.3),
    )
    reference = spur6(
        mesh, mass=(0.7, 1.1), moment_of_inertia=(4e-4, 1e-3), base_radius=(0.03, 0.05),
        torque=(90.0, 150.0), bearing_stiffness=1e9, mesh_damping=900.0, driver=driver,
    )  # fmt: skip
    pinion, wheel = (
        shaft_chain([name], inertia, mass=mass, bearing_stiffness=1e9)
        for name, inertia, mass in (("pinion", 4e-4, 0.7), ("wheel", 1e-3, 1.1))
    )
    teeth = GearMesh(
        "pinion", "wheel", (0.03, 0.05), mesh.stiffness, 900.0, events=(0.0, 0.3),
        driver=driver, friction=mesh,
    )  # fmt: skip
    built = assemble([pinion, wheel], [teeth], {})
    phase = np.linspace(0.0, 0.9, 4)
    (pinion_pair,), (other,) = reference.contacts, built.contacts
    assert isinstance(pinion_pair, Contact)
    np.testing.assert_allclose(other.direction, pinion_pair.direction, atol=1e-17)
    np.testing.assert_allclose(other.friction(phase), pinion_pair.friction(phase), atol=1e-17)
    np.testing.assert_array_equal(built.mass, reference.mass)
    np.testing.assert_array_equal(built.stiffness, reference.stiffness)
    assert built.names == reference.names


def test_refusals():
    disc = shaft_chain(["a"], 1e-3)
    with pytest.raises(InputError, match="two bodies"):
        assemble([disc, disc], [], {})
    with pytest.raises(InputError, match='no disc "b"'):
        assemble([disc], [GearMesh("a", "b", 0.03, 1e8)], {})
    with pytest.raises(InputError, match="cycles = 0"):
        assemble([disc, shaft_chain(["b"], 1e-3)], [GearMesh("a", "b", 0.03, 1e8, cycles=0)], {})
    with pytest.raises(InputError, match="Give one value, or 1"):
        shaft_chain(["a", "b"], 1e-3, [1e4, 1e4])
