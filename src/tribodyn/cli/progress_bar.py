"""Progress on stderr: a bar in a terminal, else lines of text."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any

from tribodyn.cli.console import tell
from tribodyn.compiled import announcing_to
from tribodyn.progress import Progress, TextProgress, counted, left


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


@contextmanager
def _lines() -> Iterator[Progress]:
    """Report in lines of text where stderr is not a terminal."""
    with announcing_to(tell):
        yield TextProgress(tell)


def progress_bar() -> AbstractContextManager[Progress]:
    """Return a progress bar if stderr is a terminal, else lines of text."""
    return Bar() if sys.stderr.isatty() else _lines()
