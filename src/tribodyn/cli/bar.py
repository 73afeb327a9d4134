"""A progress bar on stderr, drawn only in a terminal."""

from __future__ import annotations

import sys
from typing import Any

from tribodyn.progress import SILENT, Progress


class Bar:
    """Progress drawn by rich while the block runs; nothing of it stays on the screen."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, SpinnerColumn, TextColumn, TimeElapsedColumn
        from rich.progress import Progress as Rich

        self._screen = Rich(
            SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(),
            console=Console(stderr=True), transient=True,
        )  # fmt: skip
        self._task: Any = None

    def __enter__(self) -> Progress:
        """Start drawing."""
        self._screen.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the bar."""
        self._screen.stop()

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


class _NoBar:
    """Where stderr is no terminal."""

    def __enter__(self) -> Progress:
        """Stay silent."""
        return SILENT

    def __exit__(self, *_: object) -> None:
        """Stay silent."""


def progress_bar() -> Bar | _NoBar:
    """Return a bar if stderr is a terminal, else something that draws nothing.

    Returns
    -------
    context manager
        Yields a :class:`tribodyn.progress.Progress`.
    """
    return Bar() if sys.stderr.isatty() else _NoBar()
