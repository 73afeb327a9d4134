"""Registry of figures by name and by the type of result that they draw.

A figure is a function that takes a result and returns a plotly figure. It registers itself with
:func:`drawing` and names the classes that it draws; a result calls :func:`draw` to plot itself.
This module knows neither figures nor results: those of the package come from the entry-point
group ``tribodyn.figures``, which names modules to import, those of others also from the group
``tribodyn.plot``, which names single figures.
"""

from __future__ import annotations

import json
import math
import re
import sys
from base64 import b64encode
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cache, partial
from importlib import import_module
from inspect import Parameter, Signature, cleandoc, signature
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from tribodyn.arguments.reading import checked
from tribodyn.errors import InputError, did_you_mean
from tribodyn.model import Registry, entry_points
from tribodyn.types import Tree

Writer = TypeVar("Writer", bound=Callable[..., Path])

#: Reason why a result cannot be drawn by a figure; empty if it can.
Lack = Callable[[Any], str]


@dataclass(frozen=True)
class Need:
    """Data that a result must have to be drawn by a figure."""

    attributes: str  #: attribute names separated by blanks, of which one must not be None
    reason: str  #: message and remedy for a result without any of them

    def __call__(self, subject: object) -> str:
        """Return the message if the data are missing."""
        values = (getattr(subject, name, None) for name in self.attributes.split())
        return "" if any(value is not None for value in values) else self.reason


@dataclass
class Sketch:
    """Figure as plain data; plotly is imported only if its figure object is requested."""

    data: list[Tree]
    layout: Tree
    frames: list[Tree] = field(default_factory=list)

    def figure(self) -> Any:
        """Figure object of plotly, which validates the data."""
        import plotly.graph_objects as go

        return go.Figure(vars(self))

    def to_json(self) -> str:
        """JSON as plotly writes it, without importing plotly."""
        parts = {name: part for name, part in vars(self).items() if part or name != "frames"}
        try:
            return json.dumps(parts, default=_packed, allow_nan=False, separators=(",", ":"))
        except ValueError:  # JSON has no NaN.
            return json.dumps(finite(parts), default=_packed, separators=(",", ":"))


def _packed(value: Any) -> Any:
    """Numbers in the base64 encoding of plotly, integers in as few bytes as possible."""
    if not isinstance(value, np.ndarray):
        return value.isoformat() if hasattr(value, "isoformat") else value.item()
    if value.dtype.kind in "iu" and value.size:
        kinds = (np.dtype(f"{value.dtype.kind}{size}") for size in (1, 2, 4))
        ends = value.min(), value.max()
        fitting = (k for k in kinds if np.iinfo(k).min <= ends[0] and ends[1] <= np.iinfo(k).max)
        value = value.astype(next(fitting, object)) if value.itemsize == 8 else value
    if value.dtype.kind not in "fiu" or value.itemsize > 8 or not value.size:
        return finite(value.tolist())
    packed = {"dtype": value.dtype.str[1:], "bdata": b64encode(value.tobytes()).decode("ascii")}
    return packed if value.ndim == 1 else {**packed, "shape": str(value.shape)[1:-1]}


def finite(part: object) -> Any:
    """The same data with None instead of NaN and infinity."""
    if isinstance(part, dict):
        return {name: finite(each) for name, each in part.items()}
    if isinstance(part, list | tuple):
        return [finite(each) for each in part]
    return None if isinstance(part, float) and not math.isfinite(part) else part


def _always(result: object) -> str:
    """Return no message: the figure needs no optional data."""
    return ""


