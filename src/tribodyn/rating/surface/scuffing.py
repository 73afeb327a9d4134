"""Scuffing by the flash and by the integral temperature: ISO/TS 6336-20 and -21.

Flash temperature, in N/mm, m/s, mm, mPa s, um and degC:
``theta_fl = mu_m X_M X_J X_G (X_share w_Bt K_Bgamma)^0.75 v_t^0.5/a^0.25``,
``X_M = 1000 E_r^0.25/B_M``, ``X_G = 0.51 X_ab sqrt(u + 1) |sqrt(1 + G) - sqrt(1 - G/u)|/
((1 + G)(u - G))^0.25``, ``mu_m = 0.060 (w_Bt/(v_SC rho_relC))^0.2 X_L eta_oil^-0.05 Ra^0.25``;
``theta_M = theta_oil + 0.47 X_S X_mp theta_fl,mean``, ``theta_Bmax = theta_M + theta_fl,max``,
``theta_S = 80 + (0.85 + 1.4 X_W) X_L eta_oil^-0.05 S_FZG^2``,
``S_B = (theta_S - theta_oil)/(theta_Bmax - theta_oil)``. The flash temperature is that of Blok.

Integral temperature, at the tip of the pinion:
``theta_flE = mu X_M X_BE X_ab (K_Bgamma w_Bt)^0.75 v^0.5/a^0.25 X_E/(X_Q X_Ca)``,
``mu = 0.045 (w_Bt K_Bgamma/(v_SC rho_redC))^0.2 eta^-0.05 X_R X_L`` with w_Bt of at least 150,
``theta_flaint = theta_flE X_eps``, ``theta_M = theta_oil + 0.7 X_S X_mp theta_flaint``,
``theta_int = theta_M + 1.5 theta_flaint``; with ``T = 3.726 S_FZG^2``
``theta_intS = 80 + 0.23 T X_L + X_W 1.5 0.2 T (100/nu_40)^0.02 X_L``; ``S = theta_intS/theta_int``:
below 1 high, 1 to 2 critical, above 2 low risk.
"""

from __future__ import annotations

import math

import numpy as np

from tribodyn.rating.surface.path_load import (
    PART_20,
    PART_21,
    PathPoints,
    ScuffingLoad,
    line_factor,
    overlap_factor,
)
from tribodyn.types import Array

#: Thermal contact coefficient of gear steel [N/(mm^0.5 m^0.5 s^0.5 K)].
THERMAL_COEFFICIENT = 435.0
ZERO = 273.15


def geometry_factor(points: PathPoints, position: Array) -> Array:
    """X_G along the path."""
    u = points.pair.ratio
    sliding = np.abs(np.sqrt(1.0 + position) - np.sqrt(1.0 - position / u))
    curvature = np.abs((1.0 + position) * (u - position)) ** 0.25
    scale = 0.51 * line_factor(points.pair) * math.sqrt(abs(u + 1.0))
    return np.asarray(scale * sliding / curvature)


def approach_factor(load: ScuffingLoad, position: Array) -> Array:
    """X_J of the approach, where the tip of the driven gear comes in with too little relief."""
    pair = load.mesh.pair
    first, last = load.points.ends
    driven, side = (1, -1.0) if pair.driver == "pinion" else (0, 1.0)
    relief = load.mesh.gears[driven].modification.tip_relief
    excess = max(1e6 * (load.effective_relief - relief), 0.0) / 50.0
    approach = np.maximum(side * position, 0.0) / (last - first)
    return np.asarray(1.0 + excess * approach**3)


def mean_friction(load: ScuffingLoad) -> float:
    """mu_m of the flash temperature method."""
    speed = 2.0 * min(load.pitch_speed, 50.0) * math.sin(load.mesh.pair.operating_pressure_angle)
    viscosity = 1e3 * load.oil.dynamic_viscosity(load.oil.temperature)
    pressed = 1e-3 * load.line_load / (speed * 1e3 * load.pitch_radius)
    value = 0.060 * pressed**0.2 * load.oil.lubricant_factor * viscosity**-0.05
    value *= (1e6 * load.roughness) ** 0.25
    branch = "v_t limited to 50 m/s" if load.pitch_speed > 50.0 else ""
    return load.factors.record("mu_m", value, f"{PART_20}, mean friction", branch=branch)


