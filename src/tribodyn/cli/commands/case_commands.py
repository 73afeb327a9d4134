"""``tribodyn cases``, ``tribodyn check`` and ``tribodyn new``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from tribodyn.cli.console import figures, say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import CaseName, Flag, Settings, changed_case, check_file


def cases(*, json: Flag = False) -> None:
    """List the built-in cases.

    Parameters
    ----------
    json : bool
        Write one JSON array to stdout.
    """
    from tribodyn.cases.catalogue import cases as all_cases

    titles = all_cases()
    if json:
        say_json([{"name": name, "title": title} for name, title in titles.items()])
    else:
        say(table([[name, title] for name, title in titles.items()], indent=""))


def check(case: CaseName, /, *, set_: Settings = None, json: Flag = False) -> None:
    """Check a case, rehearse its run and show the geometry that follows from it.

    Parameters
    ----------
    json : bool
        Write one flat JSON object in SI to stdout.
    """
    from tribodyn.study.case.provenance import assumptions
    from tribodyn.study.pipeline.assembly import geometry
    from tribodyn.study.pipeline.cautions import case_cautions
    from tribodyn.study.pipeline.preview import operating_figures
    from tribodyn.study.pipeline.run import rehearse

    ready = changed_case(case, set_ or [])
    warnings = rehearse(ready)
    values = {n: float(v) for n, v in (geometry(ready) | operating_figures(ready)).items()}
    if json:
        say_json(values)
    else:
        say(f"{ready.title}\n{figures(values)}")
    show_warnings([*case_cautions(ready), *warnings])
    kinds = [assumption.kind for assumption in assumptions(ready)]
    tell(
        f"The case is in order; {kinds.count('assumed')} values are assumed, "
        f"{kinds.count('default')} are defaults."
    )


def new(
    path: Path,
    /,
    *,
    from_: Annotated[str | None, Parameter(name="--from")] = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """Write a commented case file to start from.

    Parameters
    ----------
    path : Path
        File to write.
    from_ : str
        Built-in case or case file to take all values from; by default a short file of no
        particular gears is written, to be filled in.
    force : bool
        Replace an existing file.
    json : bool
        Write one JSON object to stdout.
    """
    from tribodyn.cases.load import load_case
    from tribodyn.study.case.reference import start_toml
    from tribodyn.study.pipeline.save import write_file

    check_file(path, force)
    write_file(path, load_case(from_).to_toml() if from_ else start_toml())
    if json:
        say_json({"path": str(path)})
    else:
        say(str(path))
        tell(f"Edit it, then: tribodyn check {path}")
