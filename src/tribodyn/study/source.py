"""Where the keys of a case came from: a file with lines, the command line, or Python."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from tribodyn.errors import Problem


@dataclass(frozen=True)
class Source:
    """Origin of the keys of a case."""

    name: str = ""  #: file name as the user gave it
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
