"""Errors and warnings that a gear engineer can act on.

Every message answers four questions: what is wrong (value and unit), where (file, line and key,
or argument), why (the limit and its origin) and what to do next.
"""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from difflib import get_close_matches
from types import FrameType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.aliases import closest, with_old_names

__all__ = [
    "Argument",
    "ComputationError",
    "InputError",
    "ModelOption",
    "ModelWarning",
    "OutputExistsError",
    "Problem",
    "TribodynError",
    "collected",
    "quiet",
    "real_numbers",
    "require_between",
    "require_one_of",
    "require_positive",
    "shortened",
    "warn",
]

#: Handlers of the model warnings of this thread, the innermost last.
_listeners: ContextVar[tuple[Callable[[ModelWarning], bool], ...]] = ContextVar(
    "listeners", default=()
)

#: Most characters of a value that a message quotes, and of one part of a message.
_QUOTED, _PART = 200, 4000
#: Most problems that one error lists.
_MOST = 50
#: Control characters, characters that change the writing direction, and lone surrogates.
_CONTROL = re.compile(
    "[\x00-\x1f\x7f-\x9f\u2028\u2029\u200e\u200f\u202a-\u202e\u2066-\u2069\ud800-\udfff]"
)
#: A long value: from a quote that opens, and so follows no word, or without a blank.
_LONG_QUOTE = re.compile(f'(?<![^\\s(\\[=,:])"[^"]{{{_QUOTED + 1},}}"?|[^\\s"]{{{_QUOTED + 1},}}')


def shortened(text: str, most: int = _QUOTED) -> str:
    """Text for a message: shortened, and with control characters escaped."""
    text = _CONTROL.sub(lambda match: repr(match[0])[1:-1], text[: most + 1])
    return text if len(text) <= most else f"{text[: most - 3]}..."


def _message(part: str) -> str:
    """Part of a message, with long quoted values shortened."""
    if len(part) > _QUOTED:
        part = _LONG_QUOTE.sub(lambda match: shortened(match[0], _QUOTED), part)
    return shortened(part, _PART)


@dataclass(frozen=True)
class Argument:
    """The argument of a function, or the field of an object, that a problem is about.

    Parameters
    ----------
    name : str
        Its name; a field of an argument follows after a point.
    gear : str
        Name of the gear for what each of the two gears has; empty otherwise.

    Examples
    --------
    >>> str(Argument("modification.tip_relief", gear="z1"))
    'argument z1_modification.tip_relief'
    """

    name: str
    gear: str = ""

    def __str__(self) -> str:
        """Name the argument as the caller writes it."""
        return f"argument {self.gear}_{self.name}" if self.gear else f"argument {self.name}"


@dataclass(frozen=True)
class ModelOption:
    """The option of a model picked by name that a problem is about, or the model as a whole.

    Parameters
    ----------
    kind : str
        What the model is of: ``"stiffness"``.
    model : str
        Name of the model; empty where an option of all models is meant.
    name : str
        Name of the option; empty where the model as a whole is meant.

    Examples
    --------
    >>> str(ModelOption("stiffness", "table", "phase")), str(ModelOption("stiffness", "table"))
    ('table stiffness: phase', 'table stiffness')
    """

    kind: str
    model: str = ""
    name: str = ""

    def __str__(self) -> str:
        """Name the model and its option."""
        if not self.model:
            return f"{self.kind} option {self.name}"
        return f"{self.model} {self.kind}: {self.name}".removesuffix(": ")


@dataclass(frozen=True)
class Problem:
    """One problem: what is wrong, where, why, and how to fix it.

    Parameters
    ----------
    what : str
        The finding, with value and unit.
    where : Argument, ModelOption or str
        What it is about; a text such as ``file:line: key`` for anything else, or empty when the
        context is obvious.
    why : str
        The limit that is broken and where it comes from.
    remedy : str
        What to do next.
    """

    what: str
    where: Argument | ModelOption | str = ""
    why: str = ""
    remedy: str = ""

    def __post_init__(self) -> None:
        for name in ("what", "where", "why", "remedy"):
            part = getattr(self, name)
            if isinstance(part, str):
                object.__setattr__(self, name, _message(part))

    def __str__(self) -> str:
        """Join the parts into one readable paragraph."""
        head = f"{self.where}: {self.what}" if self.where else self.what
        parts = [part for part in (head, self.why, self.remedy) if part]
        return " ".join(p if p.endswith(("?", "...")) else f"{p.rstrip('.')}." for p in parts)


