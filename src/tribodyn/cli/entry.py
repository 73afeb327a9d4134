"""Run a command of the command line and turn every failure into a message.

Nothing heavy is imported at the top, so that even an early interruption is caught.
"""

from __future__ import annotations

import _thread
import gc
import os
import re
import signal
import sys
import threading
import time
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from tribodyn.errors import Problem


#: Delay before an interruption that a callback dropped is repeated [s].
_RETRY_DELAY = 0.05
#: Signals within this time after an interruption count as the same one [s].
_REPEAT_INTERVAL = 0.5


class _InterruptHandler:
    """Handle Ctrl-C: a repeated one must not cut off the reaction to the first."""

    def __init__(self) -> None:
        self.last = -_REPEAT_INTERVAL

    def __call__(self, *_: object) -> None:
        """Interrupt, unless that was done a moment ago."""
        now = time.monotonic()
        if now - self.last >= _REPEAT_INTERVAL:
            self.last = now
            raise KeyboardInterrupt


_interrupt_handler = _InterruptHandler()


@contextmanager
def interruptible() -> Iterator[None]:
    """Repeat an interruption that was dropped inside the block."""
    previous = sys.unraisablehook
    timers: list[threading.Timer] = []

    def repeat_interruption(dropped: sys.UnraisableHookArgs) -> None:
        if issubclass(dropped.exc_type, KeyboardInterrupt):
            threads = sys.modules.get("tribodyn.interrupt")
            if threads is not None and threads.interruption_recorded():
                return  # The main thread raises it again when its wait ends.
            _interrupt_handler.last = -_REPEAT_INTERVAL
            timers.append(threading.Timer(_RETRY_DELAY, _interrupt))
            timers[-1].daemon = True
            timers[-1].start()
        else:
            previous(dropped)

    sys.unraisablehook = repeat_interruption
    try:
        yield
    finally:
        sys.unraisablehook = previous
        for timer in timers:
            timer.cancel()


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Ignore interruptions while the message of the first one is written."""
    in_main_thread = threading.current_thread() is threading.main_thread()
    previous_handler = signal.signal(signal.SIGINT, signal.SIG_IGN) if in_main_thread else None
    try:
        yield
    finally:
        if in_main_thread:
            signal.signal(signal.SIGINT, previous_handler)


def _interrupt() -> None:
    """Interrupt the main thread, also out of a system call."""
    if hasattr(signal, "pthread_kill"):
        main = threading.main_thread().ident
        if main is not None:
            signal.pthread_kill(main, signal.SIGINT)
    else:
        _thread.interrupt_main()


#: Exit code of a command that was stopped by Ctrl-C.
INTERRUPTED = 130

_TRACEBACK = "TRIBODYN_TRACEBACK"
#: New objects after which Python looks for unreachable ones: with its 700 a tenth of a short run.
_NEW_OBJECTS = 50_000
#: A negative quantity or range, such as "-5 N*m": no option begins with a digit.
_NEGATIVE = re.compile(r"-\s*\.?\d")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and leave with its exit code.

    Parameters
    ----------
    arguments : sequence of str, optional
        Arguments after the program's name; those of the process by default.
    """
    _open_streams()
    in_main_thread = threading.current_thread() is threading.main_thread()
    previous_handler = signal.getsignal(signal.SIGINT)
    handles_interrupts = in_main_thread and previous_handler is signal.default_int_handler
    if handles_interrupts:
        signal.signal(signal.SIGINT, _interrupt_handler)
    if arguments is None:
        gc.set_threshold(_NEW_OBJECTS, 20)
    code = call(sys.argv[1:] if arguments is None else arguments)
    if in_main_thread and arguments is None:
        # The output is complete: a repeated Ctrl-C must not disturb the end of Python.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    elif handles_interrupts:
        # Called by a program, which continues with its own handler of Ctrl-C.
        signal.signal(signal.SIGINT, previous_handler)
    sys.exit(code)


