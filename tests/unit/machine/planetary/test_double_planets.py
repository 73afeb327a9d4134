"""Stepped and meshed double planets in the plane model: rotation, loads, phases, modes, motion."""

import math

import numpy as np
import pytest

from known_planetary import LIN_PARKER
from tribodyn.dynamics import harmonic_balance
from tribodyn.errors import InputError
from tribodyn.machine import (
    MeshedPlanets,
    SteppedPlanets,
    load_shares,
    mesh_phases,
    planetary_kinematics,
    planetary_modes,
    planetary_plane_model,
    planetary_positions,
)

#: Teeth of sun, planet at the sun, planet at the ring, ring.
STEPPED, MESHED = (18, 30, 20, 72), (24, 16, 18, 66)
TEETH = {"stepped": STEPPED, "meshed": MESHED}
MODULE, RACK = 2e-3, math.radians(20.0)


def base(teeth):
    return 0.5 * MODULE * teeth * math.cos(RACK)


def geometry(kind):
    """Double planets, pressure angles, and radii of u of sun, planets, ring and carrier."""
    sun, first, second, ring = TEETH[kind]
    to_sun = 0.5 * MODULE * (sun + first)
    to_ring = 0.5 * MODULE * (ring - second)
    radii = {"sun": base(sun), "first": base(first), "second": base(second), "ring": base(ring)}
    radii["carrier"] = to_sun
    if kind == "stepped":
        # The ring has another module: its teeth reach the axis of the planets.
        ratio = to_sun / to_ring
        radii["ring"], radii["second"] = radii["ring"] * ratio, radii["second"] * ratio
        return SteppedPlanets(radii["second"] / radii["first"]), radii
    between = 0.5 * MODULE * (first + second)
    cosine = (to_sun**2 + to_ring**2 - between**2) / (2.0 * to_sun * to_ring)
    pair = MeshedPlanets(
        *(0.7, 0.5, 6e8, RACK), angle=math.acos(cosine), radius_ratio=to_ring / to_sun
    )
    return pair, radii


def model(kind, planets=3, **changes):
    double, _ = geometry(kind)
    angles = {"sun_pressure_angle": RACK, "ring_pressure_angle": RACK}
    data = {**LIN_PARKER, **angles, "force_per_planet": 1000.0, **changes}
    return planetary_plane_model(planets=planets, double_planets=double, **data)


def kinematics(kind, held, driver, **more):
    sun, first, second, ring = TEETH[kind]
    return planetary_kinematics(
        sun_teeth=sun, ring_teeth=ring, planet_teeth=(first, second), planet_type=kind,
        held=held, input=driver, input_speed=100.0, **more,
    )  # fmt: skip


@pytest.mark.parametrize("kind", TEETH)
@pytest.mark.parametrize(
    ("held", "driver"), [("ring", "sun"), ("sun", "carrier"), ("carrier", "ring")]
)
def test_speeds_by_willis_strain_no_mesh(kind, held, driver):
    _, radii = geometry(kind)
    stage, system = kinematics(kind, held, driver), model(kind)
    motion, at = np.zeros(system.size), 2.0 * np.pi * np.arange(3) / 3
    for first, member in zip((2, 5, 8), ("carrier", "ring", "sun"), strict=True):
        motion[first] = stage.speeds[member] * radii[member]
    meshed = kind == "meshed"
    speeds = ("sun_planet", "ring_planet") if meshed else ("planet",)
    for body, name in enumerate(speeds):
        first = 9 + 9 * body + 3 * np.arange(3)
        angle, radius = at, radii["carrier"]
        if body:
            pair, _ = geometry(kind)
            angle, radius = at + pair.angle, radius * pair.radius_ratio
        motion[first] = -np.sin(angle) * radius * stage.speeds["carrier"]
        motion[first + 1] = np.cos(angle) * radius * stage.speeds["carrier"]
        motion[first + 2] = stage.speeds[name] * radii[("first", "second")[body]]
    scale = np.abs(motion).max()
    for contact in system.contacts:
        assert contact.direction @ motion == pytest.approx(0.0, abs=1e-12 * scale)
    # The pins move with the carrier: only the supports of the central members are strained.
    strained = np.asarray(system.stiffness) @ motion
    np.testing.assert_allclose(strained[9:], 0.0, atol=1e-6 * 1e8 * scale)
    together = np.zeros(system.size)
    together[0::3] = 1.0
    assert all(abs(contact.direction @ together) < 1e-12 for contact in system.contacts)


