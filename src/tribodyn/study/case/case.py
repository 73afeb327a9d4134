"""The case: what the user typed, checked and in SI, with everything derived one call away."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cached_property
from inspect import Signature
from typing import TYPE_CHECKING, Any, ClassVar

from tribodyn.errors import InputError
from tribodyn.model import text
from tribodyn.study.case import derive
from tribodyn.study.case.checks import cross_problems, left_behind
from tribodyn.study.case.gears import Gears, is_needed
from tribodyn.study.case.given import Given, Source, plain, unsound, without_spread
from tribodyn.study.case.hypoid import hypoid_flanks
from tribodyn.study.case.provenance import (
    Stated,
    effective_values,
    keys_that_changed,
    provenance,
    read_stated,
    reason_faults,
    settled,
    tables,
    without_records,
)
from tribodyn.study.case.section import Section, Table, choices, flat, signature_of, table
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
from tribodyn.study.case.values import Plain, as_meant, as_typed, read_fields

if TYPE_CHECKING:
    from tribodyn.gear import HypoidFlanks, Material, SpurPair
    from tribodyn.losses import Gearbox
    from tribodyn.lubricant import Lubricant
    from tribodyn.mesh.table_file import TableFile


#: Keys whose choice decides which other keys of their table are allowed, beside those that name
#: models.
_DECIDES = ("solver.method",)


class Case(Section, whole=True):
    """One gear pair under one load: frozen, checked, in SI.

    Made by :func:`tribodyn.load_case`, or from nested keywords: a float is SI, text and pint
    quantities carry their unit.

    Parameters
    ----------
    source : Source, optional
        Where the values come from; then a bare number for a dimension is refused.
    **data : object
        The tables of the case file.

    Raises
    ------
    InputError
        Listing every fault with its place, the allowed range and the remedy.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> case.gears.pinion.teeth
    16
    """

    __signature__: ClassVar[Signature]

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
    losses: Losses | None = table(Losses, "what loses power beside the teeth", "none")
    solver: Solver = table(Solver, "how the motion is computed", "empty")

    def __init__(self, source: Source | None = None, /, **data: Any) -> None:
        found = list(unsound(data))
        if found:
            raise InputError((source or Source()).place(found))
        data, misspelt, meant = as_meant(data)
        middles, self._spread, spread_faults = without_spread(data)
        given = Given(middles if source is not None else plain(middles))
        source = source or Source()
        stated, found = read_stated(given)
        body = without_records(given.data)
        marks = body.pop("assumed", {})
        chosen = choices(given)
        vars(self).update(read_fields(type(self), body, "", chosen, found))
        found = [fault for fault in found if is_needed(fault[0], given.get("gears.kind"))]
        found += [*misspelt, *reason_faults(marks)]
        found = [fault for fault in found if fault[0] not in dict(spread_faults)] + spread_faults
        readable = not any(key.startswith("gears") for key, _ in found)
        found += cross_problems(given, chosen, {key for key, _ in found})
        if not found:
            found = derive.case_problems(self)
        elif readable and self.gears is not None:
            told = {key for key, _ in found}
            found += [fault for fault in derive.gear_problems(self.gears) if fault[0] not in told]
        if found:
            raise InputError(source.place(as_typed(found, meant)))
        self._source, self._assumed = source, dict(marks)
        self._stated, stale = settled(self, self._effective, given, stated)
        for key in stale:
            del self._assumed[key]
        self._given = Given({**given.data, **tables(self._stated, self._assumed)})

    def __getstate__(self) -> dict[str, Any]:
        """What makes a case, without what is derived from it."""
        derived = {k for k, v in vars(type(self)).items() if isinstance(v, cached_property)}
        return {key: value for key, value in vars(self).items() if key not in derived}

    def replace(self, changes: Mapping[str, Any], *, by: str = "") -> Case:
        """Return a new case with some values changed; it is checked as a whole.

        Parameters
        ----------
        changes : mapping
            Dotted key to value: a float in SI, text with a unit, a pint quantity, or None to go
            back to the default. A changed value is no longer marked as assumed, and the origin of
            the case no longer stands for it.
        by : str
            What made the change, for messages, for example ``"--set"``; then a bare number for
            a dimension is refused as in a file.

        Raises
        ------
        InputError
            As for a case file.

        Examples
        --------
        >>> import tribodyn
        >>> rough = tribodyn.load_case("fzg-roughness").replace(
        ...     {"gears.composite_roughness": "0.991 um"})
        >>> round(rough.gears.composite_roughness * 1e6, 3)
        0.991
        """
        ready = changes if by else {key: Plain(value) for key, value in changes.items()}
        gone = left_behind(self._given, ready, self._chosen_by(ready))
        spread = {key: text for key, text in self._spread.items() if key not in gone}
        data = self._given.merged({**spread, **dict.fromkeys(gone), **ready})
        if "assumed" in data:
            kept = {k: w for k, w in data["assumed"].items() if k not in changes and k not in gone}
            data["assumed"] = kept
        source = self._source.with_replaced(changes, by or "replace:")
        return type(self)(source, **data)

    def _chosen_by(self, changes: Mapping[str, Any]) -> dict[str, str]:
        """Models, laws and methods that changes choose anew, by key; unknown names are left out."""
        selectors = [
            f"{name}.{t.kind.selector}"
            for name, t in self.fields.items()
            if isinstance(t, Table) and t.kind.selector
        ]
        chosen = {}
        for key in (*selectors, *_DECIDES):
            if key not in changes:
                continue
            section, _, name = key.partition(".")
            spec = type(getattr(self, section)).fields[name]
            value = changes[key]
            value = value.value if isinstance(value, Plain) else value
            value = spec.default if value is None else value
            if value in spec.names():
                chosen[key] = value
        return chosen

    @cached_property
    def _effective(self) -> dict[str, Any]:
        return effective_values(self)

    @cached_property
    def _changed(self) -> tuple[str, ...]:
        return keys_that_changed(self)

    @property
    def uncertain(self) -> dict[str, str]:
        """Values that are known within bounds, as they were written, by dotted key."""
        return dict(self._spread)

    @property
    def assumed(self) -> dict[str, str]:
        """Reasons of values that the source of the case does not print, by dotted key."""
        return self._assumed

    @cached_property
    def mesh_table(self) -> TableFile | None:
        """The mesh table of another program; None where the teeth are computed."""
        return derive.mesh_table(self.gears)

    @property
    def gear_ratio(self) -> float:
        """Teeth of the wheel over teeth of the pinion."""
        return self.gears.wheel.teeth / self.gears.pinion.teeth

    @cached_property
    def gear_pair(self) -> SpurPair:
        """Both gears in their working position.

        Raises
        ------
        InputError
            If the case has a mesh table of another program, or a hypoid pair.
        """
        if self.gears.kind != "spur":
            raise InputError(derive.no_gear_pair(self.gears.kind))
        return derive.gear_pair(self.gears, self.dynamics.backlash)

    @cached_property
    def hypoid_flanks(self) -> HypoidFlanks | None:
        """Flanks of the side that carries; None where the gears are no hypoid pair."""
        return hypoid_flanks(self.gears) if self.gears.kind == "hypoid" else None

    @cached_property
    def material_properties(self) -> Material:
        """Material of both gears."""
        return derive.material(self.material)

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
        own = getattr(self.gears, gear).density
        return float(self.material.density if own is None else own)

    @property
    def thermal_contact_coefficients(self) -> tuple[float, float]:
        """``sqrt(k rho c)`` of pinion and wheel [J/(m^2 K s^0.5)]; gear steel if not given."""
        return derive.thermal_contact_coefficients(self)

    @cached_property
    def lubricant_properties(self) -> Lubricant | None:
        """The oil at its working temperature; None if the case has none."""
        return None if self.lubricant is None else derive.lubricant(self.lubricant)

    @cached_property
    def gearbox(self) -> Gearbox | None:
        """Shafts, seals and oil bath; None if the case has no ``[losses]``."""
        return None if self.losses is None else derive.gearbox(self.losses)

    @property
    def backlash(self) -> float:
        """Total play on the line of action [m]: given, or that of the tooth thicknesses."""
        given = self.dynamics.backlash
        if given is None:
            return derive.backlash(self)
        return given

    @property
    def composite_roughness(self) -> float | None:
        """Root of the sum of squares of both roughnesses [m]; None if none is given."""
        pinion, wheel = self.gears.pinion.rms, self.gears.wheel.rms
        if pinion is not None and wheel is not None:
            return math.hypot(pinion, wheel)
        return self.gears.composite_roughness

    @property
    def pinion_speed(self) -> float:
        """Speed of the pinion [rad/s], whichever gear the speed is given for."""
        of_wheel = self.operation.speed_of == "wheel"
        return self.operation.speed * (self.gear_ratio if of_wheel else 1.0)

    @property
    def pinion_torque(self) -> float:
        """Nominal torque on the pinion [N*m], whichever gear the torque is given for."""
        of_wheel = self.operation.speed_of == "wheel"
        return self.operation.torque / (self.gear_ratio if of_wheel else 1.0)

    @property
    def given(self) -> Given:
        """What the user gave, before any default."""
        return self._given

    @property
    def source(self) -> Source:
        """Where the values came from."""
        return self._source

    @property
    def stated(self) -> Stated:
        """What the values were that the reasons and the origin of the case belong to."""
        return self._stated

    def values(self) -> Iterator[tuple[str, Any]]:
        """Walk over all values of the case.

        Yields
        ------
        tuple of (str, object)
            Dotted key and value in SI; None where nothing was given and a default is derived.
        """
        return iter(flat(self).items())

    def to_toml(self) -> str:
        """Write the complete commented case file; it reads back to an equal case.

        Returns
        -------
        str
            TOML text with value, unit, symbol, meaning and range of every key.
        """
        from tribodyn.study.case.write import case_toml

        return case_toml(self)

    def __eq__(self, other: object) -> bool:
        """Cases are equal when all values and what is known of their origin are."""
        if not isinstance(other, Case):
            return NotImplemented
        same = self._effective == other._effective and self._spread == other._spread
        return same and provenance(self) == provenance(other)

    def __hash__(self) -> int:
        """Hash of all values in force."""
        return hash(tuple(self._effective.items()))

    def __repr__(self) -> str:
        """Show a table of all values with units."""
        from tribodyn.study.case.write import case_table

        return case_table(self)

    __str__ = __repr__

    def _repr_html_(self) -> str:
        """Table of all values for notebooks."""
        from tribodyn.record import html_table
        from tribodyn.study.case.write import case_rows

        return html_table(f"Case: {self.title}", ("key", "value", "origin"), case_rows(self))


Case.__signature__ = signature_of(Case)
