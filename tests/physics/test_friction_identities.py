"""Friction laws against plain formulas anywhere, and friction moments against sliding power."""

from __future__ import annotations

import math

import numpy as np
import pytest

from known_pairs import pair_of, standard, type_c
from references import friction_formulas as printed
from references import friction_table
from tribodyn.contact import effective_modulus, hertz_line, path_of_contact
from tribodyn.errors import quiet
from tribodyn.friction import LAWS, TribologicalContact, pitch_point
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import build

#: Pairs, speeds [rad/s], torques [N m], oils [Pa s, kg/m^3], roughness [m] and film [m].
STATES = [
    (pair_of(), 94.2, 90.0, (0.082, 880.0), 0.53e-6, 0.3e-6),
    (pair_of(driver="wheel"), 210.0, 140.0, (0.03, 861.0), 0.25e-6, 0.5e-6),
    (type_c(), 300.0, 200.0, (0.012, 840.0), 0.4e-6, 0.2e-6),
    (standard((20, 31)), 150.0, 60.0, (0.16, 900.0), 0.1e-6, 0.9e-6),
]
STEEL = Material()


def contacts(pair, speed, torque, oil, roughness, film):
    """Nine places from A to E, with half of the load on the pair."""
    path = path_of_contact(pair)
    where = path.A + (path.E - path.A) * np.linspace(0.03, 0.97, 9)
    motion = path.kinematics(where, speed)
    point = pitch_point(pair, speed, torque)
    load = np.full(9, 0.5 * point.load_per_width)
    modulus = effective_modulus(STEEL, STEEL)
    return TribologicalContact(
        load_per_width=load,
        hertz_pressure=hertz_line(load, motion.equivalent_radius, modulus).maximum_pressure,
        sliding_speed=motion.sliding_speed,
        entrainment_speed=motion.entrainment_speed,
        slide_to_roll_ratio=motion.slide_to_roll_ratio,
        equivalent_radius=motion.equivalent_radius,
        dynamic_viscosity=oil[0],
        composite_roughness=roughness,
        oil_density=oil[1],
        film_thickness=np.full(9, film),
        pitch=point,
    )


def plain_xu(ratio, pressure, viscosity, roughness, speed, radius, log=math.log10):
    """GPa, cP, um, m/s and m, with the coefficients of the paper."""
    shear = abs(ratio) * pressure * log(viscosity)
    f = -8.916465 - 0.354068 * shear + 2.812084 * math.exp(-shear)
    f += 0.620305 * math.exp(roughness)
    powers = pressure**1.03303 * abs(ratio) ** 1.036077 * speed**-0.100601
    return math.exp(f) * powers * viscosity**0.752755 * radius**-0.390958


def plain_benedict_kelly(load, sliding, speed, viscosity, roughness):
    """N/mm, m/s, cP and um."""
    argument = 29700.0 * load / (viscosity * abs(sliding) * speed**2)
    return 0.0127 * 1.13 / (1.13 - roughness) * math.log10(argument)


def plain(name, c, i):
    """Coefficient of contact i by the printed formula of a law, in its units."""
    speed, sliding = c.entrainment_speed[i], c.sliding_speed[i]
    viscosity, roughness = c.dynamic_viscosity * 1e3, c.composite_roughness * 1e6
    ratio, pressure = c.slide_to_roll_ratio[i], c.hertz_pressure[i] * 1e-9
    kinematic = c.dynamic_viscosity / c.oil_density * 1e6
    if name == "xu-2007":
        return plain_xu(ratio, pressure, viscosity, roughness, speed, c.equivalent_radius[i])
    if name == "benedict-kelly":
        load = c.load_per_width[i] * 1e-3
        return max(plain_benedict_kelly(load, sliding, speed, viscosity, roughness), 0.0)
    if name == "mixed-ehl":
        share = min(printed.load_share(c.film_thickness[i] / c.composite_roughness), 1.0)
        share = 1.0 if c.film_thickness[i] / c.composite_roughness > 2.2576 else share
        film = plain("xu-2007", c, i)
        return film * share**1.2 + 0.15 * (1.0 - share)
    if name == "drozdov":
        return printed.drozdov(abs(sliding), 2.0 * speed, kinematic, pressure * 1e9 / 98066.5)
    if name == "misharin":
        coefficient = printed.misharin(abs(sliding), 2.0 * speed, kinematic)
        return min(max(coefficient, 0.02), 0.08)
    point = c.pitch
    state = (
        point.load_per_width * 1e-3, point.sum_velocity, point.equivalent_radius * 1e3, viscosity,
        roughness / math.sqrt(math.pi),
    )  # fmt: skip
    return {"schlenk": printed.schlenk, "iso-6336-22": printed.iso_6336_22}[name](*state)


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize(
    "name",
    ["xu-2007", "benedict-kelly", "mixed-ehl", "drozdov", "misharin", "schlenk", "iso-6336-22"],
)
def test_laws_at_other_places_of_other_gears_with_other_oils(name, state):
    c = contacts(*state)
    with quiet("friction-range", "friction-roughness"):
        coefficient = LAWS[name](c)
    assert coefficient == pytest.approx([plain(name, c, i) for i in range(9)], rel=1e-12)


