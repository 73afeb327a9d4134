"""The oil film of the touching pairs: by a formula everywhere, or solved at places on the path.

A solved film is known at some positions of the path of contact under the load that they carry.
What lies between them, and what a slightly other load would do, is told by the ratio of the
solution to a formula that covers all regimes: the ratio hardly changes along the path, while the
formula follows every change of load, radius and speed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.contact import Kinematics, PathOfContact, effective_modulus, hertz_line
from tribodyn.ehl import FILM_MODELS, moes_central
from tribodyn.ehl.load_exponent import moes_load_exponent
from tribodyn.ehl.solved_films import Films
from tribodyn.errors import warn
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.cycle import MeshCycle
from tribodyn.mesh.film_places import film_places
from tribodyn.mesh.grid import PhaseFunction, PhaseGrid
from tribodyn.mesh.positions import MOST, PathPositions, path_positions
from tribodyn.progress import SILENT, Progress

__all__ = ["FilmAt", "PathFilm", "SolvedPath", "Touching", "path_film", "touching_pairs"]

FloatArray = NDArray[np.float64]

#: Films of all touching pairs under the loads per width given.
FilmAt = Callable[[FloatArray], Films]

#: Estimated error of the film between the positions that deserves a warning.
_ROUGH = 1e-3
#: Compliance over its estimate below which a film counts as rigid: its stiffness has a bound.
_RIGID = 1e-3


@dataclass(frozen=True, eq=False)
class Touching:
    """Pairs in contact without their load, as arrays of one shape.

    Parameters
    ----------
    age : array
        Mesh cycles since the pair entered contact.
    equivalent_radius : array [m]
        Reduced radius of curvature.
    entrainment_speed : array [m/s]
        HALF the sum of the surface speeds.
    lubricant : Lubricant
        Oil at working temperature.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    common_face_width : float [m]
        Length of the contact line.
    """

    age: FloatArray
    equivalent_radius: FloatArray
    entrainment_speed: FloatArray
    lubricant: Lubricant
    effective_modulus: float
    common_face_width: float

    def films(self, model: str, load_per_width: FloatArray, **options: Any) -> Films:
        """Films of every one of these contacts.

        Parameters
        ----------
        model : str
            Name in ``tribodyn.ehl.FILM_MODELS``.
        load_per_width : array [N/m]
            Their loads.
        **options : object
            Options of the model.

        Returns
        -------
        Films
        """
        return FILM_MODELS[model].films(
            load_per_width,
            self.equivalent_radius,
            self.entrainment_speed,
            self.lubricant,
            self.effective_modulus,
            length=self.common_face_width,
            **options,
        )

    def scales(self, load_per_width: FloatArray) -> dict[str, FloatArray]:
        """Estimates of the films that are right in every regime, to a factor near one.

        Parameters
        ----------
        load_per_width : array [N/m]
            Their loads.

        Returns
        -------
        dict of str to array
            One for each array of :class:`tribodyn.ehl.solved_films.Films`.
        """
        arguments = (
            load_per_width, self.equivalent_radius, self.entrainment_speed,
            self.lubricant.dynamic_viscosity, self.lubricant.pressure_viscosity_coefficient,
            self.effective_modulus,
        )  # fmt: skip
        film, slope = moes_central(*arguments), moes_load_exponent(*arguments)
        hertz = hertz_line(load_per_width, self.equivalent_radius, self.effective_modulus)
        return {
            "central_film": film,
            "minimum_film": film,
            "film_pressure": hertz.maximum_pressure,
            "film_stiffness": -self.common_face_width * load_per_width / (slope * film),
        }


@dataclass(frozen=True, eq=False)
class PathFilm:
    """A solved film along the path of contact, as a function of the load of every contact.

    Parameters
    ----------
    model : str
        Name of the model in ``tribodyn.ehl.FILM_MODELS``.
    options : mapping
        Options of the model, with its defaults.
    places : PathPositions
        Positions at which the film is solved.
    roll_angle : array [rad]
        Roll angle of the driving gear at these positions.
    solved : Touching
        The pair at these positions.
    touching : Touching
        Contacts of the mesh table.
    zone : array of int
        Zone of each contact of the mesh table.
    """

    model: str
    options: Mapping[str, Any]
    places: PathPositions
    roll_angle: FloatArray
    solved: Touching
    touching: Touching
    zone: NDArray[np.int64]

    def load_of(self, grid: PhaseGrid, load_per_width: FloatArray) -> FloatArray:
        """Read the loads at the positions from those of a mesh table.

        Parameters
        ----------
        grid : PhaseGrid
            Knots of the mesh table.
        load_per_width : array (n, pairs) [N/m]
            Load of every pair, zero where it is not in contact.

        Returns
        -------
        array (positions,) [N/m]
        """
        age = self.places.sided_age
        at = PhaseFunction(grid, load_per_width)(age)
        return np.asarray(at[np.arange(age.size), np.floor(age).astype(int)])

    def solve(self, load_per_width: FloatArray, progress: Progress = SILENT) -> SolvedPath:
        """Solve the film at the positions.

        Parameters
        ----------
        load_per_width : array (positions,) [N/m]
            Load at each position.
        progress : Progress
            Told how many positions are done.

        Returns
        -------
        SolvedPath

        Raises
        ------
        ComputationError
            If a position cannot be solved.

        Warns
        -----
        ModelWarning
            Code ``film-positions`` where the positions are too few.
        """
        with film_places(lambda index: f"at the roll angle {self.roll_angle[index]:.4f} rad"):
            films = self.solved.films(self.model, load_per_width, **self.options, progress=progress)
        scales = self.solved.scales(load_per_width)
        ratios = [
            np.log(getattr(films, name) / scales[name])
            for name in ("central_film", "minimum_film", "film_pressure")
        ]
        # The compliance and not the stiffness, which has a pole where the compliance is zero.
        ratios.append(scales["film_stiffness"] / np.asarray(films.film_stiffness))
        error = self.places.truncation(ratios[0])
        if error > _ROUGH:
            count = self.options["positions"]
            warn(
                "film-positions",
                f"between the {count} positions at which the film is solved it is known to about "
                f"{100.0 * error:.2g} % only; {100.0 * _ROUGH:g} % is usual. Give for example "
                f"film.positions = {min(2 * count, MOST)}",
            )
        between = self.places.interpolate(np.stack(ratios, axis=1), self.touching.age, self.zone).T
        return SolvedPath(self, load_per_width, films, np.exp(between[:3]), between[3])


@dataclass(frozen=True, eq=False)
class SolvedPath:
    """Films solved along the path of contact; called with loads it gives those of all contacts.

    Parameters
    ----------
    path : PathFilm
        Positions and contacts.
    load_per_width : array (positions,) [N/m]
        Load at each position.
    films : Films
        Films at the positions.
    factors : array (3, m)
        Central film, minimum film and pressure of the contacts of the mesh table over their
        scales.
    yielding : array (m,)
        Compliance of their films over its scale; not positive where the film rises with the load.
    """

    path: PathFilm
    load_per_width: FloatArray
    films: Films
    factors: FloatArray
    yielding: FloatArray

    @property
    def rigid_share(self) -> float:
        """Part of the contacts whose film does not fall with the load."""
        return float(np.mean(self.yielding < _RIGID))

    def __call__(self, load_per_width: FloatArray) -> Films:
        """Films of all contacts of the mesh table.

        Parameters
        ----------
        load_per_width : array (m,) [N/m]
            Their loads, near those that the positions were solved for.

        Returns
        -------
        Films
        """
        *scales, stiffness = self.path.touching.scales(load_per_width).values()
        central, minimum, pressure = np.stack(scales) * self.factors
        film_stiffness = stiffness / np.maximum(self.yielding, _RIGID)
        return Films(central, minimum, pressure, film_stiffness)


def path_film(
    model: str,
    options: Mapping[str, Any],
    contact: PathOfContact,
    pinion_speed: float,
    touching: Touching,
    side: FloatArray,
) -> PathFilm:
    """Choose the positions at which a solved film is computed.

    Parameters
    ----------
    model : str
        Name of the model in ``tribodyn.ehl.FILM_MODELS``.
    options : mapping
        Options of the model, with its defaults.
    contact : PathOfContact
        Path of contact of the pair.
    pinion_speed : float [rad/s]
        Speed of the pinion.
    touching : Touching
        Contacts of the mesh table.
    side : array
        Age of a place beside each contact, on the side of an edge that is meant.

    Returns
    -------
    PathFilm

    Raises
    ------
    InputError
        If the number of positions is out of range.
    """
    places = path_positions(contact, options["positions"])
    path = contact.A + contact.direction * places.age * contact.pair.base_pitch
    motion = contact.kinematics(path, pinion_speed)
    solved = replace(
        touching,
        age=places.age,
        equivalent_radius=motion.equivalent_radius,
        entrainment_speed=motion.entrainment_speed,
    )
    radius = getattr(motion, f"{contact.pair.driver}_curvature_radius")
    return PathFilm(
        model=model,
        options=options,
        places=places,
        roll_angle=radius / contact.pair.driving.base_radius,
        solved=solved,
        touching=touching,
        zone=places.zone_of(side),
    )


def touching_pairs(
    cycle: MeshCycle, motion: Kinematics, lubricant: Lubricant, material: Material
) -> Touching:
    """Gather what the films of the touching pairs depend on, their loads excepted.

    Parameters
    ----------
    cycle : MeshCycle
        Places of the pairs.
    motion : Kinematics
        Curvatures and speeds of the touching ones.
    lubricant : Lubricant
        Oil at working temperature.
    material : Material
        Material of both gears.

    Returns
    -------
    Touching
    """
    return Touching(
        age=cycle.age,
        equivalent_radius=motion.equivalent_radius,
        entrainment_speed=motion.entrainment_speed,
        lubricant=lubricant,
        effective_modulus=effective_modulus(material, material),
        common_face_width=cycle.contact.pair.common_face_width,
    )
