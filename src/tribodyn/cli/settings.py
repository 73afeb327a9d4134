"""Options that commands share, and their words: ``--set`` and the ranges of studies."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.console import show_warnings
from tribodyn.errors import (
    Argument,
    InputError,
    OutputExistsError,
    Problem,
    TribodynError,
    collected,
)
from tribodyn.study.studies.study_axes import UnreadError, read_range, read_values, toml_value
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase


Output = Path | None
Flag = Annotated[bool, Parameter(negative="")]
Words = Annotated[list[str] | None, Parameter(name="--set", negative="")]
# These mean the same in every command, so their help texts are defined here once.
CaseName = Annotated[
    str, Parameter(help="Built-in case, or path of a case file or of a REXS model.")
]
Mesh = Annotated[
    str | None,
    Parameter(help="Mesh of a machine or a stage; torques and speeds are those of its pinion."),
]
Force = Annotated[bool, Parameter(negative="", help="Replace an earlier result in that directory.")]
Settings = Annotated[
    list[str] | None,
    Parameter(
        name="--set", negative="", help='Values to change, for example "operation.torque=120 N*m".'
    ),
]


@Parameter(name="*")
@dataclass(frozen=True)
class Place:
    """Where a study is written, and what its case has else.

    Parameters
    ----------
    out : Path
        Directory to write; by default that of the case with "-" and the name of the command.
    set_ : list of str
        Values of the case to change, for example "operation.torque=120 N*m".
    force : bool
        Replace an earlier result in that directory.
    json : bool
        Write the results in SI as one JSON object to stdout.
    """

    out: Output = None
    set_: Words = None
    force: Flag = False
    json: Flag = False

    def reserved(self, source: str, kind: str) -> Path:
        """Directory of a study of a case or a file, reserved until the command ends."""
        target = self.out if self.out is not None else Path(f"{Path(source).stem}-{kind}")
        check_place(target, self.force)
        return target

    def case(self, kind: str, case: str) -> tuple[Any, Path]:
        """The case of a study with its changes, and the directory to write."""
        ready = changed_case(case, self.set_ or [], kind)
        return ready, self.reserved(case, kind)


@Parameter(name="*")
@dataclass(frozen=True)
class Best(Place):
    """Where a study and the best case are written.

    Parameters
    ----------
    out : Path
        Directory to write; by default that of the case with "-" and the name of the command. It
        holds best.toml.
    """


@Parameter(name="*")
@dataclass(frozen=True)
class Spread(Place):
    """Where a study of tolerances is written, and what is spread.

    Parameters
    ----------
    set_ : list of str
        Tolerances and other changes of the case, such as "operation.torque=150 N*m +- 2 %".
    """


@Parameter(name="*")
@dataclass(frozen=True)
class Measured(Place):
    """Where the coefficients are written, and further data of the measurement.

    Parameters
    ----------
    set_ : list of str
        Further data: gear_loss_factor, gear_sets (2: equal slave gears), no_load_torque,
        other_loss, and the standard uncertainties torque_loss_uncertainty, torque_uncertainty,
        other_loss_uncertainty and gear_loss_factor_uncertainty, as in "no_load_torque=5 N*m".
    """


#: A directory called like the case and the command.
USUAL, BEST, SPREAD, MEASURED = Place(), Best(), Spread(), Measured()
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


def read_changes(settings: Sequence[str]) -> Tree:
    """Read ``KEY=VALUE`` words as in a case file, where quotes may be left out."""
    from tribodyn.study.case.values import written

    changes: Tree = {}
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


def changed_case(name_or_path: str, settings: Sequence[str], study: str) -> Any:
    """Load the case of a study, which has what the study needs, and change values."""
    from tribodyn.study.studies.needs import require

    case = changed_any_case(name_or_path, settings)
    require(study, case, name_or_path)
    return case


def changed_any_case(name_or_path: str, settings: Sequence[str]) -> AnyCase:
    """Load the case of a gear pair, a machine or a planetary stage and change values."""
    from tribodyn.cases.load import load_changed_case

    case: AnyCase = load_changed_case(name_or_path, read_changes(settings), by="--set")
    return case


RANGE = 'Write "operation.speed=400..3500 rpm:60"'
GRAMMAR = f'{RANGE} or "operation.torque=50,150,300 N*m"'


def read_ranges(texts: Sequence[str], *, lists: bool = True) -> Tree:
    """Read what varies: a range with its number of points, or a list of values."""
    ranges: Tree = {}
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


def in_si(option: str, text: str, unit: str, example: str) -> float:
    """A number with its unit, in SI."""
    from tribodyn.units import UnitProblemError, parse

    try:
        return parse(text, unit)
    except UnitProblemError as error:
        raise InputError(f'"{text}"', option, str(error), f'Write {option} "{example}"') from None


@contextmanager
def with_options(options: Mapping[str, str]) -> Iterator[None]:
    """Name the options of the command line where a function complains about its arguments."""
    try:
        yield
    except TribodynError as error:
        names = {str(Argument(name)): option for name, option in options.items()}
        named = [replace(p, where=names.get(str(p.where), p.where)) for p in error.problems]
        raise type(error)(named) from None
