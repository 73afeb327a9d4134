"""``tribodyn warm-up``: kernels are compiled ahead of the first run."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json


def warm_up(
    case: str | None = None,
    /,
    *,
    jobs: int | None = None,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Compile what a case needs into the disk cache, by a run that nothing is kept of.

    Parameters
    ----------
    case : str
        Built-in case or path of a case file; all built-in cases by default.
    jobs : int
        Processes side by side; as many as there are processors by default, at most four.
    json : bool
        Write kernels and seconds as one JSON object to stdout.
    """
    from tribodyn.cases.compile_ahead import warm_up as compute
    from tribodyn.cli.bar import progress_bar

    with progress_bar() as progress:
        found = compute(case, jobs, progress)
    if json:
        say_json(found)
        return
    for name, seconds in found["compiled"].items():
        say(f"compiled in {seconds:.0f} s: {name}")
    for name in found["there_already"]:
        say(f"there already: {name}")
    what = "runs of the built-in cases compile" if case is None else "a run of this case compiles"
    say(f"Done in {found['seconds']:.0f} s; {what} nothing more")
