"""Rating of a cylindrical gear pair under one load: pitting and bending of both gears."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from tribodyn.errors import ModelWarning, collected, require_positive, warn
from tribodyn.gear import CylindricalPair
from tribodyn.rating.bending import record_bending, record_helix_factor, record_root_stress
from tribodyn.rating.conditions import RatingConditions, rating_conditions
from tribodyn.rating.factor import Factor, Factors, refuse_unknown, split_replacements
from tribodyn.rating.influence.dynamic_factor import record_dynamic_factor
from tribodyn.rating.influence.face_load import (
    record_face_load_factors,
    record_transverse_load_factors,
)
from tribodyn.rating.mesh_load import MeshLoad
from tribodyn.rating.oil import GearOil
from tribodyn.rating.pitting import record_contact_stress, record_film_factors, record_pitting
from tribodyn.rating.rated_gear import RatedGear
from tribodyn.rating.surface.micropitting import record_micropitting
from tribodyn.rating.surface.path_load import ScuffingLoad
from tribodyn.rating.surface.scuffing import record_scuffing_flash, record_scuffing_integral
from tribodyn.types import Tree

#: Names of both gears.
GEARS = ("pinion", "wheel")


@dataclass(frozen=True)
class GearRating:
    """Rating of one gear of a pair.

    Parameters
    ----------
    pitting_safety : float
        S_H, pure number.
    bending_safety : float
        S_F, pure number.
    load_cycles : float, optional
        Number of load cycles N, pure number; None where no life is stated.
    factors : mapping of str to Factor
        All factors of the gear and of its mesh, by the names of the standard.
    """

    pitting_safety: float
    bending_safety: float
    load_cycles: float | None
    factors: Mapping[str, Factor]

    def to_dict(self) -> Tree:
        """Safeties and factors, as JSON has them.

        Returns
        -------
        dict of str
        """
        return {
            "pitting_safety": self.pitting_safety,
            "bending_safety": self.bending_safety,
            "load_cycles": self.load_cycles,
            "factors": {name: factor.to_dict() for name, factor in self.factors.items()},
        }


@dataclass(frozen=True)
class PairRating:
    """Rating of a gear pair; made by :func:`rate_pair`.

    Parameters
    ----------
    pinion, wheel : GearRating
        Ratings of the gears.
    factors : mapping of str to Factor
        Factors of the mesh, by the names of the standard.
    conditions : RatingConditions
        Load, life and edition.
    scuffing_safety_flash, scuffing_safety_integral, micropitting_safety : float, optional
        S_B, S_intS and S_lambda, pure numbers; None where the oil has no load stage of the test.
    overridden : tuple of str
        Factors that the caller gave.
    warnings : tuple of ModelWarning
        Ranges that were left.
    """

    pinion: GearRating
    wheel: GearRating
    factors: Mapping[str, Factor]
    conditions: RatingConditions
    scuffing_safety_flash: float | None
    scuffing_safety_integral: float | None
    micropitting_safety: float | None
    overridden: tuple[str, ...]
    warnings: tuple[ModelWarning, ...]

    @property
    def gears(self) -> dict[str, GearRating]:
        """Both ratings by the name of their gear."""
        return {"pinion": self.pinion, "wheel": self.wheel}

    @property
    def pitting_safety(self) -> float:
        """Smaller S_H of both gears."""
        return min(gear.pitting_safety for gear in self.gears.values())

    @property
    def bending_safety(self) -> float:
        """Smaller S_F of both gears."""
        return min(gear.bending_safety for gear in self.gears.values())

    def to_dict(self) -> Tree:
        """Ratings and factors, as JSON has them.

        Returns
        -------
        dict of str
        """
        return {
            "edition": self.conditions.edition,
            "scuffing_safety_flash": self.scuffing_safety_flash,
            "scuffing_safety_integral": self.scuffing_safety_integral,
            "micropitting_safety": self.micropitting_safety,
            **{name: rating.to_dict() for name, rating in self.gears.items()},
            "factors": {name: factor.to_dict() for name, factor in self.factors.items()},
            "overridden": list(self.overridden),
            "warnings": [str(warning) for warning in self.warnings],
        }


def load_cycles(gear: RatedGear, speed: float, life: float | None) -> float | None:
    """Load cycles of a gear [-] that turns at a speed [rad/s] for a life [s]."""
    if gear.load_cycles is not None or life is None:
        return gear.load_cycles
    return speed / (2.0 * math.pi) * life * gear.meshes_per_turn


def _surface_safeties(
    mesh: MeshLoad, oil: GearOil
) -> tuple[float | None, float | None, float | None]:
    """Safeties against scuffing (flash, integral) and micropitting of a mesh."""
    load = ScuffingLoad(mesh, oil)
    return record_scuffing_flash(load), record_scuffing_integral(load), record_micropitting(load)


def _record_mesh(mesh: MeshLoad, oil: GearOil) -> None:
    """Factors of a mesh that both gears need."""
    _ = mesh.tangential_force, mesh.pitch_line_speed, mesh.line_load
    record_dynamic_factor(mesh)
    record_face_load_factors(mesh)
    record_contact_stress(mesh)
    record_transverse_load_factors(mesh)
    record_film_factors(mesh, oil)
    record_helix_factor(mesh)


def _gear_ratings(
    mesh: MeshLoad, oil: GearOil, replacements: Mapping[str, Mapping[str, float]]
) -> dict[str, GearRating]:
    """Ratings of both gears."""
    ratings = {}
    speeds = mesh.speed, mesh.speed / abs(mesh.ratio)
    for index, name in enumerate(GEARS):
        count = load_cycles(mesh.rated[index], speeds[index], mesh.conditions.required_life)
        factors = Factors(replacements[name], mesh.factors)
        pitting = record_pitting(mesh, index, oil, factors, count)
        record_root_stress(mesh, index, factors)
        bending = record_bending(mesh, index, factors, count)
        ratings[name] = GearRating(pitting, bending, count, MappingProxyType(factors))
    return ratings


def rate_mesh(mesh: MeshLoad, oil: GearOil, factors: Mapping[str, float]) -> PairRating:
    """Rating of a mesh under its load, where values of the caller replace computed factors."""
    split = split_replacements(factors, ("mesh", *GEARS))
    mesh.factors.replacements.update(split["mesh"])
    with collected() as warnings:
        _record_mesh(mesh, oil)
        surface = _surface_safeties(mesh, oil)
        ratings = _gear_ratings(mesh, oil, split)
    for warning in warnings:
        warn(warning.code, warning.message, stacklevel=4)
    refuse_unknown(factors, {**ratings["wheel"].factors, **ratings["pinion"].factors})
    return PairRating(
        ratings["pinion"],
        ratings["wheel"],
        MappingProxyType(mesh.factors),
        mesh.conditions,
        *surface,
        tuple(factors),
        tuple(warnings),
    )


def rate_pair(
    pair: CylindricalPair,
    *,
    torque: float,
    speed: float,
    oil: GearOil,
    pinion: RatedGear | None = None,
    wheel: RatedGear | None = None,
    factors: Mapping[str, float] | None = None,
    **conditions: Any,
) -> PairRating:
    """Rate a cylindrical gear pair, spur, helical or internal: ISO 6336-1, -2, -3, -5, -20 to -22.

    Parameters
    ----------
    pair : CylindricalPair
        Geometry with tip relief and leads.
    torque : float [N*m]
        Of the pinion.
    speed : float [rad/s]
        Of the pinion.
    oil : GearOil
        Its viscosity at 40 degC is that of the lubricant factors; scuffing and micropitting need
        the load stages of its FZG tests.
    pinion, wheel : RatedGear, optional
        Material, accuracy, roughness and load cycles; Eh MQ of grade 6 by default.
    factors : mapping of str to float, optional
        Values in SI units that replace computed factors, by the names of the standard: ``K_v``, or
        ``pinion.Y_F`` for one gear.
    **conditions
        Fields of :class:`RatingConditions`, such as ``application_factor`` and ``required_life``.

    Returns
    -------
    PairRating

    Raises
    ------
    InputError
        If a value is out of range, a name is unknown, or the rim is thinner than Y_B covers.

    Warns
    -----
    ModelWarning
        ``rating-range`` where a factor is used outside of the range of its source, with value and
        limit; ``rating-resonance`` in the main resonance.

    Notes
    -----
    Computed factors may replace those of the standard: K_v from the motion, K_Hbeta and K_Halpha
    from a load distribution, K_gamma from the load sharing. Bevel and hypoid pairs are not covered.
    Sources: ISO 6336-1, -2, -3 (2019, or 2006 with ``edition=2006``), ISO 6336-5:2016, scuffing
    ISO/TS 6336-20 and -21, micropitting ISO/TS 6336-22 method B.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=40e-3)
    >>> oil = GearOil(kinematic_viscosity_at_40=220e-6)
    >>> rating = rate_pair(pair, torque=500.0, speed=150.0, oil=oil, required_life=3.6e7)
    >>> print(f"{rating.pitting_safety:.2f} {rating.bending_safety:.2f}")
    1.03 2.72
    """
    require_positive("torque", torque, "N*m")
    require_positive("speed", speed, "rad/s")
    rated = pinion or RatedGear(), wheel or RatedGear()
    mesh = MeshLoad(pair, *rated, rating_conditions(conditions), torque, speed, Factors())
    return rate_mesh(mesh, oil, factors or {})
