"""Progress on stderr: a bar in a terminal, else lines of text."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any

from tribodyn.cli.console import tell
from tribodyn.compiled import announcing_to
from tribodyn.progress import Progress


def _columns() -> list[Any]:
    """Spinner, task, count, bar, elapsed time and remaining time."""
    from rich.progress import (
        BarColumn,
        ProgressColumn,
        SpinnerColumn,
        TextColumn,
        TimeElapsedColumn,
    )
    from rich.text import Text

    class Count(ProgressColumn):
        def render(self, task: Any) -> Text:
            return Text(counted(task.completed, task.total))

    class Left(ProgressColumn):
        max_refresh = 0.5

        def render(self, task: Any) -> Text:
            return Text(left(task.time_remaining))

    text = TextColumn("{task.description}")
    return [SpinnerColumn(), text, Count(), BarColumn(), TimeElapsedColumn(), Left()]


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


class Bar:
    """Progress bar drawn by rich while the block runs and erased after it."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.progress import Progress as Rich

        self._screen = Rich(*_columns(), console=Console(stderr=True), transient=True)
        self._task: Any = None
        self._name = ""
        self._announcing = announcing_to(lambda text: self._screen.console.print(f"{text} ..."))

    def __enter__(self) -> Progress:
        """Start drawing."""
        self._announcing.__enter__()
        self._screen.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the bar."""
        self._screen.stop()
        self._announcing.__exit__(None, None, None)

    def start(self, task: str, total: int | None = None) -> None:
        """Begin a task of ``total`` steps."""
        self.finish()
        self._name = task
        self._task = self._screen.add_task(task, total=total)

    def advance(self, steps: int = 1) -> None:
        """Draw ``steps`` more steps as done."""
        if self._task is not None:
            self._screen.advance(self._task, steps)

    def describe(self, stage: str) -> None:
        """Draw what the current step does."""
        if self._task is not None:
            self._screen.update(self._task, description=f"{self._name} ({stage})")

    def finish(self) -> None:
        """End the task."""
        if self._task is not None:
            self._screen.remove_task(self._task)
            self._task = None


#: Least time between two lines of progress [s].
_INTERVAL = 20.0


class Lines:
    """Progress in lines of text, of computations that take longer than a few seconds."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
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
        """Write a line unless the last is recent."""
        now = self._clock()
        if not self._task or now - self._last < _INTERVAL:
            return
        self._last, remaining = now, ""
        if self._total is not None and self._done > self._first >= 0:
            each = (now - self._begin) / (self._done - self._first)
            remaining = left(each * (self._total - self._done))
        count = ": ".join(filter(None, (self._task, counted(self._done, self._total))))
        tell(", ".join(filter(None, (count + stage, remaining))))


@contextmanager
def _lines() -> Iterator[Progress]:
    """Report in lines of text where stderr is not a terminal."""
    with announcing_to(tell):
        yield Lines()


def progress_bar() -> AbstractContextManager[Progress]:
    """Return a progress bar if stderr is a terminal, else lines of text."""
    return Bar() if sys.stderr.isatty() else _lines()
