"""The built-in cases by name, and those that other packages add.

Another package adds a case through the entry-point group ``tribodyn.cases``: the entry point's
name is the case's name, and it loads to the path of a case file.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from importlib.metadata import EntryPoints, entry_points
from importlib.resources import files
from pathlib import Path

from tribodyn.errors import InputError
from tribodyn.study.case.case import Case
from tribodyn.study.case.checks import DEFAULT_MARK
from tribodyn.study.case.provenance import changed_keys, same
from tribodyn.study.case.read import read_text
from tribodyn.study.case.values import Plain
from tribodyn.study.machine.read import read_case


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
    for entry in _external_cases():
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


@lru_cache(maxsize=1)
def _external_cases() -> EntryPoints:
    """Cases of other packages; cached, since searching the installed packages takes a while."""
    return entry_points(group="tribodyn.cases")


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
    lines = case.source.lines
    if "based_on" in lines:
        return case
    plain = {
        key: why
        for key, why in case.assumed.items()
        if why != DEFAULT_MARK and f"assumed.{key}.value" not in lines
    }
    models = _models(case.origin, plain)
    stale = {key for key in plain if _of_another_value(case, key, models)}
    data = {**case.user_input.data, "assumed": _without(case.user_input.data["assumed"], stale)}
    copied = [model for model in models if case.origin and model.origin == case.origin]
    if not (stale or copied):
        return case
    bases = [{key: Plain(v) for key, v in model.stated.base.items()} for model in copied]
    copies = [Case(case.source, **{**data, "based_on": base}) for base in bases]
    return min(copies or [Case(case.source, **data)], key=lambda copy: len(changed_keys(copy)))


def _models(origin: str | None, plain: Mapping[str, str]) -> list[Case]:
    """Built-in cases with the origin, or with one of the reasons, of a case."""
    if not (origin or plain):
        return []
    models = [_model(path) for path in case_files().values()]
    return [
        model
        for model in models
        if model is not None
        and ((origin and model.origin == origin) or plain.items() & model.assumed.items())
    ]


@lru_cache(maxsize=64)
def _model(path: Path) -> Case | None:
    """A named case, or None where another package brings one that is faulty."""
    try:
        model: Case = read_case(read_text(path), path.name)
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
