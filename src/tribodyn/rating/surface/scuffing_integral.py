"""Scuffing by the integral temperature: ISO/TS 6336-21.

In N/mm, m/s, mm, mPa s, um and degC, at the tip of the pinion:
``theta_flE = mu X_M X_BE X_ab (K_Bgamma w_Bt)^0.75 v^0.5/a^0.25 X_E/(X_Q X_Ca)``,
``mu = 0.045 (w_Bt K_Bgamma/(v_SC rho_redC))^0.2 eta^-0.05 X_R X_L`` with w_Bt of at least 150,
``theta_flaint = theta_flE X_eps``, ``theta_M = theta_oil + 0.7 X_S X_mp theta_flaint``,
``theta_int = theta_M + 1.5 theta_flaint``; with ``T = 3.726 S_FZG^2``
``theta_intS = 80 + 0.23 T X_L + X_W 1.5 0.2 T (100/nu_40)^0.02 X_L``; ``S = theta_intS/theta_int``:
below 1 high, 1 to 2 critical, above 2 low risk.
"""

from __future__ import annotations

import math

from tribodyn.rating.surface.path_load import PART_21, ScuffingLoad, line_factor, overlap_factor
from tribodyn.rating.surface.scuffing_flash import THERMAL_COEFFICIENT, ZERO


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
