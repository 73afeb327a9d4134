"""Write a case as a REXS 1.4 model, together with the complete case as an attribute."""

from __future__ import annotations

import json
import math
import zipfile
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

from tribodyn.errors import InputError, OutputExistsError
from tribodyn.files import atomic_write
from tribodyn.nomenclature import GEARS
from tribodyn.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from tribodyn.gear import SpurPair
    from tribodyn.study.case.case import Case

#: Attribute of the gear unit that holds the complete case.
WHOLE_CASE = "custom_tribodyn_case"
#: Numbers of the components.
_UNIT, _CASING, _STAGE, _OIL, _MATERIAL, _LOAD = 1, 2, 3, 4, 5, 6
_SHAFTS, _GEARS, _TOOL = (7, 8), (9, 10), 11
_FLANKS = ((12, 13), (14, 15))
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
_TO_MM, _TO_DEG = 1e3, 180.0 / math.pi

Attribute = tuple[str, str, Any]  # name, unit, value


def write_rexs(case: Case, path: str | PathLike[str], *, force: bool = False) -> None:
    """Write a case as a REXS 1.4 model.

    Parameters
    ----------
    case : Case
        Case of a spur pair.
    path : path
        File to write: ``.rexs`` is XML, ``.rexsj`` JSON, ``.rexsz`` XML in a zip.
    force : bool
        Replace a file.

    Raises
    ------
    InputError
        If the case has no gears (kind "table"), the suffix is unknown, or the file exists.

    Data without a counterpart in REXS (models, structure, flank forms) are stored in an attribute
    of the gear unit, ``custom_tribodyn_case``, from which the case is restored without loss.
    Source: rexs.info, model of REXS 1.4.
    """
    target = Path(path)
    writer = _WRITERS.get(target.suffix.lower())
    if writer is None:
        why = "The suffix determines the format of the model"
        remedy = f"Use a suffix of {', '.join(_WRITERS)}"
        raise InputError(f'the name ends in "{target.suffix}"', str(path), why, remedy)
    if case.spur_pair is None:
        what = f'gears of the kind "{case.gears.kind}" are not a cylindrical stage'
        raise InputError(what, "gears.kind", "", "Write a case of spur gears")
    if target.exists() and (target.is_dir() or not force):
        raise OutputExistsError("this exists already", str(path), "", "Choose another name")
    content = writer(case)
    with atomic_write(target) as place:
        place.write_bytes(content)


def _parts(case: Case) -> dict[str, Any]:
    from tribodyn import __version__

    pair = case.gear_pair
    operation = case.operation
    driver = GEARS.index(operation.speed_of)
    torque = operation.torque if case.gears.driver == operation.speed_of else -operation.torque
    load: list[dict[str, Any]] = [
        _part(_UNIT, "gear_unit", "", [("load_duration_fraction", "%", 100.0)]),
        _part(
            _SHAFTS[driver],
            "shaft",
            "",
            [("rotational_speed", "1 / min", operation.speed * 30.0 / math.pi)],
        ),
        _part(_LOAD, "external_load", "", [("torque_around_u_axis", "N m", torque)]),
    ]
    temperature = case.lubricant.temperature if case.lubricant else None
    if temperature is not None:
        kelvin = [("temperature_lubricant", "C", temperature - ZERO_CELSIUS)]
        load.append(_part(_CASING, "gear_casing", "", kelvin))
    gears = [_gear(pair, case, which) for which in range(2)]
    components = [
        _part(_UNIT, "gear_unit", case.title, [(WHOLE_CASE, "none", case.to_toml())]),
        _part(_CASING, "gear_casing", "Casing", []),
        _part(_STAGE, "cylindrical_stage", "Stage",
              [("center_distance", "mm", pair.center_distance * _TO_MM)]),
        *([_oil(case)] if case.lubricant else []),
        _part(_MATERIAL, "material", "Material", [
            ("elastic_modulus", "N / mm^2", case.material.youngs_modulus * 1e-6),
            ("poisson_ratio", "none", case.material.poissons_ratio),
            ("density", "kg / dm^3", case.material.density * 1e-3),
        ]),
        _part(_LOAD, "external_load", "Load", [("defines_torque", "none", True)]),
        *(_part(n, "shaft", f"Shaft of the {name}", [])
          for n, name in zip(_SHAFTS, GEARS, strict=True)),
        _part(_TOOL, "rack_shaped_tool", "Rack", [
            ("addendum_coefficient_reference_profile", "none", case.gears.dedendum_coefficient),
            ("dedendum_coefficient_reference_profile", "none", case.gears.addendum_coefficient),
            ("tip_radius_factor", "none", case.gears.rack_tip_radius_coefficient),
        ]),
        *(part for gear in gears for part in gear),
        *(part for _, part in _forms(case)),
    ]  # fmt: skip
    return {
        "version": "1.4",
        "applicationId": "tribodyn",
        "applicationVersion": __version__,
        "relations": _relations(case, _SHAFTS[driver]),
        "components": components,
        "load_spectrum": {"id": 1, "load_cases": [{"id": 1, "components": load}]},
    }


