"""From a gear pair, its oil and its load to the mesh table of one mesh cycle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from types import SimpleNamespace
from typing import Any

import numpy as np

from tribodyn.contact import Kinematics, path_of_contact
from tribodyn.contact.face_contacts import SLICES
from tribodyn.ehl import blok_flash_temperature
from tribodyn.ehl.steady.batch import Films
from tribodyn.errors import ModelWarning, collected, require_positive, warn
from tribodyn.friction import FrictionParts, TribologicalContact, pitch_point
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.columns import FILM_COLUMNS, MIXED_COLUMNS, MeshColumns
from tribodyn.mesh.cycle import MeshCycle, PairsInContact, mesh_cycle, pairs_in_contact
from tribodyn.mesh.film.film_columns import as_columns, friction_columns
from tribodyn.mesh.gears import Gears
from tribodyn.mesh.loads import (
    Loads,
    quasi_static_loads,
    reported_films,
    tribological_contact,
    warn_of_rigid_films,
)
from tribodyn.mesh.sharing import (
    FittedLaw,
    SharedLoad,
    Teeth,
    ToothContact,
    ToothModel,
    shared_load_columns,
    teeth_of,
)
from tribodyn.mesh.table import MeshTable
from tribodyn.model import NO_OPTIONS
from tribodyn.progress import SILENT, Progress
from tribodyn.record import from_parts
from tribodyn.stiffness import MODELS
from tribodyn.stiffness.loaded.face_problem import has_slices
from tribodyn.types import Array, ByName, Mask


def build(
    pair: Gears,
    *,
    material: Material,
    stiffness_model: str = "potential-energy",
    stiffness_options: ByName = NO_OPTIONS,
    lubricant: Lubricant,
    friction_law: str,
    friction_options: ByName = NO_OPTIONS,
    composite_roughness: float,
    film_model: str = "none",
    film_options: ByName = NO_OPTIONS,
    pinion_speed: float,
    pinion_torque: float,
    steps: int | None = None,
    force_law: bool = False,
    progress: Progress = SILENT,
) -> MeshTable:
    """Compute everything that happens in the tooth contact over one mesh cycle.

    Parameters
    ----------
    pair, material : gear pair, Material
        Both gears in their working position with the one that drives, and their material.
    stiffness_model, stiffness_options
        Name in ``tribodyn.stiffness.MODELS``, and options of that model.
    lubricant : Lubricant
        Oil at working temperature.
    friction_law, friction_options
        Name in ``tribodyn.friction.LAWS``, and options of that law.
    composite_roughness : float [m]
        Root of the sum of squares of both roughnesses; zero for ideal flanks.
    film_model, film_options
        Name in ``tribodyn.ehl.FILM_MODELS``, and options of that model, whose ``stiffness`` puts
        the film in series with the teeth.
    pinion_speed : float [rad/s]
        Speed of the pinion in the running sense.
    pinion_torque : float [N*m]
        Magnitude of the torque on the pinion.
    steps : int
        Wanted number of phase intervals, at least 16; by default 512, or 1024 where pairs are
        solved together, which begin to carry at phases that are no events, or 96 where contacts
        are slices of lines, which enter and leave gradually.
    force_law : bool
        Fit the force law of pairs that are springs of their own too, whose stiffness may grow
        with their load; else it is their stiffness times the deflection. That of pairs which are
        solved together is always fitted.
    progress : Progress
        Receives the number of solved oil films.

    Raises
    ------
    InputError
        If a value is out of range or a model unknown.
    ComputationError
        If the load share does not settle, a pair in contact has no stiffness, or its film cannot
        be solved.

    Notes
    -----
    Loads are quasi-static: those of the loaded tooth contact where the stiffness model couples
    the pairs or flanks are modified; else pairs deflect equally, so each carries a share in
    proportion to its secant stiffness. A tip corner that touches beyond the path of contact has
    the friction of the end that is next to it, and no film of its own. Hertz pressure, film and
    friction of a pair come from its own share. A film that is solved is solved at some positions
    of the path of contact and interpolated between them. Source: the single laws, each named in
    its function.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=17, wheel_teeth=22, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> build(pair, material=Material(), stiffness_model="rectangular",
    ...       stiffness_options={"pair_stiffness": 5e8}, lubricant=Lubricant(0.08, 880.0, 2e-8),
    ...       friction_law="constant", friction_options={"coefficient": 0.05},
    ...       composite_roughness=0.0, pinion_speed=100.0, pinion_torque=90.0)  # doctest: +ELLIPSIS
    MeshTable(contact ratio 1.5477, mesh frequency 270.6 Hz, mean stiffness 7.739e+08 N/m, ...)
    """
    settings = from_parts(
        ToothContact,
        SimpleNamespace(**locals()),
        composite_roughness=float(composite_roughness),
    )
    operation = {"pinion_speed": pinion_speed, "pinion_torque": pinion_torque}
    return mesh_table(
        pair, settings, **operation, steps=steps, force_law=force_law, progress=progress
    )


def mesh_table(
    pair: Gears,
    settings: ToothContact,
    *,
    pinion_speed: float,
    pinion_torque: float,
    steps: int | None = None,
    force_law: FittedLaw = False,
    progress: Progress = SILENT,
) -> MeshTable:
    """Compute the tooth contact with these settings at one speed and torque, as :func:`build`."""
    operation = (pinion_speed, pinion_torque)
    loaded = loaded_mesh(
        pair, settings, operation, steps=steps, force_law=force_law, progress=progress
    )
    return loaded.table(settings)


@dataclass(frozen=True, eq=False)
class LoadedMesh:
    """A mesh under its quasi-static load, with its films, before anything rubs."""

    pair: Gears
    settings: ToothContact
    cycle: MeshCycle
    pairs: PairsInContact
    motion: Kinematics  #: of the pairs in contact
    teeth: Teeth
    loads: Loads[SharedLoad]
    pinion_speed: float
    pinion_torque: float
    force_law: FittedLaw

    @cached_property
    def films(self) -> Films:
        """Films of the pairs in contact."""
        return self.loads.film_at(self.loads.tribological)

    @cached_property
    def _reported(self) -> Films:
        return reported_films(self.films, self.loads, self.teeth.least_load)

    @cached_property
    def _load_columns(self) -> dict[str, Any]:
        loads, fitted = self.loads, self.force_law
        return shared_load_columns(self.teeth, loads.shared, loads.springs, force_law=fitted)

    def table(self, settings: ToothContact) -> MeshTable:
        """Mesh table with the friction law and the roughness of some settings."""
        operation = float(self.pinion_speed), float(self.pinion_torque)
        cycle, motion, loads = self.cycle, self.motion, self.loads
        contact = tribological_contact(
            motion,
            self.pairs,
            loads.tribological,
            settings.composite_roughness,
            pitch_point(self.pair, *operation),
            self.films,
            bodies=settings.bodies,
        )
        friction = loads.film_at.friction(contact, motion, settings)
        columns = columns_of(cycle, motion, loads, contact, self._reported, friction)
        return table_of(self.pair, settings, cycle, operation, self._load_columns | columns)


def columns_of(
    cycle: MeshCycle,
    motion: Kinematics,
    loads: Loads[SharedLoad],
    contact: TribologicalContact,
    reported: Films,
    friction: Array | FrictionParts,
) -> dict[str, Any]:
    """Columns of a mesh table that follow from the contacts, which may be those of many in rows."""
    columns: dict[str, Array] = {
        **_motion_columns(motion, cycle.sliding_direction),
        "load_per_width": loads.load_per_width,
        "hertz_pressure": np.where(loads.load_per_width > 0.0, contact.hertz_pressure, 0.0),
        **as_columns(reported, contact.composite_roughness),
    }
    columns |= friction_columns(friction, columns.get("film_ratio"))
    coefficient = columns["friction_coefficient"]
    columns["flash_temperature"] = _flash_temperature(contact, coefficient, loads.load_per_width)
    return _spread(columns, cycle.in_contact)


def _flash_temperature(contact: TribologicalContact, friction: Array, load: Array) -> Array:
    """Greatest rise of the surface temperature in each contact, by Blok."""
    sliding, entrainment = contact.sliding_speed, contact.entrainment_speed
    return blok_flash_temperature(
        friction * load * np.abs(sliding),
        2.0 / np.pi * contact.load_per_width / contact.hertz_pressure,
        entrainment + 0.5 * sliding,
        entrainment - 0.5 * sliding,
        *contact.bodies,
    )


def table_of(
    pair: Gears,
    settings: ToothContact,
    cycle: MeshCycle,
    operation: tuple[float, float],
    columns: Mapping[str, object],
) -> MeshTable:
    """Make a mesh table of its columns."""
    return from_parts(
        MeshTable,
        *(cycle, settings),
        gear_pair=pair,
        pinion_speed=operation[0],
        pinion_torque=operation[1],
        film_stiffness_kind=settings.film["stiffness"],
        **_face_columns(cycle),
        **columns,
    )


def _face_columns(cycle: MeshCycle) -> dict[str, Array]:
    """Where the contacts are on the face, if they are slices of it."""
    slices = cycle.slices
    if slices is None:
        return {}
    return {"face_position": slices.face_position, "contact_width": slices.width}


def loaded_mesh(
    pair: Gears,
    settings: ToothContact,
    operation: tuple[float, float],
    *,
    steps: int | None = None,
    force_law: FittedLaw = False,
    loading: Array | None = None,
    progress: Progress = SILENT,
) -> LoadedMesh:
    """Share the load at a speed and a torque of the pinion among the pairs; find their films."""
    # loading: the force of all pairs at each knot over that of the torque alone.
    pinion_speed, pinion_torque = operation
    require_positive("pinion_speed", pinion_speed, "rad/s")
    require_positive("pinion_torque", pinion_torque, "N*m")
    cycle, teeth = teeth_under_load(pair, settings, pinion_torque, steps, loading)
    motion = cycle.motion(pinion_speed)
    pairs = pairs_in_contact(cycle, motion, settings.lubricant, settings.material)
    loads = quasi_static_loads(cycle, teeth, pairs, settings, pinion_speed, progress)
    warn_of_rigid_films(loads.film_at)
    return LoadedMesh(pair, settings, cycle, pairs, motion, teeth, loads, *operation, force_law)


def teeth_under_load(
    pair: Gears, settings: ToothContact, torque: float, steps: int | None, loading: Array | None
) -> tuple[MeshCycle, Teeth]:
    """Teeth under load over one mesh cycle, the same object for equal arguments."""
    usual = _steps(pair, settings.stiffness_model)  # registers the models of others, too
    steps = steps or usual
    arguments = (pair, settings.teeth, torque, steps)
    try:
        hash(arguments)
    except TypeError:  # an option is an array
        return _loaded_teeth(*arguments, loading)
    if loading is not None:
        return _loaded_teeth(*arguments, loading)
    cycle, teeth, warnings = _cached_teeth(*arguments, MODELS.version)
    for warning in warnings:
        warn(warning.code, warning.message, stacklevel=4)
    return cycle, teeth


#: Number of loads in the cache of teeth: enough for one axis of an operating map.
_LOADS = 128


@lru_cache(maxsize=_LOADS)
def _cached_teeth(*arguments: Any) -> tuple[MeshCycle, Teeth, list[ModelWarning]]:
    with collected() as warnings:
        return (*_loaded_teeth(*arguments[:-1]), warnings)


@lru_cache(maxsize=8)
def _cycle(pair: Gears, steps: int, slices: int = 0) -> MeshCycle:
    """Contacts over the mesh cycle, cached: the same object under every load."""
    return mesh_cycle(path_of_contact(pair), steps, slices)


def _loaded_teeth(
    pair: Gears, model: ToothModel, torque: float, steps: int, loading: Array | None = None
) -> tuple[MeshCycle, Teeth]:
    cycle = _cycle(pair, steps, SLICES if has_slices(pair, MODELS[model.name]) else 0)
    over = 1.0 if loading is None else loading[:, None]
    places = (cycle.grid.phase, cycle.path, cycle.in_contact)
    force = torque / pair.pinion.base_radius
    return cycle, teeth_of(cycle.contact, places, model, force, over, cycle.slices)


def _steps(pair: Gears, model: str) -> int:
    if has_slices(pair, MODELS[model]):
        return 96
    together = MODELS[model].coupled or pair.has_modification
    return 1024 if together else 512


def _motion_columns(motion: Kinematics, direction: Array) -> dict[str, Array]:
    columns = {n: v for n, v in vars(motion).items() if n in MeshColumns.__dataclass_fields__}
    return {**columns, "sliding_direction": direction}


def _spread(contact_values: dict[str, Array], in_contact: Mask) -> dict[str, Any]:
    """Spread the values of the touching pairs over all pairs, with zeros elsewhere."""
    columns: dict[str, Any] = dict.fromkeys((*FILM_COLUMNS, *MIXED_COLUMNS))
    places = np.flatnonzero(in_contact)
    for name, values in contact_values.items():
        column = np.zeros((*values.shape[:-1], in_contact.size))
        column[..., places] = values
        columns[name] = column.reshape(*values.shape[:-1], *in_contact.shape)
    return columns