def flash_temperatures(load: ScuffingLoad, position: Array, friction: float) -> Array:
    """theta_fl along the path [K]."""
    pair = load.mesh.pair
    share = load.points.share(position, load.grade)
    unit = 1e-3 * share * load.line_load * load.helical_factor
    material = 1000.0 * (1e-6 * load.modulus) ** 0.25 / THERMAL_COEFFICIENT
    scale = friction * material * math.sqrt(load.pitch_speed) / (1e3 * pair.center_distance) ** 0.25
    shape = approach_factor(load, position) * geometry_factor(load.points, position)
    return np.asarray(scale * shape * unit**0.75)


def scuffing_temperature(stage: int, load: ScuffingLoad) -> float:
    """theta_S [K] from the failure load stage of the FZG test A/8.3/90."""
    viscosity = 1e3 * load.oil.dynamic_viscosity(load.oil.temperature)
    slope = (0.85 + 1.4 * load.structure_factor) * load.oil.lubricant_factor * viscosity**-0.05
    return float(ZERO + 80.0 + slope * stage**2)


def record_scuffing_flash(load: ScuffingLoad) -> float | None:
    """S_B of a mesh; None without a load stage of the oil."""
    record, oil, points = load.factors.record, load.oil, load.points
    record("X_M", 1000.0 * (1e-6 * load.modulus) ** 0.25 / THERMAL_COEFFICIENT, PART_20)
    record("X_alphabeta", line_factor(points.pair), f"{PART_20}, pressure angle factor")
    friction = mean_friction(load)
    position = points.grid()
    flash = flash_temperatures(load, position, friction)
    first, last = points.ends
    mean = float(np.trapezoid(flash, position)) / (last - first)
    mean = record("theta_fl_mean", mean, f"{PART_20}, mean flash temperature", unit="K")
    place = position[int(np.argmax(flash))]
    branch = f"at G = {place:.4g}"
    highest = record("theta_fl_max", float(flash.max()), PART_20, unit="K", branch=branch)
    cooling = record(
        "X_S", oil.lubrication_factor, f"{PART_20}, lubrication", branch=oil.lubrication
    )
    bulk = oil.temperature + 0.47 * cooling * load.mates_factor * mean
    bulk = record("theta_M", bulk, f"{PART_20}, bulk temperature", unit="K")
    contact = record("theta_B_max", bulk + highest, f"{PART_20}, contact temperature", unit="K")
    if oil.scuffing_load_stage is None:
        return None
    limit = scuffing_temperature(oil.scuffing_load_stage, load)
    limit = record("theta_S", limit, f"{PART_20}, scuffing temperature", unit="K")
    record("scuffing_margin", limit - contact, f"{PART_20}, at least 50 K", unit="K")
    safety = (limit - oil.temperature) / (contact - oil.temperature)
    return record("S_B", safety, f"{PART_20}, safety against scuffing")


def friction_coefficient(load: ScuffingLoad) -> float:
    """Mean friction of the integral temperature method."""
    pair, oil = load.mesh.pair, load.oil
    radius = 1e3 * load.pitch_radius / math.cos(pair.base_helix_angle)
    speed = 2.0 * load.mesh.pitch_line_speed * math.tan(pair.operating_pressure_angle)
    speed *= math.cos(pair.transverse_pressure_angle)
    unit = 1e-3 * load.line_load
    rough = 2.2 * (1e6 * load.roughness / radius) ** 0.25
    viscosity = 1e3 * oil.dynamic_viscosity(oil.temperature)
    pressed = max(unit, 150.0) * load.helical_factor / (speed * radius)
    value = 0.045 * pressed**0.2 * viscosity**-0.05 * rough * oil.lubricant_factor
    branch = f"w_Bt = {unit:.4g} N/mm raised to 150 N/mm" if unit < 150.0 else ""
    return load.factors.record("mu_mC", value, f"{PART_21}, mean friction", branch=branch)


def tip_geometry_factor(load: ScuffingLoad) -> float:
    """X_BE at the tip of the pinion."""
    pair = load.mesh.pair
    pinion, ratio = pair.pinion, pair.ratio
    first = math.sqrt(pinion.tip_radius**2 - pinion.base_radius**2)
    second = pair.line_of_action_length - first
    sliding = abs(math.sqrt(first) - math.sqrt(second / ratio))
    return float(0.51 * math.sqrt(abs(ratio + 1.0)) * sliding / abs(first * second) ** 0.25)


def approach_ratio_factor(ratio: float) -> float:
    """X_Q by the approach over the recess addendum contact ratio."""
    return min(max(1.4 - 4.0 / 15.0 * ratio, 0.6), 1.0)


