"""Films along the path of contact over many operating points, all of them solved in one batch."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact import Kinematics, effective_modulus, hertz_line, path_of_contact
from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.gear import Material, SpurPair
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.cycle import PathPositions, path_positions
from tribodyn.mesh.film.film_columns import as_columns, film_places
from tribodyn.mesh.sharing import LEAST_SHARE, teeth_of
from tribodyn.mesh.tooth_contact import ToothContact
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Parts, Record, quantity, record
from tribodyn.types import Array, Mask

_NO_OPTIONS: Mapping[str, Any] = MappingProxyType({})
#: Positions for the models that have no such option.
_POSITIONS = 30


@record
class FilmOverOperation(Record):
    """Films of one tooth pair from entry to exit, for every torque at every speed.

    Positions stand in the order in which the pair passes them; where the load jumps a position
    occurs twice, with the load before and the load after.

    Parameters
    ----------
    pinion_torque : array (torques,) [N*m]
        Torques on the pinion.
    pinion_speed : array (speeds,) [rad/s]
        Speeds of the pinion.
    path : array (positions,) [m]
        Distance from the pinion's base tangent point along the line of action.
    roll_angle : array (positions,) [rad]
        Roll angle of the driving gear.
    load_per_width : array (torques, positions) [N/m]
        Load of the pair per face width.
    hertz_pressure : array (torques, positions) [Pa]
        Maximum Hertzian pressure.
    entrainment_speed : array (speeds, positions) [m/s]
        HALF the sum of the surface speeds.
    central_film, minimum_film : array (torques, speeds, positions) [m] or None
        Oil film, where the model gives it; NaN where the pair carries less than a thousandth of
        the load.
    film_ratio : array (torques, speeds, positions) or None
        Least known film over the composite roughness.
    film_pressure : array (torques, speeds, positions) [Pa] or None
        Greatest pressure in the film, where it is solved.
    film_stiffness : array (torques, speeds, positions) [N/m] or None
        Stiffness of the film over the common face width.
    """

    pinion_torque: Array = quantity("torque", axis=True)
    pinion_speed: Array = quantity("speed", axis=True)
    path: Array = quantity("position", axis=True)
    roll_angle: Array = quantity("position", axis=True)
    load_per_width: Array = quantity("torque", "position")
    hertz_pressure: Array = quantity("torque", "position")
    entrainment_speed: Array = quantity("speed", "position")
    central_film: Array | None = quantity("torque", "speed", "position", default=None)
    minimum_film: Array | None = quantity("torque", "speed", "position", default=None)
    film_ratio: Array | None = quantity("torque", "speed", "position", default=None)
    film_pressure: Array | None = quantity("torque", "speed", "position", default=None)
    film_stiffness: Array | None = quantity("torque", "speed", "position", default=None)

    def _parts(self) -> Parts:
        """With coordinates of the dimensions, by which frames and selections find values."""
        parts = super()._parts()
        for dim, name in (("torque", "pinion_torque"), ("speed", "pinion_speed"),
                          ("position", "path")):  # fmt: skip
            parts.coordinates[dim] = (dim, *parts.coordinates[name][1:])
        return parts

    def __repr__(self) -> str:
        """One line."""
        shape = (self.pinion_torque.size, self.pinion_speed.size, self.path.size)
        film = self.minimum_film if self.minimum_film is not None else self.central_film
        least = "no film" if film is None else f"films from {np.nanmin(film) * 1e6:.4g} um"
        return "FilmOverOperation({} torques, {} speeds, {} positions, {})".format(*shape, least)


def film_over_operation(
    pair: SpurPair,
    *,
    material: Material,
    stiffness_model: str = "potential-energy",
    stiffness_options: Mapping[str, Any] = _NO_OPTIONS,
    lubricant: Lubricant,
    composite_roughness: float = 0.0,
    film_model: str = "newton",
    film_options: Mapping[str, Any] = _NO_OPTIONS,
    pinion_speed: ArrayLike,
    pinion_torque: ArrayLike,
    progress: Progress = SILENT,
) -> FilmOverOperation:
    """Find the films along the path of contact for every torque at every speed.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position.
    material : Material
        Material of both gears.
    stiffness_model : str
        Name in ``tribodyn.stiffness.MODELS``: shares the load among the pairs.
    stiffness_options : mapping
        Options of the stiffness model.
    lubricant : Lubricant
        Oil at working temperature.
    composite_roughness : float [m]
        Root of the sum of squares of both roughnesses; zero for ideal flanks.
    film_model : str
        Name in ``tribodyn.ehl.FILM_MODELS``.
    film_options : mapping
        Options of the film model. Its ``stiffness`` only tells which stiffness is computed: the
        load is shared by the teeth alone.
    pinion_speed : float or array (speeds,) [rad/s]
        Speeds of the pinion in the running sense.
    pinion_torque : float or array (torques,) [N*m]
        Magnitudes of the torque on the pinion.
    progress : Progress
        Told how many films are solved.

    Returns
    -------
    FilmOverOperation

    Raises
    ------
    InputError
        If a value is out of range or a model unknown.
    ComputationError
        If a film cannot be solved.

    Notes
    -----
    Load share, pressures and films as in :func:`tribodyn.mesh.build`. Source: the single models.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=17, wheel_teeth=22, normal_module=4e-3,
    ...                  normal_pressure_angle=0.3490658504, pinion_face_width=50e-3)
    >>> films = film_over_operation(
    ...     pair, material=Material(), lubricant=Lubricant(0.08, 880.0, 2e-8), film_model="moes",
    ...     stiffness_model="rectangular", stiffness_options={"pair_stiffness": 5e8},
    ...     pinion_speed=[100.0, 200.0], pinion_torque=[90.0, 180.0, 270.0])
    >>> films.central_film.shape
    (3, 2, 30)
    """
    speed = np.atleast_1d(np.asarray(pinion_speed, dtype=float))
    torque = np.atleast_1d(np.asarray(pinion_torque, dtype=float))
    _check(speed, torque, composite_roughness)
    model = FILM_MODELS[film_model]
    options = model.complete(film_options)
    contact = path_of_contact(pair)
    places = path_positions(contact, options.get("positions", _POSITIONS))
    path = contact.A + contact.direction * places.age * pair.base_pitch
    settings = ToothContact(
        material=material,
        lubricant=lubricant,
        stiffness_model=stiffness_model,
        stiffness_options=stiffness_options,
    )
    share = _shares(pair, settings, places, torque)
    total_load = torque / (pair.pinion.base_radius * pair.common_face_width)
    # A pair that its relief keeps apart has no film; the solver is given a little load instead.
    load = total_load[:, None] * np.maximum(share, LEAST_SHARE)
    touches = (share > LEAST_SHARE)[:, None, :]
    motion = contact.kinematics(path, speed[:, None])
    modulus = effective_modulus(material, material)
    angle = _roll_angle(pair, motion)

    def place(number: int, turn: int, position: int) -> str:
        return (
            f"under {torque[number]:g} N*m at {speed[turn]:g} rad/s and the roll angle "
            f"{angle[position]:.4f} rad"
        )

    with film_places(place):
        films = model.films(
            load[:, None, :], motion.equivalent_radius, motion.entrainment_speed, lubricant,
            modulus, length=pair.common_face_width, progress=progress, **options,
        )  # fmt: skip
    return FilmOverOperation(
        pinion_torque=torque,
        pinion_speed=speed,
        path=path,
        roll_angle=angle,
        load_per_width=load,
        hertz_pressure=hertz_line(load, motion.equivalent_radius[0], modulus).maximum_pressure,
        entrainment_speed=motion.entrainment_speed,
        **_masked(as_columns(films, composite_roughness), touches),
    )


def _masked(columns: dict[str, Array], touches: Mask) -> dict[str, Array]:
    return {name: np.where(touches, column, np.nan) for name, column in columns.items()}


def _check(speed: Array, torque: Array, composite_roughness: float) -> None:
    require_positive("pinion_speed", speed, "rad/s")
    require_positive("pinion_torque", torque, "N*m")
    require_between("composite_roughness", composite_roughness, 0.0, 1e-4, "m")
    for name, values in (("pinion_speed", speed), ("pinion_torque", torque)):
        if values.ndim != 1 or values.size == 0:
            raise InputError(
                f"{name} has the shape {values.shape}",
                where=f"argument {name}",
                why="It is one value or a list of values",
                remedy="Every torque is combined with every speed: give each value once",
            )


def _roll_angle(pair: SpurPair, motion: Kinematics) -> Array:
    radius = getattr(motion, f"{pair.driver}_curvature_radius")[0]
    return np.asarray(radius / pair.driving.base_radius)


def _shares(pair: SpurPair, settings: ToothContact, places: PathPositions, torque: Array) -> Array:
    """Load share of the pair at each position for each torque (torques, positions)."""
    contact, age = path_of_contact(pair), places.sided_age
    number = np.floor(age).astype(int)
    phase = age - number
    path, in_contact = contact.pair_paths(phase)
    found = []
    for force in torque / pair.pinion.base_radius:
        teeth = teeth_of(contact, (phase, path, in_contact), settings, force)
        share = teeth.shared_load().share[np.arange(age.size), number]
        found.append(share)
    return np.array(found)
