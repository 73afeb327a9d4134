"""The structure with twelve coordinates: what its two shafts have where a case does not say."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from tribodyn.study.geometry import geometry

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case import Case
    from tribodyn.study.damping import Damping


#: Options of the structure and their defaults: those of the benchmark rig, whose first elastic
#: mode lies at 492 Hz. No source prints them.
RIG: Mapping[str, float] = MappingProxyType(
    {
        "shaft1_stiffness": 75397.3113,
        "shaft2_stiffness": 75397.3113,
        "shaft1_damping": 1.0,
        "shaft2_damping": 1.0,
        "shaft1_moment_of_inertia": 6.829922680095e-3,
        "shaft2_moment_of_inertia": 6.829922680095e-3,
        "shaft1_mass": 1.5,
        "shaft2_mass": 1.5,
        "bearing_stiffness": 3.5e9,
    }
)
#: Those that no other structure has.
RIG_KEYS = tuple(name for name in RIG if name.startswith("shaft"))

#: Bodies in the order of the structure, and those of them that are gears.
_BODIES = ("shaft1", "wheel", "pinion", "shaft2")


def is_rig_key(key: str) -> bool:
    """Tell whether a dotted key belongs to this structure alone."""
    section, _, name = key.partition(".")
    return section == "dynamics" and name in RIG_KEYS


def rig_of(case: Case, mesh: MeshTable, damping: Damping, shared: Mapping[str, Any]) -> System:
    """Build the structure with twelve coordinates."""
    from tribodyn.dynamics import fzg12

    given = dict(shared)
    turning, torque = given.pop("moment_of_inertia"), given.pop("torque")
    body = geometry(case)
    mass = _bodies({name: body[f"mass_{name}"] for name in ("pinion", "wheel")}, case, "mass")
    inertia = dict(zip(("pinion", "wheel"), turning, strict=True))
    stiffness = _option(case, "bearing_stiffness")
    return fzg12(
        mesh.functions(),
        torque=torque[0],
        mass=mass,
        moment_of_inertia=_bodies(inertia, case, "moment_of_inertia"),
        shaft_stiffness=[_option(case, f"shaft{n}_stiffness") for n in (1, 2)],
        shaft_damping=[_option(case, f"shaft{n}_damping") for n in (1, 2)],
        bearing_stiffness=stiffness,
        bearing_damping=[
            {"wheel": damping.bearing_wheel, "pinion": damping.bearing_pinion}.get(
                name, _support(case, stiffness, own)
            )
            for name, own in zip(_BODIES, mass, strict=True)
        ],
        **given,
    )


def _option(case: Case, name: str) -> float:
    value = getattr(case.dynamics, name)
    return RIG[name] if value is None else float(value)


def _bodies(gears: Mapping[str, float], case: Case, what: str) -> list[float]:
    """One value for each body: given for the gears, options for the shafts."""
    return [gears[n] if n in gears else _option(case, f"{n}_{what}") for n in _BODIES]


def _support(case: Case, stiffness: float, mass: float) -> float:
    """Damping of the support of a disc."""
    if case.dynamics.bearing_damping is not None:
        return case.dynamics.bearing_damping
    return 2.0 * case.dynamics.bearing_damping_ratio * math.sqrt(stiffness * mass)
