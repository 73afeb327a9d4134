"""Pressure and film of a contact that moves or changes: frames, a slider, a play button."""

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
from tribodyn.plot.look.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.look.panels import event_lines
from tribodyn.plot.look.style import INK, MUTED, PAIR_COLORS, TOTAL, Trace, figure, player
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.contact import PathOfContact
    from tribodyn.ehl import TransientLineContact

#: Points of a profile, and of the dry pressure: enough for a screen, small as a file.
_POINTS, _DRY = 200, 41
#: Upper ends and lower ends of the three rows of panels, from the top down, and the height [px].
_PRESSURE, _FILM, _TRACK = (0.71, 1.0), (0.36, 0.66), (0.0, 0.2)
#: Width of each of the lower panels.
_HALF = 0.44
_HEIGHT = 760
#: Time for which a place is shown [ms].
_FRAME = 160
_SLIDER = {"active": 0, "x": 0.0, "len": 1.0, "y": -0.12, "pad": {"t": 0}}
#: Frames of an animation over time: more are not seen and make the file large.
_FRAMES = 60


def _short(values: Any) -> NDArray[np.float32]:
    """Half the bytes; a screen shows four digits."""
    return np.asarray(values, dtype=np.float32)


@dataclass(frozen=True)
class Track:
    """What the contact moves along: the path of contact, or time."""

    quantity: str
    words: str
    values: Array  #: place of each contact, in SI
    letters: Mapping[str, float] = field(default_factory=dict)  #: places to be marked, in SI

    @property
    def places(self) -> Array:
        """Places in the display unit."""
        return displayed(self.quantity, self.values)

    def axis(self, share: tuple[float, float], anchor: str) -> dict[str, Any]:
        """Describe the axis under one of the lower panels, on which time runs to the right."""
        backwards = self.values[-1] < self.values[0]
        return {
            "domain": share,
            "anchor": anchor,
            "title": {"text": axis_label(self.quantity, self.words)},
            "autorange": "reversed" if backwards else True,
            "nticks": 6,
        }


def _moving(contact: Any, scales: Scales, place: float, dry: bool) -> list[Trace]:
    """Everything that changes from one place to the next, in the order of the frames."""
    kept = thinned(contact, _POINTS)
    position = _short(scales.position * contact.position[kept])
    pressure = _short(scales.pressure * contact.pressure[kept])
    film = _short(scales.film * contact.film[kept])
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


def _on(x: str, y: str) -> dict[str, Any]:
    return {"xaxis": x, "yaxis": y, "showlegend": False}


def _resting(places: Array, loads: Array, films: Array, unit: str) -> list[Trace]:
    """Load and minimum film over the whole track, in display units."""
    load = curve(places, loads, "load", INK, unit=display_unit("load_per_width"))
    film = curve(places, films, "minimum film", INK, unit=unit)
    return [{**load, **_on("x3", "y3")}, {**film, **_on("x4", "y4")}]


def _axes(contacts: Sequence[Any], scales: Scales, track: Track) -> dict[str, Any]:
    ends = scales.position * np.array([window(one) for one in contacts])
    # What is drawn suits most of the contacts: an unloaded one would make all others small.
    first = max(ends[:, 0].min(), 1.5 * float(np.median(ends[:, 0])))
    highest = scales.pressure * max(float(one.pressure.max()) for one in contacts)
    height = float(np.median([film_height([one], [scales]) for one in contacts]))
    height = min(film_height(contacts, [scales] * len(contacts)), 2.0 * height)
    low = {"domain": _TRACK, "rangemode": "tozero", "nticks": 6}
    labels = axis_label("load_per_width", "Load"), f"Thinnest [{scales.film_unit}]"
    return {
        "xaxis": {
            "anchor": "y2",
            "range": [first, ends[:, 1].max()],
            "title": {"text": scales.position_label},
        },
        "yaxis": {
            "domain": _PRESSURE,
            "range": [0.0, 1.05 * highest],
            "title": {"text": scales.pressure_label},
        },
        "yaxis2": {"domain": _FILM, "range": [0.0, height], "title": {"text": scales.film_label}},
        "xaxis3": track.axis((0.0, _HALF), "y3"),
        "yaxis3": {**low, "anchor": "x3", "title": {"text": labels[0]}},
        "xaxis4": track.axis((1.0 - _HALF, 1.0), "y4"),
        "yaxis4": {**low, "anchor": "x4", "title": {"text": labels[1]}},
    }


def _letters(track: Track) -> dict[str, Any]:
    """Lines at the marked places in both lower panels."""
    places = {name: float(displayed(track.quantity, at)) for name, at in track.letters.items()}
    marks = event_lines(places.items(), share=_HALF)
    shapes = [
        {**shape, "xref": axis, "y1": _TRACK[1]}
        for axis in ("x3", "x4")
        for shape in marks["shapes"]
    ]
    notes = [
        {**note, "xref": axis, "y": _TRACK[1]}
        for axis in ("x3", "x4")
        for note in marks["annotations"]
    ]
    return {"shapes": shapes, "annotations": notes}


