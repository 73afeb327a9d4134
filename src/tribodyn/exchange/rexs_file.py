"""Content of a REXS file: components with their values, relations and load cases.

REXS is the open exchange format of gearbox models (rexs.info). A model is written as XML
(``.rexs``), as JSON (``.rexsj``), or as one of both in a zip (``.rexsz``). XML is converted to the
structure of the JSON form first.
"""

from __future__ import annotations

import json
import math
import zipfile
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from io import BytesIO
from os import PathLike
from pathlib import Path
from xml.etree import ElementTree

from tribodyn import units
from tribodyn.errors import Argument, InputError, Problem
from tribodyn.types import Tree
from tribodyn.validated_files import LARGEST, read_bytes

#: Spellings of units that differ from ours, without blanks.
_UNITS = {
    "C": "degC",
    "°": "deg",
    "mum": "um",
    "1/min": "rpm",
    "none": "",
    "Nm": "N*m",
    "kg/dm^3": "kg/dm^3",
    "N/(mmmum)": "N/mm/um",
    "kgm^2": "kg*m^2",
}
#: Attribute of the gear unit that holds the complete case.
WHOLE_CASE = "custom_tribodyn_case"
#: Names of later versions -> the first name, of attributes that are read.
RENAMED = {
    "operating_time_fraction": "load_duration_fraction",  # 1.3
    "arithmetic_mean_roughness_flank_iso_4287_1997": "arithmetic_average_roughness_flank",  # 2.0.0
    "tip_corner_radius_factor_reference_profile": "tip_radius_factor",  # 2.0.0
}
#: Versions whose attributes are known; the last ones have other spellings, too.
VERSIONS = (
    *(f"1.{minor}" for minor in range(8)), "2.0.0", "2.0", "0.10", "0.90", "1.00", "1.10",
)  # fmt: skip
#: Attributes of gears, tools, shafts and bearings that are read or say nothing of their shape.
_NAMES = """
    addendum_coefficient_reference_profile addendum_modification_coefficient
    arithmetic_average_roughness_flank axial_force_absorption axial_stiffness bearing_type
    bending_stiffness catalogue_designation catalogue_value_e center_distance contact_angle
    diameter_of_rolling_element display_color face_width helix_angle_reference_diameter
    inner_diameter inner_diameter_begin inner_diameter_end length length_of_rolling_element name
    normal_module normal_pressure_angle number_of_bearing_rows number_of_rolling_elements
    number_of_teeth outer_diameter outer_diameter_begin outer_diameter_end radial_force_absorption
    radial_stiffness rotational_speed support_vector tip_diameter tip_radius_factor
    u_axis_vector u_coordinate_on_shaft u_coordinate_on_shaft_inner_side
    u_coordinate_on_shaft_outer_side w_axis_vector width
    """
_READ = frozenset(_NAMES.split())
#: Words in the kinds of these components, and most names of one kind in a remark.
_PARTS, _MOST_NAMES = ("gear", "flank", "tool", "shaft", "bearing", "cylindrical_stage"), 20
_REMEDY = "Export it again from the program that wrote it"
#: Largest number of components of one model: real gearboxes have some hundred.
_MOST = 100_000


@dataclass(frozen=True)
class Value:
    """One value of a component, as written: a number, a flag, a text, numbers, or None."""

    content: float | bool | str | tuple[float, ...] | None
    unit: str = ""


