"""``tribodyn new``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json, tell
from tribodyn.errors import InputError, OutputExistsError, Problem


def new(
    path: Path,
    /,
    *,
    from_: Annotated[str, Parameter(name="--from")],
    force: Annotated[bool, Parameter(negative="")] = False,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Write a commented case file to start from.

    Parameters
    ----------
    path : Path
        File to write.
    from_ : str
        Built-in case or case file to take the values from.
    force : bool
        Replace an existing file.
    json : bool
        Write one JSON object to stdout.
    """
    from tribodyn.cases.load import load_case
    from tribodyn.study.pipeline.save import write_file

    if path.exists() and (path.is_dir() or not force):
        remedy = "Choose another name" + ("" if path.is_dir() else ", or add --force to replace it")
        raise OutputExistsError(Problem("this exists already", str(path), "", remedy))
    if not path.parent.is_dir():
        raise InputError(Problem("there is no such directory", str(path.parent), "", "Create it"))
    write_file(path, load_case(from_).to_toml())
    if json:
        say_json({"path": str(path)})
    else:
        say(str(path))
        tell(f"Edit it, then: tribodyn check {path}")
