"""The tables of the case file apart from ``[gears]``: oil, load, and the chosen models."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, Any

from tribodyn.errors import Problem
from tribodyn.model import REQUIRED, choice, flag, integer, model_choice, number
from tribodyn.study.case.section import Section, table
from tribodyn.study.case.user_input import UserInput, conflicting_keys

if TYPE_CHECKING:
    from tribodyn.model import Registry

_GUARD = "guards against a wrong unit"
_RPM = math.pi / 30.0
_TWO_PI = 2.0 * math.pi
#: Properties of an oil at its working temperature, and those that only a heated film needs.
PROPERTIES = ("dynamic_viscosity", "density", "pressure_viscosity_coefficient")
THERMAL = ("temperature_viscosity_coefficient", "thermal_conductivity")
#: Figures of a data sheet: those of the viscosity first.
SHEET = (
    "kinematic_viscosity_at_40",
    "kinematic_viscosity_at_100",
    "viscosity_index",
    "density_at_15",
    "base_oil",
)
_SHEET_SAYS = (
    "the figures of a data sheet: kinematic_viscosity_at_40, viscosity_index, density_at_15"
)


def _films() -> Registry[Any]:
    from tribodyn.ehl import FILM_MODELS

    return FILM_MODELS


def _stiffnesses() -> Registry[Any]:
    from tribodyn.stiffness import MODELS

    return MODELS


def _laws() -> Registry[Any]:
    from tribodyn.friction import LAWS

    return LAWS


def _structures() -> Registry[Any]:
    from tribodyn.dynamics import STRUCTURES

    return STRUCTURES


def _engines() -> Registry[Any]:
    from tribodyn.dynamics import ENGINES

    return ENGINES


@cache
def _lubricants() -> list[str]:
    from tribodyn.lubricant import library

    return list(library())


@cache
def _bearings() -> list[str]:
    from tribodyn.losses import BEARINGS

    return list(BEARINGS)


class MaterialData(Section):
    """The ``[material]`` table: both gears are made of it."""

    youngs_modulus: float = number(
        206e9, 1e8, 1e12, "from polymers to tungsten carbide", of="youngs_modulus"
    )
    poissons_ratio: float = number(
        0.3, 0.0, 0.49, "0.5 is incompressible, negative is no gear material", of="poissons_ratio"
    )
    density: float = number(7800.0, 500.0, 25000.0, "from polymers to tungsten", of="density")


@cache
def _base_oils() -> list[str]:
    from tribodyn.lubricant import BASE_OILS

    return list(BASE_OILS)


class LubricantData(Section):
    """The ``[lubricant]`` table: a name from the library, a data sheet, or the properties."""

    name: str | None = choice(
        None, _lubricants, meaning="name of an oil of the library", argument="lubricant"
    )
    dynamic_viscosity: float | None = number(None, 1e-5, 100.0, _GUARD, of="dynamic_viscosity")
    density: float | None = number(None, 500.0, 2000.0, "liquids; " + _GUARD, of="density")
    pressure_viscosity_coefficient: float | None = number(
        None, 1e-10, 1e-7, "oils lie between 5 and 40 1/GPa", of="pressure_viscosity_coefficient"
    )
    temperature_viscosity_coefficient: float | None = number(
        None,
        0.001,
        0.3,
        "gear oils lie between 0.02 and 0.07 1/K",
        of="temperature_viscosity_coefficient",
    )
    thermal_conductivity: float | None = number(
        None, 0.01, 2.0, "mineral oil has about 0.13 W/m/K", of="thermal_conductivity"
    )
    kinematic_viscosity_at_40: float | None = number(
        None,
        2e-6,
        0.1,
        _GUARD,
        of="kinematic_viscosity",
        symbol="nu_40",
        example='"220 mm^2/s"',
        meaning="kinematic viscosity at 40 degC, of a data sheet",
        argument="viscosity_at_40",
    )
    kinematic_viscosity_at_100: float | None = number(
        None,
        2e-6,
        1e-3,
        "the viscosity index begins at 2 mm^2/s",
        of="kinematic_viscosity",
        symbol="nu_100",
        example='"18.7 mm^2/s"',
        meaning="kinematic viscosity at 100 degC, of a data sheet",
        argument="viscosity_at_100",
    )
    viscosity_index: float | None = number(
        None,
        -100.0,
        400.0,
        "gear oils lie between 80 and 250",
        of="viscosity_index",
        meaning="viscosity index by ISO 2909, in the place of one of the two viscosities",
        argument="index",
    )
    density_at_15: float | None = number(
        None,
        700.0,
        1300.0,
        "liquid lubricants",
        of="density",
        symbol="rho_15",
        example='"892 kg/m^3"',
        meaning="density at 15 degC, of a data sheet",
        argument="density_at_15_degc",
    )
    base_oil: str | None = choice(
        None,
        _base_oils,
        meaning="base oil of a data sheet, for the estimate of pressure_viscosity_coefficient by "
        "AGMA 925-A03; mineral if not given",
        argument="base_oil",
    )
    temperature: float | None = number(
        None, 233.15, 473.15, "gear oils work between -40 and 200 degC", of="temperature"
    )
    heat_transfer: float | None = number(
        None,
        1e-3,
        1e12,
        "small gearboxes have some 10 W/K",
        of="heat_transfer",
        meaning="heat transfer coefficient times area: oil and gears take on the temperature at "
        "which the surroundings take up what is lost",
    )
    ambient_temperature: float | None = number(
        None, 233.15, 473.15, "20 degC if not given with heat_transfer", of="ambient_temperature"
    )
    gear_heat_transfer: float | None = number(
        None,
        1e-3,
        1e12,
        "gears and oil have one temperature if not given",
        of="gear_heat_transfer",
        meaning="heat transfer coefficient times area between gears and oil: the gears, which take "
        "up the friction of the teeth, and the film are warmer than the oil",
    )
    gear_temperature: float | None = number(
        None,
        233.15,
        473.15,
        "that of the oil if not given",
        of="gear_temperature",
        meaning="bulk temperature of the gears, at which the oil enters the film",
    )


class Operation(Section):
    """The ``[operation]`` table."""

    speed: float = number(
        REQUIRED, 0.01 * _RPM, 2e5 * _RPM, _GUARD, of="speed", argument="pinion_speed"
    )
    torque: float = number(REQUIRED, 1e-6, 1e8, _GUARD, of="torque", argument="pinion_torque")
    speed_of: str = choice(
        "pinion", ("pinion", "wheel"), meaning="the gear whose speed and torque are given"
    )
    torque_balance: str = choice(
        "drive",
        ("drive", "load", "both"),
        meaning="which nominal torque is held when friction acts",
    )


class Film(Section):
    """The ``[film]`` table: how the oil film is found."""

    model: str = model_choice("none", _films, meaning="how the oil film is found")

    @property
    def stiffness(self) -> str:
        """Stiffness of the film in the mesh; that of the film model where nothing was chosen."""
        model = self.chosen
        return vars(self).get("stiffness") or (str(model.options["stiffness"]) if model else "none")


class Stiffness(Section):
    """The ``[stiffness]`` table: how the teeth give way."""

    model: str = model_choice("fe2d", _stiffnesses, meaning="tooth stiffness model")


class Friction(Section):
    """The ``[friction]`` table."""

    law: str = model_choice("none", _laws, meaning="friction law of the tooth contact")


class Dynamics(Section):
    """The ``[dynamics]`` table: the vibrating structure."""

    model: str = model_choice("spur-6dof", _structures, meaning="structure that vibrates")
    mesh_law: str | None = choice(
        None,
        {
            "stiffness": "mesh force as a stiffness over the mesh phase times the deflection",
            "tangent": "film stiffness as the slope of the load over the central film; of the mesh "
            "force, linear about the load",
            "force-law": "mesh force as it follows from the loaded tooth contact, any deflection",
        },
        meaning="k(t) times deflection, linearized about the load, or the whole force law",
    )
    friction_load: str = choice(
        "nominal",
        {
            "nominal": "friction coefficients and load shares of the mesh at rest under the "
            "nominal load",
            "dynamic": "friction coefficients and load shares follow the dynamic load of the teeth",
        },
        meaning="load that friction coefficients and load shares belong to",
    )
    bearing_damping_ratio: float = number(
        0.02,
        0.0,
        2.0,
        "supports lie between 0.01 and 0.1",
        meaning="damping of each gear on its bearing over its critical value",
    )
    mesh_damping: float | None = number(None, 0.0, 1e9, _GUARD, of="mesh_damping")
    mesh_damping_ratio: float = number(
        0.04, 0.0, 2.0, "meshes lie between 0.03 and 0.17", of="mesh_damping_ratio"
    )
    damping_in_gap: bool = flag(False, meaning="keep the mesh damping while the flanks are apart")
    backlash: float | None = number(
        None,
        0.0,
        0.01,
        _GUARD,
        of="backlash",
        basis="the tooth thicknesses at the operating pitch circles",
        argument="backlash",
    )
    transmission_error_amplitude: float = number(
        0.0,
        0.0,
        1e-3,
        _GUARD,
        of="transmission_error",
        meaning="amplitude of the static transmission error at mesh frequency",
    )
    transmission_error_phase: float = number(
        0.0,
        -_TWO_PI,
        _TWO_PI,
        "one turn",
        of="angle",
        meaning="phase of the static transmission error where a pair enters contact",
    )


#: Engines of periodic motions from spectra, and of the choice by fitness.
BALANCE, AUTO = "harmonic-balance", "auto"


class Solver(Section):
    """The ``[solver]`` table."""

    method: str = choice(
        "steady",
        {
            "steady": "the periodic motion, found directly",
            "transient": "motion over time from the static equilibrium, measured over its second "
            "half",
        },
        meaning="periodic motion, or motion from the static equilibrium",
    )
    engine: str = model_choice("runge-kutta-4", _engines, meaning="how the motion is found")
    steps_per_mesh_cycle: int | None = integer(
        None,
        64,
        262144,
        "fewer do not resolve the mesh, more only cost time",
        example="1024",
        meaning="integration steps per mesh cycle",
        argument="steps",
        basis="the fastest motion of the structure, from 1024 to 65536",
    )
    coupling: str = choice(
        "none",
        {
            "none": "film, friction and stiffness belong to the load of the torque alone",
            "static": "load, film, friction and stiffness agree at rest, friction in the balance "
            "of the torques",
            "dynamic": "they agree with the load of the steady motion at every mesh phase",
        },
        meaning="load that film, friction and stiffness belong to",
    )
    coupling_tolerance: float = number(
        1e-6,
        1e-12,
        1e-2,
        "a hundredth is no agreement",
        meaning="change that counts as agreement",
    )
    cycles: int | None = integer(
        None,
        1,
        100000,
        "more only cost time",
        example="50",
        meaning="mesh cycles of a transient run",
    )


class ShaftData(Section):
    """The ``[losses.pinion]`` and ``[losses.wheel]`` tables: what turns with a gear and loses."""

    bearing: str | None = choice(
        None, _bearings, meaning="bearings of the shaft, all of the same type"
    )
    bearings: int = integer(2, 1, 16, _GUARD, meaning="number of bearings, which share the load")
    bearing_drag_factor: float = number(
        0.0,
        0.0,
        0.01,
        "diagrams of the catalogue end at 0.0012",
        symbol="V_M",
        meaning="drag of the oil bath on the bearings, read off the catalogue at the oil level",
    )
    bearing_oil_level: float = number(
        0.0,
        0.0,
        1.0,
        _GUARD,
        unit="m",
        display_unit="mm",
        symbol="H",
        example='"10 mm"',
        meaning="oil above the lowest point of the outer raceways",
    )
    seal_diameter: float = number(
        0.0,
        0.0,
        2.0,
        _GUARD,
        unit="m",
        display_unit="mm",
        symbol="d_sh",
        example='"30 mm"',
        meaning="diameter of the shaft under the lips of its seals; zero for none",
    )
    seals: int = integer(1, 1, 16, _GUARD, meaning="number of lips")
    immersion: float = number(
        0.0,
        0.0,
        10.0,
        _GUARD,
        unit="m",
        display_unit="mm",
        symbol="h",
        example='"20 mm"',
        meaning="depth of the lowest point of the pitch circle in the oil bath; zero for none",
    )


class Losses(Section):
    """The ``[losses]`` table: power losses other than those of the teeth."""

    oil_volume: float = number(
        0.0,
        0.0,
        10.0,
        _GUARD,
        unit="m^3",
        display_unit="l",
        symbol="V",
        example='"1.2 l"',
        meaning="oil in the sump, needed where a gear is immersed",
    )
    windage: bool = flag(True, meaning="count the gears in air and oil mist")
    pinion: ShaftData = table(ShaftData, "shaft of the pinion", "empty")
    wheel: ShaftData = table(ShaftData, "shaft of the wheel", "empty")


def heat_problems(inputs: UserInput) -> Iterator[tuple[str, Problem]]:
    """Check that a heat balance has an oil with temperature dependence, and gears."""
    key, other = "lubricant.heat_transfer", "lubricant.ambient_temperature"
    gears = "lubricant.gear_temperature"
    if gears in inputs and "lubricant.dynamic_viscosity" in inputs:
        why, remedy = "The film needs the viscosity at it", "State the viscosity at it"
        what = f"{inputs.show(gears)} with properties at one temperature"
        yield gears, Problem(what, "", why, f"{remedy} and remove gear_temperature")
    if key not in inputs:
        for name in (other, "lubricant.gear_heat_transfer"):
            if name in inputs:
                why, remedy = "Without heat_transfer the temperatures are fixed", "Remove it"
                yield name, Problem(inputs.show(name), "", why, f"{remedy}, or add heat_transfer")
        return
    if gears in inputs and "lubricant.gear_heat_transfer" not in inputs:
        why, remedy = "The balance finds this temperature", "Remove it, or add gear_heat_transfer"
        yield gears, Problem(f"{inputs.show(gears)} with heat_transfer", "", why, remedy)
    if "lubricant.dynamic_viscosity" in inputs:
        what = f"{inputs.show(key)} with properties at one temperature"
        why = "The balance needs the viscosity at others"
        remedy = 'Name an oil, for example name = "ISO VG 220", or give the figures of a data sheet'
        yield key, Problem(what, "", why, f"{remedy}, or remove heat_transfer")
    if inputs.get("gears.kind", "spur") == "table":
        why = "A mesh table has its friction at one temperature"
        yield key, Problem(inputs.show(key), "", why, "Remove it")


def lubricant_problems(inputs: UserInput) -> Iterator[tuple[str, Problem]]:
    """Check the oil: from the library, from a data sheet, or properties at one temperature."""
    if "lubricant" not in inputs:
        return
    yield from heat_problems(inputs)
    stated = [name for name in (*PROPERTIES, *THERMAL, *SHEET) if f"lubricant.{name}" in inputs]
    if "lubricant.name" in inputs:
        for name in stated:
            yield conflicting_keys(inputs, "lubricant.name", f"lubricant.{name}")
    elif any(name in SHEET for name in stated):
        yield from _data_sheet(inputs, stated)
    else:
        for name in PROPERTIES:
            if name not in stated:
                why = "Without a name from the library all three properties are needed"
                remedy = f'Add {name}, name an oil, for example name = "80W", or give {_SHEET_SAYS}'
                yield f"lubricant.{name}", Problem(f"{name} is missing", "", why, remedy)


def _data_sheet(inputs: UserInput, stated: list[str]) -> Iterator[tuple[str, Problem]]:
    """Check that an oil of a data sheet has two viscosity figures, density and temperature."""
    for name in ("dynamic_viscosity", "density", "temperature_viscosity_coefficient"):
        if name in stated:
            first = next(figure for figure in stated if figure in SHEET)
            what = f"{inputs.show(f'lubricant.{name}')} and {inputs.show(f'lubricant.{first}')}"
            why = "It follows from the figures of the data sheet"
            yield f"lubricant.{name}", Problem(what, "", why, "Remove it")
    figures = [name for name in SHEET[:3] if name in stated]
    if len(figures) < 2:
        missing = next(name for name in SHEET[:3] if name not in stated)
        why = f"Two of three figures are needed: {', '.join(SHEET[:3])}"
        remedy = "Add one from the data sheet"
        yield f"lubricant.{missing}", Problem(f"{missing} is missing", "", why, remedy)
    for name, example in (("density_at_15", "892 kg/m^3"), ("temperature", "60 degC")):
        if f"lubricant.{name}" not in inputs:
            remedy = f'Add {name} = "{example}", with the value of your oil'
            why = "An oil of a data sheet needs it"
            yield f"lubricant.{name}", Problem(f"{name} is missing", "", why, remedy)
    if "base_oil" in stated and "pressure_viscosity_coefficient" in stated:
        yield conflicting_keys(
            inputs, "lubricant.base_oil", "lubricant.pressure_viscosity_coefficient"
        )
