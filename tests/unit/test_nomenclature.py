"""The table of quantities is consistent with itself and with the unit reader."""

import importlib
import inspect
import pkgutil

import pytest

import tribodyn
from tribodyn.nomenclature import QUANTITIES, find, lookup
from tribodyn.units import convert


def test_every_row_is_complete() -> None:
    for name, quantity in QUANTITIES.items():
        assert quantity.name == name
        assert name.isidentifier()
        assert name == name.lower()
        assert quantity.meaning, name
        assert bool(quantity.unit) == bool(quantity.display_unit), name
        # raises when the two are of different kinds
        convert(1.0, quantity.unit, quantity.display_unit)


def test_si_units_are_si() -> None:
    for quantity in QUANTITIES.values():
        if quantity.unit and quantity.unit != "rad":
            base = {"kg", "m", "s", "N", "Pa", "Hz", "K", "W", "J", "rad"}
            units_used = set(
                quantity.unit.replace("^2", "").replace("^3", "").replace("/", "*").split("*")
            )
            assert units_used <= base | {"1"}, quantity


def test_label_shows_the_display_unit() -> None:
    assert lookup("hertz_pressure").label == "Hertz pressure [GPa]"
    assert lookup("transverse_contact_ratio").label == "Transverse contact ratio"


def test_unknown_name_names_the_nearest() -> None:
    with pytest.raises(KeyError, match='did you mean "base_radius"'):
        lookup("base_radus")


def test_find_prefers_exact_symbol_then_parts() -> None:
    assert [quantity.name for quantity in find("epsilon_alpha")] == ["transverse_contact_ratio"]
    assert [quantity.name for quantity in find("mass")] == ["mass"]
    assert {"bearing_stiffness", "bearing_damping", "bearing_force"} <= {
        quantity.name for quantity in find("bearing")
    }
    assert find("contact ratio")[0].name == "transverse_contact_ratio"
    assert find("no such thing") == []


def test_a_public_class_has_one_meaning() -> None:
    places: dict[str, set[str]] = {}
    for module in pkgutil.iter_modules(tribodyn.__path__, "tribodyn."):
        public = importlib.import_module(module.name) if module.ispkg else None
        for name in getattr(public, "__all__", ()):
            value = getattr(public, name)
            if inspect.isclass(value):
                places.setdefault(name, set()).add(value.__module__)
    assert len(places) > 100
    assert {name: found for name, found in places.items() if len(found) > 1} == {}