def _open_streams() -> None:
    """Replace closed streams, and letters that a stream cannot encode."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # Python began with it closed.
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115 -- for the whole process
        elif hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")


def call(arguments: Sequence[str]) -> int:
    """Run the command line and return its exit code.

    Parameters
    ----------
    arguments : sequence of str
        Words after the program's name.

    Returns
    -------
    int
        0 done, 1 computation failed, 2 bad input, 130 interrupted.
    """
    try:
        with interruptible(), _plain_warnings():
            code = _dispatch(list(arguments))
            sys.stdout.flush()
            return code
    except BrokenPipeError:
        _redirect_to_null(sys.stdout)
        return 0
    except (Exception, KeyboardInterrupt) as error:
        with _interrupts_ignored():
            return _failed(error, "--json" in arguments)


@contextmanager
def _plain_warnings() -> Iterator[None]:
    """Show model warnings without the source line that they come from."""
    show_default = warnings.showwarning

    def show(message: Warning | str, *place: Any, **more: Any) -> None:
        from tribodyn.cli.console import show_warnings
        from tribodyn.errors import ModelWarning

        if isinstance(message, ModelWarning):
            show_warnings([message])
        else:
            show_default(message, *place, **more)

    warnings.showwarning = show
    try:
        yield
    finally:
        warnings.showwarning = show_default


def _redirect_to_null(stream: TextIO) -> None:
    """Let Python flush the rest of a buffer at exit where nothing can fail."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _dispatch(arguments: list[str]) -> int:
    from cyclopts.exceptions import CycloptsError

    from tribodyn.cli.app import COMMANDS, make_app
    from tribodyn.cli.settings import reserved_outputs
    from tribodyn.errors import InputError

    names = [each.name for each in COMMANDS]
    if arguments and not arguments[0].startswith("-") and arguments[0] not in names:
        raise InputError(_no_command(arguments[0], names))
    # A leading space marks a negative value as an argument: the parser takes "-..." for an option.
    tokens = [f" {argument}" if _NEGATIVE.match(argument) else argument for argument in arguments]
    try:
        with reserved_outputs:
            result: Any = make_app()(tokens, exit_on_error=False, print_error=False)
    except CycloptsError as error:
        what = re.sub(r"^Unused Tokens: \[(.*)\]", r"too many arguments: \1", str(error).strip())
        why = "Commands take the arguments and options that their help lists"
        raise InputError(what, why=why, remedy=_remedy(arguments, what)) from None
    return result if isinstance(result, int) else 0


def _remedy(arguments: list[str], what: str) -> str:
    """Return what to write instead of an invalid command."""
    from tribodyn.cli.app import COMMANDS

    settings = [
        argument for argument in arguments if "=" in argument and not argument.startswith("-")
    ]
    if len(settings) > arguments.count("--set") and arguments[0] not in ("sweep", "bifurcation"):
        return "Repeat --set before every KEY=VALUE"
    command = next((each for each in COMMANDS if arguments[:1] == [each.name]), None)
    if command is not None and command.example and "requires an argument" in what:
        return f"Write for example: tribodyn {command.name} {command.example}"
    return f"See: tribodyn {command.name} --help" if command else "See: tribodyn --help"


def _no_command(name: str, names: list[str]) -> Problem:
    from tribodyn.errors import Problem, did_you_mean

    remedy = did_you_mean(name, names, "See: tribodyn --help")
    return Problem(f'there is no command "{name}"', "", f"Commands: {', '.join(names)}", remedy)


def _failed(error: BaseException, as_json: bool) -> int:
    """Report a failure on stderr and, with --json, as one JSON object on stdout."""
    from tribodyn.cli.console import say_json, show_problems
    from tribodyn.errors import Problem, TribodynError
    from tribodyn.files import LOCATION_ERRNOS, cannot_write

    if isinstance(error, TribodynError):
        code, problems = error.exit_code, list(error.problems)
    elif isinstance(error, KeyboardInterrupt):
        code = INTERRUPTED
        problems = [
            Problem(
                "interrupted",
                remedy="No unfinished file is left",
                why="The job was ended from outside",
            )
        ]
    elif isinstance(error, OSError) and error.errno in LOCATION_ERRNOS:
        code, problems = 1, [cannot_write(error.filename or "standard output", error)]
    else:
        code, problems = 1, [_unexpected(error)]
    with _unwritable_stream_closed(sys.stderr):
        show_problems(problems)
    with _unwritable_stream_closed(sys.stdout):
        sys.stdout.flush()  # data of the command that are still buffered
        if as_json:
            fields = [
                {"what": p.what, "where": str(p.where), "why": p.why, "remedy": p.remedy}
                for p in problems
            ]
            say_json({"error": {"exit_code": code, "problems": fields}})
    return code


@contextmanager
def _unwritable_stream_closed(stream: TextIO) -> Iterator[None]:
    """Drop what a stream cannot take (full disk, closed pipe); the exit code stays as it is."""
    try:
        yield
        stream.flush()
    except OSError:
        _redirect_to_null(stream)


def _unexpected(error: BaseException) -> Problem:
    import traceback

    from tribodyn.errors import Problem

    if os.environ.get(_TRACEBACK):
        traceback.print_exception(error)
    return Problem(
        f"unexpected {type(error).__name__}: {error}".rstrip(": "),
        why="This is a fault of tribodyn, not of the input",
        remedy=f"Set {_TRACEBACK}=1 to see where it happened, and report it",
    )
