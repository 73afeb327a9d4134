"""``tribodyn cases``."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json, table


def cases(*, json: Annotated[bool, Parameter(negative="")] = False) -> None:
    """List the built-in cases.

    Parameters
    ----------
    json : bool
        Write one JSON array to stdout.
    """
    from tribodyn.cases.catalogue import cases as all_cases

    found = all_cases()
    if json:
        say_json([{"name": name, "title": title} for name, title in found.items()])
    else:
        say(table([[name, title] for name, title in found.items()], indent=""))
