"""The docstrings are the contract: complete, equal to the signature, with the right units."""

import importlib
import pkgutil
from collections.abc import Callable, Iterator

import docstring_checks
import pytest
from source_tree import Module, modules, parse_entries, read

import tribodyn
from tribodyn.nomenclature import QUANTITIES
from tribodyn.study import case as case_model
from tribodyn.study.case.section import Section

CHECKS = [getattr(docstring_checks, name) for name in docstring_checks.__all__]

GOOD = '''"""Room."""

__all__ = ["law"]


def law(load_per_width: float, extra: float) -> float:
    """Film.

    Parameters
    ----------
    load_per_width : float [N/m]
        Load.
    extra : float
        Extra length [m].

    Returns
    -------
    float [m]

    Raises
    ------
    InputError
        If not positive.

    Examples
    --------
    >>> law(1.0, 2.0)
    1.0
    """
    require_positive("load_per_width", load_per_width)
    return 1.0
'''
PAGE = '__all__ = ["law"]\n'

BAD = {
    "missing_docstrings": [('"""Room."""\n', ""), ('"""Film.', 'x = """')],
    "missing_doctests": [(">>>", "->")],
    "missing_raises": [("Raises\n    ------", "Errors:")],
    "missing_returns": [("Returns\n    -------", "Gives:")],
    "missing_units": [("Extra length [m]", "Extra length")],
    "parameters_differ": [
        ("extra : float", "other : float"),
        ("load: float, ", ""),
        ("load_per_width: float, extra: float", "extra: float, load_per_width: float"),
        ("Parameters\n    ----------", "Arguments:"),
    ],
    "units_differ": [("[N/m]", "[N/mm]"), ("[N/m]", "[m]")],
}


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_docstrings(check: Callable[[Module], list[str]]) -> None:
    complaints = [complaint for module in modules() for complaint in check(module)]
    assert not complaints, "\n".join(complaints)


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_good_docstring_passes(check: Callable[[Module], list[str]]) -> None:
    assert check(read(GOOD, page=PAGE)) == []


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [(name, old, new) for name, changes in BAD.items() for old, new in changes if old in GOOD],
)
def test_check_can_fail(name: str, old: str, new: str) -> None:
    assert getattr(docstring_checks, name)(read(GOOD.replace(old, new), page=PAGE))


def test_every_check_can_fail() -> None:
    assert sorted(BAD) == sorted(docstring_checks.__all__)


def test_entries_with_several_names_and_lines() -> None:
    text = "X.\n\nParameters\n----------\na, b : float [m]\n    Long\n    text.\n*rest : int\n\n"
    entries = parse_entries(text + "Returns\n-------\nfloat\n", "Parameters")
    assert list(entries) == ["a", "b", "rest"]
    assert entries["b"].split() == [":", "float", "[m]", "Long", "text."]


def public_names() -> Iterator[tuple[str, str]]:
    for info in pkgutil.walk_packages(tribodyn.__path__, "tribodyn."):
        if info.name.endswith("__main__"):
            continue
        module = importlib.import_module(info.name)
        for name in getattr(module, "__all__", ()):
            yield info.name, name


def test_every_public_name_resolves() -> None:
    missing = [
        f"{module}.{name}"
        for module, name in public_names()
        if not hasattr(importlib.import_module(module), name)
    ]
    assert not missing
    for name in tribodyn.__all__:
        assert getattr(tribodyn, name) is not None, name


def test_case_fields_have_the_units_of_the_nomenclature() -> None:
    sections, sections_seen = [Section], []
    while sections:
        section = sections.pop()
        sections += section.__subclasses__()
        for name, spec in section.specs():
            if name in QUANTITIES and spec.kind != "flag":
                sections_seen.append(name)
                assert spec.unit == QUANTITIES[name].unit, (section, name)
    assert case_model.__doc__  # importing it makes the sections known
    assert {"normal_module", "face_width", "speed", "torque"} <= set(sections_seen)
