"""Films of many loaded contacts, solved in one batch: what a film model hands over."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.errors import ModelWarning, warn
from tribodyn.lubricant import Lubricant
from tribodyn.progress import SILENT, Progress

__all__ = ["Films", "solved_films"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Films:
    """Oil films of loaded contacts: arrays of one shape, ``None`` where a model has none.

    Parameters
    ----------
    central_film, minimum_film : array [m], optional
        Film in the centre of the contact, and at its thinnest.
    film_pressure : array [Pa], optional
        Greatest pressure in the film.
    film_stiffness : array [N/m], optional
        Stiffness of the film over the length of the contact line; the tangent one is negative
        where the central film rises with the load.
    solutions : tuple of LineContactSolution
        Pressure and film of each contact in flat order; empty for formulas.
    """

    central_film: Array | None
    minimum_film: Array | None
    film_pressure: Array | None
    film_stiffness: Array | None
    solutions: tuple[Any, ...] = field(default=(), repr=False)


def solved_films(
    load_per_width: ArrayLike,
    equivalent_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    lubricant: Lubricant,
    effective_modulus: float,
    *,
    length: float,
    method: str,
    stiffness: str,
    nodes: int,
    inlet: str,
    domain: tuple[float, float] | None,
    progress: Progress = SILENT,
) -> Films:
    """Solve many contacts in threads.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Normal load per face width.
    equivalent_radius : float or array [m]
        Reduced radius of curvature.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds.
    lubricant : Lubricant
        Oil at working temperature.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    length : float [m]
        Length of the contact line.
    method : str
        ``"newton"`` or ``"multigrid"``.
    stiffness : str
        ``"tangent"``, ``"secant"`` or ``"seed"``; ``"none"`` gives the tangent stiffness too.
    nodes : int
        Nodes of the grid of each contact.
    inlet : str
        ``"flooded"`` or ``"zero"``.
    domain : (float, float), optional
        First and last position in half widths; as the film demands where absent.
    progress : Progress
        Told how many contacts are done.

    Returns
    -------
    Films
        Of the common shape of the arguments.

    Raises
    ------
    ComputationError
        If a contact cannot be solved.
    """
    from tribodyn.ehl.batch import solve_line_contacts

    tangent = stiffness in ("none", "tangent")
    with warnings.catch_warnings():
        # Whoever uses the stiffness says what a negative one means for it.
        warnings.filterwarnings("ignore", r"\[film-stiffness\]", ModelWarning)
        batch = solve_line_contacts(
            load_per_width,
            equivalent_radius,
            entrainment_speed,
            lubricant,
            effective_modulus,
            nodes=nodes,
            method=method,
            inlet=inlet,
            domain="auto" if domain is None else domain,
            stiffness=tangent,
            keep_solutions=True,
            progress=progress,
        )
    solutions = tuple(np.ravel(batch.solutions))
    pressures = np.array([solution.pressure.max() for solution in solutions])
    if tangent:
        film_stiffness = length * batch.film_stiffness
    else:
        film_stiffness = _sums(solutions, length, stiffness).reshape(batch.central_film.shape)
    if stiffness == "seed":
        warn(
            "seed-film-stiffness",
            "the film stiffness is the sum as one source prints it: a length, which doubles when "
            f"the {nodes} nodes are doubled. It is shown and not put in series with the teeth. "
            'Take film.stiffness = "tangent", or "secant" for a sum that is sound',
            stacklevel=4,
        )
    return Films(
        central_film=batch.central_film,
        minimum_film=batch.minimum_film,
        film_pressure=pressures.reshape(batch.central_film.shape),
        film_stiffness=film_stiffness,
        solutions=solutions,
    )


def _sums(solutions: tuple[Any, ...], length: float, kind: str) -> Array:
    """Secant or printed sum of every solution; what the latter has to say is said once."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", r"\[seed-film-stiffness\]", ModelWarning)
        each = [solution.film_stiffness(length, kind=kind) for solution in solutions]
    return np.array(each)
