"""Pressure and film of several line contacts in one picture."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.plot.contact_scales import (
    Scales,
    contact_scales,
    dry_pressure,
    film_height,
    place_of_minimum,
    thinned,
    window,
)
from tribodyn.plot.line_contact import curve, point
from tribodyn.plot.style import INK, MUTED, PAIR_COLORS, Panel, stack

_POINTS = 1000
_COLORS = (*PAIR_COLORS, INK)
#: Short gaps, so that none swallows a spike [px].
_DASHES = ("solid", "9px,3px", "9px,3px,2px,3px", "16px,3px", "3px,2px", "16px,3px,3px,3px")


def _look(number: int) -> dict[str, Any]:
    """Colour and dash of a contact: thirty contacts differ in at least one of them."""
    return {"color": _COLORS[number % len(_COLORS)], "dash": _DASHES[number % len(_DASHES)]}


def _checked(solutions: Iterable[Any], labels: Iterable[str]) -> tuple[list[Any], list[str]]:
    contacts, names = list(solutions), [str(label) for label in labels]
    if len(contacts) != len(names):
        raise InputError(
            Problem(
                what=f"{len(contacts)} contacts and {len(names)} labels",
                where="argument labels",
                why="Each contact has one name in the legend",
                remedy="Give as many labels as solutions",
            )
        )
    return contacts, names


def _pressures(rows: Sequence[tuple[Any, Scales, str]]) -> list[dict[str, Any]]:
    traces = []
    for number, (solution, scales, name) in enumerate(rows):
        kept, look = thinned(solution, _POINTS), _look(number)
        x, y = dry_pressure(solution)
        dry = curve(scales.position * x, scales.pressure * y, "dry", MUTED, dash="dot", width=1.2)
        first = {"name": "dry (Hertz)", "legendgroup": "dry", "showlegend": number == 0}
        # Where all are drawn in their own half widths, the dry pressure is the same for all.
        if number == 0 or scales.pressure == rows[0][1].pressure:
            traces.append({**dry, **first, "hoverinfo": "skip", "hovertemplate": None})
        traces.append(
            curve(
                scales.position * solution.position[kept],
                scales.pressure * solution.pressure[kept],
                name,
                look["color"],
                dash=look["dash"],
                unit=scales.pressure_unit,
            )
        )
    return traces


def _films(rows: Sequence[tuple[Any, Scales, str]]) -> list[dict[str, Any]]:
    traces, marks = [], []
    for number, (solution, scales, name) in enumerate(rows):
        kept, look = thinned(solution, _POINTS), _look(number)
        least = f"{name}: at least {scales.film_text(solution.minimum_film)}"
        traces.append(
            curve(
                scales.position * solution.position[kept],
                scales.film * solution.film[kept],
                least,
                look["color"],
                dash=look["dash"],
                unit=scales.film_unit,
            )
        )
        mark = point(
            scales.position * place_of_minimum(solution),
            scales.film * solution.minimum_film,
            name,
            look["color"],
        )
        marks.append({**mark, "showlegend": False, "hoverinfo": "skip", "hovertemplate": None})
    return traces + marks


def compare_line_contacts(
    solutions: Iterable[Any], labels: Iterable[str], *, dimensionless: bool = False
) -> Any:
    """Draw pressure and film of several line contacts over each other.

    Parameters
    ----------
    solutions : iterable of LineContactSolution
        What :func:`tribodyn.ehl.solve_line_contact` returns, for example over the torque.
    labels : iterable of str
        Name of each contact in the legend.
    dimensionless : bool
        Whether every contact is drawn in its own half widths, Hertz pressures and ``b^2/R``: then
        shapes are compared, and the place of a spike relative to the contact.

    Returns
    -------
    plotly.graph_objects.Figure
        Dots mark the minimum films, thin dotted curves the dry pressures.

    Raises
    ------
    InputError
        If there is no contact, their number is not that of the labels, or some have units and
        others have not.
    """
    contacts, names = _checked(solutions, labels)
    scales = contact_scales(contacts, dimensionless)
    rows = list(zip(contacts, scales, names, strict=True))
    thinnest, units, name = min(rows, key=lambda row: row[1].film * row[0].minimum_film)
    ends = np.array([[used.position * end for end in window(one)] for one, used, _ in rows])
    height = {"range": [0.0, film_height(contacts, scales)]}
    return stack(
        f"The thinnest film, {units.film_text(thinnest.minimum_film)}, is that of {name}",
        scales[0].position_label,
        [
            Panel(scales[0].pressure_label, _pressures(rows), {"rangemode": "tozero"}),
            Panel(scales[0].film_label, _films(rows), height),
        ],
        {"xaxis": {"range": [ends[:, 0].min(), ends[:, 1].max()]}},
    )
