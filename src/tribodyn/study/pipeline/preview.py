"""Quick checks of a case: oil in operation, pitch line, load, losses and natural modes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError, collected
from tribodyn.study.case.to_models import chosen_options
from tribodyn.study.pipeline.tooth_contact import loaded_settings
from tribodyn.types import Array, ByName

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.gear import SpurPair
    from tribodyn.losses import GearboxLosses
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.pair import PairCase

#: Elastic natural frequencies in a summary.
_MODES = 12
#: Number of systems whose natural frequencies are cached, and of loads whose figures are.
_CACHE_SIZE = 256
#: Figures of the mesh force that have a dynamic factor.
_FACTORS = ("peak", "rms")


def operating_figures(case: PairCase) -> dict[str, float]:
    """Speed and force at the pitch line, power, and the oil at its operating temperature."""
    torque, speed = case.pinion_torque, case.pinion_speed
    figures = {"input_power": torque * speed}
    if (pair := case.spur_pair) is not None:
        radius = pair.pinion.base_radius / np.cos(pair.operating_pressure_angle)
        figures |= {
            "pitch_line_velocity": speed * radius,
            "tangential_force": torque / radius,
            "line_load": torque / pair.pinion.base_radius / pair.common_face_width,
        }
    oil = case.lubricant_properties
    if oil is not None:
        figures |= {
            "oil_viscosity": oil.dynamic_viscosity,
            "oil_density": oil.density,
            "oil_pressure_viscosity_coefficient": oil.pressure_viscosity_coefficient,
        }
        if oil.temperature is not None:
            figures["oil_temperature"] = oil.temperature
        if case.lubricant is not None and case.lubricant.gear_temperature is not None:
            figures["gear_temperature"] = case.lubricant.gear_temperature
    return figures


def load_figures(case: PairCase, mesh: MeshTable, figures: Mapping[str, float]) -> dict[str, float]:
    """Dynamic factors, efficiency, and the mesh stiffness of ISO 6336-1 for comparison."""
    lost, power = figures["mean_friction_power"], figures["input_power"]
    if case.operation.torque_balance == "load":
        power += lost  # the driver brings up the friction
    loads = {
        "gear_power_loss": lost,
        "input_power": power,
        "efficiency": 1.0 - lost / power,
        **_dynamic_factors(figures),
    } | gearbox_figures(case, lost)
    return loads | (standard_figures(case) if case.spur_pair is not None else {})


def _dynamic_factors(figures: Mapping[str, float]) -> dict[str, float]:
    """Peak and rms mesh force over the mean, which is the force at rest with friction."""
    # The force of the torque alone is no measure: friction takes a part of it or adds to it.
    mean = figures["mean_mesh_force"]
    if not mean > 0.0:
        return {}
    return {f"dynamic_factor_{name}": figures[f"{name}_mesh_force"] / mean for name in _FACTORS}


def gearbox_losses_of(case: PairCase, lost: Any, **point: Any) -> GearboxLosses:
    """Losses of the gearbox of a case for given tooth losses, at its own or another point."""
    from tribodyn.losses import Gearbox, gearbox_losses

    point = {"pinion_torque": case.pinion_torque, "pinion_speed": case.pinion_speed, **point}
    return gearbox_losses(
        case.gear_pair if case.hypoid_flanks is None else case.hypoid_flanks,
        case.gearbox or Gearbox(windage=False),
        lost,
        **point,
        lubricant=case.lubricant_properties,
        torque_balance=case.operation.torque_balance,
    )


def gearbox_figures(case: PairCase, lost: float) -> dict[str, float]:
    """Losses of shafts and oil, if the case has them, and the total efficiency."""
    if case.gearbox is None:
        return {}
    losses = gearbox_losses_of(case, lost)
    bearings = losses.total_of("bearing_rolling", "bearing_sliding", "bearing_seal", "bearing_drag")
    figures = {
        "bearing_power_loss": bearings,
        "seal_power_loss": losses.seal,
        "churning_power_loss": losses.churning,
        "windage_power_loss": losses.windage,
        "total_power_loss": losses.total,
        "total_efficiency": losses.efficiency,
    }
    return {name: float(value[0, 0]) for name, value in figures.items()}


def standard_figures(case: PairCase) -> dict[str, float]:
    """``b c_gamma_alpha`` of ISO 6336-1, and the share of the gear bodies in the deflection."""

    def under() -> Callable[[float], dict[str, float]]:
        settings = loaded_settings(case)
        bored = chosen_options(case, "stiffness").get("reference") == "bore"
        return lru_cache(_CACHE_SIZE)(partial(_standard_figures, case.gear_pair, settings, bored))

    # The same at every speed, so a study reuses it for the same loads.
    tables = ("gears", "dynamics", "material", "stiffness")
    return case._once("standard_figures", tables, under)(case.pinion_torque)


def _standard_figures(
    pair: SpurPair, settings: ByName, bored: bool, torque: float
) -> dict[str, float]:
    from tribodyn.stiffness import iso6336_mesh_stiffness, iso6336_single_stiffness
    from tribodyn.stiffness.loaded.contact import body_share

    figures, force = {}, torque / pair.pinion.base_radius
    with collected() as outside:
        single = iso6336_single_stiffness(pair, settings["material"], force)
    if not outside:  # else its polynomial does not hold for these profile shifts
        mean = iso6336_mesh_stiffness(single, pair.transverse_contact_ratio)
        figures["iso_mesh_stiffness"] = pair.common_face_width * mean
    if bored:
        figures["gear_body_share"] = body_share(pair, torque, **settings)
    return figures


def mode_figures(system: System, mesh_frequency: float, speed: float) -> dict[str, float]:
    """Elastic natural frequencies, and the speed at which the mesh mode is excited."""
    elastic, mesh_mode = _frequencies(system)
    figures = {f"natural_frequency_{k}": f for k, f in enumerate(elastic[:_MODES], 1)}
    if mesh_mode:
        figures |= {
            "mesh_natural_frequency": mesh_mode,
            "resonance_speed": speed * mesh_mode / mesh_frequency,
            "resonance_ratio": mesh_frequency / mesh_mode,
        }
    return figures


#: Cached elastic natural frequencies and that of the mesh, by system without friction: they are the
#: same at every speed.
_frequency_cache: dict[object, tuple[Array, float]] = {}


def _frequencies(system: System) -> tuple[Array, float]:
    """Elastic natural frequencies [Hz] and that of the mesh; none if the system is unstable."""
    from tribodyn.dynamics import natural_modes

    key = _without_friction(system)
    if (cached := _frequency_cache.get(key)) is not None:
        return cached
    try:
        modes = natural_modes(system)
    except InputError:
        return np.zeros(0), 0.0  # a structure that is not stable about its static load has none
    elastic, mesh_mode = modes.frequency[modes.rigid :], 0.0
    if elastic.size and modes.contacts:
        mesh_mode = float(modes.frequency[int(np.argmax(modes.contact_share))])
    if key is not None:
        if len(_frequency_cache) >= _CACHE_SIZE:
            _frequency_cache.clear()
        _frequency_cache[key] = elastic, mesh_mode
    return elastic, mesh_mode


def _without_friction(system: System) -> object:
    """Cache key of the natural modes with one closed contact; None for other systems."""
    from tribodyn.mesh.grid import PhaseFunction

    if len(system.contacts) != 1 or system.frictions:
        return None
    direction, stiffness = system.contacts[0].direction, system.contacts[0].stiffness
    if callable(direction) or not isinstance(stiffness, PhaseFunction):
        return None
    parts = system.mass, system.stiffness, direction, stiffness.values
    grid = stiffness.grid.event_phases, stiffness.grid.intervals
    return grid, *(np.asarray(part).tobytes() for part in parts)