@dataclass(frozen=True)
class Drawing:
    """Figure function with its caption and requirements.

    Parameters
    ----------
    name : str
        Name in :data:`FIGURES`.
    draw : callable
        Takes what it draws, returns a plotly figure.
    heading : str
        Heading of the figure in a report.
    caption : str or callable
        What to look for, in plain language; or a function of the result that returns it.
    missing : callable
        Function of the result that returns why it cannot be drawn; empty if it can.
    of : tuple of str
        Classes that it draws, by name: ``"Campbell"``, or ``"Result.mesh"`` for a part of one.
    made_by : str
        How to obtain such a result, for the message when another result is drawn.
    """

    name: str
    draw: Callable[..., Any]
    heading: str
    caption: str | Callable[[Any], str]
    missing: Lack = _always
    of: tuple[str, ...] = ()
    made_by: str = ""

    def __post_init__(self) -> None:
        """Extend ``missing`` to results of any class."""
        lack = self.missing

        def missing(result: object) -> str:
            """Sentence that says why a result cannot be drawn; empty if it can."""
            subject = self.subject(result)
            if subject is not None:
                return lack(subject)
            kinds = " or ".join(dict.fromkeys(place.partition(".")[0] for place in self.of))
            return f"This figure draws a {kinds}. {self.made_by}".strip()

        object.__setattr__(self, "missing", missing)

    def subject(self, result: object) -> Any:
        """Return the result, or the part of it, that the figure draws; None if it draws another.

        Parameters
        ----------
        result : object
            Any result.

        Returns
        -------
        object or None
        """
        kinds = {kind.__name__ for kind in type(result).__mro__}
        for place in self.of:
            name, _, path = place.partition(".")
            if name not in kinds:
                continue
            part = result
            for attribute in path.split(".") if path else ():
                part = getattr(part, attribute, None)
            if part is not None:
                return part
        return None if self.of else result

    def caption_of(self, result: object) -> str:
        """Caption: what to look for in the figure of a result.

        Parameters
        ----------
        result : object
            One of the classes in ``of``.
        """
        return self.caption if isinstance(self.caption, str) else self.caption(self.subject(result))

    def __call__(self, result: object, *arguments: object, **options: object) -> Any:
        """Draw the figure of a result.

        Parameters
        ----------
        result : object
            One of the classes in ``of``.
        *arguments, **options
            Of the figure function, where it has any.

        Returns
        -------
        plotly.graph_objects.Figure

        Raises
        ------
        InputError
            If the result has nothing to draw.
        """
        figure = self.sketch(result, *arguments, **options)
        return figure.figure() if isinstance(figure, Sketch) else figure

    def sketch(self, result: object, *arguments: object, **options: object) -> Any:
        """Draw the figure of a result without importing plotly, unless the figure function does.

        Parameters
        ----------
        result, *arguments, **options
            As for a call.

        Returns
        -------
        Sketch or plotly.graph_objects.Figure

        Raises
        ------
        InputError
            If the result has nothing to draw.
        """
        reason = self.missing(result)
        if reason:
            what = f'no figure "{self.name}" of this {type(result).__name__}'
            remedy = (
                self.made_by or "tribodyn.plot.FIGURES lists the figures, each with its caption"
            )
            raise InputError(what, "", reason.removesuffix(self.made_by).strip(), remedy)
        self._check_options(options)
        return self.draw(self.subject(result), *arguments, **options)

    def _check_options(self, options: Iterable[str]) -> None:
        """Refuse options that the figure does not have."""
        declared = _options(self.draw)
        if any(each.kind is each.VAR_KEYWORD for each in declared):
            return
        names = [each.name for each in declared]
        for name in options:
            if name not in names:
                why = f"It has {', '.join(names) or 'none'}"
                remedy = did_you_mean(name, names, "Leave it out")
                raise InputError(f'no option "{name}" of the figure "{self.name}"', "", why, remedy)


def _options(figure: Callable[..., object]) -> list[Parameter]:
    """Parameters of a figure function but what it draws."""
    return [*signature(figure).parameters.values()][1:]


def figure_text(text: str, argument: str, kinds: Iterable[str] = ()) -> str:
    """Docstring of a figure function, completed from its registration."""
    if "\nParameters\n" in text:
        return text
    what = " or ".join(kinds) or "object"
    returns = "Returns\n-------\nplotly.graph_objects.Figure"
    return f"{text}\n\nParameters\n----------\n{argument} : {what}\n\n{returns}\n"


def _second_paragraph(text: str) -> str:
    """Paragraph below the first line of a docstring, unless a section begins there."""
    paragraph = f"{text}\n\n\n\n".split("\n\n")[1]
    return "" if "\n---" in paragraph else " ".join(paragraph.split())


FIGURES: Registry[Callable[..., Any]] = Registry("figure", "tribodyn.plot")


