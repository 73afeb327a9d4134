"""The built-in cases by name, and those that other packages add.

Another package adds a case through the entry-point group ``tribodyn.cases``: the entry point's
name is the case's name, and it loads to the path of a case file.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from tribodyn.errors import InputError
from tribodyn.model import entry_points
from tribodyn.study.case.checks import DEFAULT_MARK
from tribodyn.study.case.provenance import changed_keys, reasons, same
from tribodyn.study.case.read import parse_toml, read_text
from tribodyn.study.case.values import Plain
from tribodyn.study.machine.read import kind_of_tables, read_case

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case


def case_files() -> dict[str, Path]:
    """Files of all named cases.

    Returns
    -------
    dict of str to Path
        Built-in cases first.

    Examples
    --------
    >>> case_files()["fzg-roughness"].name
    'fzg-roughness.toml'
    """
    folder = Path(str(files("tribodyn.cases")))
    paths = {path.stem: path for path in sorted(folder.glob("*.toml"), key=_name)}
    for entry in entry_points("tribodyn.cases"):
        if entry.name not in paths:
            paths[entry.name] = Path(str(entry.load()))
    return paths


def machine_files() -> dict[str, Path]:
    """Files of the built-in machines: gearboxes with shafts, bearings and several meshes."""
    folder = Path(str(files("tribodyn.cases"))) / "machines"
    return {path.stem: path for path in sorted(folder.glob("*.toml"), key=_name)}


def planetary_files() -> dict[str, Path]:
    """Files of the built-in planetary stages."""
    folder = Path(str(files("tribodyn.cases"))) / "planets"
    return {path.stem: path for path in sorted(folder.glob("*.toml"), key=_name)}


def all_files() -> dict[str, Path]:
    """Files of all named cases: gear pairs, machines and planetary stages."""
    return {**case_files(), **machine_files(), **planetary_files()}


def _name(path: Path) -> str:
    return path.stem


def cases(*, machines: bool = False) -> dict[str, str]:
    """Names and one-line descriptions of all named cases.

    Parameters
    ----------
    machines : bool
        Add the built-in machines and planetary stages to the gear pairs.

    Returns
    -------
    dict of str to str
        Name to the title of the case.

    Examples
    --------
    >>> "fzg-roughness" in cases()
    True
    """
    import tomllib

    return {
        name: tomllib.loads(path.read_text(encoding="utf-8")).get("title", "")
        for name, path in (all_files() if machines else case_files()).items()
    }


def with_known_reasons(case: Case) -> Case:
    """Drop reasons that a built-in case gives, word for word, for another value of the same key."""
    # A file with the origin of a built-in case began as its copy: compare it with that case.
    if not (case.assumed or case.origin) or "based_on" in (lines := case.source.lines):
        return case
    kind = type(case)
    plain = {
        key: why
        for key, why in case.assumed.items()
        if why != DEFAULT_MARK and f"assumed.{key}.value" not in lines
    }
    models = [model for path in all_files().values() if (model := _model_of(path, case, plain))]
    stale = {key for key in plain if _of_another_value(case, key, models)}
    tables = case.user_input.data
    data = {**tables, "assumed": _without(tables["assumed"], stale)}
    copied = [model for model in models if case.origin and model.origin == case.origin]
    if not (stale or copied):
        return case
    bases = [{key: Plain(v) for key, v in model.stated.base.items()} for model in copied]
    copies = [kind(case.source, **{**data, "based_on": base}) for base in bases]
    listed: list[Case] = copies or [kind(case.source, **data)]
    return min(listed, key=lambda copy: len(changed_keys(copy)))


def _model_of(path: Path, case: Case, plain: Mapping[str, str]) -> Case | None:
    """Named case of the kind of another, if it has its origin or one of its reasons."""
    kind, origin, why = _beginning(path)
    is_source = (case.origin and case.origin == origin) or plain.items() & why.items()
    return _model(path) if kind is type(case) and is_source else None


@lru_cache(maxsize=64)
def _beginning(path: Path) -> tuple[type[Case] | None, str | None, dict[str, str]]:
    """Kind, origin and reasons of a named case; no kind where another package brings a bad one."""
    try:
        data = parse_toml(read_text(path), path.name)
        return kind_of_tables(data), data.get("origin"), dict(reasons({"assumed": {}, **data}))
    except (InputError, ValueError, TypeError):
        return None, None, {}


@lru_cache(maxsize=64)
def _model(path: Path) -> Case | None:
    """A named case, or None where another package brings one that is faulty."""
    try:
        model: Case = read_case(read_text(path), path.name, path.parent)
        return model
    except InputError:
        return None


def _of_another_value(case: Case, key: str, models: list[Case]) -> bool:
    """Whether built-in cases have the reason of a key, and none of them its value."""
    sources = [model for model in models if model.assumed.get(key) == case.assumed[key]]
    value = case.stated.marks[key]
    return bool(sources) and not any(same(model.stated.marks[key], value) for model in sources)


def _without(marks: Mapping[str, object], keys: set[str]) -> dict[str, object]:
    return {key: mark for key, mark in marks.items() if key not in keys}
