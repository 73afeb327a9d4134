"""A progress bar on stderr, drawn only in a terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any

from tribodyn.cli.console import tell
from tribodyn.compiled import announcing_to
from tribodyn.progress import SILENT, Progress


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
        self._task = self._screen.add_task(task, total=total)

    def advance(self, steps: int = 1) -> None:
        """Draw ``steps`` more steps as done."""
        if self._task is not None:
            self._screen.advance(self._task, steps)

    def finish(self) -> None:
        """End the task."""
        if self._task is not None:
            self._screen.remove_task(self._task)
            self._task = None


@contextmanager
def _no_bar() -> Iterator[Progress]:
    """Report only compilations, which take minutes, where stderr is not a terminal."""
    with announcing_to(tell):
        yield SILENT


def progress_bar() -> AbstractContextManager[Progress]:
    """Return a progress bar if stderr is a terminal, else a silent one."""
    return Bar() if sys.stderr.isatty() else _no_bar()