def drawing(
    name: str = "",
    *,
    heading: str,
    caption: str | Callable[[Any], str] = "",
    missing: Lack = _always,
    of: str | Iterable[str] = (),
    made_by: str = "",
) -> Callable[[Callable[..., Any]], Drawing]:
    """Register a figure function under a name and for the classes that it draws.

    Parameters
    ----------
    name : str
        Name in :data:`FIGURES`; that of the function by default.
    heading : str
        Heading of the figure in a report.
    caption : str or callable
        What to look for, in plain language; or a function of the result that returns it. By default
        the paragraph below the first line of the docstring of the function.
    missing : callable
        Function of the result that returns why it cannot be drawn, see :class:`Need`.
    of : str or iterable of str
        Classes that it draws, by name, or parts of them: ``("MeshTable", "Result.mesh")``. The
        function is handed the part; a ``"Result"`` is that of a pair of gears. Empty: any result,
        which is handed over as it is.
    made_by : str
        How to obtain such a result, for the message when another result is drawn.

    Returns
    -------
    callable
        Decorator that turns the function into a :class:`Drawing`.

    Raises
    ------
    TypeError
        If the function has neither a caption nor such a paragraph.

    Examples
    --------
    >>> from tribodyn.plot import FIGURES
    >>> FIGURES["mesh_force"].heading
    'Mesh force'
    """
    kinds = (of,) if isinstance(of, str) else of
    # Results of every kind are a Result; a figure of that name is of the motion of a pair.
    more = (missing, tuple(re.sub(r"^Result\b", "PairResult", kind) for kind in kinds), made_by)

    def keep(draw: Callable[..., object]) -> Drawing:
        argument, description = next(iter(signature(draw).parameters)), cleandoc(draw.__doc__ or "")
        sentences = caption or _second_paragraph(description)
        if not sentences and sys.flags.optimize < 2:  # which drops docstrings
            raise TypeError(
                f"{draw.__name__} has no caption, nor a second paragraph in its docstring"
            )
        figure = Drawing(name or draw.__name__, checked(draw), heading, sentences, *more)
        text = figure_text(description, argument, figure.of)
        object.__setattr__(figure, "__doc__", text)
        FIGURES.register(figure.name)(figure)
        return figure

    return keep


@cache
def load_figures() -> None:
    """Import the modules of the entry-point group: their figures and reports register."""
    for entry in entry_points("tribodyn.figures"):
        import_module(entry.module)


def figures_of(result: object) -> list[str]:
    """Names of the figures that draw this type of result."""
    load_figures()
    return [name for name in FIGURES if draws(FIGURES[name], result)]


def draws(figure: Callable[..., object], result: object) -> bool:
    """Whether a figure draws this type of result."""
    try:
        return not isinstance(figure, Drawing) or figure.subject(result) is not None
    except InputError:  # The figure draws gears of another kind.
        return False


def bound_figure(result: object, name: str) -> Callable[..., Any]:
    """Figure as a method of a result, with the options and the help of the figure function."""
    figure = FIGURES[name]
    if not isinstance(figure, Drawing):
        return partial(figure, result)

    def plot(*arguments: object, **options: object) -> Any:
        return figure(result, *arguments, **options)

    first = next(iter(signature(figure.draw).parameters))
    subject = rf"(?m)^{first} : .*\n(?:[ \t]+.*\n|\n(?=[ \t]))*"
    text = re.sub(subject, "", figure.__doc__ or "")
    plot.__doc__ = text.replace("Parameters\n----------\n\n", "")
    plot.__name__ = plot.__qualname__ = f"plot_{name}"
    plot.__signature__ = Signature(_options(figure.draw))  # type: ignore[attr-defined]
    return plot


def draw(result: object, name: str = "", *arguments: object, **options: object) -> Any:
    """Draw a result: the figure of that name, or the first that draws its class itself."""
    load_figures()
    if name:
        return FIGURES[name](result, *arguments, **options)
    kinds = [kind.__name__ for kind in type(result).__mro__]
    for kind in kinds:
        for each in FIGURES:
            figure = FIGURES[each]
            if isinstance(figure, Drawing) and kind in figure.of:
                return figure(result, *arguments, **options)
    what, why = f"no figure draws a {kinds[0]}", "Figures are registered with what they draw"
    raise InputError(what, why=why, remedy=f'Register one with @drawing(..., of="{kinds[0]}")')


#: Takes a result and a path, writes the file and returns its path; by the name of the class.
REPORTS: Registry[Callable[..., Path]] = Registry("report")


def report_of(kind: str) -> Callable[[Writer], Writer]:
    """Register a function that writes the report of a class, given by its name."""

    def keep(writer: Writer) -> Writer:
        REPORTS.register(kind)(writer)
        return writer

    return keep


def write_report_of(result: object, path: Path) -> Path:
    """Write the report of a result to a file."""
    load_figures()
    kinds = [kind.__name__ for kind in type(result).__mro__]
    for kind in kinds:
        if kind in REPORTS:
            return REPORTS[kind](result, path)
    what = f"there is no report of a {kinds[0]}"
    why = "Reports are registered with their class"
    raise InputError(what, why=why, remedy=f'Register one with @report_of("{kinds[0]}")')
