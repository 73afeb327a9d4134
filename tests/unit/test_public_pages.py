"""Pages of public names: loaded when they are first used, and checked wherever they come from."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module
from inspect import isfunction

import pytest

import tribodyn as td

_FRESH = """
import sys
from tribodyn.machine.section import Section
assert "tribodyn.machine.machine" not in sys.modules
assert Section.__init__.reads, "its arguments are not checked"
"""


def test_a_class_checks_its_arguments_before_its_page_is_used() -> None:
    done = subprocess.run([sys.executable, "-c", _FRESH], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", ["signals.cepstrum", "measurement.mesh_speed"])
def test_a_function_is_not_hidden_by_the_module_of_its_name(name: str) -> None:
    page, function = name.split(".")
    assert isfunction(getattr(import_module(f"tribodyn.{page}"), function))


def test_pages_list_their_names() -> None:
    assert {*td.machine.__all__} <= {*dir(td.machine)}
    with pytest.raises(AttributeError, match="no attribute 'shafft'"):
        td.machine.shafft  # noqa: B018


def test_names_of_hypoid_gears_are_those_of_their_page() -> None:
    page = import_module("tribodyn.gear.hypoid")
    assert {name for name in td.gear.__all__ if "hypoid" in name.lower()} < {*page.__all__}
    assert page.EaseOff is td.gear.EaseOff
    assert isfunction(page.misalignment_study)
    assert isfunction(page.tooth_contact)
