"""Damping in force: the values given, or the ratios turned into values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tribodyn.study.case.provenance import effective
from tribodyn.study.pipeline.geometry import geometry

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case


@dataclass(frozen=True)
class Damping:
    """Damping coefficients of a case."""

    mesh: float  #: of the tooth contact along the line of action [N*s/m]
    bearing_pinion: float  #: [N*s/m]
    bearing_wheel: float  #: [N*s/m]


def equivalent_mass(
    inertia_pinion: float, inertia_wheel: float, radius_pinion: float, radius_wheel: float
) -> float:
    """Mass that vibrates along the line of action when both gears turn freely."""
    weighted = inertia_pinion * radius_wheel**2 + inertia_wheel * radius_pinion**2
    return inertia_pinion * inertia_wheel / weighted


def damping_of(case: Case, mesh: MeshTable) -> Damping:
    """Damping of a case."""
    data, body = case.dynamics, geometry(case)
    mesh_damping = data.mesh_damping
    if mesh_damping is None:
        mass = equivalent_mass(
            body["moment_of_inertia_pinion"], body["moment_of_inertia_wheel"],
            body["base_radius_pinion"], body["base_radius_wheel"],
        )  # fmt: skip
        mesh_damping = 2.0 * data.mesh_damping_ratio * math.sqrt(mesh.mean_mesh_stiffness * mass)
    supports = _supports(case, (body.get("mass_pinion", 0.0), body.get("mass_wheel", 0.0)))
    return Damping(mesh_damping, *supports)


def _supports(case: Case, masses: tuple[float, float]) -> tuple[float, float]:
    from tribodyn.dynamics.structure.structures import support_damping

    names = ("bearing_stiffness", "bearing_damping", "bearing_damping_ratio")
    values = [effective(case).get(f"dynamics.{name}") for name in names]
    return support_damping(values[0], masses, values[1], values[2])
