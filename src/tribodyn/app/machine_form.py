"""Form of a machine or a planetary stage as data: its parts by name, and models of its teeth."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any

from tribodyn.app.case_form import Typed, field_of, key_label
from tribodyn.model import Option
from tribodyn.study.case.case import Case
from tribodyn.study.case.checks import case_options
from tribodyn.study.case.provenance import effective
from tribodyn.study.case.section import Table, options_of
from tribodyn.study.case.values import Plain
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.pair_cases import SHARED
from tribodyn.study.machine.tables import TABLES, MeshDynamics, part_table
from tribodyn.study.machine.user_tables import flat_keys

#: Groups of the form, those of parts with a table for each of them.
_GROUPS = {
    "operation": "Speed and load",
    "planets": "Planetary stage",
    "meshes": "Meshes",
    "gears": "Gears",
    "bearings": "Bearings",
    "shafts": "Shafts",
    "couplings": "Couplings",
    "faults": "Faults",
    "dynamics": "Motion",
    "solver": "Solution",
}
_PARTS = ("planets", "meshes", "gears", "bearings", "shafts", "couplings", "faults")
_MEANINGS = {
    "shafts": "their sections are edited in the file",
    "meshes": "with models of their own where these are given",
}


class MachineForm:
    """Form of a machine or stage, with typed text that is not part of the case yet."""

    def __init__(self, case: MachineCase, typed: Typed, units: Mapping[str, str]) -> None:
        self.case, self.typed, self.units = case, typed, units

    @cached_property
    def _pair(self) -> Case | None:
        """Pair of gears whose models stand for those of all meshes."""
        return next((pair for _, pair, _ in self.case.mesh_pairs()), None)

    @cached_property
    def _defaults(self) -> Mapping[str, Any]:
        return effective(self._pair) if self._pair is not None else {}

    def groups(self) -> list[dict[str, Any]]:
        """All tables with their fields: what is given first, the others collapsed."""
        groups = []
        for name, title in _GROUPS.items():
            inner = [
                self._group(f"{name}.{part}", part, self._of_part(name, part))
                for part in (self.case.data.get(name, {}) if name in _PARTS else ())
            ]
            fields = {} if name in _PARTS else self._of_table(name)
            if fields or inner:
                group = self._group(name, title, fields, inner, name == "operation")
                groups.append({**group, "meaning": _MEANINGS.get(name, "")})
        for name in SHARED if self._pair is not None else ():
            groups.append(self._group(name, key_label(name), self._of_model(name)))
        return groups

    def options(self) -> dict[str, Option]:
        """All options of the case by key."""
        options: dict[str, Option] = {}
        for name in _GROUPS:
            if name in _PARTS:
                for part in self.case.data.get(name, {}):
                    options |= self._of_part(name, part)
            else:
                options |= self._of_table(name)
        for name in SHARED if self._pair is not None else ():
            options |= self._of_model(name)
        return options

    def _of_table(self, name: str) -> dict[str, Option]:
        """Options of a table of the machine, and those of what it gives for its meshes."""
        options = {f"{name}.{key}": option for key, option in options_of(TABLES[name], "")}
        given = (f"{name}.{key}" for key, _ in flat_keys(self.case.data.get(name, {})))
        return {**options, **self._known(key for key in given if key not in options)}

    def _of_part(self, name: str, part: str) -> dict[str, Option]:
        """Options of the table of a part, and those of what it gives besides."""
        prefix, body = f"{name}.{part}", self.case.data[name][part]
        table = part_table(name, body)
        stage = name == "gears" and "planets" in self.case.data
        skipped = ("shaft", "position") if stage else ()
        options = {f"{prefix}.{k}": o for k, o in options_of(table, "") if k not in skipped}
        if name == "meshes" and "stiffness" in body and not isinstance(body["stiffness"], Mapping):
            options |= {f"{prefix}.{key}": option for key, option in options_of(MeshDynamics, "")}
        given = {f"{prefix}.{key}": value for key, value in flat_keys(body)}
        return {**options, **self._known(key for key in given if key not in options)}

    def _known(self, keys: Iterator[str]) -> dict[str, Option]:
        options = {key: self.case.option_of(key) for key in keys}
        return {key: option for key, option in options.items() if option is not None}

    def _of_model(self, name: str) -> dict[str, Option]:
        """Options of a table of models and of the model that it names."""
        table = Case.fields[name]
        assert isinstance(table, Table)
        options = {f"{name}.{key}": option for key, option in options_of(table.kind, "")}
        if selector := table.kind.selector:
            key = f"{name}.{selector}"
            chosen = self.typed.get(key) or self._text(key) or self._defaults.get(key)
            options |= {f"{name}.{k}": o for k, o in case_options(name, str(chosen)).items()}
        return options

    def _group(
        self,
        key: str,
        title: str,
        options: Mapping[str, Option],
        inner: list[dict[str, Any]] | None = None,
        is_open: bool = False,
    ) -> dict[str, Any]:
        fields = [self._field(name, option) for name, option in options.items()]
        shown = [each for each in fields if each["value"] or each["required"]]
        inner = inner or []
        return {
            "key": key,
            "title": title,
            "meaning": "",
            "note": "",
            "values": sum(bool(f["value"]) for f in fields) + sum(g["values"] for g in inner),
            "open": is_open,
            "fields": shown,
            "more": [each for each in fields if each not in shown],
            "groups": inner,
        }

    def _field(self, key: str, option: Option) -> dict[str, Any]:
        default = self._defaults.get(key, None if option.required else option.default)
        unit = self.units.get(key, "")
        field = field_of(key, option, self._text(key), default, unit)
        if key in self.typed and option.kind == "number":
            field["value"] = self.typed[key].removesuffix(unit).strip() if unit else self.typed[key]
        return field

    def _text(self, key: str) -> str:
        """Value as text: typed, or as the case gives it; empty where it has a default."""
        if key in self.typed:
            return self.typed[key]
        value: Any = self.case.data
        for name in key.split("."):
            value = value.get(name) if isinstance(value, Mapping) else None
        value = self.case.uncertain.get(key, value)
        if isinstance(value, Plain):
            option = self.case.option_of(key)
            value = f"{value.value} {option.unit}".strip() if option else value.value
        if value is None or isinstance(value, Mapping):
            return ""
        if isinstance(value, bool):
            return str(value).lower()
        return ", ".join(map(str, value)) if isinstance(value, list | tuple) else str(value)