#: A slip, and what it does to the arguments of the plain formula of Xu.
XU_SLIPS = {
    "right": {},
    "MPa in the place of GPa": {"pressure": 1e3},
    "sum of the speeds": {"speed": 2.0, "ratio": 0.5},
    "sum of the speeds, same ratio": {"speed": 2.0},
    "mm in the place of m": {"radius": 1e3},
    "Pa s in the place of cP": {"viscosity": 1e-3},
    "Ra in the place of rms": {"roughness": 0.8},
    "natural logarithm": {"log": math.log},
}


@pytest.mark.parametrize("slip", XU_SLIPS)
def test_reference_values_of_xu_tell_every_slip(slip):
    changed = dict(XU_SLIPS[slip])
    log = changed.pop("log", math.log10)
    errors = []
    for row in friction_table.TABLE:
        _, _, _, speed, ratio, radius, pressure, wanted, _ = row
        state = {"ratio": ratio, "pressure": pressure, "viscosity": 82.0, "roughness": 0.53,
                 "speed": speed, "radius": radius * 1e-3}  # fmt: skip
        state = {name: value * changed.get(name, 1.0) for name, value in state.items()}
        errors.append(abs(plain_xu(**state, log=log) / wanted - 1.0))
    if slip == "right":
        assert max(errors) < 1e-5
    else:
        assert min(errors) > 1e-2


@pytest.mark.parametrize(
    ("load", "speed", "viscosity", "roughness"),
    [(1e3, 1, 1, 1), (1, 2, 1, 1), (1, 1, 1e-3, 1), (1, 1, 1, 0.8)],
)
def test_reference_values_of_benedict_and_kelly_tell_every_slip(load, speed, viscosity, roughness):
    for row in friction_table.TABLE:
        _, share, sliding, entrainment, _, _, _, _, wanted = row
        width = share * friction_table.NORMAL_FORCE / friction_table.FACE_WIDTH * 1e-3
        state = (width, sliding, entrainment, 82.0, 0.53)
        assert plain_benedict_kelly(*state) == pytest.approx(wanted, rel=1e-5)
        slips = (width * load, sliding, entrainment * speed, 82.0 * viscosity, 0.53 * roughness)
        assert abs(plain_benedict_kelly(*slips) / wanted - 1.0) > 1e-2


@pytest.mark.parametrize("law", ["xu-2007", "mixed-ehl", "mixed", "benedict-kelly", "schlenk"])
@pytest.mark.parametrize("state", STATES[:3])
def test_moments_times_speeds_are_friction_times_sliding(law, state):
    pair, speed, torque, oil, roughness, _ = state
    with quiet():
        mesh = build(
            pair,
            material=STEEL,
            stiffness_model="rectangular",
            stiffness_options={"pair_stiffness": 3e8},
            lubricant=Lubricant(oil[0], oil[1], 2e-8),
            friction_law=law,
            composite_roughness=roughness,
            film_model="dowson-higginson",
            pinion_speed=speed,
            pinion_torque=torque,
            steps=64,
        )
    wheel = speed / pair.ratio
    power = mesh.friction_moment_pinion * speed - mesh.friction_moment_wheel * wheel
    sliding = mesh.friction_coefficient * mesh.load_share * np.abs(mesh.sliding_speed)
    assert power == pytest.approx(sliding.sum(axis=1), rel=1e-10)
    parts = mesh.asperity_friction_coefficient
    assert (parts is None) == (law not in ("mixed", "mixed-ehl"))
    if parts is not None:
        touching = mesh.in_contact
        film = mesh.friction_coefficient[touching] - parts[touching]
        assert np.all((film >= 0.0) & (parts[touching] >= 0.0))
        assert parts[touching] == pytest.approx(0.15 * (1.0 - mesh.film_load_share[touching]))
        assert mesh.mean_asperity_friction_coefficient < mesh.mean_friction_coefficient
