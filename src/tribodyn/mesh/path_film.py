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

from tribodyn.contact import PathOfContact
from tribodyn.ehl.steady.solved_films import Films
from tribodyn.errors import warn
from tribodyn.mesh.film_places import film_places
from tribodyn.mesh.grid import PhaseFunction, PhaseGrid
from tribodyn.mesh.positions import MOST, PathPositions, path_positions
from tribodyn.mesh.touching import Touching
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, Index

#: Films of all touching pairs under the loads per width given.
FilmAt = Callable[[Array], Films]

#: Estimated error of the film between the positions that deserves a warning.
_ROUGH = 3e-3
#: Compliance over its estimate below which a film counts as rigid: its stiffness has a bound.
_RIGID = 1e-3
#: Distance from an event that tells its two sides apart [mesh cycles].
_BESIDE = 1e-9


@dataclass(frozen=True, eq=False)
class PathFilm:
    """A solved film along the path of contact, as a function of the load of every contact."""

    model: str  #: name of the model in ``tribodyn.ehl.FILM_MODELS``
    options: Mapping[str, Any]  #: options of the model, with its defaults
    places: PathPositions  #: positions at which the film is solved
    roll_angle: Array  #: roll angle of the driving gear at these positions [rad]
    solved: Touching  #: the pair at these positions
    touching: Touching  #: contacts of the mesh table
    zone: Index  #: zone of each contact of the mesh table

    def load_of(self, grid: PhaseGrid, load_per_width: Array) -> Array:
        """Read the loads at the positions from those of a mesh table."""
        age = self.places.sided_age
        at = PhaseFunction(grid, load_per_width)(age)
        return np.asarray(at[np.arange(age.size), np.floor(age).astype(int)])

    def solve(self, load_per_width: Array, progress: Progress = SILENT) -> SolvedPath:
        """Solve the film at the positions."""
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
            more = f"film.positions = {min(2 * count, MOST)}" if count < MOST else "no more exist"
            warn(
                "film-positions",
                f"between the {count} positions at which the film is solved it is known to no "
                f"better than {100.0 * error:.2g} %: load and film change much along the path of "
                f"contact. More positions help: {more}",
            )
        between = self.places.interpolate(np.stack(ratios, axis=1), self.touching.age, self.zone).T
        return SolvedPath(self, load_per_width, films, np.exp(between[:3]), between[3])


@dataclass(frozen=True, eq=False)
class SolvedPath:
    """Films solved along the path of contact; called with loads it gives those of all contacts."""

    path: PathFilm  #: positions and contacts
    load_per_width: Array  #: load at each position [N/m]
    films: Films  #: films at the positions
    factors: Array
    yielding: Array  #: compliance of their films over its scale

    @property
    def rigid_share(self) -> float:
        """Part of the contacts whose film does not fall with the load."""
        return float(np.mean(self.yielding < _RIGID))

    def __call__(self, load_per_width: Array) -> Films:
        """Films of all contacts of the mesh table."""
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
    side: Array,
    bends: tuple[float, ...] = (),
) -> PathFilm:
    """Choose the positions at which a solved film is computed."""
    places = path_positions(contact, options["positions"], bends)
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
        # On an event the side tells the zone; bends lie between the knots.
        zone=places.zone_of(touching.age + np.clip(side - touching.age, -_BESIDE, _BESIDE)),
    )