def contact_ratio_factor(first: float, second: float) -> float:
    """X_eps from the addendum contact ratios of pinion and wheel."""
    total = first + second
    if total < 1.0:
        shape = first**2 + second**2
    elif total < 2.0 and max(first, second) < 1.0:
        shape = 0.70 * (first**2 + second**2) - 0.22 * total + 0.52 - 0.60 * first * second
    else:
        larger, smaller = max(first, second), min(first, second)
        if total < 2.0:
            shape = 0.18 * larger**2 + 0.70 * smaller**2 + 0.82 * larger - 0.52 * smaller
            shape -= 0.30 * larger * smaller
        else:
            shape = 0.44 * larger**2 + 0.59 * smaller**2 + 0.30 * larger - 0.30 * smaller
            shape -= 0.15 * larger * smaller
    return shape / (2.0 * total * first)


def _relief_factor(load: ScuffingLoad) -> tuple[float, str]:
    """X_Ca of the tip relief of the gear with the greater addendum contact ratio."""
    ratios = load.addendum_ratios
    if load.grade is not None and load.grade > 6:
        return 1.0, f"grade {load.grade} is coarser than 6"
    index = 0 if ratios[0] >= ratios[1] else 1
    relief = load.mesh.gears[index].modification.tip_relief
    return overlap_factor(relief, load.effective_relief, max(ratios)), ("pinion", "wheel")[index]


def record_scuffing_integral(load: ScuffingLoad) -> float | None:
    """S_intS of a mesh; None without a load stage of the oil."""
    record, oil, mesh = load.factors.record, load.oil, load.mesh
    friction = friction_coefficient(load)
    first, second = load.addendum_ratios
    approach, recess = (second, first) if mesh.pair.driver == "pinion" else (first, second)
    x_q = record("X_Q", approach_ratio_factor(approach / recess), f"{PART_21}, approach factor")
    relief, branch = _relief_factor(load)
    x_ca = record("X_Ca", relief, f"{PART_21}, tip relief factor", branch=branch)
    run_in = min(gear.running_in for gear in mesh.rated)
    rough = 1e3 * load.roughness / (load.pitch_radius / math.cos(mesh.pair.base_helix_angle))
    x_e = record("X_E", 1.0 + (1.0 - run_in) * 30.0 * rough, f"{PART_21}, running-in factor")
    x_be = record("X_BE", tip_geometry_factor(load), f"{PART_21}, geometry at the pinion's tip")
    x_m = 1000.0 * (1e-6 * load.modulus) ** 0.25 / THERMAL_COEFFICIENT
    unit = 1e-3 * load.helical_factor * load.line_load
    flash = friction * x_m * x_be * line_factor(mesh.pair) * unit**0.75
    flash *= math.sqrt(mesh.pitch_line_speed) / (1e3 * mesh.pair.center_distance) ** 0.25
    flash *= x_e / (x_q * x_ca)
    flash = record("theta_flE", flash, f"{PART_21}, flash temperature at the tip", unit="K")
    x_eps = record("X_eps", contact_ratio_factor(first, second), f"{PART_21}, contact ratio factor")
    mean = record("theta_flaint", flash * x_eps, f"{PART_21}, mean flash temperature", unit="K")
    cooling = record("X_S", oil.lubrication_factor, PART_21, branch=oil.lubrication)
    bulk = oil.temperature + 0.7 * cooling * load.mates_factor * mean
    bulk = record("theta_Mint", bulk, f"{PART_21}, bulk temperature", unit="K")
    integral = bulk + 1.5 * mean
    integral = record("theta_int", integral, f"{PART_21}, integral temperature", unit="K")
    if oil.scuffing_load_stage is None:
        return None
    torque = 3.726 * oil.scuffing_load_stage**2
    thin = (100.0 / (1e6 * oil.kinematic_viscosity_at_40)) ** 0.02
    factor = oil.lubricant_factor
    limit = 80.0 + 0.23 * torque * factor + load.structure_factor * 0.3 * torque * thin * factor
    limit = record("theta_intS", ZERO + limit, f"{PART_21}, scuffing temperature", unit="K")
    safety = (limit - ZERO) / (integral - ZERO)
    risk = "high" if safety < 1.0 else "critical" if safety <= 2.0 else "low"
    return record("S_intS", safety, f"{PART_21}, safety against scuffing", branch=f"risk {risk}")
