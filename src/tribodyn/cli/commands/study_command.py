"""``tribodyn study``: many runs of a case, in a store that can be continued."""

from __future__ import annotations

import logging
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from tribodyn.cli.commands.sweep_command import INTERRUPTED
from tribodyn.cli.console import say, say_json, tell
from tribodyn.cli.progress_bar import progress_bar
from tribodyn.cli.settings import Flag, Output
from tribodyn.errors import quiet
from tribodyn.progress import left

if TYPE_CHECKING:
    from tribodyn.variants import StudyState


def study(
    study: str,
    /,
    *,
    out: Output = None,
    scheduler: str = "",
    status: Flag = False,
    force: Flag = False,
    json: Flag = False,
) -> int:
    """Compute the members of a study file into a store; the same command continues it.

    Parameters
    ----------
    study : str
        Path of a study file; with --status that of a store will do.
    out : Path
        Store to write; by default that of the file with "-study".
    scheduler : str
        Address of a Dask scheduler whose workers compute, such as "tcp://127.0.0.1:8786"; by
        default this machine does.
    status : bool
        Report the progress of the study, which may run elsewhere, and compute nothing.
    force : bool
        Replace another study in that place.
    json : bool
        Write the progress as one JSON object to stdout.
    """
    from tribodyn.variants import run_study, study_state

    place = out if out is not None else Path(f"{Path(study).stem}-study")
    if status:
        state = study_state(study if out is None and Path(study).is_dir() else place)
        _show(state, json)
        return 0
    if scheduler:
        _silence_dask()
    try:
        with quiet("leftover"), progress_bar() as progress:
            state = run_study(study, place, scheduler=scheduler, force=force, progress=progress)
    except KeyboardInterrupt:
        tell("interrupted: finished chunks are stored; the same command continues from there")
        _show(study_state(place), json)
        return INTERRUPTED
    _show(state, json)
    for name in state.damaged:
        tell(f"Chunk {name} was damaged or missing and was computed again.")
    for name, why in state.missing.items():
        tell(f"Chunk {name} could not be computed; the same command tries again. {why}")
    tell(f"Store: {place}")
    return 1 if state.missing or state.failed == state.members else 0


def _silence_dask() -> None:
    """Keep the log of Dask off the screen; our own messages report what matters."""
    with suppress(ImportError):
        import distributed  # noqa: F401  # which sets levels of its own when it is imported
    for name in list(logging.root.manager.loggerDict):
        if name.startswith("distributed"):
            logging.getLogger(name).setLevel(logging.CRITICAL)


def _show(state: StudyState, as_json: bool) -> None:
    if as_json:
        say_json({**asdict(state), "complete": state.complete})
        return
    share = 100.0 * state.done / max(state.members, 1)
    say(f"{state.title}\n  {state.done} of {state.members} members are done ({share:.3g} %)")
    if state.failed:
        say(f"  {state.failed} of them failed:")
        for reason, count in state.reasons.items():
            say(f"  {count:>8}  {reason}")
    if not state.complete:
        running = ["It is being computed", *filter(None, [left(state.seconds_left)])]
        say(
            f"  {', '.join(running) if state.running else 'No process of this machine computes it'}"
        )
