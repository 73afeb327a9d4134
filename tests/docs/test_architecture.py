"""The table of packages lists those of the import layers, in their order."""

import re
import tomllib

from pages import ROOT


def test_the_table_of_packages_follows_the_import_layers() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    layers = project["tool"]["importlinter"]["contracts"][0]["layers"]
    page = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    rows = re.findall(r"^\| \[(\w+)\]\(\.\./src/tribodyn/\1(?:\.py)?\) \|", page, re.MULTILINE)
    groups = [set(re.findall(r"\w+", layer)) for layer in layers if layer[0] != "("]
    groups = [group - {"members"} for group in groups if group != {"members"}]
    listed = iter(rows)
    assert [{next(listed) for _ in group} for group in groups] == groups
    assert not list(listed)
