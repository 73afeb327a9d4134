"""Named oils, each number with its source: ``library.toml``."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from tribodyn.errors import Argument, InputError
from tribodyn.lubricant.astm_d341 import MARGIN
from tribodyn.lubricant.oil import Lubricant
from tribodyn.model import Registry
from tribodyn.units import ZERO_CELSIUS

#: Temperatures closer than this [K] are the same.
_SAME_TEMPERATURE = 0.01


@lru_cache(maxsize=1)
def _records() -> Registry[dict[str, Any]]:
    """Read the library once."""
    import tomllib
    from importlib.resources import files

    text = files("tribodyn.lubricant").joinpath("library.toml").read_text(encoding="utf-8")
    records: Registry[dict[str, Any]] = Registry("oil of the library")
    for name, record in tomllib.loads(text).items():
        records.register(name)(record)
    return records


def library() -> list[str]:
    """Names of the oils in the library.

    Returns
    -------
    list of str

    Source: ``library.toml``, where every number names its own.

    Examples
    --------
    >>> "ISO VG 100" in library()
    True
    """
    return _records().names()


def from_library(name: str, temperature: float | None = None) -> Lubricant:
    """Oil of the library at a working temperature.

    Parameters
    ----------
    name : str
        Name of the oil.
    temperature : float, optional [K]
        Working temperature. By default the one at which the oil is known, or the lower of two.

    Raises
    ------
    InputError
        If there is no such oil, or nothing is known of it at that temperature.

    An oil known at one temperature has no other; one known at two follows ASTM D341 up to 30 K
    beyond them. Source: ``library.toml``, where every number names its own.

    Examples
    --------
    >>> from_library("80W").dynamic_viscosity
    0.082
    """
    record = _records()[name]
    if "kinematic_viscosity" in record:
        return _at_temperature(name, record, temperature)
    return _as_known(name, record, temperature)


def temperature_range(name: str) -> tuple[float, float]:
    """Temperatures between which an oil of the library is known [K].

    Parameters
    ----------
    name : str
        Name of the oil.

    Returns
    -------
    (float, float)
        Both the same for an oil that is known at one temperature.

    Raises
    ------
    InputError
        If there is no such oil.

    Examples
    --------
    >>> temperature_range("ISO VG 100")
    (283.15, 403.15)
    """
    record = _records()[name]
    if "kinematic_viscosity" not in record:
        known = float(record["temperature"]["value"])
        return known, known
    cold, warm = (float(point["temperature"]) for point in record["kinematic_viscosity"])
    return cold - MARGIN, warm + MARGIN


def _common(name: str, record: dict[str, Any]) -> dict[str, Any]:
    """Return the arguments that every oil of the library has."""
    quantities_of: dict[str, list[str]] = {}
    for key, value in record.items():
        for entry in value if isinstance(value, list) else [value]:
            if isinstance(entry, dict):
                quantities_of.setdefault(entry["source"], []).append(key.replace("_", " "))
    return {
        "name": name,
        "thermal_conductivity": float(record["thermal_conductivity"]["value"]),
        "source": "; ".join(f"{', '.join(q)}: {source}" for source, q in quantities_of.items()),
        "assumptions": tuple(record.get("assumptions", ())),
    }


def _at_temperature(name: str, record: dict[str, Any], temperature: float | None) -> Lubricant:
    """Return an oil that is known at two temperatures."""
    cold, warm = (
        (float(point["temperature"]), float(point["value"]))
        for point in record["kinematic_viscosity"]
    )
    return Lubricant.from_temperature(
        cold[0] if temperature is None else temperature,
        (cold, warm),
        float(record["density"]["value"]),
        base_oil=record["base_oil"]["value"],
        **_common(name, record),
    )


def _as_known(name: str, record: dict[str, Any], temperature: float | None) -> Lubricant:
    """Return an oil that is known at one temperature only."""
    known = float(record["temperature"]["value"])
    if temperature is not None and not abs(temperature - known) <= _SAME_TEMPERATURE:
        raise InputError(
            f'"{name}" at {temperature - ZERO_CELSIUS:g} degC',
            where=Argument("temperature"),
            why=f"the properties of this oil are known at {known - ZERO_CELSIUS:g} degC only",
            remedy=f"Leave the temperature out or give {known:g} K ({known - ZERO_CELSIUS:g} "
            "degC), or give dynamic_viscosity, density and pressure_viscosity_coefficient "
            "at your temperature",
        )
    return Lubricant(
        float(record["dynamic_viscosity"]["value"]),
        float(record["density"]["value"]),
        float(record["pressure_viscosity_coefficient"]["value"]),
        temperature=known,
        temperature_viscosity_coefficient=float(
            record["temperature_viscosity_coefficient"]["value"]
        ),
        **_common(name, record),
    )