@pytest.mark.parametrize("kind", TEETH)
def test_loads_are_the_torques_of_willis(kind):
    _, radii = geometry(kind)
    load = np.asarray(model(kind, ring_torsional_support=0.0).force)
    torques = {m: load[i] * radii[m] for i, m in ((2, "carrier"), (5, "ring"), (8, "sun"))}
    assert torques["sun"] == pytest.approx(3 * 1000.0 * radii["sun"])
    assert sum(torques.values()) == pytest.approx(0.0, abs=1e-12 * abs(torques["carrier"]))
    stage = kinematics(kind, "ring", "sun", input_torque=torques["sun"])
    for member, torque in stage.torques.items():
        assert torques[member] == pytest.approx(torque, rel=1e-12)
    # Meshed planets: the ring turns with the sun where the carrier is held.
    sign = 1.0 if kind == "meshed" else -1.0
    assert kinematics(kind, "carrier", "sun").ratio * sign > 0.0


def test_stepped_planets_with_equal_gears_are_simple_planets():
    simple = planetary_plane_model(planets=4, force_per_planet=3000.0, **LIN_PARKER)
    equal = planetary_plane_model(
        planets=4, force_per_planet=3000.0, double_planets=SteppedPlanets(1.0), **LIN_PARKER
    )
    for name in ("mass", "stiffness", "force"):
        expected = np.asarray(getattr(simple, name))
        np.testing.assert_allclose(getattr(equal, name), expected, rtol=1e-12)
    for one, other in zip(simple.contacts, equal.contacts, strict=True):
        np.testing.assert_array_equal(one.direction, other.direction)
    teeth = {"sun_teeth": 17, "ring_teeth": 61, "planets": 3}
    single = mesh_phases(**teeth)
    stepped = mesh_phases(**teeth, planet_teeth=(22, 22), planet_type="stepped")
    assert stepped.cycles == {"sun": 1, "ring": 1}
    np.testing.assert_allclose(stepped.ring, single.ring, atol=1e-12)


@pytest.mark.parametrize("kind", TEETH)
def test_a_floating_sun_shares_the_load_and_forces_follow_the_radii(kind):
    double, _ = geometry(kind)
    data = {**LIN_PARKER, "sun_pressure_angle": RACK, "ring_pressure_angle": RACK}
    data |= {"planets": 3, "force_per_planet": 1000.0, "double_planets": double}
    errors = {"pin_errors": [80e-6, 0.0, -20e-6]}
    floating = load_shares(**{**data, "sun_support": 0.0}, **errors)
    np.testing.assert_allclose(floating.share, 1.0, atol=1e-9)
    supported = load_shares(**{**data, "sun_support": 1e10}, **errors)
    assert supported.share[0] < 0.95
    # The same loads by the equations of all coordinates, with the rotations of the planets.
    system = planetary_plane_model(**{**data, "sun_support": 1e10}, **errors)
    rows = np.array([contact.direction for contact in system.contacts])
    springs = np.array([float(contact.stiffness) for contact in system.contacts])
    matrix = np.asarray(system.stiffness) + (rows.T * springs) @ rows
    position = np.linalg.lstsq(matrix, np.asarray(system.force), rcond=1e-13)[0]
    forces = (springs * (rows @ position)).reshape(-1, 3)
    np.testing.assert_allclose(supported.force, forces[0], rtol=1e-6)
    ratios = list(double.force_ratio.values())
    np.testing.assert_allclose(forces, np.outer(ratios, forces[0]), rtol=1e-6)


def test_modes_of_pairs_have_types_and_multiplicities():
    modes = planetary_modes(model("meshed", 4))
    counts = {kind: modes.types.count(kind) for kind in ("rotational", "translational", "planet")}
    assert counts == {"rotational": 9, "translational": 18, "planet": 6}
    moving = modes.of_type("translational")
    np.testing.assert_allclose(moving[0::2], moving[1::2], rtol=1e-8)


