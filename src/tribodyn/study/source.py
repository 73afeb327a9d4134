"""Where the keys of a case came from: a file with lines, the command line, or Python."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from tribodyn.errors import Problem

__all__ = ["Source"]


@dataclass(frozen=True)
class Source:
    """Origin of the keys of a case.

    Parameters
    ----------
    name : str
        File name as the user gave it; empty for a case made in Python.
    lines : mapping of str to list of int
        Lines of each dotted key, from :func:`tribodyn.study.lines.key_lines`.
    replaced : mapping of str to str
        Keys that were replaced afterwards, and by what, for example ``"--set"``.
    """

    name: str = ""
    lines: Mapping[str, list[int]] = field(default_factory=dict)
    replaced: Mapping[str, str] = field(default_factory=dict)

    def line(self, key: str) -> int:
        """Line of a key or, where it is not written, of the nearest table around it; or zero."""
        while key and key not in self.lines:
            key = key.rpartition(".")[0]
        return self.lines[key][0] if key else 0

    def where(self, key: str) -> str:
        """Write ``file:line: key`` with as much of it as is known."""
        if key in self.replaced:
            return f"{self.replaced[key]} {key}"
        if not self.name:
            return key
        line = self.line(key)
        return f"{self.name}:{line}: {key}" if line else f"{self.name}: {key}"

    def place(self, found: Iterable[tuple[str, Problem]]) -> list[Problem]:
        """Set the place of each problem and order the problems as the file is read."""
        ordered = sorted(found, key=lambda pair: self.line(pair[0]))
        return [replace(problem, where=self.where(key)) for key, problem in ordered]

    def with_replaced(self, keys: Iterable[str], by: str) -> Source:
        """Return the same source with some keys replaced."""
        return replace(self, replaced={**self.replaced, **dict.fromkeys(keys, by)})
