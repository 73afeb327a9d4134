"""What IPython and notebooks show: progress as text, short tracebacks, warnings without source."""

from __future__ import annotations

import sys
import sysconfig
import warnings
from pathlib import Path
from traceback import walk_tb
from typing import Any

from tribodyn import progress
from tribodyn.errors import ModelWarning, TribodynError

#: Least time between two texts of progress [s].
_INTERVAL = 0.5
#: Folders of frames that are not of the user.
_PACKAGE = str(Path(__file__).parent)
_INSTALLED = (_PACKAGE, *map(sysconfig.get_path, ("stdlib", "purelib", "platlib")))


class CellProgress(progress.TextProgress):
    """Progress in one line below a cell, which is empty again at the end."""

    def __init__(self) -> None:
        self._width = 0
        super().__init__(self._replace, _INTERVAL)

    def _replace(self, text: str) -> None:
        """Write over the line."""
        sys.stdout.write(f"\r{text:<{self._width}}")
        sys.stdout.flush()
        self._width = len(text)

    def finish(self) -> None:
        """Clear the line."""
        super().finish()
        if self._width:
            self._replace("")
            sys.stdout.write("\r")


def users_traceback(traceback: Any) -> Any:
    """Cut a traceback after the last line of the user."""
    frame, last = traceback, None
    while frame is not None:
        if not frame.tb_frame.f_code.co_filename.startswith(_INSTALLED):
            last = frame
        frame = frame.tb_next
    if last is not None:
        last.tb_next = None
    return traceback


def _is_unknown_attribute(traceback: Any) -> bool:
    """Whether the package says of one of its objects that it has no such attribute."""
    *_, (frame, _) = walk_tb(traceback)
    return frame.f_code.co_name == "__getattr__" and frame.f_code.co_filename.startswith(_PACKAGE)


def _show_error(
    shell: Any,
    kind: type[BaseException],
    error: BaseException,
    traceback: object,
    tb_offset: Any = None,
) -> None:
    """Show an error of the package at the line of the user, without those that led to it."""
    if not isinstance(error, TribodynError) and not _is_unknown_attribute(traceback):
        shell.showtraceback((kind, error, traceback), tb_offset=tb_offset)
        return
    error.__cause__, error.__suppress_context__ = None, True
    short = users_traceback(traceback)
    shell.showtraceback((kind, error.with_traceback(short), short), tb_offset=tb_offset)


def _brief_format(usual: Any) -> Any:
    """Format of warnings that shows those of the package without a line of source."""

    def formatwarning(message: Any, category: type[Warning], *place: Any, **more: Any) -> str:
        if issubclass(category, ModelWarning):
            return f"{category.__name__}: {message}\n"
        return str(usual(message, category, *place, **more))

    return formatwarning


def prepare(shell: Any) -> None:
    """Set up an interactive shell of IPython; handlers that the user has set remain."""
    if shell is None or progress.automatic is CellProgress:
        return
    progress.automatic = CellProgress
    warnings.formatwarning = _brief_format(warnings.formatwarning)
    if not shell.custom_exceptions:
        shell.set_custom_exc((TribodynError, AttributeError), _show_error)
