"""``--set KEY=VALUE``: values changed on the command line."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from tribodyn.errors import InputError, Problem

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case


def read_changes(settings: Sequence[str]) -> dict[str, Any]:
    """Read ``KEY=VALUE`` words as in a case file, where quotes may be left out.

    No value, as in ``friction.variant=``, goes back to the default.

    Parameters
    ----------
    settings : sequence of str
        For example ``"operation.torque=120 N*m"``.

    Returns
    -------
    dict of str to object

    Raises
    ------
    InputError
        If a word has no key, or a key is set twice.

    Examples
    --------
    >>> read_changes(["operation.torque=120 N*m", "gears.pinion.teeth=17"])
    {'operation.torque': '120 N*m', 'gears.pinion.teeth': 17}
    """
    from tribodyn.study.case.values import written

    changes: dict[str, Any] = {}
    problems = []
    for setting in settings:
        key, equals, value = (part.strip() for part in setting.partition("="))
        if not (key and equals):
            remedy = 'Write --set "operation.torque=120 N*m"'
            problems.append(Problem(f'"{setting}" is not KEY=VALUE', "--set", "", remedy))
        elif key in changes:
            what = f"{key} is set to {written(changes[key])} and to {written(read_value(value))}"
            problems.append(Problem(what, "--set", "", "Keep one of them"))
        else:
            changes[key] = read_value(value) if value else None
    if problems:
        raise InputError(problems)
    return changes


def read_value(text: str) -> Any:
    """Read a TOML value; what is none is text.

    Parameters
    ----------
    text : str
        As in a case file, where quotes may be left out.

    Returns
    -------
    object
    """
    try:
        value = tomllib.loads(f"value = {text}\n")
    except tomllib.TOMLDecodeError:
        return text
    return value["value"] if list(value) == ["value"] else text


def changed_case(name_or_path: str, settings: Sequence[str]) -> Case:
    """Load a case and change values.

    Parameters
    ----------
    name_or_path : str
        As for :func:`tribodyn.load_case`.
    settings : sequence of str
        As for :func:`read_changes`.

    Returns
    -------
    Case

    Raises
    ------
    InputError
        If the case or a change is faulty.
    """
    from tribodyn.cases.load import load_case

    case = load_case(name_or_path)
    changes = read_changes(settings)
    return case.replace(changes, by="--set") if changes else case