def test_phases_of_double_planets():
    sun, first, second, ring = MESHED
    teeth = {"sun_teeth": sun, "ring_teeth": ring, "planet_teeth": (first, second)}
    angles = 2.0 * np.pi / (ring - sun) * np.array([0.0, 13.0, 29.0])
    phases = mesh_phases(**teeth, planets=3, angles=angles, planet_type="meshed", sun_to_planet=0.2)
    np.testing.assert_allclose(phases.sun, sun * angles / (2.0 * np.pi) % 1.0, atol=1e-9)
    np.testing.assert_allclose(phases.ring, phases.sun, atol=1e-9)  # the ring turns with the sun
    np.testing.assert_allclose(phases.planet, (phases.sun + 0.2) % 1.0, atol=1e-9)
    sun, first, second, ring = STEPPED
    teeth = {"sun_teeth": sun, "ring_teeth": ring, "planet_teeth": (first, second)}
    stepped = mesh_phases(**teeth, planets=4, planet_type="stepped")
    assert stepped.cycles == {"sun": 3, "ring": 2}
    # 18 teeth of the sun and 72 of the ring for 4 planets: other types are excited by each.
    assert (stepped.excitation(1).types, stepped.excitation(1, "ring").types) == ("P", "R")
    stage = kinematics("stepped", "ring", "sun")
    ring_frequency = ring * abs(stage.relative_speeds["ring"]) / (2.0 * np.pi)
    assert stage.mesh_frequency / ring_frequency == pytest.approx(3 / 2)


def test_planets_that_do_not_fit_are_refused():
    sun, first, second, ring = STEPPED
    teeth = {"sun_teeth": sun, "ring_teeth": ring, "planet_teeth": (first, second)}
    with pytest.raises(InputError, match=r"\(18\*20 \+ 72\*30\)/gcd\(30, 20\)\)/5"):
        mesh_phases(**teeth, planets=5, planet_type="stepped")
    with pytest.raises(InputError, match="A stepped planet has 2 gears"):
        mesh_phases(sun_teeth=18, ring_teeth=72, planets=3, planet_type="stepped")
    with pytest.raises(InputError, match="Both planets of a pair have the same axis"):
        MeshedPlanets(0.7, 0.5, 6e8, RACK, angle=0.0)
    with pytest.raises(InputError, match="double_planets is int"):
        planetary_plane_model(planets=3, double_planets=2, **LIN_PARKER)
    assert planetary_positions(**teeth, planets=4, planet_type="stepped").clearance is None


def test_motion_of_pairs_in_phase_only_turns_until_a_pin_differs():
    sun, first, second, ring = MESHED  # 24 teeth of the sun and 3 pairs: all in phase
    phases = mesh_phases(
        sun_teeth=sun, ring_teeth=ring, planets=3, planet_teeth=(first, second),
        planet_type="meshed",
    )  # fmt: skip

    def stiffness(phase):
        return 5e8 * (1.0 + 0.1 * np.cos(2.0 * np.pi * phase))

    moves = []
    for error in (0.0, 30e-6):
        system = model(
            "meshed", phases=phases, sun_mesh_stiffness=stiffness, damping_ratio=0.02,
            pin_errors=[error, 0.0, 0.0],
        )  # fmt: skip
        motion = harmonic_balance(system, 700.0)
        ranges = np.ptp(motion.position, axis=0)
        moves.append(ranges[system.names.index("sun_x")] / ranges[system.names.index("sun_u")])
    assert moves[0] < 1e-9 < 1e-4 < moves[1]


def test_stepped_planets_have_two_mesh_frequencies_in_one_motion():
    sun, first, second, ring = STEPPED
    phases = mesh_phases(
        sun_teeth=sun, ring_teeth=ring, planets=3, planet_teeth=(first, second),
        planet_type="stepped",
    )  # fmt: skip

    def stiffness(phase):
        return 5e8 * (1.0 + 0.1 * np.cos(2.0 * np.pi * phase))

    entry = {"phases": phases, "ring_mesh_stiffness": stiffness, "damping_ratio": 0.02}
    motion = harmonic_balance(model("stepped", **entry), 250.0)
    rotation = motion.position[:, 5] - motion.position[:, 5].mean()
    spectrum = np.abs(np.fft.rfft(rotation))
    spectrum = spectrum / spectrum.max()
    # Two cycles of the ring meshes in the period; the constant sun meshes add nothing.
    assert int(spectrum.argmax()) == 2
    assert spectrum[1::2].max() < 1e-7