def _gear(pair: SpurPair, case: Case, which: int) -> list[dict[str, Any]]:
    gear, options = pair.gears[GEARS[which]], case.gears.by_name[GEARS[which]]
    helix = gear.helix_angle if gear.hand == "right" else -gear.helix_angle
    attributes: list[Attribute] = [
        ("number_of_teeth", "none", gear.teeth),
        ("normal_module", "mm", gear.normal_module * _TO_MM),
        ("helix_angle_reference_diameter", "deg", helix * _TO_DEG),
        ("face_width", "mm", gear.face_width * _TO_MM),
        ("tip_diameter", "mm", gear.tip_diameter * _TO_MM),
    ]
    if options.roughness_ra is not None:
        attributes.append(("arithmetic_average_roughness_flank", "mum", options.roughness_ra * 1e6))
    flank: list[Attribute] = [
        ("normal_pressure_angle", "deg", gear.normal_pressure_angle * _TO_DEG),
        ("addendum_modification_coefficient", "none", gear.profile_shift_coefficient),
    ]
    name = GEARS[which].capitalize()
    return [
        _part(_GEARS[which], "cylindrical_gear", name, attributes),
        *(_part(n, "cylindrical_gear_flank", name, flank) for n in _FLANKS[which]),
    ]


def _oil(case: Case) -> dict[str, Any]:
    oil = case.lubricant_properties
    assert oil is not None
    name = case.lubricant.name if case.lubricant and case.lubricant.name else "Oil"
    return _part(_OIL, "lubricant", name, [("density_at_15_degree_celsius", "kg / dm^3",
                 (oil.density + 0.7 * ((oil.temperature or 288.15) - 288.15)) * 1e-3)])  # fmt: skip


def _forms(case: Case) -> list[tuple[tuple[int, int], dict[str, Any]]]:
    """Reliefs and crownings, each with the flanks to which it is attached."""
    forms: list[tuple[tuple[int, int], dict[str, Any]]] = []
    for flanks, gear in zip(_FLANKS, case.gears.by_name.values(), strict=True):
        for key, kind, amounts, length in _FORMS:
            amount = getattr(gear.modification, key, 0.0)
            if amount:
                values = [(name, "mm", amount * _TO_MM) for name in amounts]
                along = getattr(gear.modification, f"{key}_length", None)
                values += [(length, "mm", along * _TO_MM)] if along else []
                number = _FLANKS[-1][-1] + 1 + len(forms)
                forms.append((flanks, _part(number, kind, "", values)))
    return forms


