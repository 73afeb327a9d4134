"""``tribodyn cite``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json
from tribodyn.errors import InputError, Problem


def cite(
    result: Path,
    /,
    *,
    bibtex: Annotated[bool, Parameter(negative="")] = False,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Print the papers behind a result.

    Parameters
    ----------
    result : Path
        Directory that "tribodyn run" wrote.
    bibtex : bool
        Write BibTeX entries.
    json : bool
        Write one JSON array to stdout.
    """
    from tribodyn.cases.load import load_case
    from tribodyn.study.pipeline.citations import cite as write_citations
    from tribodyn.study.pipeline.citations import papers

    file = result / "case.toml"
    if not file.is_file():
        why = "It holds no case.toml" if result.is_dir() else "There is no such directory"
        remedy = "Give the directory that tribodyn run wrote"
        raise InputError(Problem("this is no result", str(result), why, remedy))
    case = load_case(file)
    if json:
        say_json([{"key": key, **entry} for key, entry in papers(case).items()])
    else:
        say(write_citations(case, "bibtex" if bibtex else "text"))
