"""Films along the path of contact over many operating points, all of them solved in one batch."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact import Kinematics, effective_modulus, hertz_line, path_of_contact
from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import InputError, require_between
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.build import mesh_table
from tribodyn.mesh.cycle import PathPositions, path_positions
from tribodyn.mesh.face_lines import along_flank, slice_count
from tribodyn.mesh.film.film_columns import as_columns, film_places
from tribodyn.mesh.gears import Gears
from tribodyn.mesh.operating_points import films_over_flank
from tribodyn.mesh.sharing import LEAST_SHARE, ToothContact, teeth_of
from tribodyn.mesh.table import MeshTable
from tribodyn.model import NO_OPTIONS
from tribodyn.nomenclature import one_or_more
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Parts, Record, fact, figure_method, from_parts, quantity, record
from tribodyn.stiffness import MODELS
from tribodyn.stiffness.loaded.face_problem import has_slices
from tribodyn.types import Array, ByName, Mask

#: Positions for the models that have no such option.
_POSITIONS = 30


@record
class FilmOverOperation(Record):
    """Films of one tooth pair from entry to exit, for every torque at every speed.

    Positions are in the order in which the pair passes them; where the load jumps a position
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
        Stiffness of the film over the common face width, or that of the slice.
    face_position : array (positions,) [m] or None
        Where contacts are slices of lines of contact: the middle of the slice at each position,
        from the middle of the face. Slices follow each other, each from its entry to its exit.
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
    face_position: Array | None = quantity("position", default=None)

    plot_lubrication_map = figure_method(
        "lubrication_map", "Draw the lubrication regime over speed and torque."
    )

    def _parts(self) -> Parts:
        """With coordinates of the dimensions, by which frames and selections find values."""
        parts = super()._parts()
        for dim, name in (
            ("torque", "pinion_torque"),
            ("speed", "pinion_speed"),
            ("position", "path"),
        ):
            parts.coordinates[dim] = (dim, *parts.coordinates[name][1:])
        return parts

    def __repr__(self) -> str:
        """One line."""
        shape = (self.pinion_torque.size, self.pinion_speed.size, self.path.size)
        film = self.minimum_film if self.minimum_film is not None else self.central_film
        least = "no film" if film is None else f"films from {np.nanmin(film) * 1e6:.4g} um"
        return "FilmOverOperation({} torques, {} speeds, {} positions, {})".format(*shape, least)


