"""A progress protocol, so that physics reports its advance and knows nothing of screens."""

from __future__ import annotations

from typing import Protocol

__all__ = ["SILENT", "Progress"]


class Progress(Protocol):
    """Anything that can be told how far a job has come."""

    def start(self, task: str, total: int | None = None) -> None:
        """Begin a task of ``total`` steps (``None`` when unknown)."""

    def advance(self, steps: int = 1) -> None:
        """Report ``steps`` more steps done."""

    def finish(self) -> None:
        """End the task."""


class _Silent:
    """Progress that says nothing: the default everywhere."""

    def start(self, task: str, total: int | None = None) -> None:
        """Begin a task silently."""

    def advance(self, steps: int = 1) -> None:
        """Ignore the advance."""

    def finish(self) -> None:
        """End silently."""


#: Progress that says nothing: the default everywhere.
SILENT: Progress = _Silent()
