"""Values of a case in SI, and the physics objects derived from them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

from tribodyn.errors import InputError
from tribodyn.model import text
from tribodyn.study.case import to_models
from tribodyn.study.case.base import BaseCase
from tribodyn.study.case.gears import Gears
from tribodyn.study.case.hypoid import hypoid_flanks
from tribodyn.study.case.provenance import (
    Assumption,
    assumptions,
    default_of,
    derived_values,
)
from tribodyn.study.case.rating_tables import Materials, RatingTable
from tribodyn.study.case.section import CaseTables, flat, table
from tribodyn.study.case.sections import (
    Dynamics,
    Film,
    Friction,
    Losses,
    LubricantData,
    MaterialData,
    Operation,
    Solver,
    Stiffness,
)
from tribodyn.study.faults.section import Faults

if TYPE_CHECKING:
    from tribodyn.gear import HypoidFlanks, Material, SpurPair
    from tribodyn.losses import Gearbox
    from tribodyn.lubricant import Lubricant
    from tribodyn.mesh.table_file import TableFile


class CaseData(BaseCase, CaseTables):
    """All tables of a case, the physics objects built from them, and their provenance."""

    title: str = text("Gear pair", meaning="one line that names this case", example='"My gear"')
    origin: str | None = text(
        None, meaning="the document that the values come from", example='"Drawing 4711"'
    )
    gears: Gears = table(Gears, "the gear pair")
    material: MaterialData = table(MaterialData, "material of the gears", "empty")
    lubricant: LubricantData | None = table(LubricantData, "the oil", "none")
    operation: Operation = table(Operation, "speed and load")
    film: Film = table(Film, "oil film", "empty")
    stiffness: Stiffness = table(Stiffness, "stiffness of the teeth", "empty")
    friction: Friction = table(Friction, "friction of the teeth", "empty")
    dynamics: Dynamics = table(Dynamics, "the vibrating structure", "empty")
    losses: Losses | None = table(Losses, "power losses other than those of the teeth", "none")
    solver: Solver = table(Solver, "how the motion is computed", "empty")
    materials: Materials | None = table(Materials, "strength of the gears, by name", "none")
    rating: RatingTable | None = table(RatingTable, "load capacity of the gears", "none")
    faults: Faults | None = table(Faults, "faults that repeat with a shaft, by name", "none")

    _default_of, _derived_values = default_of, derived_values

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """What is assumed: reasons in ``[assumed]``, and what the case does not give."""
        return assumptions(self)

    @cached_property
    def mesh_table(self) -> TableFile | None:
        """The mesh table of another program; None where the teeth are computed."""
        return to_models.mesh_table(self.gears)

    @property
    def gear_ratio(self) -> float:
        """Teeth of the wheel over teeth of the pinion."""
        return abs(self.gears.wheel.teeth / self.gears.pinion.teeth)

    @cached_property
    def gear_pair(self) -> SpurPair:
        """Both gears in their working position.

        Raises
        ------
        InputError
            If the case has a mesh table of another program, or a hypoid pair.
        """
        if self.gears.kind != "spur":
            raise InputError(to_models.no_gear_pair(self.gears.kind))
        pair = partial(to_models.case_pair, self.gears, self.dynamics)
        return self._once("gear_pair", ("gears", "dynamics"), pair)

    @property
    def spur_pair(self) -> SpurPair | None:
        """Both gears in their working position; None where they are no spur gears."""
        return self.gear_pair if self.gears.kind == "spur" else None

    @property
    def contact_models(self) -> tuple[str, str]:
        """Names of the models of the tooth contact in force: stiffness, and film."""
        return to_models.contact_models(self)

    @cached_property
    def hypoid_flanks(self) -> HypoidFlanks | None:
        """Flanks of the side that carries; None where the gears are no hypoid pair."""
        return hypoid_flanks(self.gears) if self.gears.kind == "hypoid" else None

    @cached_property
    def material_properties(self) -> Material:
        """Material of both gears."""
        return self._once("material", ("material",), lambda: to_models.material(self.material))

    def density(self, gear: str) -> float:
        """Density of one gear [kg/m^3]: its own, or that of the material.

        Parameters
        ----------
        gear : str
            ``"pinion"`` or ``"wheel"``.

        Returns
        -------
        float

        Examples
        --------
        >>> import tribodyn
        >>> tribodyn.load_case("fzg-film").density("wheel")
        7800.0
        """
        value = getattr(self.gears, gear).density
        return float(self.material.density if value is None else value)

    @property
    def thermal_contact_coefficients(self) -> tuple[float, float]:
        """``sqrt(k rho c)`` of pinion and wheel [J/(m^2 K s^0.5)]; gear steel if not given."""
        return to_models.thermal_contact_coefficients(self)

    @cached_property
    def lubricant_properties(self) -> Lubricant | None:
        """The oil at its working temperature; None if the case has none."""
        return None if self.lubricant is None else to_models.lubricant(self.lubricant)

    @cached_property
    def film_lubricant(self) -> Lubricant | None:
        """The oil at the bulk temperature of the gears, at which it enters the film."""
        oil = self.lubricant
        if oil is None or oil.gear_temperature is None:
            return self.lubricant_properties
        return to_models.lubricant(oil, oil.gear_temperature)

    @cached_property
    def gearbox(self) -> Gearbox | None:
        """Shafts, seals and oil bath; None if the case has no ``[losses]``."""
        return None if self.losses is None else to_models.gearbox(self.losses)

    @property
    def backlash(self) -> float:
        """Total play on the line of action [m]: given, or that of the tooth thicknesses."""
        value = self.dynamics.backlash
        if value is None:
            return to_models.backlash(self)
        return value

    @property
    def composite_roughness(self) -> float | None:
        """Root of the sum of squares of both roughnesses [m]; None if none is given."""
        pinion, wheel = self.gears.pinion.rms, self.gears.wheel.rms
        if pinion is not None and wheel is not None:
            return math.hypot(pinion, wheel)
        return self.gears.composite_roughness

    @property
    def is_rated(self) -> bool:
        """Whether the case asks for the load capacity of its gears."""
        return self.rating is not None

    @property
    def speed_ratio(self) -> float:
        """Speed of the pinion over that of the gear whose speed and torque the case gives."""
        return self.gear_ratio if self.operation.speed_of == "wheel" else 1.0

    @property
    def pinion_speed(self) -> float:
        """Speed of the pinion [rad/s], whichever gear the speed is given for."""
        return self.operation.speed * self.speed_ratio

    @property
    def pinion_torque(self) -> float:
        """Nominal torque on the pinion [N*m], whichever gear the torque is given for."""
        return self.operation.torque / self.speed_ratio

    @property
    def operating_point(self) -> tuple[float, float]:
        """Speed [rad/s] and nominal torque [N*m] of the pinion."""
        return self.pinion_speed, self.pinion_torque

    def values(self) -> Iterator[tuple[str, Any]]:
        """Iterate over all values of the case.

        Yields
        ------
        tuple of (str, object)
            Dotted key and value in SI; None where nothing was given and a default is derived.
        """
        return iter(flat(self).items())
