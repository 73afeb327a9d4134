"""Micropitting by the specific film thickness: ISO/TS 6336-22, method B; the film of method A too.

At A, AB, B, C, D, DE and E, ``S_lambda = lambda_min/lambda_GFP``, ``lambda = h/Ra``,
``h = 1600 rho_n G_M^0.6 U^0.7 W^-0.13 S_GF^0.22`` in um and mm with ``G_M = 1e6 alpha_M E_r``,
``U = eta_M v_S/(2000 E_r rho_n)``, ``W = 2 pi p_dyn^2/E_r^2``,
``S_GF = alpha_B eta_B/(alpha_M eta_M)`` (B at the contact temperature, M at the bulk temperature),
``p_dyn = sqrt(E_r/(2 pi) F_t X_Y/(b rho_n cos(alpha_t) cos(beta_b)) K)``, the flash temperature of
Blok, and ``theta_M = theta_oil + 7400 (P mu_m H_v/(a b))^0.72 X_S/(1.2 X_Ca)`` (P in kW, mm).

By the FZG micropitting test C-GF/8.3 ``lambda_GFP = W_W lambda_GFT``: the film ratio of the test
gears at A, at the oil temperature of the test and the torque of the failure load stage 5 to 10:
70.0, 98.9, 132.5, 171.6, 215.6 and 265.1 N m.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.errors import quiet, warn
from tribodyn.friction import iso_6336_22
from tribodyn.gear import CylindricalPair, spur_pair
from tribodyn.rating.conditions import RatingConditions
from tribodyn.rating.factor import Factors, check_range
from tribodyn.rating.materials import GearMaterial
from tribodyn.rating.mesh_load import PRACTICE, MeshLoad
from tribodyn.rating.oil import GearOil
from tribodyn.rating.rated_gear import RatedGear
from tribodyn.rating.surface.path_load import PART_22, ScuffingLoad, overlap_factor
from tribodyn.types import Array

#: sqrt(lambda rho c) of gear steel with 45 W/(m K), 7800 kg/m3 and 440 J/(kg K).
THERMAL_COEFFICIENT: Final = math.sqrt(45.0 * 7800.0 * 440.0)
#: alpha_38 = a eta_38^b [m^2/N, Pa s] by base oil.
_PRESSURE_VISCOSITY: Final = {
    "mineral": (2.657e-8, 0.1348), "pao": (1.466e-8, 0.0507), "polyglycol": (1.392e-8, 0.1572),
    "water-soluble polyglycol": (1.392e-8, 0.1572),
}  # fmt: skip


#: Temperature [K] above which the pressure-viscosity coefficient has no meaning.
_HOTTEST: Final = 673.15


class FilmPoints(NamedTuple):
    """Film at points of the path of contact."""

    position: Array  #: G
    pressure: Array  #: p_dyn [Pa]
    flash_temperature: Array  #: [K]
    film_thickness: Array  #: h [m]
    film_ratio: Array  #: lambda


def pressure_viscosity(oil: GearOil, temperature: Array) -> Array:
    """Pressure-viscosity coefficient [1/Pa] at temperatures [K]."""
    scale, exponent = _PRESSURE_VISCOSITY.get(oil.base_oil, _PRESSURE_VISCOSITY["mineral"])
    at_38 = scale * oil.dynamic_viscosity(311.15) ** exponent
    return np.asarray(at_38 * (1.0 + 516.0 * (1.0 / temperature - 1.0 / 311.0)))


def load_losses_factor(load: ScuffingLoad) -> float:
    """H_v."""
    pair = load.mesh.pair
    first, second = load.addendum_ratios
    total = pair.transverse_contact_ratio
    shape = first**2 + second**2 + 1.0 - total if total < 2.0 else 0.5 * total
    teeth = 1.0 / pair.pinion.teeth + 1.0 / abs(pair.wheel.teeth) * pair.wheel.sign
    value = shape * teeth * math.pi / math.cos(pair.base_helix_angle)
    return load.factors.record("H_v", value, f"{PART_22}, load losses factor")


def _friction(load: ScuffingLoad) -> float:
    """mu_m at the oil temperature."""
    pair, oil = load.mesh.pair, load.oil
    normal = load.line_load * load.helical_factor / math.cos(pair.transverse_pressure_angle)
    speed = 2.0 * load.pitch_speed * math.sin(pair.operating_pressure_angle)
    radius = load.pitch_radius / math.cos(pair.base_helix_angle)
    viscosity = oil.dynamic_viscosity(oil.temperature)
    value = iso_6336_22(normal, speed, radius, viscosity, load.roughness, oil.lubricant_factor)
    return load.factors.record("mu_mGF", float(value), f"{PART_22}, mean friction")


def _relief_factor(load: ScuffingLoad) -> tuple[float, str]:
    """X_Ca of method B, with adequate relief and grade 6 or finer."""
    relief = min(gear.modification.tip_relief for gear in load.mesh.gears)
    if relief < 0.999 * load.effective_relief or (load.grade is not None and load.grade > 6):
        return 1.0, "no adequate relief"
    return overlap_factor(relief, relief, max(load.addendum_ratios)), "adequate relief"


def bulk_temperature(load: ScuffingLoad, friction: float) -> float:
    """theta_M [K]."""
    mesh, oil = load.mesh, load.oil
    power = 1e-3 * mesh.torque * mesh.speed
    area = 1e6 * mesh.pair.center_distance * mesh.face_width
    relief, branch = _relief_factor(load)
    relief = load.factors.record("X_Ca_22", relief, f"{PART_22}, tip relief factor", branch=branch)
    heat = power * friction * load_losses_factor(load) / area
    rise = 7400.0 * heat**0.72 * oil.lubrication_factor / (1.2 * relief)
    return load.factors.record("theta_MGF", oil.temperature + rise, PART_22, unit="K")


def _oil_temperatures(contact: Array, bulk: float) -> tuple[Array, float]:
    """Temperatures at which properties of the oil are taken, at most 400 degC [K]."""
    hottest = float(contact.max()) - 273.15
    check_range("theta_B", hottest, -20.0, 250.0, "the properties of an oil, in degC")
    if hottest > 400.0:
        warn("rating-range", f"theta_B = {hottest:.4g} degC: properties of the oil at 400 degC")
    return np.minimum(contact, _HOTTEST), min(bulk, _HOTTEST)


def sliding_parameter(oil: GearOil, contact: Array, bulk: float) -> tuple[Array, float, float]:
    """S_GF at contact temperatures [K]; eta_M [Pa s] and alpha_M [1/Pa] at the bulk temperature."""
    contact, bulk = _oil_temperatures(contact, bulk)
    eta_m, alpha_m = oil.dynamic_viscosity(bulk), float(pressure_viscosity(oil, np.asarray(bulk)))
    eta_b = np.array([oil.dynamic_viscosity(temperature) for temperature in contact.ravel()])
    alpha_b = pressure_viscosity(oil, contact)
    return alpha_b * eta_b.reshape(contact.shape) / (alpha_m * eta_m), eta_m, alpha_m


def heated_film(oil: GearOil, temperature: float, contact: Array, bulk: float) -> Array:
    """Film between heated flanks over an isothermal one of oil at a temperature [K]."""
    sliding, eta_m, alpha_m = sliding_parameter(oil, contact, bulk)
    _, eta, alpha = sliding_parameter(oil, np.array([temperature]), temperature)
    return np.asarray((alpha_m / alpha) ** 0.6 * (eta_m / eta) ** 0.7 * sliding**0.22)


def film_points(load: ScuffingLoad, position: Array) -> FilmPoints:
    """Film at positions G of the path of contact."""
    mesh, pair, oil = load.mesh, load.mesh.pair, load.oil
    friction = _friction(load)
    bulk = bulk_temperature(load, friction)
    motion = path_of_contact(pair).kinematics(load.points.path(position), mesh.speed)
    radius, modulus = motion.equivalent_radius, load.modulus
    angles = math.cos(pair.transverse_pressure_angle) * math.cos(pair.base_helix_angle)
    share = load.points.share(position, load.grade)
    pressure = np.sqrt(modulus / (2.0 * np.pi) * share * load.line_load / (radius * angles))
    speeds = motion.entrainment_speed, motion.sliding_speed
    flash, film = local_film(oil, (modulus, friction, bulk), pressure, radius, speeds)
    return FilmPoints(position, pressure, flash, film, film / load.roughness)


def local_film(
    oil: GearOil,
    mesh: tuple[float, float, float],
    pressure: Array,
    radius: Array,
    speeds: tuple[Array, Array],
) -> tuple[Array, Array]:
    """Flash temperature [K] and film [m] where flanks have a pressure [Pa]."""
    modulus, friction, bulk = mesh  # E_r [Pa], mean friction, temperature [K]
    entrainment, sliding_speed = speeds
    surfaces = np.abs(entrainment + 0.5 * sliding_speed), np.abs(entrainment - 0.5 * sliding_speed)
    carried = THERMAL_COEFFICIENT * (np.sqrt(surfaces[0]) + np.sqrt(surfaces[1]))
    flash = 0.5 * math.sqrt(math.pi) * friction * pressure * np.abs(sliding_speed) / carried
    flash *= np.sqrt(8.0 * radius * pressure / modulus)
    sliding, eta_m, alpha_m = sliding_parameter(oil, bulk + flash, bulk)
    speed = eta_m * entrainment / (modulus * radius)
    loaded = np.maximum(2.0 * np.pi * pressure**2 / modulus**2, 1e-300)
    film = 1.6 * radius * (alpha_m * modulus) ** 0.6 * speed**0.7 * loaded**-0.13 * sliding**0.22
    return flash, film


def material_factor(load: ScuffingLoad) -> float:
    """W_W, mean of both gears, by type of material unless stated."""
    values = []
    for gear in load.mesh.rated:
        kind = gear.material.kind
        default = 1.0 if kind == "Eh" else 1.5 if kind.startswith("N") else 0.5
        default = 0.65 if kind == "IF" else default
        values.append(default if gear.micropitting_factor is None else gear.micropitting_factor)
    return sum(values) / 2.0


def least_film_ratio(load: ScuffingLoad) -> float:
    """lambda_min of a mesh, with the film at each named point."""
    names = load.points.named
    within = load.points.ends
    films = film_points(load, np.array(list(names.values())))
    record = load.factors.record
    for name, place, film, ratio in zip(
        names, films.position, films.film_thickness, films.film_ratio, strict=True
    ):
        if within[0] <= place <= within[1]:
            branch = f"G = {place:.4g}, h = {film * 1e6:.4g} um"
            record(f"lambda_{name}", float(ratio), f"{PART_22}, film ratio", branch=branch)
    inside = (films.position >= within[0]) & (films.position <= within[1])
    least = int(np.argmin(np.where(inside, films.film_ratio, np.inf)))
    branch = f"at {list(names)[least]}"
    return record("lambda_min", float(films.film_ratio[least]), PART_22, branch=branch)


#: Torque of the pinion [N*m] by failure load stage.
TORQUES = {5: 70.0, 6: 98.9, 7: 132.5, 8: 171.6, 9: 215.6, 10: 265.1}
#: Speed of the pinion [1/min], and Ra of the flanks [m].
_SPEED, _ROUGHNESS = 2250.0, 0.5e-6


@lru_cache(maxsize=1)
def _test_gears() -> CylindricalPair:
    """Type C-GF."""
    with quiet():
        return spur_pair(
            pinion_teeth=16,
            wheel_teeth=24,
            normal_module=4.5e-3,
            normal_pressure_angle=math.radians(20.0),
            center_distance=91.5e-3,
            pinion_profile_shift_coefficient=0.182,
            wheel_profile_shift_coefficient=0.171,
            pinion_tip_diameter=82.46e-3,
            wheel_tip_diameter=118.36e-3,
            pinion_face_width=14e-3,
        )


def reference_film_ratio(oil: GearOil, stage: int) -> float:
    """lambda_GFT of an oil that failed in a load stage."""
    gear = RatedGear(material=GearMaterial(), arithmetic_roughness=_ROUGHNESS)
    ones = dict.fromkeys(("K_A", "K_gamma", "K_v", "K_Hbeta", "K_Halpha"), 1.0)
    factors = Factors({**ones, "C_eff": 1.0})  # no relief
    for name in ones:
        factors.record(name, 1.0, PART_22)
    factors.record("c_prime", 1e10, PART_22)
    speed = _SPEED * math.pi / 30.0
    mesh = MeshLoad(_test_gears(), gear, gear, RatingConditions(), TORQUES[stage], speed, factors)
    tested = replace(
        oil,
        temperature=oil.micropitting_test_temperature,
        lubrication=oil.micropitting_test_lubrication,
    )
    load = ScuffingLoad(mesh, tested)
    with quiet("friction-range"):
        films = film_points(load, np.array([load.points.named["A"]]))
    return float(films.film_ratio[0])


def record_micropitting(load: ScuffingLoad) -> float | None:
    """S_lambda of a mesh; None without a load stage of the oil or a permissible film ratio."""
    record, oil = load.factors.record, load.oil
    least = least_film_ratio(load)
    if "lambda_GFP" in load.factors.replacements:
        limit = record("lambda_GFP", 0.0, f"{PART_22}, permissible film ratio")
    elif oil.micropitting_load_stage is None:
        return None
    else:
        stage = oil.micropitting_load_stage
        tested = reference_film_ratio(oil, stage)
        branch = f"load stage {stage}"
        tested = record("lambda_GFT", tested, f"{PRACTICE}, test gears at A", branch=branch)
        weight = record("W_W", material_factor(load), f"{PRACTICE}, material factor")
        limit = record("lambda_GFP", weight * tested, f"{PART_22}, permissible film ratio")
    return record("S_lambda", least / limit, f"{PART_22}, safety against micropitting, method B")
