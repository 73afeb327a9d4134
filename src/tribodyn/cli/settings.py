"""Options that commands share, and their words: ``--set`` and the ranges of studies."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.console import show_warnings
from tribodyn.errors import InputError, OutputExistsError, Problem, collected
from tribodyn.study.studies.range_syntax import UnreadError, read_range, read_values, toml_value

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.user_tables import PartsCase


Output = Path | None
Flag = Annotated[bool, Parameter(negative="")]
Words = Annotated[list[str] | None, Parameter(name="--set", negative="")]
# These mean the same in every command, so their help texts are defined here once.
CaseName = Annotated[
    str, Parameter(help="Built-in case, or path of a case file or of a REXS model.")
]
PairName = Annotated[
    str, Parameter(help="Built-in gear pair, or path of the case file of one; no machine.")
]
Force = Annotated[bool, Parameter(negative="", help="Replace an earlier result in that directory.")]
Settings = Annotated[
    list[str] | None,
    Parameter(
        name="--set", negative="", help='Values to change, for example "operation.torque=120 N*m".'
    ),
]

#: Directories that the running command writes, released when it ends.
reserved_outputs = ExitStack()


def check_place(target: Path, force: bool) -> None:
    """Reserve the directory of a result until the command ends; refuse it before any work is done.

    Leftovers of killed runs next to it are removed.
    """
    from tribodyn.files import clear_leftovers, reserved
    from tribodyn.study.pipeline.save import check_parent, check_target

    check_parent(target)
    reserved_outputs.enter_context(reserved(target))
    with collected() as leftovers:
        clear_leftovers(target)
    show_warnings(leftovers)
    remedy = "Choose another directory with --out, or replace it with --force"
    check_target(target, force, remedy=remedy)


def check_file(path: Path, force: bool) -> None:
    """Refuse a file that exists and must not be replaced, or that has no directory."""
    if path.exists() and (path.is_dir() or not force):
        remedy = "Choose another name" + ("" if path.is_dir() else ", or add --force to replace it")
        raise OutputExistsError("this exists already", str(path), "", remedy)
    if not path.parent.is_dir():
        raise InputError("there is no such directory", str(path.parent), "", "Create it")


def read_changes(settings: Sequence[str]) -> dict[str, Any]:
    """Read ``KEY=VALUE`` words as in a case file, where quotes may be left out."""
    from tribodyn.study.case.values import written

    changes: dict[str, Any] = {}
    problems = []
    for setting in settings:
        key, equals, value = (part.strip() for part in setting.partition("="))
        if not (key and equals):
            remedy = 'Write --set "operation.torque=120 N*m"'
            problems.append(Problem(f'"{setting}" is not KEY=VALUE', "--set", "", remedy))
        elif key in changes:
            what = f"{key} is set to {written(changes[key])} and to {written(toml_value(value))}"
            problems.append(Problem(what, "--set", "", "Keep one of them"))
        else:
            changes[key] = toml_value(value) if value else None
    if problems:
        raise InputError(problems)
    return changes


def changed_case(name_or_path: str, settings: Sequence[str]) -> Case:
    """Load the case of a gear pair and change values."""
    from tribodyn.study.case.case import Case

    case = changed_any_case(name_or_path, settings)
    if isinstance(case, Case):
        return case
    from tribodyn.cli.app import ANY, names_of_commands

    kind = "machine" if hasattr(case, "machine") else "planetary stage"
    why = f"Commands for machines and planetary stages: {names_of_commands(ANY)}"
    remedy = "Name a case of one pair of gears (tribodyn cases), or use one of these commands"
    raise InputError(f"this is a {kind}, not a gear pair", name_or_path, why, remedy)


def changed_any_case(name_or_path: str, settings: Sequence[str]) -> Case | PartsCase:
    """Load the case of a gear pair, a machine or a planetary stage and change values."""
    from tribodyn.cases.load import load_changed_case

    case: Case | PartsCase = load_changed_case(name_or_path, read_changes(settings), by="--set")
    return case


RANGE = 'Write "operation.speed=400..3500 rpm:60"'
GRAMMAR = f'{RANGE} or "operation.torque=50,150,300 N*m"'


def read_ranges(texts: Sequence[str], *, lists: bool = True) -> dict[str, Any]:
    """Read what varies: a range with its number of points, or a list of values."""
    ranges: dict[str, Any] = {}
    problems = []
    grammar = GRAMMAR if lists else RANGE
    if not texts:
        problems.append(Problem("nothing varies", "", "", grammar))
    for item in texts:
        key, equals, text = (part.strip() for part in item.partition("="))
        try:
            if not (key and equals and text):
                raise UnreadError("It is not KEY=VALUES")
            if key in ranges:
                raise UnreadError(f"{key} varies twice: give all its values at once")
            if ".." not in text and not lists:
                raise UnreadError("A diagram goes over a range LOW..HIGH with a number of points")
            ranges[key] = read_values(text)
        except UnreadError as fault:
            problems.append(Problem(f'cannot read "{item}"', "", str(fault), grammar))
    if problems:
        raise InputError(problems)
    return ranges


def read_ends(text: str, example: str = "400..3500 rpm") -> tuple[Any, Any]:
    """Read the two ends of a range without points."""
    try:
        first, last, _ = read_range(f"{text}:2")
    except UnreadError as fault:
        what, remedy = f'cannot read "{text}"', f'Write "{example}"'
        raise InputError(what, "", str(fault), remedy) from None
    return first, last
