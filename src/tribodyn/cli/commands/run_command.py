"""``tribodyn run``, ``app``, and ``warm-up``, which compiles kernels ahead of the first run."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from textwrap import shorten
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from tribodyn.cli.console import figures, say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import CaseName, Flag, Force, Settings, changed_any_case, check_place
from tribodyn.errors import InputError
from tribodyn.study.pipeline.summary_figures import by_topic, figure_of, is_chief, split_key

if TYPE_CHECKING:
    from tribodyn.study import MachineResult, Result


@Parameter(name="*")
@dataclass(frozen=True)
class Printed:
    """What a run writes to stdout.

    Parameters
    ----------
    quiet : bool
        Omit the tables; warnings and the location of the report are printed.
    all : bool
        Print every figure with its meaning, not the chief ones of each part.
    json : bool
        Write the summary as one flat JSON object in SI to stdout.
    """

    quiet: Flag = False
    all: Flag = False
    json: Flag = False


_CHIEF = Printed()


def run(
    case: CaseName,
    /,
    *,
    out: Path | None = None,
    set_: Settings = None,
    force: Force = False,
    printed: Printed = _CHIEF,
    open_: Annotated[bool, Parameter(name="--open", negative="")] = False,
    csv: Flag = False,
) -> None:
    """Compute a case; write its report and its data into a new directory.

    Parameters
    ----------
    out : Path
        Directory to write; by default it is called like the case.
    printed : Printed
        What is written to stdout.
    open_ : bool
        Show the report in the web browser.
    csv : bool
        Write the motion over the time as response.csv as well.
    """
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.errors import ModelWarning

    target = out if out is not None else Path(Path(case).stem)
    ready = changed_any_case(case, set_ or [])
    check_place(target, force)
    with progress_bar() as progress, warnings.catch_warnings():
        # They are shown below, from the result.
        warnings.simplefilter("ignore", ModelWarning)
        from tribodyn.cases.load import run as compute

        result: Result | MachineResult = compute(ready, progress)
        progress.start("Report")
        result.save(target, force=force, csv=csv)
        progress.finish()
    if printed.json:
        say_json(result.summary())
    elif not printed.quiet:
        text = figures(result.rows()) if printed.all else screen(result.summary())
        say(f"{result.case.title}\n{text}")
    show_warnings(result.warnings)
    report = target / "report.html"
    tell(f"Report: {report}")
    if open_:
        import webbrowser

        webbrowser.open(report.absolute().as_uri())


def warm_up(case: str | None = None, /, *, jobs: int | None = None, json: Flag = False) -> None:
    """Compile what a case needs into the disk cache, by a run whose result is discarded.

    Parameters
    ----------
    case : str
        Built-in case or path of a case file; all built-in cases by default.
    jobs : int
        Parallel processes; by default one per processor, at most four.
    json : bool
        Write kernels and seconds as one JSON object to stdout.
    """
    from tribodyn.cases.compile_ahead import warm_up as compute
    from tribodyn.cli.progress_bar import progress_bar

    with progress_bar() as progress:
        report = compute(case, jobs, progress)
    if json:
        say_json(report)
        return
    for name, seconds in report["compiled"].items():
        say(f"compiled in {seconds:.0f} s: {name}")
    for name in report["there_already"]:
        say(f"already cached: {name}")
    what = "runs of the built-in cases compile" if case is None else "a run of this case compiles"
    say(f"Done in {report['seconds']:.0f} s; {what} nothing more")


def app(
    case: str = "",
    /,
    *,
    folder: Path = Path(),
    host: str = "127.0.0.1",
    port: int = 8050,
    no_browser: Flag = False,
) -> None:
    """Serve a page for the whole job, on this machine alone, until Ctrl-C.

    Parameters
    ----------
    case : str
        Built-in case, or path of a case file in the folder; without it a short one to fill in.
    folder : Path
        Folder that the page reads and writes, and nothing beyond it; by default this one.
    host : str
        Address to serve at. Any but 127.0.0.1 lets other machines reach it, who need the token.
    port : int
        Port to serve at; 0 takes one that is free.
    no_browser : bool
        Write the address only, and open no browser.
    """
    import webbrowser
    from importlib.util import find_spec

    if find_spec("dash") is None:
        why, remedy = "The page is drawn by Dash", 'Install it with pip install "tribodyn[app]"'
        raise InputError("Dash is not installed", "tribodyn app", why, remedy)
    if not 0 <= port <= 65535:
        raise InputError(f"port = {port}", "--port", "Ports are 0 to 65535")
    from tribodyn.app.server import Page

    page = Page(folder, case, host, port)
    tell(f"The page is at {page.address}")
    tell("It belongs to whoever has this address. Ctrl-C ends it.")
    if not no_browser and not webbrowser.open(page.address):
        tell("No browser could be opened: open the address in one yourself.")
    with suppress(KeyboardInterrupt):
        page.serve()
    tell("The page has ended.")


_WIDTH = 100
#: Kinds with a figure in each row; of the others each part has a row.
_FIGURES_DOWN = ("meshes", "planets")
#: A value that is less than this part of the greatest of its table and unit is rounding.
_ROUNDING = 1e-9


def screen(values: Mapping[str, float]) -> str:
    """Tables of the chief figures, and how to see the others."""
    chief = [name for name in values if is_chief(name)]
    kinds: dict[str, list[str]] = {}
    for name in chief:
        load, kind, part, _ = split_key(name)
        title = "load cases" if load else kind if part else ""
        kinds.setdefault(title, []).append(name)
    lines: list[str] = []
    for title, names in kinds.items():
        if not title:
            lines += _listed(values, names)
        else:
            lines += _grid(values, names, title)
    left = len(values) - len(chief)
    return "\n".join([*lines, f"{left} more figures with --all; tribodyn explain NAME for one"])


def _listed(values: Mapping[str, float], names: list[str]) -> Iterator[str]:
    """Figures one below the other by topic, with as much of the meaning as fits."""
    rows = [(name, figure_of(name).show(values[name]), figure_of(name).meaning) for name in names]
    name_width, value_width = (max(len(row[i]) for row in rows) for i in (0, 1))
    space = _WIDTH - name_width - value_width - 6
    cells = {row[0]: (*row[:2], shorten(row[2], space, placeholder=" ...")) for row in rows}
    lines = dict(zip(cells, table(list(cells.values())).splitlines(), strict=True))
    for topic, listed in by_topic(names).items():
        yield topic
        yield from (lines[name] for name in listed)


def _grid(values: Mapping[str, float], names: list[str], title: str) -> Iterator[str]:
    """Figures over parts: columns that do not fit beside each other follow below."""
    cells: dict[tuple[str, str], tuple[str, str]] = {}
    numbers = _numbers(values, names)
    for name in names:
        load, kind, part, figure = split_key(name)
        column = f"{kind}.{part} {figure}" if part else figure
        place = (load, column) if load else (part, figure)
        cells[place[::-1] if title in _FIGURES_DOWN else place] = numbers[name]
    rows, columns = (list(dict.fromkeys(key[i] for key in cells)) for i in (0, 1))
    units = {key[title not in _FIGURES_DOWN]: unit for key, (_, unit) in cells.items()}
    heads = {
        label: [*label.split(" "), *([f"[{units[label]}]"] if units.get(label) else [])]
        for label in (*rows, *columns)
    }
    labels = [f"  {' '.join(heads[row])}" for row in rows]
    deepest = max(len(heads[column]) for column in columns)
    block: list[list[str]] = []
    for column in columns:
        head = [""] * (deepest - len(heads[column])) + heads[column]
        block.append([*head, *(cells.get((row, column), ("-", ""))[0] for row in rows)])
    first = [title[:1].upper() + title[1:], *[""] * (deepest - 1), *labels]
    yield from _side_by_side(first, block)


def _side_by_side(first: list[str], columns: list[list[str]]) -> Iterator[str]:
    """Right-aligned columns behind the first one, as many as fit in each block."""
    widths = [max(map(len, column)) + 2 for column in columns]
    label_width = max(map(len, first))
    start = 0
    while start < len(columns):
        end, width_used = start, label_width
        while end < len(columns) and (end == start or width_used + widths[end] <= _WIDTH):
            width_used += widths[end]
            end += 1
        for number, label in enumerate(first):
            fitting = zip(columns[start:end], widths[start:end], strict=True)
            cells = "".join(column[number].rjust(width) for column, width in fitting)
            yield label.ljust(label_width) + cells
        start = end


def _numbers(values: Mapping[str, float], names: list[str]) -> dict[str, tuple[str, str]]:
    """Five digits and the unit of each value, zero where it is rounding next to the others."""
    split = {name: figure_of(name).show(values[name]).partition(" ") for name in names}
    greatest: dict[str, float] = {}
    for number, _, unit in split.values():
        greatest[unit] = max(greatest.get(unit, 0.0), abs(float(number)))
    return {
        name: (_digits(float(number), _ROUNDING * greatest[unit]), unit)
        for name, (number, _, unit) in split.items()
    }


def _digits(value: float, rounding: float) -> str:
    """Five digits, of greater numbers all before the point."""
    return f"{float(f'{value:.5g}'):.9g}" if abs(value) > rounding else "0"