def film_over_operation(
    pair: Gears,
    *,
    material: Material,
    stiffness_model: str = "potential-energy",
    stiffness_options: ByName = NO_OPTIONS,
    lubricant: Lubricant,
    composite_roughness: float = 0.0,
    film_model: str = "newton",
    film_options: ByName = NO_OPTIONS,
    pinion_speed: ArrayLike,
    pinion_torque: ArrayLike,
    progress: Progress = SILENT,
) -> FilmOverOperation:
    """Find the films along the path of contact for every torque at every speed.

    Parameters
    ----------
    pair, material
        As the models, their options and ``lubricant`` for :func:`tribodyn.mesh.build`; the film
        does not change the load share.
    stiffness_model, stiffness_options
        As there.
    lubricant, composite_roughness, film_model, film_options
        As there [m].
    pinion_speed : float or array (speeds,) [rad/s]
        Speeds of the pinion in the running sense.
    pinion_torque : float or array (torques,) [N*m]
        Magnitudes of the torque on the pinion.
    progress : Progress
        Receives the number of solved films.

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
    speed, torque = one_or_more(pinion_speed=pinion_speed, pinion_torque=pinion_torque)
    require_between("composite_roughness", composite_roughness, 0.0, 1e-4, "m")
    settings = from_parts(ToothContact, SimpleNamespace(**locals()))
    if has_slices(pair, MODELS[stiffness_model]):
        fields = films_over_flank(pair, settings, torque, speed, progress)
        return FilmOverOperation(pinion_torque=torque, pinion_speed=speed, **fields)
    model, contact = FILM_MODELS[film_model], path_of_contact(pair)
    options = model.complete(film_options)
    places = path_positions(contact, options.get("positions", _POSITIONS))
    path = contact.A + contact.direction * places.age * pair.base_pitch
    share = _shares(pair, settings, places, torque)
    total_load = torque / (pair.pinion.base_radius * pair.common_face_width)
    # A pair that its relief separates has no film; the solver gets a small load instead.
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
        contacts = load[:, None, :], motion.equivalent_radius, motion.entrainment_speed
        model_options = {"length": pair.common_face_width, "progress": progress, **options}
        films = model.films(*contacts, lubricant, modulus, **model_options)
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


def _roll_angle(pair: Gears, motion: Kinematics) -> Array:
    radius = getattr(motion, f"{pair.driver}_curvature_radius")[0]
    return np.asarray(radius / pair.driving.base_radius)


def _shares(pair: Gears, settings: ToothContact, places: PathPositions, torque: Array) -> Array:
    """Load share of the pair at each position for each torque (torques, positions)."""
    contact, age = path_of_contact(pair), places.sided_age
    number = np.floor(age).astype(int)
    phase = age - number
    path, in_contact = contact.pair_paths(phase)
    shares = []
    for force in torque / pair.pinion.base_radius:
        teeth = teeth_of(contact, (phase, path, in_contact), settings.teeth, force)
        share = teeth.shared_load().share[np.arange(age.size), number]
        shares.append(share)
    return np.array(shares)


_OF_A_PAIR = ("film_stiffness", "tooth_stiffness", "pair_stiffness", "load_share")
_OF_THE_MESH = ("film_mesh_stiffness", "tooth_mesh_stiffness", "comprehensive_mesh_stiffness")


@record
class ComprehensiveStiffness(Record):
    """Stiffness of oil film and teeth; made by :func:`tribodyn.mesh.comprehensive_stiffness`.

    Values of one tooth pair are in the order in which it passes them from A to E, a place where
    another pair enters or leaves twice; values of the mesh stand over the mesh phase.

    Parameters
    ----------
    gear_pair : gear pair
        Both gears in their working position.
    kind : str
        ``"approach"``, ``"tangent"``, ``"secant"`` or ``"seed"``.
    stiffness_model, film_model : str
        Models of the teeth and of the film.
    pinion_torque : array (t,) [N*m]
        Torques on the pinion.
    pinion_speed : array (s,) [rad/s]
        Speeds of the pinion.
    path : array (m,) [m]
        Distance from the pinion's base tangent point along the line of action.
    roll_angle : array (m,) [rad]
        Roll angle of the driving gear.
    load_share : array (t, s, m)
        Part of the load on the pair.
    film_stiffness : array (t, s, m) [N/m]
        Stiffness of the film of the pair.
    tooth_stiffness : array (t, s, m) [N/m]
        Stiffness of the teeth of the pair without film.
    pair_stiffness : array (t, s, m) [N/m]
        Teeth and film of the pair in series.
    phase : array (p,)
        Mesh phase, 0 where a pair reaches A; events occur twice.
    film_mesh_stiffness : array (t, s, p) [N/m]
        Sum of the films of all pairs in contact.
    tooth_mesh_stiffness : array (t, s, p) [N/m]
        Stiffness of the teeth of all pairs.
    comprehensive_mesh_stiffness : array (t, s, p) [N/m]
        Stiffness of the whole mesh with its films.
    face_position : array (m,) [m] or None
        Where contacts are slices of lines of contact: the middle of the slice at each place, from
        the middle of the face; load share and stiffnesses of a place are those of the slice.
    """

    gear_pair: Gears
    kind: str = fact()
    stiffness_model: str = fact()
    film_model: str = fact()
    pinion_torque: Array = quantity("torque", unit="N*m", axis=True)
    pinion_speed: Array = quantity("speed", unit="rad/s", axis=True)
    path: Array = quantity("place", unit="m", axis=True)
    roll_angle: Array = quantity("place", unit="rad", axis=True)
    load_share: Array = quantity("torque", "speed", "place", unit="1")
    film_stiffness: Array = quantity("torque", "speed", "place", unit="N/m")
    tooth_stiffness: Array = quantity("torque", "speed", "place", unit="N/m")
    pair_stiffness: Array = quantity("torque", "speed", "place", unit="N/m")
    phase: Array = quantity("phase", unit="1", axis=True)
    film_mesh_stiffness: Array = quantity("torque", "speed", "phase", unit="N/m")
    tooth_mesh_stiffness: Array = quantity("torque", "speed", "phase", unit="N/m")
    comprehensive_mesh_stiffness: Array = quantity("torque", "speed", "phase", unit="N/m")
    face_position: Array | None = quantity("place", unit="m", default=None)

    @property
    def mean_mesh_stiffness(self) -> Array:
        """Mean of the comprehensive stiffness over the phase (t, s) [N/m]."""
        return self._mean(self.comprehensive_mesh_stiffness)

    @property
    def mean_tooth_stiffness(self) -> Array:
        """Mean stiffness of the teeth alone over the phase (t, s) [N/m]."""
        return self._mean(self.tooth_mesh_stiffness)

    @property
    def maximum_mesh_stiffness(self) -> Array:
        """Greatest comprehensive stiffness (t, s) [N/m]."""
        return np.asarray(self.comprehensive_mesh_stiffness.max(axis=2))

    @property
    def series_of_totals(self) -> Array:
        """What the literature takes: ``K_m K_o/(K_m + K_o)`` of the sums of all pairs (t, s, p)."""
        teeth, film = self.tooth_mesh_stiffness, self.film_mesh_stiffness
        return np.asarray(teeth * film / (teeth + film))

    def _mean(self, values: Array) -> Array:
        return np.asarray(np.trapezoid(values, self.phase, axis=2) / np.ptp(self.phase))

    def __repr__(self) -> str:
        """One line with the figures that matter."""
        mean = self.mean_mesh_stiffness
        return (
            f"ComprehensiveStiffness({self.kind}, {self.film_model}, {self.stiffness_model}, "
            f"{self.pinion_torque.size} torques, {self.pinion_speed.size} speeds, "
            f"mean {mean.min():.4g} to {mean.max():.4g} N/m)"
        )


def comprehensive_stiffness(
    pair: Gears,
    *,
    material: Material,
    stiffness_model: str = "potential-energy",
    stiffness_options: ByName = NO_OPTIONS,
    lubricant: Lubricant,
    film_model: str = "newton",
    film_options: ByName = NO_OPTIONS,
    kind: str = "tangent",
    pinion_speed: ArrayLike,
    pinion_torque: ArrayLike,
    steps: int = 128,
    progress: Progress = SILENT,
) -> ComprehensiveStiffness:
    """Find the stiffness of oil film and teeth for every torque at every speed.

    Parameters
    ----------
    pair, material
        As the models, their options and ``lubricant`` for :func:`tribodyn.mesh.build`.
    stiffness_model, stiffness_options
        As there.
    lubricant, film_model
        As there.
    film_options : mapping
        Options of the film model; ``kind`` replaces its ``stiffness``.
    kind : str
        ``"approach"``, ``"tangent"`` or ``"secant"``: the film of each pair in series with its
        teeth, at the load that it then carries. ``"seed"``: as "Prediction of Vibration
        Characteristics in Spur Gear Drives Considering Elastohydrodynamic Lubrication" prints it.
    pinion_speed : float or array (s,) [rad/s]
        Speeds of the pinion in the running sense.
    pinion_torque : float or array (t,) [N*m]
        Magnitudes of the torque on the pinion.
    steps : int
        Phase intervals of a mesh cycle.
    progress : Progress
        Receives the number of solved films.

    Raises
    ------
    InputError
        If a value is out of range, a model unknown, or it has no such film stiffness.
    ComputationError
        If a film cannot be solved, or the load share does not settle.

    Notes
    -----
    ``1/K = 1/K_m + 1/K_o`` for each pair, and the pairs then share the load; ``"seed"`` takes it
    of the sums over all pairs. The printed sum of the source for ``K_o`` has the unit of a length;
    it is multiplied here with the Hertzian pressure, by which its pressures are divided. It still
    doubles with every doubling of the nodes. Source: "Prediction of
    Vibration Characteristics in Spur Gear Drives Considering Elastohydrodynamic Lubrication".

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=17, wheel_teeth=22, normal_module=4e-3,
    ...                  normal_pressure_angle=0.3490658504, pinion_face_width=50e-3)
    >>> found = comprehensive_stiffness(
    ...     pair, material=Material(), lubricant=Lubricant(0.08, 880.0, 2e-8), film_model="moes",
    ...     stiffness_model="rectangular", stiffness_options={"pair_stiffness": 5e8},
    ...     pinion_speed=100.0, pinion_torque=[90.0, 180.0], steps=32)
    >>> bool((found.pair_stiffness < 5e8).all())
    True
    """
    speeds, torques = one_or_more(pinion_speed=pinion_speed, pinion_torque=pinion_torque)
    _check_kind(film_model, kind)
    settings = from_parts(
        ToothContact,
        SimpleNamespace(**locals()),
        film_options={**film_options, "stiffness": kind},
    )

    def table_at(torque: float, speed: float) -> MeshTable:
        return mesh_table(
            pair, settings, pinion_speed=speed, pinion_torque=torque, steps=steps, progress=progress
        )

    tables = [[table_at(torque, speed) for speed in speeds.tolist()] for torque in torques.tolist()]
    columns = [[_columns(table, kind) for table in row] for row in tables]
    table = tables[0][0]
    path, face = _in_order(table, table.path), table.face_position
    on_face = None if face is None else _in_order(table, np.broadcast_to(face, table.path.shape))
    radius = path if pair.driver == "pinion" else pair.line_of_action_length - path
    return from_parts(
        ComprehensiveStiffness,
        settings,
        gear_pair=pair,
        kind=kind,
        pinion_torque=torques,
        pinion_speed=speeds,
        path=path,
        face_position=on_face,
        roll_angle=radius / pair.driving.base_radius,
        phase=table.phase,
        **{
            name: np.array([[each[name] for each in row] for row in columns])
            for name in (*_OF_A_PAIR, *_OF_THE_MESH)
        },
    )


def _columns(table: MeshTable, kind: str) -> dict[str, Array]:
    """Values of one pair in the order of its way, and of the mesh over the phase."""
    film, teeth = np.asarray(table.film_stiffness), table.tooth_stiffness
    comprehensive, pair_stiffness = table.mesh_stiffness, table.stiffness
    if kind == "seed":
        film = film * table.hertz_pressure  # its pressures are over the Hertzian one
    on_corners = table.mesh_stiffness / table.stiffness.sum(axis=1)
    pair_columns = {
        "film_mesh_stiffness": np.nansum(film, axis=1),
        "tooth_mesh_stiffness": teeth.sum(axis=1) * on_corners,
    }
    if kind == "seed":
        each, total = pair_columns.values()
        touch = table.in_contact & np.isfinite(film)
        pair_stiffness = np.zeros(film.shape)
        pair_stiffness[touch] = 1.0 / (1.0 / film[touch] + 1.0 / teeth[touch])
        comprehensive = each * total / (each + total)
    of_a_pair = (film, teeth, pair_stiffness, table.load_share)
    ordered = (_in_order(table, column) for column in of_a_pair)
    return {
        **dict(zip(_OF_A_PAIR, ordered, strict=True)),
        **pair_columns,
        "comprehensive_mesh_stiffness": comprehensive,
    }


def _in_order(table: MeshTable, column: Array) -> Array:
    """Values of a pair from its entry to its exit, of all slices one after the other."""
    return along_flank(column, table.in_contact, slice_count(table))


def _check_kind(film_model: str, kind: str) -> None:
    if film_model == "none" or kind == "none":
        raise InputError(
            "no oil film" if film_model == "none" else 'kind = "none"',
            where="argument film_model" if film_model == "none" else "argument kind",
            why="The comprehensive stiffness is that of teeth and film",
            remedy='Take film_model = "newton" and kind = "approach"',
        )