@dataclass
class Component:
    """A part of the gearbox."""

    id: int
    kind: str
    name: str
    values: dict[str, Value] = field(default_factory=dict)

    def __str__(self) -> str:
        return f"{self.kind} {self.id}" + (f' "{self.name}"' if self.name else "")

    def number(self, name: str, unit: str) -> float | None:
        """A finite number in an SI unit; None where the file has none."""
        value = self.values.get(name)
        if value is None or isinstance(value.content, tuple) or value.content in (None, ""):
            return None
        content = value.content
        if isinstance(content, bool | str) or not math.isfinite(content):
            raise InputError(f"{name} = {content}", str(self), "It is not a number", _REMEDY)
        return self._parsed(name, content, value.unit, unit)

    def vector(self, name: str, unit: str) -> tuple[float, ...] | None:
        """Three finite numbers in an SI unit; None where the file has none."""
        value = self.values.get(name)
        if value is None or not isinstance(value.content, tuple) or len(value.content) != 3:
            return None
        if not all(map(math.isfinite, value.content)):
            raise InputError(f"{name} = {value.content}", str(self), "It is not finite", _REMEDY)
        return tuple(self._parsed(name, item, value.unit, unit) for item in value.content)

    def text(self, name: str) -> str:
        """Return a text, also of digits only; empty where the file has none."""
        content = self.values[name].content if name in self.values else None
        if isinstance(content, float):
            return f"{content:.12g}"
        return content if isinstance(content, str) else ""

    def _parsed(self, name: str, content: object, unit: str, si_unit: str) -> float:
        written = "".join(unit.split())
        written = _UNITS.get(written, written)
        try:
            return units.parse(f"{content!r} {written}".strip(), si_unit)
        except units.UnitProblemError as error:
            what = f'{name} = {content:g} "{unit}"'
            raise InputError(what, str(self), str(error), _REMEDY) from None


@dataclass(frozen=True)
class Relation:
    """Relation between components: their numbers by role."""

    kind: str
    refs: tuple[tuple[str, int], ...]

    def of(self, role: str) -> int | None:
        """Number of the component in a role."""
        return next((number for name, number in self.refs if name == role), None)


@dataclass
class RexsFile:
    """A REXS model as stored in its file."""

    version: str
    application: str
    components: dict[int, Component]
    relations: list[Relation]
    load_cases: dict[int, dict[int, Component]]

    def related(self, kind: str, **roles: int) -> Iterator[Relation]:
        """Relations of one kind in which the components have the roles."""
        for relation in self.relations:
            if relation.kind == kind and all(relation.of(r) == n for r, n in roles.items()):
                yield relation

    def unread(self) -> dict[str, list[str]]:
        """Names of attributes with a value that are not read, by kind of gear, shaft or bearing."""
        names: dict[str, dict[str, None]] = {}
        for part in self.components.values():
            if any(stem in part.kind for stem in _PARTS):
                filled = (name for name, value in part.values.items() if value.content is not None)
                listed = [n for n in filled if n not in _READ and not n.startswith("custom_")]
                names.setdefault(part.kind, {}).update(dict.fromkeys(listed))
        return {kind: list(each) for kind, each in sorted(names.items()) if each}

    @property
    def stored_case(self) -> str:
        """Text of the case that tribodyn stored in the file; empty in files of other programs."""
        return next((unit.text(WHOLE_CASE) for unit in self.of_kind("gear_unit")), "")

    def of_kind(self, *kinds: str) -> list[Component]:
        """Components of some kinds, in the order of their numbers."""
        return sorted((c for c in self.components.values() if c.kind in kinds), key=lambda c: c.id)


def read_file(path: str | PathLike[str]) -> RexsFile:
    """Read a REXS file; the content determines the format, not the name."""
    place = str(path)
    try:
        content = read_bytes(Path(path), "rexs")
    except TypeError:
        why = "It is the path of a file"
        raise InputError(
            f"path = {path!r}", Argument("path"), why, "Give a text or a Path"
        ) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        what, why = f"cannot be read: {reason}", "The file system reports this error"
        raise InputError(what, place, why, "Check the path and its permissions") from None
    try:
        return model_of(_tree(content, place), place)
    except RecursionError:
        raise InputError("its elements are nested too deeply", place, "", _REMEDY) from None


