"""Friction of a film over an area, line by line along the entrainment."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from tribodyn.ehl.traction.film_temperature import (
    film_temperature_rise,
    film_thermal_resistance,
    thermal_oil,
)
from tribodyn.ehl.traction.shear_models import SHEAR_MODELS
from tribodyn.ehl.traction.traction import FilmShear, FilmState
from tribodyn.errors import require_between
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

#: Least film that is sheared, over the central one.
_THINNEST = 0.01


@record
class AreaFriction(Record):
    """Friction of a contact over an area.

    Parameters
    ----------
    coefficient : float [-]
        Friction force over the normal force.
    force : float [N]
        Friction force, not negative.
    position : (lines,) array [m]
        Position of each line, across the entrainment.
    force_per_width : (lines,) array [N/m]
        Friction force of each line.
    temperature_rise : (lines,) array [K]
        Rise of the mean film temperature of each line above the inlet; zero without heating.
    mean_temperature_rise : float [K]
        Its mean, weighted with the heat of the lines.
    """

    coefficient: float = fact()
    force: float = fact()
    position: Array = quantity("position", unit="m", axis=True)
    force_per_width: Array = quantity("position", unit="N/m")
    temperature_rise: Array = quantity("position", unit="K")
    mean_temperature_rise: float = fact()


def area_friction(
    solution: Any,
    sliding_speed: float,
    shear_model: str,
    eyring_stress: float,
    flash_temperature: bool,
    bodies: tuple[float, float],
    oil: Mapping[str, float | None],
) -> AreaFriction:
    """See :meth:`tribodyn.ehl.PointContactSolution.friction`."""
    require_between("sliding_speed", sliding_speed, -math.inf, math.inf, "m/s")
    angle = solution.entrainment_angle
    along_y = abs(math.sin(angle)) > abs(math.cos(angle))
    axis, across = (solution.y, solution.x) if along_y else (solution.x, solution.y)
    turned = np.transpose if along_y else np.asarray
    pressure, film = turned(solution.pressure), turned(solution.film)
    # Where the grid does not resolve the film at the end of a roller.
    film = np.maximum(film, _THINNEST * solution.central_film)
    loaded = np.flatnonzero((pressure > 0.0).any(axis=1) & (solution.line_half_width > 0.0))
    state = FilmState(
        np.broadcast_to(axis, (loaded.size, axis.size)),
        pressure[loaded],
        film[loaded],
        solution.lubricant,
        solution.effective_modulus,
        viscosity_law=solution.viscosity_law,
    )
    model = SHEAR_MODELS[shear_model]
    shear = FilmShear(state, model, model.complete(eyring_stress, dict(oil)))
    speed = np.full(loaded.size, abs(float(sliding_speed)))
    rise = np.zeros(loaded.size)
    if flash_temperature:
        half = 0.5 * speed
        resistance = film_thermal_resistance(
            solution.line_half_width[loaded], state.central_film,
            solution.entrainment_speed + half, solution.entrainment_speed - half,
            thermal_oil(solution.lubricant).thermal_conductivity, bodies,
        )  # fmt: skip

        def heat(warmer: Array) -> tuple[Array, Array]:
            """Heat of the lines, and its slope over their temperature."""
            force, slope = shear.sliding(speed, warmer)
            return speed * force, speed * slope

        rise = film_temperature_rise(heat, resistance)
    lines, _ = shear.sliding(speed, rise if flash_temperature else None)
    force_per_width, temperature_rise = np.zeros(across.size), np.zeros(across.size)
    force_per_width[loaded], temperature_rise[loaded] = lines, rise
    force = float(force_per_width.sum() * (across[1] - across[0]))
    total = float(lines.sum())
    return AreaFriction(
        coefficient=force / solution.normal_force,
        force=force,
        position=across,
        force_per_width=force_per_width,
        temperature_rise=temperature_rise,
        mean_temperature_rise=float(lines @ rise) / total if total > 0.0 else 0.0,
    )
