"""Quasi-static loads of the tooth pairs, with or without their oil film in series."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.contact import Kinematics, hertz_line
from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import ComputationError, Problem, warn
from tribodyn.friction import TribologicalContact
from tribodyn.mesh.cycle import MeshCycle
from tribodyn.mesh.path_film import FilmAt, PathFilm, SolvedPath, path_film
from tribodyn.mesh.series import in_series
from tribodyn.mesh.touching import Touching
from tribodyn.progress import Progress

__all__ = [
    "IN_SERIES",
    "Loads",
    "quasi_static_loads",
    "tribological_contact",
    "usable_stiffness",
    "warn_of_rigid_films",
]

FloatArray = NDArray[np.float64]
#: Kinds of film stiffness that are springs; the printed sum of one source has the unit of a length.
IN_SERIES = ("tangent", "secant")
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Loads:
    """Stiffness, load share and film of every tooth pair.

    Parameters
    ----------
    stiffness : array (n, pairs) [N/m]
        Teeth, and film where it counts.
    share : array (n, pairs)
        Part of the total normal force.
    film_at : callable
        Films of the touching pairs as a function of their loads per width; a
        :class:`tribodyn.mesh.path_film.SolvedPath` where they are solved.
    """

    stiffness: FloatArray
    share: FloatArray
    film_at: FilmAt


def usable_stiffness(found: FloatArray, in_contact: BoolArray, model: str) -> FloatArray:
    """Check what a stiffness model gave; models of third parties are checked here once for all.

    Parameters
    ----------
    found : array
        What the model returned [N/m].
    in_contact : bool array (n, pairs)
        Whether the pair is in contact.
    model : str
        Name of the model.

    Returns
    -------
    array (n, pairs) [N/m]

    Raises
    ------
    ComputationError
        If a pair in contact has no stiffness.
    """
    stiffness = np.asarray(found)
    sound = stiffness.shape == in_contact.shape and bool(
        np.all(np.where(in_contact, np.isfinite(stiffness) & (stiffness > 0.0), stiffness == 0.0))
    )
    if not sound:
        raise ComputationError(
            Problem(
                what=f'the stiffness model "{model}" gave no usable pair stiffness',
                where="stiffness of the tooth pairs",
                why="It must be finite and positive where a pair is in contact, zero elsewhere",
                remedy="Check the options of the model, or choose another",
            )
        )
    return stiffness


def quasi_static_loads(
    cycle: MeshCycle,
    tooth_stiffness: FloatArray,
    total_load: float,
    touching: Touching,
    pinion_speed: float,
    model: str,
    options: Mapping[str, Any],
    progress: Progress,
) -> Loads:
    """Share the load among the pairs and find their films.

    Parameters
    ----------
    cycle : MeshCycle
        Places of the pairs.
    tooth_stiffness : array (n, pairs) [N/m]
        Stiffness of the teeth of each pair.
    total_load : float [N/m]
        Load of all pairs together per face width.
    touching : Touching
        The pairs in contact.
    pinion_speed : float [rad/s]
        Speed of the pinion.
    model : str
        Name of the film model.
    options : mapping
        Its options, complete.
    progress : Progress
        Told how many films are solved.

    Returns
    -------
    Loads

    Raises
    ------
    ComputationError
        If a film cannot be solved, or the load share does not settle.
    """

    def of_formula(loads: FloatArray) -> FilmAt:
        return lambda load: touching.films(model, load, **options)

    def of_path(loads: FloatArray) -> FilmAt:
        return along.solve(along.load_of(cycle.grid, loads), progress)

    film_of = of_formula
    if FILM_MODELS[model].method:
        along: PathFilm = path_film(
            model, options, cycle.contact, pinion_speed, touching, cycle.side
        )
        film_of = of_path
    if options["stiffness"] in IN_SERIES:
        found = in_series(tooth_stiffness, cycle.in_contact, total_load, film_of, cycle.named)
        return Loads(*found)
    share = tooth_stiffness / tooth_stiffness.sum(axis=1, keepdims=True)
    return Loads(tooth_stiffness, share, film_of(total_load * share))


def warn_of_rigid_films(film_at: FilmAt) -> None:
    """Say where a solved film has no tangent stiffness, because it does not fall with the load.

    Parameters
    ----------
    film_at : callable
        Films as a function of their loads.

    Warns
    -----
    ModelWarning
        Code ``film-stiffness`` where a film counts as rigid.
    """
    share = film_at.rigid_share if isinstance(film_at, SolvedPath) else 0.0
    if share > 0.0:
        warn(
            "film-stiffness",
            f"in {100.0 * share:.2g} % of the contacts of the mesh cycle the central film does not "
            "fall with the load, so that it has no tangent stiffness: there it counts as rigid. "
            "Light loads do that, where contacts turn from rigid to elastic, and starved inlets",
            stacklevel=4,
        )


def tribological_contact(
    motion: Kinematics, touching: Touching, load_per_width: FloatArray, composite_roughness: float
) -> TribologicalContact:
    """Loaded contacts as the friction laws see them.

    Parameters
    ----------
    motion : Kinematics
        Curvatures and speeds of the touching pairs.
    touching : Touching
        The same pairs with oil and material.
    load_per_width : array [N/m]
        Their loads.
    composite_roughness : float [m]
        Root of the sum of squares of both roughnesses.

    Returns
    -------
    TribologicalContact
    """
    hertz = hertz_line(load_per_width, motion.equivalent_radius, touching.effective_modulus)
    return TribologicalContact(
        load_per_width=load_per_width,
        hertz_pressure=hertz.maximum_pressure,
        sliding_speed=motion.sliding_speed,
        entrainment_speed=motion.entrainment_speed,
        slide_to_roll_ratio=motion.slide_to_roll_ratio,
        equivalent_radius=motion.equivalent_radius,
        dynamic_viscosity=touching.lubricant.dynamic_viscosity,
        composite_roughness=composite_roughness,
    )