def _tree(content: bytes, place: str) -> Tree:
    """The model in the structure of the JSON form."""
    if content[:4] == b"PK\x03\x04":
        content = _unzipped(content, place)
    try:
        head = content[:4096].decode(json.detect_encoding(content), "replace")
        if head.lstrip("\ufeff \t\r\n")[:1] == "{":
            tree = json.loads(content)["model"]
        else:
            parser = ElementTree.XMLParser(target=_NoDoctype())
            tree = _from_xml(ElementTree.fromstring(content, parser), place)
    except (KeyError, TypeError):
        raise InputError("it is JSON without a REXS model", place, "", _REMEDY) from None
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError("it is not a REXS file", place, str(error), _REMEDY) from None
    if not isinstance(tree, dict):
        raise InputError("it does not contain a REXS model", place, "", _REMEDY)
    return tree


def _unzipped(content: bytes, place: str) -> bytes:
    """The single model in a zip."""
    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            # Macintosh computers add a folder with a second file for each.
            inside = [n for n in archive.namelist() if not n.startswith("__MACOSX/")]
            models = [n for n in inside if n.lower().endswith((".rexs", ".rexsj"))]
            names = models or [n for n in inside if n.lower().endswith((".xml", ".json"))]
            if len(names) != 1:
                what = f"the zip contains {len(names) or 'no'} REXS models"
                why = "It has to contain one file that ends in .rexs or .rexsj"
                raise InputError(what, place, why, "Extract the model that you want to read")
            with archive.open(names[0]) as member:
                model = member.read(LARGEST["rexs"] + 1)
    except InputError:
        raise
    # The library raises many kinds of errors for a damaged zip.
    except Exception as error:
        raise InputError("it is a damaged zip", place, str(error), _REMEDY) from None
    if len(model) > LARGEST["rexs"]:
        what = f"its model is larger than {LARGEST['rexs'] / 1e6:g} MB"
        raise InputError(what, place, "Models of gearboxes are smaller", _REMEDY)
    return model


class _NoDoctype(ElementTree.TreeBuilder):
    """Tree builder that refuses documents with a document type, which may declare entities."""

    def doctype(self, *_: object) -> None:
        raise ValueError("It declares a document type, which REXS files do not have")


def _from_xml(root: ElementTree.Element, place: str) -> Tree:
    for element in root.iter():
        element.tag = str(element.tag).rpartition("}")[2]  # some programs write a namespace
    if root.tag != "model":
        what = f"its XML root is <{root.tag}>, not the <model> of REXS"
        raise InputError(what, place, "", _REMEDY)
    spectrum = root.find("load_spectrum")
    cases = [] if spectrum is None else spectrum.findall("load_case")
    return {
        **root.attrib,
        "relations": [
            {**relation.attrib, "refs": [ref.attrib for ref in relation.iter("ref")]}
            for relation in root.iter("relation")
        ],
        "components": _xml_components(root.find("components")),
        "load_spectrum": {
            "load_cases": [{**c.attrib, "components": _xml_components(c)} for c in cases]
        },
    }


def _xml_components(parent: ElementTree.Element | None) -> list[Tree]:
    elements = [] if parent is None else parent.findall("component")
    return [
        {
            **component.attrib,
            "attributes": [
                {**a.attrib, "text": _xml_array(a) if len(a) else (a.text or "").strip()}
                for a in component.findall("attribute")
            ],
        }
        for component in elements
    ]


def _xml_array(attribute: ElementTree.Element) -> list[str] | None:
    array = attribute.find("array")
    return None if array is None else [(item.text or "").strip() for item in array.iter("c")]