def _relations(case: Case, loaded: int) -> list[dict[str, Any]]:
    links: list[tuple[str, dict[str, int]]] = [
        ("assembly", {"assembly": _UNIT, "part": n}) for n in (_CASING, _STAGE, *_SHAFTS)
    ]
    links += [("stage", {"stage": _STAGE, "gear_1": _GEARS[0], "gear_2": _GEARS[1]})]
    links += [("assembly", {"assembly": loaded, "part": _LOAD})]
    for shaft, gear, (left, right) in zip(_SHAFTS, _GEARS, _FLANKS, strict=True):
        links += [
            ("assembly", {"assembly": shaft, "part": gear}),
            ("flank", {"gear": gear, "left": left, "right": right}),
            ("reference", {"origin": gear, "referenced": _MATERIAL}),
            ("ordered_reference", {"origin": gear, "referenced": _TOOL}),
        ]
    if case.lubricant:
        links += [("reference", {"origin": _CASING, "referenced": _OIL})]
    links += [
        ("reference", {"origin": flank, "referenced": part["id"]})
        for flanks, part in _forms(case)
        for flank in flanks
    ]
    return [
        {
            "id": n,
            "type": kind,
            **({"order": 1} if kind == "ordered_reference" else {}),
            "refs": [{"role": role, "id": number} for role, number in roles.items()],
        }
        for n, (kind, roles) in enumerate(links, start=1)
    ]


def _part(number: int, kind: str, name: str, attributes: list[Attribute]) -> dict[str, Any]:
    rounded = [(n, u, float(f"{v:.15g}") if isinstance(v, float) else v) for n, u, v in attributes]
    return {"id": number, "type": kind, "name": name, "attributes": rounded}


def tree_of(case: Case) -> dict[str, Any]:
    """The model of a case in the structure of the JSON form."""
    kinds = {bool: "boolean", int: "integer", float: "floating_point", str: "string"}

    def plain(parts: list[dict[str, Any]]) -> list[dict[str, Any]]:
        return [
            {
                **part,
                "attributes": [
                    {"id": name, **({} if unit == "none" else {"unit": unit}), kinds[type(v)]: v}
                    for name, unit, v in part["attributes"]
                ],
            }
            for part in parts
        ]

    tree = _parts(case)
    (load,) = tree["load_spectrum"]["load_cases"]
    spectrum = {"id": 1, "load_cases": [{**load, "components": plain(load["components"])}]}
    return {**tree, "components": plain(tree["components"]), "load_spectrum": spectrum}


def _as_json(case: Case) -> bytes:
    return json.dumps({"model": tree_of(case)}, indent=1, ensure_ascii=False).encode()


def _as_xml(case: Case) -> bytes:
    tree = _parts(case)

    def add(parent: ElementTree.Element, tag: str, values: dict[str, Any]) -> ElementTree.Element:
        plain = {k: str(v) for k, v in values.items() if not isinstance(v, list | dict)}
        return ElementTree.SubElement(parent, tag, plain)

    def add_parts(parent: ElementTree.Element, parts: list[dict[str, Any]]) -> None:
        for part in parts:
            element = add(parent, "component", part)
            for name, unit, value in part["attributes"]:
                text = str(value).lower() if isinstance(value, bool) else str(value)
                add(element, "attribute", {"id": name, "unit": unit}).text = text

    head = {k: v for k, v in tree.items() if isinstance(v, str)}
    root = ElementTree.Element("model", head)
    relations = add(root, "relations", {})
    for relation in tree["relations"]:
        element = add(relations, "relation", relation)
        for ref in relation["refs"]:
            add(element, "ref", ref)
    add_parts(add(root, "components", {}), tree["components"])
    spectrum = add(root, "load_spectrum", {"id": 1})
    (load,) = tree["load_spectrum"]["load_cases"]
    add_parts(add(spectrum, "load_case", {"id": 1}), load["components"])
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True))


def _as_zip(case: Case) -> bytes:
    from io import BytesIO

    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("rexs-model.rexs", _as_xml(case))
    return buffer.getvalue()


_WRITERS: dict[str, Callable[[Case], bytes]] = {
    ".rexs": _as_xml,
    ".rexsj": _as_json,
    ".rexsz": _as_zip,
}
