"""Scuffing by the flash temperature: ISO/TS 6336-20.

In N/mm, m/s, mm, mPa s, um and degC:
``theta_fl = mu_m X_M X_J X_G (X_share w_Bt K_Bgamma)^0.75 v_t^0.5/a^0.25``,
``X_M = 1000 E_r^0.25/B_M``, ``X_G = 0.51 X_ab sqrt(u + 1) |sqrt(1 + G) - sqrt(1 - G/u)|/
((1 + G)(u - G))^0.25``, ``mu_m = 0.060 (w_Bt/(v_SC rho_relC))^0.2 X_L eta_oil^-0.05 Ra^0.25``;
``theta_M = theta_oil + 0.47 X_S X_mp theta_fl,mean``, ``theta_Bmax = theta_M + theta_fl,max``,
``theta_S = 80 + (0.85 + 1.4 X_W) X_L eta_oil^-0.05 S_FZG^2``,
``S_B = (theta_S - theta_oil)/(theta_Bmax - theta_oil)``. The flash temperature is that of Blok.
"""

from __future__ import annotations

import math

import numpy as np

from tribodyn.rating.surface.path_load import (
    PART_20,
    PathPoints,
    ScuffingLoad,
    line_factor,
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