class TribodynError(Exception):
    """Base of every error raised on purpose; ``exit_code`` is what the command line returns.

    Parameters
    ----------
    problems : Problem, str or iterable of Problem
        What is wrong; all faults of one input come in one error.
    where, why, remedy : str
        The rest of a :class:`Problem` whose finding is given as a text.

    Examples
    --------
    >>> print(InputError("nodes = 3", where=Argument("nodes"), why="At least 4 are needed"))
    argument nodes: nodes = 3. At least 4 are needed.
    """

    exit_code = 1

    def __init__(
        self,
        problems: Problem | str | Iterable[Problem],
        where: Argument | ModelOption | str = "",
        why: str = "",
        remedy: str = "",
    ) -> None:
        if isinstance(problems, str):
            problems = Problem(problems, where, why, remedy)
        listed = (problems,) if isinstance(problems, Problem) else tuple(problems)
        if len(listed) > _MOST:
            more = f"{len(listed) - _MOST} more problems are not listed"
            listed = (*listed[:_MOST], Problem(more, remedy="Correct these first"))
        self.problems = listed
        super().__init__("\n".join(str(problem) for problem in self.problems))


class InputError(TribodynError, ValueError):
    """The input is wrong: a unit, a range, a name or a contradiction. Exit code 2."""

    exit_code = 2


class OutputExistsError(InputError):
    """The output directory exists already and was not to be replaced."""


class ComputationError(TribodynError, RuntimeError):
    """The input is valid but the computation failed. Exit code 1."""

    exit_code = 1


class ModelWarning(UserWarning):
    """A model is used outside its range, or a figure needs care.

    Parameters
    ----------
    code : str
        Stable identifier such as ``"friction-range"``.
    message : str
        Value, limit and remedy.
    affected : array of bool or float, optional
        Which of the evaluated points it concerns, or their part of the load; None if all.
    """

    def __init__(self, code: str, message: str, affected: Any = None) -> None:
        self.code = code
        self.message = message
        self.affected = affected
        super().__init__(f"[{code}] {message}")


def warn(code: str, message: str, *, stacklevel: int = 2, affected: object = None) -> None:
    """Issue a :class:`ModelWarning` with a stable code.

    Parameters
    ----------
    code : str
        Stable identifier.
    message : str
        Value, limit and remedy.
    stacklevel : int
        Frames to skip, as in :func:`warnings.warn`.
    affected : array of bool or float, optional
        As of :class:`ModelWarning`.
    """
    warning = ModelWarning(code, message, affected)
    if not any(takes(warning) for takes in reversed(_listeners.get())):
        warnings.warn(warning, stacklevel=frames(stacklevel + 1, sys._getframe()))


def frames(count: int, frame: FrameType) -> int:
    """Frames to skip from this one on, with those in between that only read arguments."""
    level = 1
    while frame.f_back is not None and count > 1:
        frame, level = frame.f_back, level + 1
        count -= frame.f_code.co_name != "reading_arguments"
    return level


@contextmanager
def _listening(takes: Callable[[ModelWarning], bool]) -> Iterator[None]:
    token = _listeners.set((*_listeners.get(), takes))
    try:
        yield
    finally:
        _listeners.reset(token)


@contextmanager
def collected() -> Iterator[list[ModelWarning]]:
    """Collect the model warnings of this thread inside the block, each once."""
    texts, issued = set[str](), list[ModelWarning]()

    def collect(warning: ModelWarning) -> bool:
        if str(warning) not in texts:
            texts.add(str(warning))
            issued.append(warning)
        return True

    with _listening(collect):
        yield issued


@contextmanager
def quiet(*codes: str) -> Iterator[None]:
    """Drop the model warnings of these codes, or all, that are issued inside the block."""
    with _listening(lambda warning: not codes or warning.code in codes):
        yield


def real_numbers(
    where: Argument | ModelOption | str, value: object, wanted: str = "real numbers"
) -> NDArray[np.float64]:
    """Read a number or an array of numbers as floats.

    Parameters
    ----------
    where : Argument, ModelOption or str
        What the value belongs to.
    value : float or array
        What was given.
    wanted : str
        What belongs there instead.

    Returns
    -------
    array
        Of the same shape.

    Raises
    ------
    InputError
        If it is a text, complex, nothing, of uneven rows or anything else but real numbers.

    Examples
    --------
    >>> float(real_numbers("nodes", 3))
    3.0
    """
    return floats(where, value, wanted).copy()


def floats(
    where: Argument | ModelOption | str, value: object, wanted: str = "real numbers"
) -> NDArray[np.float64]:
    """Read numbers as floats without a copy where that is possible."""
    try:
        array = np.asarray(value)
        if array.dtype.kind == "O" and all(isinstance(item, int) for item in array.flat):
            array = array.astype(float)
    except (TypeError, ValueError, OverflowError):
        array = np.asarray(None)
    if array.dtype.kind not in "fiub":
        remedy = "Give numbers in SI units, in rows of one length where there are several"
        raise InputError(f"{_brief(value)} is not real", where, f"Wanted: {wanted}", remedy)
    return array.astype(float, copy=False)


def _brief(value: object) -> str:
    text = f'"{value}"' if isinstance(value, str) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


