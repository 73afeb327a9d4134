"""A REXS 1.4 model under construction, and its forms: XML, JSON and XML in a zip."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterable
from io import BytesIO
from typing import Any
from xml.etree import ElementTree

Attribute = tuple[str, str, Any]  # name, unit, value
_KINDS = {bool: "boolean", int: "integer", float: "floating_point", str: "string",
          tuple: "floating_point_array"}  # fmt: skip


class ModelTree:
    """Components, relations and load cases, numbered as they are added."""

    def __init__(self) -> None:
        self.components: list[dict[str, Any]] = []
        self.relations: list[dict[str, Any]] = []
        self.load_cases: list[dict[str, Any]] = []

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
    def model(self) -> dict[str, Any]:
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


def _component(
    number: int, kind: str, name: str, attributes: Iterable[Attribute]
) -> dict[str, Any]:
    listed = [
        {"id": n, **({} if unit == "none" else {"unit": unit}), _KINDS[type(v)]: _rounded(v)}
        for n, unit, v in attributes
        if v is not None
    ]
    return {"id": number, "type": kind, "name": name, "attributes": listed}


def _rounded(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_rounded(item) for item in value]
    return float(f"{value:.15g}") if isinstance(value, float) else value


def _element(parent: ElementTree.Element, tag: str, values: dict[str, Any]) -> ElementTree.Element:
    plain = {k: str(v) for k, v in values.items() if not isinstance(v, list | dict)}
    return ElementTree.SubElement(parent, tag, plain)


def _add_components(parent: ElementTree.Element, components: list[dict[str, Any]]) -> None:
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
