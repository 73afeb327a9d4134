"""Say where on the path of contact a film could not be solved."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

from tribodyn.errors import Problem, TribodynError

#: How the batch of contacts names the one that failed.
_CONTACT = re.compile(r"contact \[([\d, ]+)\]")


@contextmanager
def film_places(describe: Callable[..., str]) -> Iterator[None]:
    """Replace the index of a contact in an error by its place."""

    def named(problem: Problem) -> Problem:
        def place(found: re.Match[str]) -> str:
            return f"contact {describe(*(int(part) for part in found.group(1).split(',')))}"

        return replace(problem, what=_CONTACT.sub(place, problem.what))

    try:
        yield
    except TribodynError as error:
        raise type(error)([named(problem) for problem in error.problems]) from error
