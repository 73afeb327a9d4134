"""A case as a REXS 1.4 model, and the forms of such a model: XML, JSON and XML in a zip."""

from __future__ import annotations

import json
import math
import zipfile
from collections.abc import Iterable
from io import BytesIO
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

from tribodyn.errors import InputError
from tribodyn.exchange.machine_parts import BEARING_TYPES
from tribodyn.exchange.rexs_file import WHOLE_CASE
from tribodyn.lubricant.library import from_library, temperature_range
from tribodyn.nomenclature import GEARS
from tribodyn.study.machine.pair_cases import pinion_and_wheel
from tribodyn.types import Tree
from tribodyn.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from tribodyn.machine import Machine
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase, MachineCase

Attribute = tuple[str, str, Any]  # name, unit, value
_KINDS = {bool: "boolean", int: "integer", float: "floating_point", str: "string",
          tuple: "floating_point_array"}  # fmt: skip


class ModelTree:
    """Components, relations and load cases, numbered as they are added."""

    def __init__(self) -> None:
        self.components: list[Tree] = []
        self.relations: list[Tree] = []
        self.load_cases: list[Tree] = []

    def add(self, kind: str, name: str, attributes: Iterable[Attribute] = ()) -> int:
        """Add a component, and return its number."""
        number = len(self.components) + 1
        self.components.append(_component(number, kind, name, attributes))
        return number

    def shared(self, kind: str, name: str, attributes: Iterable[Attribute]) -> int:
        """Number of a component that equal ones share, such as a material."""
        wanted = _component(0, kind, name, attributes)["attributes"]
        same = (c for c in self.components if c["type"] == kind and c["attributes"] == wanted)
        return next((c["id"] for c in same), 0) or self.add(kind, name, attributes)

    def relate(self, kind: str, **roles: int) -> None:
        """Add a relation between components, once."""
        refs = [{"role": role, "id": number} for role, number in roles.items()]
        if not any(r["type"] == kind and r["refs"] == refs for r in self.relations):
            order = {"order": 1} if kind == "ordered_reference" else {}
            number = len(self.relations) + 1
            self.relations.append({"id": number, "type": kind, **order, "refs": refs})

    def add_load_case(self, parts: Iterable[tuple[int, str, list[Attribute]]]) -> None:
        """Add a load case with the number, name and values of components."""
        listed = [
            _component(number, self.components[number - 1]["type"], name, attributes)
            for number, name, attributes in parts
        ]
        self.load_cases.append({"id": len(self.load_cases) + 1, "components": listed})

    @property
    def model(self) -> Tree:
        """The model in the structure of the JSON form."""
        from tribodyn import __version__

        return {
            "version": "1.4",
            "applicationId": "tribodyn",
            "applicationVersion": __version__,
            "relations": self.relations,
            "components": self.components,
            "load_spectrum": {"id": 1, "load_cases": self.load_cases},
        }

    def as_json(self) -> bytes:
        """JSON."""
        return json.dumps({"model": self.model}, indent=1, ensure_ascii=False).encode()

    def as_xml(self) -> bytes:
        """XML."""
        head = {name: value for name, value in self.model.items() if isinstance(value, str)}
        root = ElementTree.Element("model", head)
        relations = _element(root, "relations", {})
        for relation in self.relations:
            element = _element(relations, "relation", relation)
            for ref in relation["refs"]:
                _element(element, "ref", ref)
        _add_components(_element(root, "components", {}), self.components)
        spectrum = _element(root, "load_spectrum", {"id": 1})
        for case in self.load_cases:
            _add_components(_element(spectrum, "load_case", case), case["components"])
        ElementTree.indent(root)
        return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True))

    def as_zip(self) -> bytes:
        """XML in a zip."""
        buffer = BytesIO()
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("rexs-model.rexs", self.as_xml())
        return buffer.getvalue()


def _component(number: int, kind: str, name: str, attributes: Iterable[Attribute]) -> Tree:
    listed = [
        {"id": n, **({} if unit == "none" else {"unit": unit}), _KINDS[type(v)]: _rounded(v)}
        for n, unit, v in attributes
        if v is not None
    ]
    return {"id": number, "type": kind, "name": name, "attributes": listed}


def _rounded(value: object) -> Any:
    if isinstance(value, tuple):
        return [_rounded(item) for item in value]
    return float(f"{value:.15g}") if isinstance(value, float) else value


