"""Deprecated names: each entry of the table works, warns and says what to write."""

from __future__ import annotations

import importlib
import inspect
import re
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.aliases import RENAMED, Alias, with_old_names
from tribodyn.checkpoints import Checkpoints
from tribodyn.dynamics import System, simulate
from tribodyn.errors import InputError, require_one_of
from tribodyn.friction import LAWS, TribologicalContact

_PACKAGE = Path(inspect.getfile(td)).parent
_OLD = "is deprecated; use "


def _definitions(name: str) -> list[Any]:
    """Functions and classes of the package with a name, in the modules that define them."""
    pattern = re.compile(rf"^(?:class|def) {name}\b", re.MULTILINE)
    paths = [path for path in _PACKAGE.rglob("*.py") if pattern.search(path.read_text("utf-8"))]
    names = (path.relative_to(_PACKAGE.parent).with_suffix("").parts for path in paths)
    modules = [
        importlib.import_module(".".join(parts))
        for parts in names
        if not {"plot", "app", "cli"} & {*parts}
    ]
    return [vars(module)[name] for module in modules]


@pytest.mark.parametrize("old", [old for old in RENAMED if not old.startswith("tribodyn.")])
def test_every_old_name_belongs_to_a_definition_with_the_new_name(old: str) -> None:
    path, _, parameter = old.partition("(")
    owner, _, attribute = path.partition(".")
    aliases = 0
    for home in _definitions(owner):
        if not parameter:
            if RENAMED[old] in {*dir(home), *getattr(home, "__annotations__", {})}:
                alias = inspect.getattr_static(home, attribute)
                assert isinstance(alias, Alias)
                assert alias.new == RENAMED[old]
                aliases += 1
            continue
        function = getattr(home, attribute, None) if attribute else home
        if function and RENAMED[old] in inspect.signature(function).parameters:
            wrapper = function.__init__ if isinstance(function, type) else function
            while wrapper.__code__.co_name != "accepting_old_names":
                wrapper = wrapper.__wrapped__
            aliases += 1
    assert aliases


def test_an_old_attribute_of_an_object_and_of_a_class_works_and_warns() -> None:
    case = td.load_case("fzg-roughness")
    with pytest.warns(DeprecationWarning, match=rf"Case\.given {_OLD}Case\.user_input$") as record:
        assert case.given is case.user_input
    assert record[0].filename == __file__
    with pytest.warns(DeprecationWarning, match=_OLD):
        assert td.Case.known() == td.Case.section_keys()
    with pytest.warns(DeprecationWarning, match=_OLD):
        assert td.Case.whole is td.Case


def test_an_old_method_computes_the_same() -> None:
    contact = TribologicalContact(1e5, 8e8, 1.0, 2.0, 0.5, 8e-3, 0.08, 5e-7, oil_density=880.0)
    law = LAWS["constant"]
    with pytest.warns(DeprecationWarning, match=_OLD):
        coefficient = law.told(contact, {"coefficient": 0.05})
    assert np.array_equal(coefficient, law.evaluate(contact, {"coefficient": 0.05}))
    with pytest.warns(DeprecationWarning, match=_OLD):
        assert contact.known("oil_density") == 880.0


def test_an_old_parameter_of_a_function_works_and_warns() -> None:
    arguments = System([[1.0]], [[0.1]], [[4.0]], [0.0]), 1.0, 3, ([1.0], [0.0])
    with pytest.warns(DeprecationWarning, match=rf"kept=\.\.\.\) {_OLD}") as record:
        earlier = simulate(*arguments, steps=64, kept=1)
    assert record[0].filename == __file__
    assert earlier == simulate(*arguments, steps=64, recorded_cycles=1)
    with pytest.raises(InputError, match="kept"):
        simulate(*arguments, steps=64, kept=1, recorded_cycles=1)
    with pytest.warns(DeprecationWarning, match=_OLD):
        assert require_one_of("inlet", "zero", known=["zero"]) == "zero"


def test_an_old_parameter_of_a_constructor_works_and_warns() -> None:
    class Study:
        def __init__(self, specification: int) -> None:
            self.specification = specification

    study: Any = with_old_names(Study)
    with pytest.warns(DeprecationWarning, match=_OLD):
        stored = study(told=3)
    with pytest.warns(DeprecationWarning, match=_OLD):
        assert stored.told == 3


def test_old_names_of_modules_and_their_contents_work_and_warn() -> None:
    for name in ("members", "checkpoints"):
        module: Any = importlib.import_module(f"tribodyn.{name}")
        with pytest.warns(DeprecationWarning, match=rf"{_OLD}tribodyn\.checkpoints\.Checkpoints$"):
            assert module.Members is Checkpoints
        with pytest.raises(AttributeError, match="Memberz"):
            _ = module.Memberz


def test_a_script_shows_the_warning_once_for_a_line(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        'import tribodyn as td\ncase = td.load_case("fzg-roughness")\n'
        "for _ in range(3):\n    case.given\n"
    )
    run = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=True)
    assert run.stderr.count(_OLD) == 1
    assert f"{script}:4: DeprecationWarning" in run.stderr


def test_the_suite_turns_old_names_into_errors() -> None:
    with pytest.raises(DeprecationWarning, match=_OLD):
        _ = td.load_case("fzg-roughness").given
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert td.load_case("fzg-roughness").user_input
