"""One field of the case file: its meaning, its unit and what it accepts.

Every section of the case declares its fields with :func:`number`, :func:`integer`,
:func:`numbers`, :func:`choice`, :func:`flag`, :func:`text` or :func:`file_path`. The :class:`Spec`
behind a field is what checks its value, what the commented case file prints and what the
documentation tables show.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pydantic import Field

from tribodyn import units
from tribodyn.nomenclature import QUANTITIES

Names = Callable[[], list[str]]


@dataclass(frozen=True)
class Spec:
    """What is known about one field."""

    kind: str
    meaning: str  #: one line
    symbol: str = ""
    unit: str = ""
    display_unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    positive: bool = False  #: zero is refused although ``low`` is zero
    origin: str = ""  #: why the limits are what they are
    names: Names | None = None  #: names allowed, for a choice
    later: tuple[str, ...] = ()  #: names that a later release will have
    example: str = ""  #: TOML value shown where the field is missing

    def show(self, value: Any) -> str:
        """Write a value in the display unit, lists in brackets, flags as TOML does."""
        if isinstance(value, tuple):
            return f"[{', '.join(self.show(item) for item in value)}]"
        if isinstance(value, bool):
            return str(value).lower()
        if self.unit:
            return units.format_quantity(value, self.unit, self.display_unit)
        return f"{value:.10g}" if isinstance(value, float) else str(value)

    def allowed(self) -> str:
        """Range or names that the field accepts, as one phrase."""
        if self.kind == "flag":
            return "true or false"
        if self.names is not None:
            return ", ".join(self.names())
        low, high = math.isfinite(self.low), math.isfinite(self.high)
        if low and high:
            sign = "above " if self.positive else ""
            return f"{sign}{self.show(self.low)} to {self.show(self.high)}"
        return {"text": "text", "file": "path of a file"}.get(self.kind, "any finite value")


#: A sensible value of each quantity, shown where one is missing or not understood.
_EXAMPLES = {
    "normal_module": '"4.5 mm"', "normal_pressure_angle": '"20 deg"', "angle": '"20 deg"',
    "center_distance": '"91.5 mm"', "composite_roughness": '"0.5 um"', "roughness_rms": '"0.4 um"',
    "face_width": '"20 mm"', "tip_diameter": '"88.6 mm"', "bore_diameter": '"30 mm"',
    "mass": '"0.676 kg"', "moment_of_inertia": '"407 kg*mm^2"', "youngs_modulus": '"206 GPa"',
    "density": '"880 kg/m^3"', "dynamic_viscosity": '"82 mPa*s"', "temperature": '"40 degC"',
    "pressure_viscosity_coefficient": '"21.9 1/GPa"', "speed": '"900 rpm"', "torque": '"90 N*m"',
    "pair_stiffness": '"2e8 N/m"', "mesh_stiffness": '"2.5e8 N/m"', "roll_angle": '"0.5 rad"',
    "sliding_speed": '"0.001 m/s"', "bearing_stiffness": '"3.5e9 N/m"', "backlash": '"0.05 mm"',
    "bearing_damping": '"4000 N*s/m"', "mesh_damping": '"900 N*s/m"',
    "shaft_stiffness": '"75400 N*m/rad"', "shaft_damping": '"1 N*m*s/rad"',
    "transmission_error": '"2 um"', "friction_coefficient": "0.05", "eyring_stress": '"5 MPa"',
    "temperature_viscosity_coefficient": '"0.04 1/K"', "thermal_conductivity": '"0.13 W/m/K"',
    "tip_relief": '"10 um"', "tip_relief_length": '"4 mm"', "root_relief": '"10 um"',
    "root_relief_length": '"4 mm"', "profile_crowning": '"5 um"', "profile_slope": '"5 um"',
    "crowning": '"5 um"', "lead_slope": '"5 um"', "misalignment": '"5 um"', "run_out": '"20 um"',
    "run_out_phase": '"0 deg"', "wear_depth": '"5 um"', "single_pitch_deviation": '"5 um"',
    "cumulative_pitch_deviation": '"5 um"',
}  # fmt: skip


def _field(default: Any, spec: Spec) -> Any:
    return Field(default, description=spec.meaning, json_schema_extra={"spec": spec})  # type: ignore[dict-item]


def number(
    default: Any,
    low: float,
    high: float,
    origin: str,
    *,
    of: str = "",
    meaning: str = "",
    positive: bool = False,
    several: bool = False,
    example: str = "",
) -> Any:
    """Declare a real field; ``of`` names its quantity in the nomenclature, ranges are SI."""
    quantity = QUANTITIES.get(of)
    spec = Spec(
        kind="numbers" if several else "number",
        meaning=meaning or (quantity.meaning if quantity else ""),
        symbol=quantity.symbol if quantity else "",
        unit=quantity.unit if quantity else "",
        display_unit=quantity.display_unit if quantity else "",
        low=low,
        high=high,
        positive=positive,
        origin=origin,
        example=example or _EXAMPLES.get(of, "1.0"),
    )
    return _field(default, spec)


def numbers(
    low: float, high: float, origin: str, *, of: str = "", meaning: str, example: str = ""
) -> Any:
    """Declare an optional list of real values; arguments as for :func:`number`."""
    return number(None, low, high, origin, of=of, meaning=meaning, several=True, example=example)


def integer(
    default: Any, low: int, high: int, origin: str, *, meaning: str, symbol: str = "", example: str
) -> Any:
    """Declare a whole-number field."""
    spec = Spec("integer", meaning, symbol, low=low, high=high, origin=origin, example=example)
    return _field(default, spec)


def choice(
    default: Any, names: tuple[str, ...] | Names, *, meaning: str, later: tuple[str, ...] = ()
) -> Any:
    """Declare a field that takes one of several names; ``names`` may be looked up late."""
    look_up = names if callable(names) else lambda: list(names)
    example = "" if callable(names) else f'"{names[0]}"'
    return _field(default, Spec("choice", meaning, names=look_up, later=later, example=example))


def flag(default: bool | None, *, meaning: str) -> Any:
    """Declare a field that is true or false."""
    return _field(default, Spec("flag", meaning))


def text(default: Any, *, meaning: str, example: str = "") -> Any:
    """Declare a field of free text."""
    return _field(default, Spec("text", meaning, example=example))


def file_path(*, meaning: str, example: str) -> Any:
    """Declare an optional path of a file; it becomes absolute."""
    return _field(None, Spec("file", meaning, example=example))