def _element(parent: ElementTree.Element, tag: str, values: Tree) -> ElementTree.Element:
    plain = {k: str(v) for k, v in values.items() if not isinstance(v, list | dict)}
    return ElementTree.SubElement(parent, tag, plain)


def _add_components(parent: ElementTree.Element, components: list[Tree]) -> None:
    for component in components:
        element = _element(parent, "component", component)
        for attribute in component["attributes"]:
            *_, kind = attribute
            value, unit = attribute[kind], attribute.get("unit", "none")
            child = _element(element, "attribute", {"id": attribute["id"], "unit": unit})
            if isinstance(value, list):
                array = _element(child, "array", {})
                for item in value:
                    _element(array, "c", {}).text = str(item)
            else:
                child.text = str(value).lower() if isinstance(value, bool) else str(value)


#: Key of a modification, kind of component, attributes of its amount, attribute of its length.
_FORMS: tuple[tuple[str, str, tuple[str, ...], str], ...] = (
    ("tip_relief", "tip_relief", ("tip_relief_depth",), "tip_relief_datum_length"),
    ("root_relief", "root_relief", ("root_relief_depth",), "root_relief_datum_length"),
    ("profile_crowning", "profile_crowning",
     ("profile_crowning_at_root", "profile_crowning_at_tip"), ""),
    ("crowning", "helix_crowning",
     ("helix_crowning_amount_datum_face", "helix_crowning_amount_non_datum_face"), ""),
    *(
        ("end_relief", f"end_relief_{face}", (f"end_relief_depth_{face}",),
         f"end_relief_length_{face}")
        for face in ("datum_face", "non_datum_face")
    ),
)  # fmt: skip
#: Keys of a rolling bearing in millimetres, and the attributes.
_BEARING_SIZES = {
    "bore_diameter": "inner_diameter", "outer_diameter": "outer_diameter", "width": "width",
    "ball_diameter": "diameter_of_rolling_element",
    "roller_diameter": "diameter_of_rolling_element",
    "roller_length": "length_of_rolling_element",
}  # fmt: skip
_TO_MM, _TO_DEG, _TO_RPM = 1e3, 180.0 / math.pi, 30.0 / math.pi
Point = tuple[float, ...]


def tree_of(case: AnyCase) -> ModelTree:
    """REXS model of a pair of cylindrical gears or of a machine, with the complete case in it."""
    tree = _CaseTree(case)
    if not case.lumped:
        tree.add_machine(case)
    elif case.spur_pair is None:
        what = f'gears of the kind "{case.gears.kind}" are not a cylindrical stage'
        raise InputError(what, "gears.kind", "", "Write a case of spur gears")
    else:
        tree.add_pair(case)
    return tree