#: Conversion hint for messages about numbers out of range, by SI unit.
_IN_SI = {
    "m": "1 mm is 1e-3 m, 1 um is 1e-6 m",
    "N/m": "1 N/mm is 1000 N/m",
    "Pa": "1 MPa is 1e6 Pa, 1 GPa is 1e9 Pa",
    "Pa*s": "30 mPa s is 0.03 Pa*s",
    "1/Pa": "20 1/GPa is 2e-8 1/Pa",
    "m^2/s": "60 cSt is 60e-6 m^2/s",
    "m/s": "Give the speed in m/s",
    "rad/s": "1400 rpm is 146.6 rad/s",
    "rad": "20 deg is 0.349 rad",
    "K": "70 degC is 343.15 K",
    "kg/m^3": "Steel has 7800 kg/m^3, oil about 870 kg/m^3",
    "N": "1 kN is 1000 N",
    "N*m": "Give the torque in N*m",
    "Hz": "Give the number in 1/s",
    "s": "1 ms is 1e-3 s",
}

#: Upper bound of any quantity in SI; its powers do not overflow.
ENDLESS = 1e60
#: Array size below which elements are checked one by one.
_FEW = 8


def _all_hold(value: object, holds: Callable[[Any], Any]) -> bool:
    """Whether floats satisfy a convex limit, checked at the extremes of an array."""
    if isinstance(value, float):
        return abs(value) < ENDLESS and bool(holds(value))
    if type(value) is not np.ndarray or value.dtype != float or not value.size:
        return False
    small = value.size < _FEW
    ends = value.ravel().tolist() if small else (float(value.min()), float(value.max()))
    return all(abs(end) < ENDLESS and holds(end) for end in ends)


def _check(
    name: str, value: object, unit: str, holds: Callable[[Any], Any], limit: str, remedy: str
) -> None:
    if _all_hold(value, holds):
        return
    array = floats(Argument(name), value)
    if not array.size:
        raise InputError(f"{name} is empty", Argument(name), "Wanted: numbers", "Give one at least")
    bad = ~((np.abs(array) < ENDLESS) & holds(array))
    if np.any(bad):
        worst = np.atleast_1d(array)[np.atleast_1d(bad)][0]
        remedy = remedy or _IN_SI.get(unit, f"Give a number {limit}")
        what, why = f"{name} = {worst:.6g} {unit}".rstrip(), f"{name} must be finite and {limit}"
        raise InputError(what, Argument(name), why, remedy)


def require_positive(name: str, value: object, unit: str = "", *, remedy: str = "") -> None:
    """Raise :class:`InputError` unless every element is finite and greater than zero.

    Parameters
    ----------
    name : str
        Argument name used in the message.
    value : float or array
        Value in ``unit``.
    unit : str
        Unit printed in the message.
    remedy : str
        What to do next.

    Raises
    ------
    InputError
        If any element is not finite or not positive.

    Examples
    --------
    >>> require_positive("load_per_width", 1.0, "N/m")
    """
    _check(name, value, unit, lambda a: a > 0.0, "greater than zero", remedy)


def require_between(
    name: str, value: object, low: float, high: float, unit: str = "", *, remedy: str = ""
) -> None:
    """Raise :class:`InputError` unless every element is finite and within [low, high].

    Parameters
    ----------
    name : str
        Argument name used in the message.
    value : float or array
        Value in ``unit``.
    low, high : float
        Inclusive limits in ``unit``.
    unit : str
        Unit printed in the message.
    remedy : str
        What to do next.

    Raises
    ------
    InputError
        If any element is not finite or outside the limits.

    Examples
    --------
    >>> require_between("poissons_ratio", 0.3, 0.0, 0.5)
    """
    limit = f"between {low:g} and {high:g} {unit}".rstrip()
    _check(name, value, unit, lambda a: (a >= low) & (a <= high), limit, remedy)


@with_old_names
def require_one_of(name: str, value: object, choices: Iterable[str]) -> str:
    """Return a value if it is one of the allowed names, or raise :class:`InputError`.

    Parameters
    ----------
    name : str
        Argument name used in the message.
    value : object
        What was given.
    choices : iterable of str
        Allowed names.

    Raises
    ------
    InputError
        If the value is none of them.

    Examples
    --------
    >>> require_one_of("inlet", "flooded", ("flooded", "zero"))
    'flooded'
    """
    allowed = list(choices)
    if not isinstance(value, str) or value not in allowed:
        what, why = f'{name} = "{value}"', f"Known: {', '.join(allowed)}"
        raise InputError(what, f"argument {name}", why, "Choose one of these")
    return value


def no_such(
    kind: str, name: str, names: Iterable[str], where: Argument | str = "", remedy: str = ""
) -> Problem:
    """Problem of an unknown name, with the closest one of the list."""
    listed = list(names)
    remedy = did_you_mean(name, listed, remedy or "Choose one of these")
    return Problem(f'there is no {kind} "{name}"', where, f"Known: {closest(name, listed)}", remedy)


def did_you_mean(name: object, names: Iterable[str], otherwise: str = "") -> str:
    """Remedy for an unknown name: the closest known name, or another text."""
    matches = get_close_matches(str(name), list(names), n=1)
    return f'Did you mean "{matches[0]}"?' if matches else otherwise
