"""Named oils, each number with its source: ``library.toml``."""

from __future__ import annotations

from functools import lru_cache

from tribodyn.errors import Argument, InputError
from tribodyn.lubricant.astm import MARGIN, walther_slope, walther_viscosity
from tribodyn.lubricant.data_sheet import SHEET_RANGE, points_through
from tribodyn.lubricant.oil import Lubricant
from tribodyn.lubricant.pressure_laws import agma_925_coefficient
from tribodyn.model import Registry
from tribodyn.types import Tree
from tribodyn.units import ZERO_CELSIUS

#: Temperature difference [K] below which temperatures are equal.
_SAME_TEMPERATURE = 0.01
#: Entries of an oil known at one temperature that only other temperatures need.
_OF_OTHER_TEMPERATURES = ("viscosity_index", "density_fall", "base_oil")


#: An oil as the library has it: tables with value, unit and source, or lists of them.
OilRecord = Tree


@lru_cache(maxsize=1)
def _records() -> Registry[OilRecord]:
    """Read the library once."""
    import tomllib
    from importlib.resources import files

    text = files("tribodyn.lubricant").joinpath("library.toml").read_text(encoding="utf-8")
    records: Registry[OilRecord] = Registry("oil of the library")
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
        If there is no such oil, or the temperature is outside :func:`temperature_range`.

    An oil known at two temperatures follows ASTM D341 up to 30 K beyond them; one known at one
    temperature follows the line of its viscosity index through that point, and says so in
    ``assumptions``. Source: ``library.toml``, where every number names its own.

    Examples
    --------
    >>> from_library("80W").dynamic_viscosity
    0.082
    """
    record = _records()[name]
    if "kinematic_viscosity" in record:
        return _at_temperature(name, record, temperature)
    return _as_known(name, record, temperature)


def library_base_oil(name: str) -> str:
    """Base oil of an oil of the library."""
    return str(_records()[name]["base_oil"]["value"])


def temperature_range(name: str) -> tuple[float, float]:
    """Temperatures between which an oil of the library is known [K].

    Parameters
    ----------
    name : str
        Name of the oil.

    Returns
    -------
    (float, float)

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
        return SHEET_RANGE
    cold, warm = (float(point["temperature"]) for point in record["kinematic_viscosity"])
    return cold - MARGIN, warm + MARGIN


def _common(name: str, record: OilRecord, unused: tuple[str, ...] = (), remark: str = "") -> Tree:
    """Arguments common to all oils of the library; sources of unused entries are left out."""
    quantities_of: dict[str, list[str]] = {}
    for key, value in record.items():
        for entry in value if isinstance(value, list) else [value]:
            if isinstance(entry, dict) and key not in unused:
                quantities_of.setdefault(entry["source"], []).append(key.replace("_", " "))
    return {
        "name": name,
        "thermal_conductivity": float(record["thermal_conductivity"]["value"]),
        "source": "; ".join(f"{', '.join(q)}: {source}" for source, q in quantities_of.items()),
        "assumptions": (*record.get("assumptions", ()), *([remark] if remark else [])),
    }


def _at_temperature(name: str, record: OilRecord, temperature: float | None) -> Lubricant:
    """Oil with data at two temperatures."""
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


def _as_known(name: str, record: OilRecord, temperature: float | None) -> Lubricant:
    """Oil with data at one temperature, at that temperature or at another one."""
    known_point = float(record["temperature"]["value"])
    if temperature is not None and not abs(temperature - known_point) <= _SAME_TEMPERATURE:
        return _by_index(name, record, temperature)
    return Lubricant(
        float(record["dynamic_viscosity"]["value"]),
        float(record["density"]["value"]),
        float(record["pressure_viscosity_coefficient"]["value"]),
        temperature=known_point,
        temperature_viscosity_coefficient=float(
            record["temperature_viscosity_coefficient"]["value"]
        ),
        **_common(name, record, _OF_OTHER_TEMPERATURES),
    )


def _by_index(name: str, record: OilRecord, temperature: float) -> Lubricant:
    """Oil away from its known point: along the line of its viscosity index through that point."""
    known_point = float(record["temperature"]["value"])
    low, high = SHEET_RANGE
    if not low <= temperature <= high:
        raise InputError(
            f'"{name}" at {temperature - ZERO_CELSIUS:g} degC',
            where=Argument("temperature"),
            why=f"the oil is known at {known_point - ZERO_CELSIUS:g} degC, and its viscosity index "
            f"holds from {low - ZERO_CELSIUS:g} to {high - ZERO_CELSIUS:g} degC",
            remedy="Give a temperature of this range, or dynamic_viscosity, density and "
            "pressure_viscosity_coefficient at yours",
        )
    viscosity, density, coefficient, index, fall = (
        float(record[key]["value"])
        for key in (
            "dynamic_viscosity", "density", "pressure_viscosity_coefficient", "viscosity_index",
            "density_fall",
        )
    )  # fmt: skip
    points = points_through(known_point, viscosity / density, index)
    thinning = walther_viscosity(temperature, points) / walther_viscosity(known_point, points)
    density_there = density - fall * (temperature - known_point)
    viscosity_there = viscosity * thinning * density_there / density
    base_oil = record["base_oil"]["value"]
    estimates = [agma_925_coefficient(each, base_oil) for each in (viscosity_there, viscosity)]
    return Lubricant(
        viscosity_there,
        density_there,
        coefficient * estimates[0] / estimates[1],
        temperature=temperature,
        temperature_viscosity_coefficient=walther_slope(temperature, points) + fall / density_there,
        **_common(
            name,
            record,
            remark=f"At {temperature - ZERO_CELSIUS:g} degC: the oil is known at "
            f"{known_point - ZERO_CELSIUS:g} degC; from there the viscosity follows the ASTM D341 "
            f"line of viscosity index {index:g}, the pressure-viscosity coefficient AGMA 925-A03 "
            f"for {base_oil} oils.",
        ),
    )