class _CaseTree(ModelTree):
    """Model with the gear unit and its casing, to which parts of a case are added."""

    def __init__(self, case: AnyCase) -> None:
        super().__init__()
        text = case.to_toml()
        self.unit = self.add("gear_unit", case.title, [(WHOLE_CASE, "none", text)])
        self.casing = self.add("gear_casing", "Casing")
        self.relate("assembly", assembly=self.unit, part=self.casing)

    def add_pair(self, case: PairCase) -> None:
        """Add the gears of a pair, each on a shaft."""
        shafts = [self.add_shaft(f"Shaft of the {name}") for name in GEARS]
        gears = [
            self.add_gear(shaft, name.capitalize(), case, name)
            for shaft, name in zip(shafts, GEARS, strict=True)
        ]
        self.add_stage("Stage", case.gear_pair.center_distance, gears)
        self.add_oil(case)
        operation, driver = case.operation, GEARS.index(case.operation.speed_of)
        drives = case.gears.driver == operation.speed_of
        torque = operation.torque if drives else -operation.torque
        temperature = case.lubricant.temperature if case.lubricant else None
        self.add_loads(shafts[driver], None, [("", 1.0, operation.speed, torque, temperature)])

    def add_machine(self, case: MachineCase) -> None:
        """Add shafts, gears, bearings, stages and loads of a machine."""
        _require_cylindrical(case)
        machine, point = case.machine(), case.operating_point
        places = machine.placement
        shafts = {}
        for name, shaft in machine.shafts.items():
            shafts[name] = number = self.add_shaft(name, places.shafts[name])
            self.add_sections(number, shaft.sections)
            self.add_material(number, shaft.material)
        pairs = {mesh: case.pair(mesh, point) for mesh in case.meshes_with_teeth}
        gears = self.add_gears(case, machine, shafts, pairs)
        stages = {}
        for name, mesh in machine.meshes.items():
            first, second = (places.gears[gear] for gear in mesh.gears)
            distance = math.hypot(second[1] - first[1], second[2] - first[2])
            stages[name] = self.add_stage(name, distance, [gears[gear] for gear in mesh.gears])
        for stage in case.stages.values():
            self.add_planets(stage, machine, shafts, stages)
        for name in case.data.get("bearings", {}):
            self.add_bearing(case, name, shafts[case.bearings[name].shaft], places.bearings[name])
        for pair in list(pairs.values())[:1]:
            self.add_oil(pair)
        oil = case.get("lubricant.temperature")
        loads = [
            (n.name, n.share, n.speed, n.torque * math.copysign(1.0, n.speed), n.temperature or oil)
            for n in case.load_cases or [point]
        ]
        self.add_loads(shafts[case.ends[0]], shafts[case.ends[1]], loads)

    def add_gears(
        self,
        case: MachineCase,
        machine: Machine,
        shafts: dict[str, int],
        pairs: dict[str, PairCase],
    ) -> dict[str, int]:
        """Add the gears of a machine; numbers by name."""
        numbers: dict[str, int] = {}
        for mesh, pair in pairs.items():
            names = pinion_and_wheel(machine.meshes[mesh].gears, machine.gears)
            for name, role in zip(names, GEARS, strict=True):
                if name in numbers:
                    continue
                gear, title = machine.gears[name], name
                for stage in case.stages.values():
                    title = stage.case_name(title)
                place = [
                    ("u_coordinate_on_shaft", "mm", float(gear.node_position) * _TO_MM),
                    *_position(machine.placement.gears[name]),
                ]
                numbers[name] = self.add_gear(shafts[gear.shaft], title, pair, role, place)
        return numbers

    def add_planets(
        self, stage: Any, machine: Machine, shafts: dict[str, int], stages: dict[str, int]
    ) -> None:
        """Add a planetary stage of pairs that are in the model."""
        carrier = self.add("planet_carrier", stage.table.carrier)
        number = self.add("planetary_stage", stage.name)
        self.relate("assembly", assembly=self.unit, part=number)
        for part in (carrier, *(stages[mesh] for mesh in stage.mesh_roles())):
            self.relate("assembly", assembly=number, part=part)
        carried = shafts[stage.table.carrier]
        self.relate("assembly", assembly=carrier, part=carried)
        central = [("central_shaft", shafts[stage.shaft_of(role)]) for role in ("sun", "ring")]
        planets = [
            ("planet_shaft", shafts[gear.shaft])
            for name, gear in machine.gears.items()
            if stage.case_name(name) != name
        ]
        for relation, shaft in (("planet_carrier_shaft", carried), *central, *planets):
            self.relate(relation, planetary_stage=number, shaft=shaft)

    def add_shaft(self, name: str, start: Point | None = None) -> int:
        """Add a shaft that begins at a point."""
        number = self.add("shaft", name, _position(start))
        self.relate("assembly", assembly=self.unit, part=number)
        return number

    def add_sections(self, shaft: int, sections: Iterable[Any]) -> None:
        """Add the sections of a shaft."""
        begin = 0.0
        for section in sections:
            lengths = {
                "u_coordinate_on_shaft": begin,
                "length": section.length,
                "outer_diameter_begin": section.outer_diameter,
                "outer_diameter_end": section.end_outer_diameter,
                "inner_diameter_begin": section.inner_diameter,
                "inner_diameter_end": section.end_inner_diameter,
            }
            values = [(name, "mm", float(value) * _TO_MM) for name, value in lengths.items()]
            self.relate("assembly", assembly=shaft, part=self.add("shaft_section", "", values))
            begin += section.length

    def add_material(self, part: int, material: Any) -> None:
        """Give a part its material."""
        values: list[Attribute] = [
            ("elastic_modulus", "N / mm^2", material.youngs_modulus * 1e-6),
            ("poisson_ratio", "none", material.poissons_ratio),
            ("density", "kg / dm^3", material.density * 1e-3),
        ]
        number = self.shared("material", "Material", values)
        self.relate("reference", origin=part, referenced=number)

    def add_gear(
        self, shaft: int, name: str, case: PairCase, role: str, place: Iterable[Attribute] = ()
    ) -> int:
        """Add a gear of a pair with its flanks, tool, material and modifications."""
        gear, options = case.gear_pair.gears[role], case.gears.by_name[role]
        helix = gear.helix_angle if gear.hand == "right" else -gear.helix_angle
        roughness = options.roughness_ra
        number = self.add("ring_gear" if gear.teeth < 0 else "cylindrical_gear", name, [
            ("number_of_teeth", "none", abs(gear.teeth)),
            ("normal_module", "mm", gear.normal_module * _TO_MM),
            ("helix_angle_reference_diameter", "deg", helix * _TO_DEG),
            ("face_width", "mm", gear.face_width * _TO_MM),
            ("tip_diameter", "mm", abs(gear.tip_diameter) * _TO_MM),
            ("arithmetic_average_roughness_flank", "mum", roughness and roughness * 1e6),
            *place,
        ])  # fmt: skip
        self.relate("assembly", assembly=shaft, part=number)
        flank: list[Attribute] = [
            ("normal_pressure_angle", "deg", gear.normal_pressure_angle * _TO_DEG),
            ("addendum_modification_coefficient", "none", gear.profile_shift_coefficient),
        ]
        flanks = [self.add("cylindrical_gear_flank", name, flank) for _ in range(2)]
        self.relate("flank", gear=number, left=flanks[0], right=flanks[1])
        self.add_material(number, case.material)
        tool = self.shared("rack_shaped_tool", "Rack", [
            ("addendum_coefficient_reference_profile", "none", case.gears.dedendum_coefficient),
            ("dedendum_coefficient_reference_profile", "none", case.gears.addendum_coefficient),
            ("tip_radius_factor", "none", gear.rack.tip_radius_coefficient),
        ])  # fmt: skip
        self.relate("ordered_reference", origin=number, referenced=tool)
        self.add_forms(flanks, options.modification)
        return number

    def add_forms(self, flanks: list[int], modification: object) -> None:
        """Add reliefs and crownings to the flanks of a gear."""
        for key, kind, amounts, length in _FORMS:
            if amount := getattr(modification, key, 0.0):
                values = [(name, "mm", amount * _TO_MM) for name in amounts]
                along = getattr(modification, f"{key}_length", None)
                values += [(length, "mm", along * _TO_MM)] if along else []
                number = self.add(kind, "", values)
                for flank in flanks:
                    self.relate("reference", origin=flank, referenced=number)

    def add_stage(self, name: str, distance: float, gears: list[int]) -> int:
        """Add a pair of gears."""
        number = self.add("cylindrical_stage", name, [("center_distance", "mm", distance * _TO_MM)])
        self.relate("assembly", assembly=self.unit, part=number)
        self.relate("stage", stage=number, gear_1=gears[0], gear_2=gears[1])
        return number

    def add_bearing(self, case: MachineCase, name: str, shaft: int, place: Point) -> None:
        """Add a bearing: with the sizes that the case has, or a support with its stiffness."""
        bearing, key = case.bearings[name], f"bearings.{name}"
        type_ = case.get(f"{key}.type", "")
        slides = not bearing.axial_stiffness if not type_ else bearing.floating
        absorbs = "no_direction" if slides or type_ == "cylindrical-roller" else "both_directions"
        if type_ in ("angular-contact", "tapered-roller"):
            absorbs = "positive" if getattr(bearing.rolling, "direction", 0) > 0 else "negative"
        values: list[Attribute] = [
            ("u_coordinate_on_shaft_inner_side", "mm", float(bearing.position) * _TO_MM),
            *_position(place),
        ]
        if bearing.rolling is None:
            kind = "concept_bearing"
            values += [
                (f"{rexs}_stiffness", unit, factor * float(value))
                for way, rexs, unit, factor in (("radial", "radial", "N / m", 1.0),
                                                ("axial", "axial", "N / m", 1.0),
                                                ("tilting", "bending", "N mm / rad", 1e3))
                if isinstance(value := getattr(bearing, f"{way}_stiffness"), float | int)
            ]  # fmt: skip
            values.append(("radial_force_absorption", "none", bearing.radial_stiffness != 0.0))
        else:
            kind, stated = "rolling_bearing_with_catalog_geometry", dict(case.values())
            names = {ours: rexs for ours, _, rexs in BEARING_TYPES.values()}
            values.append(("bearing_type", "none", names.get(type_)))
            values += [
                (rexs, "mm", float(size) * _TO_MM)
                for ours, rexs in _BEARING_SIZES.items()
                if (size := stated.get(f"{key}.{ours}"))
            ]
            count = stated.get(f"{key}.balls") or stated.get(f"{key}.rollers")
            values.append(("number_of_rolling_elements", "none", count))
            angle = stated.get(f"{key}.contact_angle")
            values.append(("contact_angle", "deg", angle and angle * _TO_DEG))
        values.append(("axial_force_absorption", "none", absorbs))
        number = self.add(kind, name, values)
        self.relate("assembly", assembly=self.unit, part=number)
        self.relate("side", assembly=number, inner_part=shaft, outer_part=self.casing)

    def add_oil(self, case: PairCase) -> None:
        """Add the oil of a pair."""
        oil = case.lubricant_properties
        if case.lubricant is None or oil is None:
            return
        at_15 = oil.density + 0.7 * ((oil.temperature or 288.15) - 288.15)
        values: list[Attribute] = [("density_at_15_degree_celsius", "kg / dm^3", at_15 * 1e-3)]
        if name := case.lubricant.name:
            low, high = temperature_range(name)
            values += [
                (f"viscosity_at_{celsius}_degree_celsius", "mm^2 / s",
                 1e6 * from_library(name, kelvin).kinematic_viscosity)
                for celsius in (40, 100)
                if low <= (kelvin := celsius + ZERO_CELSIUS) <= high
            ]  # fmt: skip
        number = self.add("lubricant", name or "Oil", values)
        self.relate("reference", origin=self.casing, referenced=number)

    def add_loads(
        self,
        shaft: int,
        output: int | None,
        loads: Iterable[tuple[str, float | None, float, float, float | None]],
    ) -> None:
        """Add load cases: name, share, speed and torque of a shaft, temperature of the oil."""
        ends = [(shaft, True)] if output is None else [(shaft, True), (output, False)]
        numbers = []
        for end, defines in ends:
            values = [("transmits_torque", "none", True), ("defines_torque", "none", defines)]
            numbers.append(self.add("external_load", "Load", values))
            self.relate("assembly", assembly=end, part=numbers[-1])
        for name, share, speed, torque, temperature in loads:
            percent = None if share is None else 100.0 * share
            celsius = None if temperature is None else temperature - ZERO_CELSIUS
            self.add_load_case([
                (self.unit, name, [("operating_time_fraction", "%", percent)]),
                (self.casing, "", [("temperature_lubricant", "C", celsius)]),
                (shaft, "", [("rotational_speed", "1 / min", speed * _TO_RPM)]),
                (numbers[0], "", [("torque_around_u_axis", "N m", torque)]),
            ])  # fmt: skip


def _position(start: Point | None) -> list[Attribute]:
    """Position in space, along the axes of the machine."""
    if start is None:
        return []
    return [
        ("support_vector", "mm", tuple(float(value) * _TO_MM for value in start)),
        ("u_axis_vector", "mm", (1.0, 0.0, 0.0)),
        ("w_axis_vector", "mm", (0.0, 0.0, 1.0)),
    ]


def _require_cylindrical(case: MachineCase) -> None:
    """Refuse what has no stage in REXS that is read: crossed axes and planets of two gears."""
    for mesh in case.meshes:
        table = case.mesh_table(mesh)
        if hasattr(table, "cutter_radius"):
            what, remedy = "hypoid gears are not a cylindrical stage", "Write a case without them"
            raise InputError(what, f"meshes.{mesh}", "", remedy)
        if getattr(table, "stiffness", None) is not None:
            what = "a mesh with a constant stiffness has no teeth that REXS could describe"
            raise InputError(what, f"meshes.{mesh}.stiffness", "", "Remove the stiffness")
    for stage in case.stages.values():
        if len(stage.planets) > 1:
            what = "planets of two gears are not written as a REXS model"
            raise InputError(what, f"{stage.key}.planet_type", "", "Write a case without them")
