"""A file that is refused as it stands is checked with the values of --set in place."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import tribodyn as td
from tribodyn.cases.load import load_changed_case
from tribodyn.errors import InputError

FAULTS = {
    "wrong unit": (r'^torque = "[^"]*"', 'torque = "100 mm"'),
    "missing": (r'^torque = "[^"]*".*\n', ""),
    "no number": (r'^torque = "[^"]*"', "torque = true"),
}
CASES = ("fzg-roughness", "helical-pair", "hypoid-axle", "planetary-stage")


def stored(name: str, fault: str, folder: Path) -> Path:
    """File of a built-in case with a fault in the torque."""
    text = re.sub(r"\n\[\[load_cases\]\][^[]*", "\n", td.load_case(name).to_toml())
    head, operation = text.split("\n[operation]")
    pattern, replacement = FAULTS[fault]
    changed = re.sub(pattern, replacement, operation, count=1, flags=re.MULTILINE)
    assert changed != operation
    path = folder / "case.toml"
    path.write_text(f"{head}\n[operation]{changed}".split("\n[assumed]")[0] + "\n", "utf-8")
    return path


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("name", CASES)
def test_a_value_of_set_mends_the_file(name, fault, tmp_path):
    path = stored(name, fault, tmp_path)
    with pytest.raises(InputError, match="torque"):
        td.load_case(path)
    case = load_changed_case(path, {"operation.torque": "80 N*m"}, "--set")
    values = dict(case.values()) if hasattr(case, "values") else None
    assert values["operation.torque"] == 80.0 if values else case.operation.torque == 80.0
    with pytest.raises(InputError, match=r"--set operation\.torque"):
        load_changed_case(path, {"operation.torque": "80 mm"}, "--set")
    with pytest.raises(InputError, match="torque"):  # another value does not help
        load_changed_case(path, {"title": "another"}, "--set")


def test_a_law_of_set_replaces_one_that_does_not_exist(tmp_path):
    text = td.load_case("fzg-roughness").to_toml().split("\n[assumed]")[0]
    path = tmp_path / "case.toml"
    path.write_text(re.sub(r'(?m)^law = "[^"]*"', 'law = "coulombe"', text), "utf-8")
    with pytest.raises(InputError, match="coulombe"):
        td.load_case(path)
    assert load_changed_case(path, {"friction.law": "xu-2007"}, "--set").friction.law == "xu-2007"