def animation(
    title: str,
    contacts: Sequence[Any],
    scales: Scales,
    track: Track,
    *,
    dry: bool = True,
    whole: tuple[Array, Array, Array] | None = None,
) -> Any:
    """Draw contacts one after the other, with a slider and a play button."""
    places = track.places
    frames = [
        _moving(one, scales, float(place), dry) for one, place in zip(contacts, places, strict=True)
    ]
    if whole is None:
        loads = displayed("load_per_width", np.array([one.load_per_width for one in contacts]))
        whole = places, loads, scales.film * np.array([one.minimum_film for one in contacts])
    words = [
        f"{rounded(track.quantity, float(at))}: "
        f"{rounded('load_per_width', float(one.load_per_width))}, "
        f"film {scales.film_text(one.minimum_film)} at its thinnest"
        for one, at in zip(contacts, track.values, strict=True)
    ]
    resting = _resting(*whole, scales.film_unit)
    moving = list(range(len(resting), len(resting) + len(frames[0])))
    made = figure(
        title,
        [*resting, *frames[0]],
        {
            **_axes(contacts, scales, track),
            **_letters(track),
            **player(words, _FRAME, redraw=False, slider=_SLIDER, buttons=-0.3),
            "height": _HEIGHT,
            "hovermode": "closest",
            "margin": {"l": 70, "r": 24, "t": 74, "b": 200},
            "legend": {"x": 1.0, "xanchor": "right", "y": 1.0, "yanchor": "top"},
        },
    )
    made.frames = [
        {"name": str(number), "data": data, "traces": moving} for number, data in enumerate(frames)
    ]
    return made


def _checked(contacts: Any, path: ArrayLike) -> tuple[list[Any], Array]:
    """Solutions in order, and the position of each."""
    kept = getattr(contacts, "solutions", contacts)
    if kept is not contacts and np.size(kept) == 0:
        why = "A batch keeps the solutions on request only"
        remedy = "Call solve_line_contacts with keep_solutions=True"
        raise InputError("the batch holds no pressure and film", "argument contacts", why, remedy)
    solutions = list(np.ravel(np.asarray(kept, dtype=object)))
    positions = np.ravel(np.asarray(path, dtype=float))
    if len(solutions) != len(positions) or len(solutions) < 2:
        what = f"{len(solutions)} contacts and {len(positions)} positions"
        why = "Each contact has one position, and a way needs two of them at least"
        remedy = "Give as many positions as contacts, from where the pair enters"
        raise InputError(what, "argument path", why, remedy)
    return solutions, positions


def film_along_path(
    contacts: Any, path: ArrayLike, *, path_of_contact: PathOfContact | None = None
) -> Any:
    """Animate pressure and film of one tooth pair from where it enters to where it leaves.

    Parameters
    ----------
    contacts : LineContactBatch or sequence of LineContactSolution
        Contacts in the order in which the pair passes them, each with its own load, radius and
        speed; a batch that kept its solutions.
    path : (n,) array [m]
        Position of each on the line of action, from the pinion's base tangent point.
    path_of_contact : PathOfContact, optional
        Gives the positions A to E, which are marked then.

    Returns
    -------
    plotly.graph_objects.Figure
        Pressure and film at one position, with a slider and a play button for the others; below,
        the load and the minimum film over the path with a mark at the position. Profiles are
        thinned to 200 points, so that thirty of them are a small file.

    Raises
    ------
    InputError
        If the batch did not keep its solutions, the numbers of contacts and positions differ, or
        there is only one.
    """
    solutions, positions = _checked(contacts, path)
    scales = contact_scales(solutions, dimensionless=False)[0]
    letters = (
        {}
        if path_of_contact is None
        else {name: float(getattr(path_of_contact, name)) for name in "ABCDE"}
    )
    films = [one.minimum_film for one in solutions]
    return animation(
        f"Along the path the least film is {scales.film_text(min(films))} "
        f"to {scales.film_text(max(films))}",
        solutions,
        scales,
        Track("path", "Path of contact", positions, letters),
    ).figure()


@dataclass(frozen=True)
class _Snapshot:
    """One instant of a contact, with the names of a steady solution."""

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
    """Kept instants, at most as many as there are frames, and their times [s]."""
    if len(transient.kept) < 2:
        what = f"{len(transient.kept)} instants have a pressure and a film"
        why = "An animation needs two of them at least"
        remedy = "Solve with keep_every = 1, or with a larger number for long series"
        raise InputError(what, "argument transient", why, remedy)
    # Width and pressure of the dry contact follow the square root of load times radius.
    strength = transient.load_per_width * transient.equivalent_radius
    widths = transient.half_width * np.sqrt(strength / strength.max())
    chosen = np.unique(np.linspace(0, len(transient.kept) - 1, _FRAMES).round().astype(int))
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
        for row, at in ((row, int(transient.kept[row])) for row in chosen)
    ]
    return snapshots, transient.time[transient.kept[chosen]]


def film_over_time(transient: TransientLineContact) -> Any:
    """Animate pressure and film of a contact whose load, radius and speed change over time.

    Parameters
    ----------
    transient : TransientLineContact
        What :func:`tribodyn.ehl.solve_transient_line_contact` returns, with kept instants.

    Returns
    -------
    plotly.graph_objects.Figure
        Pressure and film at up to sixty of the kept instants; below, load and minimum film over
        the whole time. The dry pressure is drawn where the load was imposed.

    Raises
    ------
    InputError
        If fewer than two instants were kept.
    """
    snapshots, time = _snapshots(transient)
    scales = contact_scales(snapshots, dimensionless=False)[0]
    return animation(
        f"Over time the least film is {scales.film_text(float(transient.minimum_film.min()))} "
        f"to {scales.film_text(float(transient.minimum_film.max()))}",
        snapshots,
        scales,
        Track("time", "Time", time),
        dry=transient.impose == "load",
        whole=(
            displayed("time", transient.time),
            displayed("load_per_width", transient.load_per_width),
            scales.film * transient.minimum_film,
        ),
    ).figure()
