"""Progress protocol: computations report their progress, independent of its display."""

from __future__ import annotations

from typing import Protocol

__all__ = ["SILENT", "Progress", "StageProgress"]


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


class StageProgress:
    """Progress of one step of a study, named where the display has a method ``describe``."""

    def __init__(self, study_progress: Progress) -> None:
        self._describe = getattr(study_progress, "describe", None)
        self._task, self._done = "", 0
        self._total: int | None = None

    def start(self, task: str, total: int | None = None) -> None:
        """Name the stage."""
        self._task, self._total, self._done = task, total, 0
        self.advance(0)

    def advance(self, steps: int = 1) -> None:
        """Name the stage with its count."""
        self._done += steps
        count = "" if self._total is None else f" {self._done} of {self._total}"
        if self._describe is not None:
            self._describe(self._task + count)

    def finish(self) -> None:
        """Do nothing: the next stage replaces the name."""
