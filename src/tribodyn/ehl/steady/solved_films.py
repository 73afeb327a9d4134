"""Films of many loaded contacts, solved in one batch: what a film model hands over."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.steady.batch import solve_line_contacts
from tribodyn.errors import quiet, warn
from tribodyn.lubricant import Lubricant
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array


@dataclass(frozen=True, eq=False)
class Films:
    """Oil films of loaded contacts: arrays of one shape, ``None`` where a model has none."""

    central_film: Array | None  #: [m]
    minimum_film: Array | None  #: [m]
    film_pressure: Array | None  #: greatest pressure in the film [Pa]
    film_stiffness: Array | None  #: stiffness of the film over the length of the contact line [N/m]
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
    """Solve many contacts in threads."""
    tangent = stiffness in ("none", "tangent")
    with quiet("film-stiffness"):
        # Whoever uses the stiffness says what a negative one means for it.
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
    with quiet("seed-film-stiffness"):
        each = [solution.film_stiffness(length, kind=kind) for solution in solutions]
    return np.array(each)
