"""The figures by name: how a figure is declared, looked up and refused when it makes no sense."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tribodyn.errors import InputError, Problem
from tribodyn.registry import Registry


def _always(result: Any) -> str:
    """Give no reason against a figure: it fits every result."""
    return ""


@dataclass(frozen=True)
class Drawing:
    """A figure function together with what a reader should know about it.

    Parameters
    ----------
    name : str
        Name in :data:`FIGURES`.
    draw : callable
        Takes a result, returns a plotly figure.
    heading : str
        Heading of the figure in a report.
    caption : str or callable
        What to look for, in plain language; a callable takes the result and says it.
    missing : callable
        Takes a result and says in one sentence why it has no such figure; empty if it has.
    """

    name: str
    draw: Callable[..., Any]
    heading: str
    caption: str | Callable[[Any], str]
    missing: Callable[[Any], str] = _always

    def caption_of(self, result: Any) -> str:
        """Tell what to look for in the figure of a result.

        Parameters
        ----------
        result : Result
            What :func:`tribodyn.run` returns.

        Returns
        -------
        str
        """
        return self.caption if isinstance(self.caption, str) else self.caption(result)

    def __call__(self, result: Any, **options: Any) -> Any:
        """Draw the figure.

        Parameters
        ----------
        result : Result
            What :func:`tribodyn.run` returns.
        **options
            Of the figure function, where it has any.

        Returns
        -------
        plotly.graph_objects.Figure

        Raises
        ------
        InputError
            If the result has nothing to draw.
        """
        reason = self.missing(result)
        if reason:
            raise InputError(Problem(what=reason))
        return self.draw(result, **options)


FIGURES: Registry[Callable[[Any], Any]] = Registry("figure", "tribodyn.plot")


def drawing(
    name: str,
    *,
    heading: str,
    caption: str | Callable[[Any], str],
    missing: Callable[[Any], str] = _always,
) -> Callable[[Callable[..., Any]], Drawing]:
    """Register a figure function under a name.

    Parameters
    ----------
    name : str
        Name in :data:`FIGURES`.
    heading : str
        Heading of the figure in a report.
    caption : str or callable
        What to look for, in plain language; a callable takes the result and says it.
    missing : callable
        Takes a result and says why it has no such figure; empty if it has.

    Returns
    -------
    callable
        Decorator that turns the function into a :class:`Drawing`.

    Examples
    --------
    >>> from tribodyn.plot import FIGURES
    >>> FIGURES["mesh_force"].heading
    'Mesh force'
    """

    def keep(draw: Callable[..., Any]) -> Drawing:
        made = Drawing(name, draw, heading, caption, missing)
        FIGURES.register(name)(made)
        return made

    return keep