def model_of(tree: Tree, place: str) -> RexsFile:
    """Build the model from a tree in the structure of the JSON form."""
    components = _components(tree.get("components"), place)
    if not components:
        raise InputError("the model has no components", place, "", _REMEDY)
    relations = [
        Relation(
            str(item.get("type", "")),
            tuple(
                (str(ref.get("role", "")), _id(ref, place)) for ref in _dicts(item, "refs", place)
            ),
        )
        for item in _dicts(tree, "relations", place)
    ]
    spectrum = tree.get("load_spectrum") or {}
    cases = {
        _id(item, place): _components(item.get("components"), place)
        for item in _dicts(spectrum, "load_cases", place)
    }
    _refuse_missing(components, relations, cases, place)
    application = f"{tree.get('applicationId', '')} {tree.get('applicationVersion', '')}".strip()
    return RexsFile(str(tree.get("version", "")), application, components, relations, cases)


def _refuse_missing(
    components: dict[int, Component],
    relations: list[Relation],
    cases: dict[int, dict[int, Component]],
    place: str,
) -> None:
    """Refuse a model that refers to missing components."""
    named = {number for relation in relations for _, number in relation.refs}
    named |= {number for case in cases.values() for number in case}
    missing = sorted(named - components.keys())
    if missing:
        some = ", ".join(str(number) for number in missing[:5])
        what = f"relations or load cases refer to missing components: {some}"
        raise InputError(what, place, "", _REMEDY)


def _components(items: object, place: str) -> dict[int, Component]:
    components: dict[int, Component] = {}
    for item in _dicts({"components": items}, "components", place):
        number = _id(item, place)
        if number in components:
            raise InputError(f"two components have the number {number}", place, "", _REMEDY)
        values = {
            RENAMED.get(str(a.get("id")), str(a.get("id", ""))): Value(
                _content(a), str(a.get("unit", ""))
            )
            for a in _dicts(item, "attributes", place)
        }
        components[number] = Component(
            number, str(item.get("type", "")), str(item.get("name", "")), values
        )
    return components


def _dicts(parent: object, name: str, place: str) -> list[Tree]:
    items = parent.get(name) if isinstance(parent, dict) else None
    if items is None:
        return []
    if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
        raise InputError(f"{name} is not a list of objects", place, "", _REMEDY)
    if len(items) > _MOST:
        what, remedy = f"there are {len(items)} {name}", "Export a smaller model"
        raise InputError(what, place, f"The limit is {_MOST}", remedy)
    return items


def _id(item: Tree, place: str) -> int:
    try:
        return int(item["id"])
    except (KeyError, TypeError, ValueError, OverflowError):
        what = f"an id is not a whole number: {item.get('id')!r}"
        raise InputError(Problem(what, place, "", _REMEDY)) from None


def _content(attribute: Tree) -> float | bool | str | tuple[float, ...] | None:
    """Number, flag, text or list of numbers; XML writes all of them as text."""
    others = [v for name, v in attribute.items() if name not in ("id", "unit")]
    content = others[0] if len(others) == 1 else None
    if isinstance(content, list):
        try:
            return tuple(map(float, content))
        except (TypeError, ValueError, OverflowError):
            return None
    if isinstance(content, bool) or content is None or isinstance(content, dict):
        return content if isinstance(content, bool) else None
    if isinstance(content, str) and content in ("true", "false"):
        return content == "true"
    try:
        return float(content)
    except (ValueError, OverflowError):
        return str(content)


def version_remark(file: RexsFile) -> str:
    """Remark on a version that is not known, with what is not read of it; empty if it is known."""
    if file.version in VERSIONS:
        return ""
    lost = [
        f"{kind}: {', '.join(names[:_MOST_NAMES])}"
        + (f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else "")
        for kind, names in file.unread().items()
    ]
    version = f"REXS version {file.version} is not known" if file.version else (
        "The file names no version of REXS"
    )  # fmt: skip
    listed = "; of ".join(lost) or "gears, shafts, bearings: none"
    reading = "is read by the names of attributes in versions 1.0 to 2.0.0"
    return f"{version} and {reading}; not read are, of {listed}"


def kinds(components: Iterable[Component]) -> dict[str, int]:
    """Number of components of each kind."""
    return dict(sorted(Counter(component.kind for component in components).items()))
