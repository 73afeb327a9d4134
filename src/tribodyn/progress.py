"""Progress protocol: computations report their progress, independent of its display."""

from __future__ import annotations

import time
from collections.abc import Callable
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


def counted(done: float, total: float | None) -> str:
    """Return "12 of 40"; empty where the total is unknown."""
    return "" if total is None else f"{done:.0f} of {total:.0f}"


def left(seconds: float | None) -> str:
    """Return the remaining time; empty where it is unknown."""
    if not seconds:
        return ""
    minutes, remainder = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"about {hours} h {minutes} min left"
    return f"about {minutes} min {remainder:02d} s left" if minutes else f"about {remainder} s left"


class TextProgress:
    """Progress as text that ``write`` receives, at most once in an interval [s]."""

    def __init__(
        self,
        write: Callable[[str], object],
        interval: float = 20.0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._send, self._interval, self._clock = write, interval, clock
        self._last = clock()
        self.start("")

    def start(self, task: str, total: int | None = None) -> None:
        """Begin a task of ``total`` steps."""
        self._task, self._total, self._done = task, total, 0
        self._begin, self._first = self._last, -1
        self._write("")

    def advance(self, steps: int = 1) -> None:
        """Count ``steps`` more steps as done."""
        self._done += steps
        if self._first < 0:  # what was stored took no time
            self._first, self._begin = self._done, self._clock()
        self._write("")

    def describe(self, stage: str) -> None:
        """Report what the current step does."""
        self._write(f" ({stage})")

    def finish(self) -> None:
        """End the task."""
        self._task = ""

    def _write(self, stage: str) -> None:
        """Write a text unless the last is recent."""
        now = self._clock()
        if not self._task or now - self._last < self._interval:
            return
        self._last, remaining = now, ""
        if self._total is not None and self._done > self._first >= 0:
            each = (now - self._begin) / (self._done - self._first)
            remaining = left(each * (self._total - self._done))
        count = ": ".join(filter(None, (self._task, counted(self._done, self._total))))
        self._send(", ".join(filter(None, (count + stage, remaining))))


#: Makes the receiver of public functions that are called without one; notebooks set theirs.
automatic: Callable[[], Progress] = lambda: SILENT  # noqa: E731
