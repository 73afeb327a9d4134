"""One tooth pair on its way along the path of contact, or a contact over time, animated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, Problem
from tribodyn.plot.contact_scales import contact_scales
from tribodyn.plot.film_animation import Track, animation
from tribodyn.plot.labels import displayed
from tribodyn.types import Array

#: Frames of an animation over time: more are not seen and make the file large.
_FRAMES = 60


def _checked(contacts: Any, path: ArrayLike) -> tuple[list[Any], Array]:
    """Solutions in order, and the position of each."""
    kept = getattr(contacts, "solutions", contacts)
    if kept is not contacts and np.size(kept) == 0:
        raise InputError(
            Problem(
                what="the batch holds no pressure and film",
                where="argument contacts",
                why="A batch keeps the solutions on request only",
                remedy="Call solve_line_contacts with keep_solutions=True",
            )
        )
    solutions = list(np.ravel(np.asarray(kept, dtype=object)))
    positions = np.ravel(np.asarray(path, dtype=float))
    if len(solutions) != len(positions) or len(solutions) < 2:
        raise InputError(
            Problem(
                what=f"{len(solutions)} contacts and {len(positions)} positions",
                where="argument path",
                why="Each contact has one position, and a way needs two of them at least",
                remedy="Give as many positions as contacts, from where the pair enters",
            )
        )
    return solutions, positions


def film_along_path(contacts: Any, path: ArrayLike, *, path_of_contact: Any = None) -> Any:
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
    )


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


def _snapshots(transient: Any) -> tuple[list[_Snapshot], Array]:
    """Kept instants, at most as many as there are frames, and their times [s]."""
    if len(transient.kept) < 2:
        raise InputError(
            Problem(
                what=f"{len(transient.kept)} instants have a pressure and a film",
                where="argument transient",
                why="An animation needs two of them at least",
                remedy="Solve with keep_every = 1, or with a larger number for long series",
            )
        )
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


def film_over_time(transient: Any) -> Any:
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
    )
