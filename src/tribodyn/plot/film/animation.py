"""Animations of pressure and film along the path of contact or over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.errors import InputError
from tribodyn.plot.film.line_contact import (
    Scales,
    contact_scales,
    curve,
    dry_pressure,
    film_height,
    point,
    thinned,
    window,
)
from tribodyn.plot.theme.colors import INK, MUTED, PAIR_COLORS, TOTAL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.theme.panels import event_lines
from tribodyn.plot.theme.style import Trace, animated, axis, figure, player
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.contact import PathOfContact
    from tribodyn.ehl import TransientLineContact

#: Points of a profile, and of the dry pressure.
_POINTS, _DRY = 200, 41
#: Vertical domains of the three rows of panels, from the top down.
_PRESSURE, _FILM, _TRACK = (0.71, 1.0), (0.36, 0.66), (0.0, 0.2)
#: Width of each of the lower panels.
_HALF = 0.44
_HEIGHT = 760
#: Duration of a frame [ms].
_FRAME = 160
_SLIDER = {"active": 0, "x": 0.0, "len": 1.0, "y": -0.12, "pad": {"t": 0}}
#: Most frames of an animation over time, which limits the size of the file.
_FRAMES = 60


def _short(values: object) -> NDArray[np.float32]:
    """Convert to single precision, which halves the size of the figure."""
    return np.asarray(values, dtype=np.float32)


@dataclass(frozen=True)
class Track:
    """Horizontal axis of an animation: the path of contact or time."""

    quantity: str
    label: str
    values: Array  #: position or time of each contact, in SI
    letters: Mapping[str, float] = field(default_factory=dict)  #: marked positions, in SI

    @property
    def places(self) -> Array:
        """Positions in the display unit."""
        return displayed(self.quantity, self.values)

    def axis(self, share: tuple[float, float], anchor: str) -> Trace:
        """Describe the horizontal axis of a lower panel, on which time runs to the right."""
        backwards = self.values[-1] < self.values[0]
        label, turn = axis_label(self.quantity, self.label), "reversed" if backwards else True
        return axis(label, domain=share, anchor=anchor, autorange=turn, nticks=6)


def _moving(contact: Any, scales: Scales, place: float, dry: bool) -> list[Trace]:
    """Traces of one frame: everything that changes from frame to frame."""
    nodes = thinned(contact, _POINTS)
    position = _short(scales.position * contact.position[nodes])
    pressure = _short(scales.pressure * contact.pressure[nodes])
    film = _short(scales.film * contact.film[nodes])
    load = float(displayed("load_per_width", contact.load_per_width))
    newton, color = display_unit("load_per_width"), PAIR_COLORS[0]
    least = scales.film * contact.minimum_film
    first = {"xaxis": "x", "yaxis": "y", "showlegend": True}
    traces = [
        {**curve(position, pressure, "oil film", TOTAL, unit=scales.pressure_unit), **first},
        {**curve(position, film, "film", TOTAL, unit=scales.film_unit), **_on("x", "y2")},
        {**point(place, load, "load", color, unit=newton), **_on("x3", "y3")},
        {**point(place, least, "minimum film", color, unit=scales.film_unit), **_on("x4", "y4")},
    ]
    if dry:
        x, hertz = dry_pressure(contact, _DRY)
        around, above = _short(scales.position * x), _short(scales.pressure * hertz)
        dashed = curve(around, above, "dry (Hertz)", MUTED, unit=scales.pressure_unit, dash="dash")
        traces.append({**dashed, **first})
    return traces


def _on(x: str, y: str) -> Trace:
    return {"xaxis": x, "yaxis": y, "showlegend": False}


def _resting(places: Array, loads: Array, films: Array, unit: str) -> list[Trace]:
    """Load and minimum film over the entire track, in display units."""
    load = curve(places, loads, "load", INK, unit=display_unit("load_per_width"))
    film = curve(places, films, "minimum film", INK, unit=unit)
    return [{**load, **_on("x3", "y3")}, {**film, **_on("x4", "y4")}]


def _axes(contacts: Sequence[Any], scales: Scales, track: Track) -> Trace:
    ends = scales.position * np.array([window(contact) for contact in contacts])
    # The axes suit the typical contact: an unloaded contact would dwarf the others.
    first = max(ends[:, 0].min(), 1.5 * float(np.median(ends[:, 0])))
    highest = scales.pressure * max(float(contact.pressure.max()) for contact in contacts)
    height = float(np.median([film_height([contact], [scales]) for contact in contacts]))
    height = min(film_height(contacts, [scales] * len(contacts)), 2.0 * height)
    low = {"domain": _TRACK, "rangemode": "tozero", "nticks": 6}
    labels = axis_label("load_per_width", "Load"), f"Thinnest [{scales.film_unit}]"
    return {
        "xaxis": axis(scales.position_label, anchor="y2", range=[first, ends[:, 1].max()]),
        "yaxis": axis(scales.pressure_label, domain=_PRESSURE, range=[0.0, 1.05 * highest]),
        "yaxis2": axis(scales.film_label, domain=_FILM, range=[0.0, height]),
        "xaxis3": track.axis((0.0, _HALF), "y3"),
        "yaxis3": axis(labels[0], anchor="x3", **low),
        "xaxis4": track.axis((1.0 - _HALF, 1.0), "y4"),
        "yaxis4": axis(labels[1], anchor="x4", **low),
    }


def _letters(track: Track) -> Trace:
    """Lines at the marked positions in both lower panels."""
    places = {name: float(displayed(track.quantity, at)) for name, at in track.letters.items()}
    marks = event_lines(places.items(), share=_HALF)
    return {
        kind: [{**mark, "xref": x, end: _TRACK[1]} for x in ("x3", "x4") for mark in marks[kind]]
        for kind, end in (("shapes", "y1"), ("annotations", "y"))
    }


def animation(
    title: str,
    contacts: Sequence[Any],
    scales: Scales,
    track: Track,
    *,
    dry: bool = True,
    history: tuple[Array, Array, Array] | None = None,
) -> Any:
    """Animate a series of contacts, with a slider and a play button."""
    places = track.places
    frames = [
        _moving(contact, scales, float(place), dry)
        for contact, place in zip(contacts, places, strict=True)
    ]
    if history is None:
        loads, films = (
            np.array([getattr(contact, name) for contact in contacts])
            for name in ("load_per_width", "minimum_film")
        )
        history = (places, displayed("load_per_width", loads), scales.film * films)
    labels = [
        f"{rounded(track.quantity, at)}: "
        f"{rounded('load_per_width', contact.load_per_width)}, "
        f"film {scales.film_text(contact.minimum_film)} at its thinnest"
        for contact, at in zip(contacts, track.values, strict=True)
    ]
    resting = _resting(*history, scales.film_unit)
    moving = list(range(len(resting), len(resting) + len(frames[0])))
    sketch = figure(
        title,
        [*resting, *frames[0]],
        {
            **_axes(contacts, scales, track),
            **_letters(track),
            **player(labels, _FRAME, redraw=False, slider=_SLIDER, buttons=-0.3),
            "height": _HEIGHT,
            "hovermode": "closest",
            "margin": {"l": 70, "r": 24, "t": 74, "b": 200},
            "legend": {"x": 1.0, "xanchor": "right", "y": 1.0, "yanchor": "top"},
        },
    )
    return animated(sketch, frames, moving)


def _checked(contacts: Any, path: ArrayLike) -> tuple[list[Any], Array]:
    """Solutions in order, and the position of each."""
    batch = getattr(contacts, "solutions", contacts)
    if batch is not contacts and np.size(batch) == 0:
        why = "A batch stores the solutions on request only"
        remedy = "Call solve_line_contacts with keep_solutions=True"
        raise InputError("the batch holds no pressure and film", "argument contacts", why, remedy)
    solutions = list(np.ravel(np.asarray(batch, dtype=object)))
    positions = np.ravel(np.asarray(path, dtype=float))
    if len(solutions) != len(positions) or len(solutions) < 2:
        what = f"{len(solutions)} contacts and {len(positions)} positions"
        why = "Each contact has one position, and a path needs at least two"
        remedy = "Give as many positions as contacts, from where the pair enters"
        raise InputError(what, "argument path", why, remedy)
    return solutions, positions


def film_along_path(
    contacts: object, path: ArrayLike, *, path_of_contact: PathOfContact | None = None
) -> Any:
    """Animate pressure and film of a tooth pair from its entry to its exit.

    Parameters
    ----------
    contacts : LineContactBatch or sequence of LineContactSolution
        Contacts in the order in which the pair passes them, each with its own load, radius and
        speed; a batch solved with ``keep_solutions=True``.
    path : (n,) array [m]
        Position of each on the line of action, from the base tangent point of the smaller gear.
    path_of_contact : PathOfContact, optional
        Marks the positions A to E.

    Returns
    -------
    plotly.graph_objects.Figure
        Pressure and film at one position, with a slider and a play button for the others; below,
        the load and the minimum film over the path with a mark at the position. Profiles are
        thinned to 200 points.

    Raises
    ------
    InputError
        If the batch has no stored solutions, the numbers of contacts and positions differ, or
        there is only one.
    """
    solutions, positions = _checked(contacts, path)
    scales = contact_scales(solutions, dimensionless=False)[0]
    marked = "" if path_of_contact is None else "ABCDE"
    letters = {name: float(getattr(path_of_contact, name)) for name in marked}
    films = [solution.minimum_film for solution in solutions]
    return animation(
        f"Along the path the minimum film is {scales.film_text(min(films))} "
        f"to {scales.film_text(max(films))}",
        solutions,
        scales,
        Track("path", "Path of contact", positions, letters),
    ).figure()


@dataclass(frozen=True)
class _Snapshot:
    """State of a transient contact at an instant, with the attributes of a steady solution."""

    position: Array
    pressure: Array
    film: Array
    central_film: float
    minimum_film: float
    outlet: float
    load_per_width: float
    half_width: float
    hertz_pressure: float
    lubricant: str = "any"


def _snapshots(transient: TransientLineContact) -> tuple[list[_Snapshot], Array]:
    """Stored instants, at most one per frame, and their times [s]."""
    if len(transient.stored_instants) < 2:
        what = f"{len(transient.stored_instants)} stored instants have a pressure and a film"
        why = "An animation needs at least two"
        remedy = "Solve with keep_every = 1, or with a larger number for long series"
        raise InputError(what, "argument transient", why, remedy)
    # Width and pressure of the dry contact follow the square root of load times radius.
    strength = transient.load_per_width * transient.equivalent_radius
    widths = transient.half_width * np.sqrt(strength / strength.max())
    chosen = np.unique(
        np.linspace(0, len(transient.stored_instants) - 1, _FRAMES).round().astype(int)
    )
    snapshots = [
        _Snapshot(
            position=transient.position,
            pressure=transient.pressure[row],
            film=transient.film[row],
            central_film=float(transient.central_film[at]),
            minimum_film=float(transient.minimum_film[at]),
            outlet=float(transient.outlet[at]),
            load_per_width=float(transient.load_per_width[at]),
            half_width=float(widths[at]),
            hertz_pressure=float(2.0 * transient.load_per_width[at] / (np.pi * widths[at])),
        )
        for row, at in ((row, int(transient.stored_instants[row])) for row in chosen)
    ]
    return snapshots, transient.time[transient.stored_instants[chosen]]


def film_over_time(transient: TransientLineContact) -> Any:
    """Animate pressure and film of a contact whose load, radius and speed change over time.

    Parameters
    ----------
    transient : TransientLineContact
        What :func:`tribodyn.ehl.solve_transient_line_contact` returns, with stored instants.

    Returns
    -------
    plotly.graph_objects.Figure
        Pressure and film at up to sixty of the stored instants; below, load and minimum film over
        time. The dry pressure is drawn if the load was imposed.

    Raises
    ------
    InputError
        If fewer than two instants are stored.
    """
    snapshots, time = _snapshots(transient)
    scales = contact_scales(snapshots, dimensionless=False)[0]
    return animation(
        f"Over time the minimum film is {scales.film_text(float(transient.minimum_film.min()))} "
        f"to {scales.film_text(float(transient.minimum_film.max()))}",
        snapshots,
        scales,
        Track("time", "Time", time),
        dry=transient.impose == "load",
        history=(
            displayed("time", transient.time),
            displayed("load_per_width", transient.load_per_width),
            scales.film * transient.minimum_film,
        ),
    ).figure()
