"""``tribodyn bifurcation``."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from tribodyn.cli.commands.study_commands import begun
from tribodyn.cli.commands.sweep_command import INTERRUPTED
from tribodyn.cli.screen import say, say_json, show_resumed, tell
from tribodyn.cli.settings import (
    RANGE,
    CaseName,
    Flag,
    Force,
    Settings,
    read_ranges,
)
from tribodyn.errors import InputError


def bifurcation(
    case: CaseName,
    /,
    *over: str,
    sweep: Literal["up", "down", "both", "independent"] = "up",
    cycles: int = 64,
    transient: int = 300,
    steps: int | None = None,
    out: Path | None = None,
    set_: Settings = None,
    force: Force = False,
    json: Flag = False,
) -> int:
    """Follow the motion of a case over one value; tell periods, jumps and step errors.

    Parameters
    ----------
    over : str
        What varies: "operation.speed=400..3500 rpm:300".
    sweep : str
        Each value from the end of the one before (up), the other way (down), both ways, or each
        by itself (independent).
    cycles : int
        Mesh cycles of the statistics at each value.
    transient : int
        Mesh cycles before, fewer where the motion repeats.
    steps : int
        Steps per mesh cycle.
    out : Path
        Directory to write; by default that of the case with "-bifurcation".
    json : bool
        Write what was found in SI as one JSON object to stdout.
    """
    from tribodyn.checkpoints import Members
    from tribodyn.cli.bar import progress_bar

    key, (first, last, points) = _one(over)
    _check_lengths(cycles, transient)
    ready, target = begun("bifurcation", case, out, set_, force)
    options: dict[str, Any] = {"cycles": cycles, "transient": transient, "keep": min(48, cycles)}
    with Members(target, force) as members:
        with progress_bar() as progress:
            from tribodyn.study.studies.axes import read_axes
            from tribodyn.study.studies.bifurcation import Findings
            from tribodyn.study.studies.bifurcation import bifurcation as compute

            read_axes(ready, {key: (first, last, points)}, by="bifurcation")
            found = compute(
                ready, key, (first, last), points, steps=steps, sweep=sweep, by="bifurcation",
                keep_partial=True, progress=progress, members=members, **options,
            )  # fmt: skip
        show_resumed(members)
        if not found.finished.any():
            raise KeyboardInterrupt
        judged = int((found.finished & (found.verdict != "")).sum())
        complete = judged == found.finished.size
        if not complete:
            tell(
                f"interrupted: {int(found.finished.sum())} of {found.finished.size} motions are "
                f"done, {judged} of them judged, and being written; the same command with --force "
                "goes on from there; Ctrl-C again stops at once"
            )
        findings = Findings(ready, found)
        with progress_bar() as progress:
            progress.start("Report")
            from tribodyn.report.answers import save_bifurcation

            save_bifurcation(found, ready, findings, target, force)
            progress.finish()
        members.close_after(complete)
    if json:
        say_json({**findings.figures(), "complete": complete})
    else:
        say("\n".join([ready.title, *(f"  {line}" for line in findings.sentences())]))
    tell(f"Diagram: {target / 'bifurcation.html'}")
    return 0 if complete else INTERRUPTED


def _one(over: tuple[str, ...]) -> tuple[str, tuple[Any, Any, int]]:
    """The one key that varies."""
    ranges = read_ranges(over, lists=False)
    if len(ranges) > 1:
        what = f"{len(ranges)} keys vary: {', '.join(ranges)}"
        raise InputError(what, "", "A diagram goes over one of them", RANGE)
    return next(iter(ranges.items()))


def _check_lengths(cycles: int, transient: int) -> None:
    """Refuse mesh cycles that make no diagram."""
    for name, value, least in (("cycles", cycles, 2), ("transient", transient, 0)):
        if value < least:
            why = f"At least {least} are needed" if least else "It is a count"
            raise InputError(f"{value} mesh cycles", f"--{name}", why, "Give more of them")
