"""Gear stages and load cases of a REXS model, with remarks on what was ignored or is doubtful."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike

from tribodyn.errors import InputError
from tribodyn.exchange.flank_forms import forms_of
from tribodyn.exchange.rexs_file import Component, RexsFile, kinds, read_file, version_remark
from tribodyn.gear.curves import involute
from tribodyn.record import html_table

_GEARS = ("cylindrical_gear", "ring_gear")
#: Stages that are not pairs of cylindrical gears.
_OTHER_STAGES = ("bevel_stage", "worm_stage")
#: Components with the temperature of the oil, the first ones before the others.
_OILED = ("gear_casing", "cylindrical_stage")
#: Largest plausible deviation of a tip circle from the standard one, in modules.
_TIP_MODULES = 2.0


@dataclass(frozen=True)
class StageGear:
    """One gear of a stage, in SI and radians; None for values that the file does not contain.

    Parameters
    ----------
    id : int
        Number of the component.
    name : str
        Its name in the file.
    teeth : int
        Number of teeth, negative for a ring gear.
    normal_module : float [m]
        Normal module.
    normal_pressure_angle, helix_angle : float [rad]
        Pressure angle in the normal section and helix angle at the reference circle.
    profile_shift_coefficient : float
        Of the flanks, over the normal module.
    face_width, tip_diameter, roughness_ra : float, optional [m]
        Width, tip circle and mean roughness of the flanks.
    modification : dict of str to float [m]
        Keys of the table ``modification`` of a case: reliefs and crownings.
    """

    id: int
    name: str
    teeth: int
    normal_module: float
    normal_pressure_angle: float
    helix_angle: float
    profile_shift_coefficient: float
    face_width: float | None = None
    tip_diameter: float | None = None
    roughness_ra: float | None = None
    modification: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Stage:
    """Two cylindrical gears in mesh.

    Parameters
    ----------
    id : int
        Number of the component.
    gear_1, gear_2 : StageGear
        The gears, in the order of the file.
    center_distance : float [m]
        Distance of the axes.
    planetary : bool
        Whether it is part of a planetary stage.
    """

    id: int
    gear_1: StageGear
    gear_2: StageGear
    center_distance: float
    planetary: bool = False

    @property
    def _teeth(self) -> int:
        return self.gear_1.teeth + self.gear_2.teeth

    @property
    def _transverse_angle(self) -> float:
        gear = self.gear_1
        return math.atan(math.tan(gear.normal_pressure_angle) / math.cos(gear.helix_angle))

    @property
    def ratio(self) -> float:
        """Teeth of the second over those of the first gear, negative with a ring gear."""
        return self.gear_2.teeth / self.gear_1.teeth

    @property
    def reference_center_distance(self) -> float:
        """Distance at which the reference circles touch [m] (ISO 21771, transverse module)."""
        gear = self.gear_1
        return 0.5 * abs(self._teeth) * gear.normal_module / math.cos(gear.helix_angle)

    @property
    def operating_pressure_angle(self) -> float:
        """Transverse pressure angle at the operating pitch circle [rad], ISO 21771."""
        cosine = self.reference_center_distance * math.cos(self._transverse_angle)
        return math.acos(min(cosine / self.center_distance, 1.0))

    @property
    def shift_sum(self) -> float:
        """Sum of the profile shifts that fits the distance without backlash, ISO 21771."""
        rise = involute(self.operating_pressure_angle) - involute(self._transverse_angle)
        return float(rise * self._teeth / (2.0 * math.tan(self.gear_1.normal_pressure_angle)))


@dataclass(frozen=True)
class Load:
    """One load case: speeds and torques of the shafts, propagated through the stages.

    Parameters
    ----------
    id : int
        Number of the load case; 0 for values outside of all load cases.
    share : float, optional
        Share of the life.
    speeds : dict of int to float [rad/s]
        Speed of each shaft, without its sign.
    torques : dict of int to float [N m]
        Torque through each shaft without losses, without its sign.
    source : int, optional
        Shaft on which the file specifies the torque.
    driven : bool
        Whether this torque brakes its shaft.
    oil_temperature : float, optional [K]
        Temperature of the oil.
    """

    id: int
    share: float | None
    speeds: dict[int, float]
    torques: dict[int, float]
    source: int | None = None
    driven: bool = False
    oil_temperature: float | None = None


def add_remark(model: GearboxModel, text: str) -> None:
    """Add a remark to those of the model, once."""
    if text not in model.remarks:
        model.remarks.append(text)


class GearboxModel:
    """Gearbox model of another program: its stages and load cases.

    Created by :func:`read_rexs`; :func:`case_from_rexs` converts a spur stage to a case.

    Parameters
    ----------
    file : RexsFile
        Content of the file.
    path : str
        Path of the file, for messages.

    Attributes
    ----------
    version, application : str
        Version of REXS and the program that wrote the file.
    components : dict of str to int
        How many components of each kind there are.
    stages : list of Stage
        Pairs of cylindrical gears.
    loads : list of Load
        Load cases.
    remarks : list of str
        Notes on what was ignored or looks wrong.
    """

    def __init__(self, file: RexsFile, path: str = "") -> None:
        self.file, self.path = file, path
        self.version, self.application = file.version, file.application
        self.components = kinds(file.components.values())
        self.remarks = [remark] if (remark := version_remark(file)) else []
        self.stages = [self._stage(component) for component in file.of_kind("cylindrical_stage")]
        self.loads = [self._load(number) for number in sorted(file.load_cases)] or [self._load(0)]
        self._remark_on_unread()

    def __repr__(self) -> str:
        count = sum(self.components.values())
        return (
            f"GearboxModel(REXS {self.version} of {self.application or 'an unnamed program'}: "
            f"{count} components, {len(self.stages)} stages, {len(self.loads)} load cases)"
        )

    def _repr_html_(self) -> str:
        """Stages as a table, for notebooks."""
        rows = [
            (
                s.id,
                f"{s.gear_1.teeth} / {s.gear_2.teeth}",
                f"{1e3 * s.gear_1.normal_module:g} mm",
                f"{math.degrees(s.gear_1.helix_angle):g} deg",
                f"{1e3 * s.center_distance:g} mm",
                f"{math.degrees(s.operating_pressure_angle):.4f} deg",
            )
            for s in self.stages
        ]
        head = ("stage", "teeth", "module", "helix", "centre distance", "alpha_wt")
        return html_table(repr(self), head, rows)

    def stage(self, number: int | None = None) -> Stage:
        """The stage with a number, or the only one.

        Parameters
        ----------
        number : int, optional
            Number of the component; not needed where there is one stage.

        Raises
        ------
        InputError
            If there is no such stage, or there is more than one and no number.
        """
        numbers = [stage.id for stage in self.stages]
        if not numbers:
            stage_kinds = ", ".join(k for k in self.components if k.endswith("_stage")) or "none"
            why = f"Stages in the file: {stage_kinds}; only cylindrical pairs are supported"
            raise InputError("there is no cylindrical stage", self.path, why)
        if number is None and len(numbers) == 1:
            number = numbers[0]
        if number not in numbers:
            what = "there are several stages" if number is None else f"there is no stage {number}"
            names = ", ".join(str(n) for n in numbers)
            raise InputError(what, self.path, f"Stages: {names}", "Choose one of them")
        return self.stages[numbers.index(number)]

    def load(self, number: int | None = None) -> Load:
        """The load case with a number, or the first one.

        Parameters
        ----------
        number : int, optional
            Number of the load case.

        Raises
        ------
        InputError
            If there is no such load case.
        """
        for load in self.loads:
            if number in (None, load.id):
                return load
        names = ", ".join(str(load.id) for load in self.loads)
        what = f"there is no load case {number}"
        raise InputError(what, self.path, f"Load cases: {names}", "Choose one of them")

    def shaft_of(self, gear: int) -> int | None:
        """Number of the shaft that carries a gear.

        Parameters
        ----------
        gear : int
            Number of the gear.

        Returns
        -------
        int or None
        """
        for relation in self.file.related("assembly", part=gear):
            number = relation.of("assembly")
            if number is not None and self.file.components[number].kind == "shaft":
                return number
        return None

    @cached_property
    def _planetary(self) -> set[int]:
        planetary = {c.id for c in self.file.of_kind("planetary_stage")}
        return {
            part
            for relation in self.file.related("assembly")
            if relation.of("assembly") in planetary and (part := relation.of("part")) is not None
        }

    def _stage(self, stage: Component) -> Stage:
        for relation in self.file.related("stage", stage=stage.id):
            numbers = [relation.of("gear_1"), relation.of("gear_2")]
            if None not in numbers:
                first, second = (
                    self._gear(self.file.components[n]) for n in numbers if n is not None
                )
                # Some programs give internal stages a negative distance.
                distance = abs(_needed(stage, "center_distance", "m"))
                pair = Stage(stage.id, first, second, distance, stage.id in self._planetary)
                self._remark_on_stage(pair)
                return pair
        raise InputError("no relation refers to both gears of the stage", str(stage))

    def _gear(self, component: Component) -> StageGear:
        if component.kind not in _GEARS:
            raise InputError(f"a cylindrical stage has a {component.kind}", str(component))
        sides = self._flanks(component)
        flank = sides[0] if sides else component
        teeth = _needed(component, "number_of_teeth", "")
        if teeth != int(teeth) or not 1 <= abs(teeth) <= 10_000:
            why = "The number of teeth is a whole number from 1 to 10000"
            raise InputError(f"number_of_teeth = {teeth:g}", str(component), why)
        sign = -1.0 if component.kind == "ring_gear" or teeth < 0.0 else 1.0
        gear = StageGear(
            component.id,
            component.name,
            int(math.copysign(teeth, sign)),
            _needed(component, "normal_module", "m"),
            _needed(flank, "normal_pressure_angle", "rad"),
            component.number("helix_angle_reference_diameter", "rad") or 0.0,
            flank.number("addendum_modification_coefficient", "") or 0.0,
            component.number("face_width", "m"),
            component.number("tip_diameter", "m"),
            component.number("arithmetic_average_roughness_flank", "m"),
        )
        _require_gear(gear, component)
        return self._with_forms(
            self._without_implausible_tip(gear, component), component, [s.id for s in sides]
        )

    def _with_forms(self, gear: StageGear, component: Component, flanks: list[int]) -> StageGear:
        """Add the flank modifications, which only external spur gears support."""
        radii = None
        if gear.tip_diameter is not None and gear.teeth > 0 and not gear.helix_angle:
            cosine = math.cos(gear.normal_pressure_angle)
            radii = (0.5 * gear.teeth * gear.normal_module * cosine, 0.5 * gear.tip_diameter)
        forms, remarks = forms_of(self.file, component, flanks, radii)
        for remark in remarks:
            add_remark(self, remark)
        return replace(gear, modification=forms)

    def _flanks(self, gear: Component) -> list[Component]:
        """Left and right flank; empty if the gear itself has the values."""
        for relation in self.file.related("flank", gear=gear.id):
            sides = [self.file.components[n] for r, n in relation.refs if r in ("left", "right")]
            if len(sides) == 2:
                for name in ("normal_pressure_angle", "addendum_modification_coefficient"):
                    unit = "rad" if name.endswith("angle") else ""
                    if sides[0].number(name, unit) != sides[1].number(name, unit):
                        add_remark(
                            self, f"{gear}: {name} of its flanks differs; the left one is used"
                        )
            if sides:
                return sides
        return []

    def _without_implausible_tip(self, gear: StageGear, component: Component) -> StageGear:
        if gear.tip_diameter is None:
            add_remark(self, f"{component}: no tip diameter; that of the standard addendum is used")
            return gear
        reference = gear.teeth * gear.normal_module / math.cos(gear.helix_angle)
        standard = reference + 2.0 * gear.normal_module * (1.0 + gear.profile_shift_coefficient)
        if abs(gear.tip_diameter - abs(standard)) <= _TIP_MODULES * gear.normal_module:
            return gear
        add_remark(
            self,
            f"{component}: tip_diameter = {gear.tip_diameter * 1e3:g} mm is ignored: the standard "
            f"addendum gives {abs(standard) * 1e3:.2f} mm",
        )
        return replace(gear, tip_diameter=None)

    def _load(self, number: int) -> Load:
        case = {**self.file.components}
        for key, part in self.file.load_cases.get(number, {}).items():
            component = self.file.components[key]
            case[key] = Component(
                key, component.kind, component.name, {**component.values, **part.values}
            )
        shafts = [c for c in case.values() if c.kind == "shaft"]
        speeds = {c.id: v for c in shafts if (v := c.number("rotational_speed", "rad/s"))}
        torques: dict[int, float] = {}
        for load in (c for c in case.values() if c.kind == "external_load"):
            torque = load.number("torque_around_u_axis", "N*m")
            for relation in self.file.related("assembly", part=load.id) if torque else ():
                shaft = relation.of("assembly")
                if shaft is not None:
                    torques[shaft] = torques.get(shaft, 0.0) + (torque or 0.0)
        source = next(iter(torques)) if len(torques) == 1 else None
        driven = source is not None and torques[source] * speeds.get(source, 1.0) < 0.0
        units = [c for c in case.values() if c.kind == "gear_unit"]
        oiled = [c for kind in _OILED for c in case.values() if c.kind == kind]
        oil = [t for c in oiled if (t := c.number("temperature_lubricant", "K")) is not None]
        shares = [s for c in units if (s := c.number("load_duration_fraction", "")) is not None]
        serial = not self._planetary
        source_torque = {} if source is None else {source: abs(torques[source])}
        return Load(
            number,
            shares[0] if shares else None,
            self._along({k: abs(v) for k, v in speeds.items()}, -1.0) if serial else speeds,
            self._along(source_torque, 1.0) if serial else source_torque,
            source,
            driven,
            oil[0] if oil else None,
        )

    def _along(self, values: dict[int, float], power: float) -> dict[int, float]:
        """Propagate speeds (power -1) or torques (1) from shaft to shaft through the stages."""
        values = dict(values)
        meshes = [
            (self.shaft_of(s.gear_1.id), self.shaft_of(s.gear_2.id), abs(s.ratio))
            for s in self.stages
        ]
        for _ in meshes:
            for first, second, ratio in meshes:
                if first in values and second is not None:
                    values.setdefault(second, values[first] * ratio**power)
                elif second in values and first is not None:
                    values.setdefault(first, values[second] / ratio**power)
        return values

    def _remark_on_stage(self, stage: Stage) -> None:
        first, second = stage.gear_1, stage.gear_2
        shift_sum = first.profile_shift_coefficient + second.profile_shift_coefficient
        if abs(first.normal_module - second.normal_module) > 1e-9:
            add_remark(self, f"stage {stage.id}: the modules of its gears differ")
        elif abs(shift_sum - stage.shift_sum) > 5e-3:
            add_remark(
                self,
                f"stage {stage.id}: the profile shifts sum up to {shift_sum:.4f}, the centre "
                f"distance has no backlash at {stage.shift_sum:.4f}",
            )

    def _remark_on_unread(self) -> None:
        for kind in _OTHER_STAGES:
            if kind in self.components:
                add_remark(self, f"{self.components[kind]} {kind}: not computed, and not read")
        for planetary in self.file.of_kind("planetary_stage"):
            add_remark(self, f"{planetary}: {self._epicyclic() or 'its gears are listed'}")
        torques = {load.source for load in self.loads}
        if torques == {None}:
            add_remark(self, "there is not exactly one torque from which all others follow")

    def _epicyclic(self) -> str:
        """Text on sun, planets and ring of a single planetary stage."""
        inner = {abs(s.gear_1.teeth) for s in self.stages if s.planetary and s.ratio > 0.0}
        outer = [s for s in self.stages if s.planetary and s.ratio < 0.0]
        if len(self.file.of_kind("planetary_stage")) != 1 or len(inner) != 1 or not outer:
            return ""
        (sun,), ring, planets = inner, abs(outer[0].gear_2.teeth), len(outer)
        fits = "" if (sun + ring) % planets == 0 else "do not "
        return (
            f"sun {sun}, {planets} planets {outer[0].gear_1.teeth}, ring {ring} teeth; ratio "
            f"{1.0 + ring / sun:.4g} with a fixed ring; equally spaced planets {fits}assemble"
        )


def _needed(component: Component, name: str, unit: str) -> float:
    value = component.number(name, unit)
    if value is None:
        raise InputError(f"{name} is missing", str(component), "", "Complete it in the program")
    return value


def _require_gear(gear: StageGear, component: Component) -> None:
    """Refuse values outside the range of real gears before anything is computed with them."""
    limits = {
        "normal_module": (gear.normal_module, 1e-6, 1.0),
        "normal_pressure_angle": (gear.normal_pressure_angle, 0.01, 1.2),
        "helix_angle": (abs(gear.helix_angle), 0.0, 1.4),
        "profile_shift_coefficient": (abs(gear.profile_shift_coefficient), 0.0, 10.0),
    }
    for name, (value, low, high) in limits.items():
        if not low <= value <= high:
            why = f"The range is {low:g} to {high:g} (SI, radians)"
            raise InputError(f"{name} = {value:g}", str(component), why)


def read_rexs(path: str | PathLike[str]) -> GearboxModel:
    """Read a gearbox model in the REXS format, XML, JSON or zip.

    Parameters
    ----------
    path : path
        File that another gear program has written.

    Returns
    -------
    GearboxModel
        Every cylindrical stage with its figures.

    Raises
    ------
    InputError
        If the file is not a REXS model, is damaged, or a stage lacks data of its gears.

    Supports REXS 1.0 to 1.6. Of another version a remark says that, and lists the attributes of
    gears, tools, shafts and bearings that are not read. Source: rexs.info, model of REXS 1.4.
    """
    return GearboxModel(read_file(path), str(path))
