"""What else a reason speaks of: a mass is that of one gear, a stiffness that of its teeth."""

from __future__ import annotations

_PROFILE = (
    "gears.normal_module", "gears.normal_pressure_angle", "gears.addendum_coefficient",
    "gears.dedendum_coefficient", "gears.rack_tip_radius_coefficient",
)  # fmt: skip
_TEETH = tuple(
    f"gears.{gear}.{name}"
    for gear in ("pinion", "wheel")
    for name in ("teeth", "profile_shift_coefficient")
)
_OIL = tuple(
    f"lubricant.{name}"
    for name in ("name", "dynamic_viscosity", "density", "pressure_viscosity_coefficient")
)
_LOAD = ("operation.speed", "operation.torque")
_ROUGHNESS = (
    "gears.composite_roughness", "gears.pinion.roughness_rms", "gears.wheel.roughness_rms",
)  # fmt: skip
_MASSES = tuple(
    f"gears.{gear}.{name}" for gear in ("pinion", "wheel") for name in ("mass", "moment_of_inertia")
)


def body(gear: str) -> tuple[str, ...]:
    """Keys that make the body of a gear."""
    own = ("teeth", "profile_shift_coefficient", "face_width", "tip_diameter", "bore_diameter")
    return (*_PROFILE, *(f"gears.{gear}.{name}" for name in own), "material.density")


_ELASTIC = (
    *dict.fromkeys((*body("pinion"), *body("wheel"))),
    "gears.center_distance", "material.youngs_modulus", "material.poissons_ratio",
)  # fmt: skip

_FOUNDATIONS: dict[str, tuple[str, ...]] = {
    "gears.center_distance": (*_PROFILE[:2], *_TEETH),
    "gears.pinion.mass": body("pinion"),
    "gears.pinion.moment_of_inertia": body("pinion"),
    "gears.wheel.mass": body("wheel"),
    "gears.wheel.moment_of_inertia": body("wheel"),
    "gears.pinion.tip_diameter": (*_PROFILE[:3], *_TEETH, "gears.center_distance"),
    "gears.wheel.tip_diameter": (*_PROFILE[:3], *_TEETH, "gears.center_distance"),
    "material.density": _MASSES,
    "material.youngs_modulus": ("material.poissons_ratio",),
    "lubricant.temperature": _OIL,
    "operation.torque": (*_PROFILE[:2], *_TEETH),
    "operation.speed_of": (*_LOAD, *_TEETH),
    "operation.torque_balance": (*_LOAD, *_TEETH),
    "friction.coefficient": (*_LOAD, *_OIL, "lubricant.temperature", *_ROUGHNESS),
    "dynamics.bearing_damping": (*_MASSES, "dynamics.bearing_stiffness"),
    "dynamics.mesh_damping": (*_MASSES, "stiffness.model"),
    "dynamics.backlash": ("gears.normal_module", "gears.center_distance"),
}
for _shaft in ("dynamics.shaft1", "dynamics.shaft2"):
    _disc, _spring = f"{_shaft}_moment_of_inertia", f"{_shaft}_stiffness"
    _FOUNDATIONS |= {_disc: (_spring,), _spring: (_disc,), f"{_shaft}_damping": (_disc, _spring)}
for _name in ("stiffness", "damping", "moment_of_inertia", "mass"):
    _twin = f"dynamics.shaft2_{_name}"  # Where it is taken as that of shaft 1.
    _FOUNDATIONS[_twin] = (*_FOUNDATIONS.get(_twin, ()), f"dynamics.shaft1_{_name}")
for _value in ("pair", "single_pair", "double_pair", "mean"):
    _FOUNDATIONS[f"stiffness.{_value}_stiffness"] = _ELASTIC
_FOUNDATIONS["stiffness.double_pair_stiffness"] = (*_ELASTIC, "stiffness.single_pair_stiffness")
for _value in ("cosine", "sine", "values"):
    _FOUNDATIONS[f"stiffness.{_value}"] = _ELASTIC


def foundations(key: str) -> tuple[str, ...]:
    """Keys whose change takes away what a reason of this key speaks of."""
    return _FOUNDATIONS.get(key, ())
