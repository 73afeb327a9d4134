"""Progress protocol: computations report their progress, independent of its display."""

from __future__ import annotations

from typing import Protocol

__all__ = ["SILENT", "Progress"]


class Progress(Protocol):
    """Receiver of the progress of a computation."""

    def start(self, task: str, total: int | None = None) -> None:
        """Begin a task of ``total`` steps (``None`` when unknown)."""

    def advance(self, steps: int = 1) -> None:
        """Report ``steps`` more steps done."""

    def finish(self) -> None:
        """End the task."""


class _Silent:
    """Progress receiver that ignores everything: the default."""

    def start(self, task: str, total: int | None = None) -> None:
        """Begin a task silently."""

    def advance(self, steps: int = 1) -> None:
        """Ignore the advance."""

    def finish(self) -> None:
        """End silently."""


#: Progress receiver that ignores everything: the default.
SILENT: Progress = _Silent()
