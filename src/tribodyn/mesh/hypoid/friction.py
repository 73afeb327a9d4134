"""Film and friction in every cell of a loaded hypoid pair, their sums, and its mesh table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field
from typing import Any, cast

import numpy as np

from tribodyn.checks import require_number
from tribodyn.contact import effective_modulus
from tribodyn.ehl import FILM_MODELS, hamrock_dowson_minimum, lubrication_regime
from tribodyn.errors import (
    quiet,
    require_between,
    require_one_of,
)
from tribodyn.friction import LAWS, FrictionParts, TribologicalContact
from tribodyn.gear.hypoid.kinematics import ENTRAINMENTS, CellMotion, cell_motion
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.film.film_columns import JUDGED_LOAD
from tribodyn.mesh.force_law import MeshForceLaw
from tribodyn.mesh.gears import NoGears
from tribodyn.mesh.hypoid.loaded_contact import (
    ContactCells,
    HypoidLoadedContact,
    wheel_torque_at,
    wrench,
)
from tribodyn.mesh.table import MeshTable
from tribodyn.model import NO_OPTIONS
from tribodyn.record import Record, fact, figure_method, quantity, record
from tribodyn.types import Array, Mask

#: Film model of each line as an elliptical contact; the other models are for line contacts.
ELLIPTICAL = "hamrock-dowson"
#: Deflections of the points of the force law, over that at the load of the table.
_POINTS = np.array([0.0, 0.03, 0.06, *np.geomspace(0.1, 1.0, 13), 1.2, 1.5, 1.9, 2.4, 3.0])
_PHASES, _CELLS = ("phase",), ("phase", "pair", "cell")


@record
class HypoidFriction(Record):
    """Film and friction of a hypoid pair over a mesh cycle; made by :func:`hypoid_friction`.

    Cells that carry no load have no film and no friction: zero, and infinite film ratio.

    Parameters
    ----------
    phase : array (phase,)
        Mesh cycles from where a pair comes into contact.
    sliding_speed, entrainment_speed : array (phase, pair, cell) [m/s]
        Amount of the sliding; HALF the sum of the rolling speeds.
    equivalent_radius : array (phase, pair, cell) [m]
        Radius of the gap across the line.
    minimum_film : array (phase, pair, cell) [m]
        Least film; where the film model has none, the central one.
    film_ratio : array (phase, pair, cell)
        Film over composite roughness.
    friction_coefficient : array (phase, pair, cell)
        Friction force over normal force.
    film_load_share : array (phase, pair, cell)
        Part of the load on the film; 1 where the friction law knows no asperities.
    friction_direction : array (phase, pair, cell, 3)
        Unit vector of the friction force on the pinion, in the fixed frame.
    pinion_friction, wheel_friction : array (phase, 6)
        Force and moment of friction on each gear over the amount of the mesh force, in the frames
        of :class:`HypoidLoadedContact`: three pure numbers and three levers in m.
    power : array (phase,) [W]
        Power lost by sliding.
    mean_coefficient : array (phase,)
        Friction forces of all cells over their normal forces.
    pinion_speed : float [rad/s]
        Speed of the pinion.
    composite_roughness : float [m]
        Root of the sum of squares of both roughnesses.
    friction_law, film_model, entrainment : str
        What was chosen.
    loaded : HypoidLoadedContact
        The contact under load.
    """

    phase: Array = quantity(*_PHASES, unit="1", axis=True)
    sliding_speed: Array = quantity(*_CELLS, unit="m/s")
    entrainment_speed: Array = quantity(*_CELLS, unit="m/s")
    equivalent_radius: Array = quantity(*_CELLS, unit="m")
    minimum_film: Array = quantity(*_CELLS, unit="m")
    film_ratio: Array = quantity(*_CELLS, unit="1")
    friction_coefficient: Array = quantity(*_CELLS, unit="1")
    film_load_share: Array = quantity(*_CELLS, unit="1")
    friction_direction: Array = quantity(*_CELLS, "component", unit="1")
    pinion_friction: Array = quantity(*_PHASES, "component6", unit="1")
    wheel_friction: Array = quantity(*_PHASES, "component6", unit="1")
    power: Array = quantity(*_PHASES, unit="W")
    mean_coefficient: Array = quantity(*_PHASES, unit="1")
    pinion_speed: float = fact()
    composite_roughness: float = fact()
    friction_law: str = fact()
    film_model: str = fact()
    entrainment: str = fact()
    loaded: HypoidLoadedContact = field()

    @property
    def mean_friction_coefficient(self) -> float:
        """Mean over the cycle of friction over normal forces."""
        return float(self.loaded.grid.mean(self.mean_coefficient))

    @property
    def minimum_film_ratio(self) -> float:
        """Least film over the composite roughness."""
        return float(self.film_ratio.min())

    @property
    def efficiency(self) -> float:
        """What the teeth pass on of the power of the pinion, over the cycle."""
        power = self.pinion_speed * self.loaded.pinion_torque
        return 1.0 - float(self.loaded.grid.mean(self.power)) / power

    @property
    def lubrication_regime(self) -> Array:
        """Regime of each cell: 0 boundary, 1 mixed, 2 full film; NaN where nothing is carried."""
        loaded = self.loaded.cell_force > 0.0
        return lubrication_regime(np.where(loaded, self.film_ratio, np.nan))

    def table(self) -> MeshTable:
        """Mesh table of the pair for the dynamics.

        Returns
        -------
        MeshTable
            Directions have twelve columns: three displacements and three rotations of each gear,
            in the frames of :class:`HypoidLoadedContact`.
        """
        return _table_of(self)

    plot_friction = figure_method("hypoid_friction", "Draw friction and film over the flank.")

    def __repr__(self) -> str:
        """One line."""
        return (
            f"HypoidFriction({self.friction_law}, mean coefficient "
            f"{self.mean_friction_coefficient:.4g}, film ratio from {self.minimum_film_ratio:.3g}, "
            f"efficiency {100.0 * self.efficiency:.2f} %)"
        )


def hypoid_friction(
    loaded: HypoidLoadedContact,
    pinion_speed: float,
    *,
    lubricant: Lubricant,
    composite_roughness: float,
    friction_law: str = "mixed-ehl",
    friction_options: Mapping[str, Any] = NO_OPTIONS,
    film_model: str = ELLIPTICAL,
    entrainment: str = "contact",
) -> HypoidFriction:
    """Film and friction in every cell of a hypoid pair under load.

    Parameters
    ----------
    loaded : HypoidLoadedContact
        The contact under load.
    pinion_speed : float
        Speed of the pinion in its running sense [rad/s].
    lubricant : Lubricant
        Oil at working temperature.
    composite_roughness : float
        Root of the sum of squares of both roughnesses [m]; zero for ideal flanks.
    friction_law, friction_options
        Name in ``tribodyn.friction.LAWS``, and options of that law.
    film_model : str
        ``"hamrock-dowson"`` takes each line as an elliptical contact under its whole force, with
        the radii of the gap in each cell; others are formulas of ``tribodyn.ehl.FILM_MODELS`` for
        lines under the load per length of the cell.
    entrainment : str
        ``"contact"`` or ``"fixed_frame"``, as in :func:`tribodyn.gear.hypoid_kinematics`.

    Raises
    ------
    InputError
        If an argument is wrong, or the law needs what a hypoid pair does not have.

    Warns
    -----
    ModelWarning
        Those of the law, for cells with at least a quarter of the greatest load per length.

    Notes
    -----
    The friction force of a cell acts against its sliding. It moves the mesh by its sum and turns
    both gears by its moments; the power of the moments is that of the forces.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks
    >>> from tribodyn.mesh import hypoid_loaded_contact
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> ease_off = EaseOff(lengthwise_crowning=30e-6, profile_crowning=6e-6)
    >>> loaded = hypoid_loaded_contact(hypoid_flanks(blank, ease_off=ease_off), 500.0, steps=16)
    >>> oil = Lubricant(0.01, 769.0, 2e-8)
    >>> rubbed = hypoid_friction(loaded, 314.16, lubricant=oil, composite_roughness=0.4e-6)
    >>> round(rubbed.mean_friction_coefficient, 3)
    0.03
    """
    speed = require_number("pinion_speed", pinion_speed)
    require_between("pinion_speed", speed, 1e-9, 1e5, "rad/s", remedy="3000 rpm is 314.16 rad/s")
    roughness = require_number("composite_roughness", composite_roughness)
    require_between("composite_roughness", roughness, 0.0, 1e-4, "m", remedy="0.4 um is 0.4e-6")
    chosen = require_one_of("entrainment", entrainment, ENTRAINMENTS)
    film_model = require_one_of("film_model", film_model, (ELLIPTICAL, *_formulas()))
    cells, law = loaded.cells, LAWS[friction_law]
    motion = cell_motion(cells.flanks.conjugate, cells.touch, cells.curvature, speed, chosen)

    def rubbed(which: Mask) -> tuple[TribologicalContact, FrictionParts]:
        film = _film(loaded, motion, which, lubricant, film_model)
        contact = _contact(loaded, motion, which, film, lubricant, roughness)
        friction = law.evaluate(contact, friction_options)
        if isinstance(friction, FrictionParts):
            return contact, friction
        return contact, FrictionParts(friction, np.zeros(friction.shape), np.ones(friction.shape))

    width = loaded.line_force / cells.length
    rubbed(width >= JUDGED_LOAD * width.max())  # for the warnings of the film and the law
    with quiet():
        contact, parts = rubbed(width > 0.0)
    return HypoidFriction(
        phase=loaded.phase,
        sliding_speed=cells.spread(motion.sliding_speed),
        entrainment_speed=cells.spread(motion.entrainment_speed),
        equivalent_radius=cells.spread(motion.equivalent_radius),
        friction_direction=cells.spread(motion.friction_direction),
        **_of_the_law(cells, width > 0.0, contact, parts),
        **_sums(loaded, motion, width > 0.0, parts.coefficient),
        pinion_speed=speed,
        composite_roughness=roughness,
        friction_law=friction_law,
        film_model=film_model,
        entrainment=chosen,
        loaded=loaded,
    )


def _of_the_law(
    cells: ContactCells, carry: Mask, contact: TribologicalContact, parts: FrictionParts
) -> dict[str, Array]:
    """Film and friction of the loaded cells, spread over all cells."""
    line_values = {
        "minimum_film": (contact.require("film_thickness"), 0.0),
        "film_ratio": (contact.film_ratio, np.inf),
        "friction_coefficient": (parts.coefficient, 0.0),
        "film_load_share": (parts.film_load_share, 1.0),
    }
    columns = {}
    for name, (values, empty) in line_values.items():
        all_lines = np.full(carry.shape, empty)
        all_lines[carry] = values
        columns[name] = cells.spread(all_lines, empty)
    return columns


def _sums(
    loaded: HypoidLoadedContact, motion: CellMotion, carry: Mask, coefficient: Array
) -> dict[str, Array]:
    """Sum the friction forces up to forces, moments, power and one coefficient of each phase."""
    cells, force = loaded.cells, loaded.line_force.copy()
    force[carry] *= coefficient
    rubbing = force[..., None] * motion.friction_direction
    of_gears = {
        f"{gear}_friction": cells.summed(sign * wrench(cells, rubbing, gear).sum(axis=1))
        / loaded.mesh_force[:, None]
        for gear, sign in (("pinion", 1.0), ("wheel", -1.0))
    }
    normal = cells.summed(loaded.line_force.sum(axis=1))
    return of_gears | {
        "power": cells.summed((force * motion.sliding_speed).sum(axis=1)),
        "mean_coefficient": cells.summed(force.sum(axis=1)) / normal,
    }


def _film(
    loaded: HypoidLoadedContact, motion: CellMotion, carry: Mask, oil: Lubricant, model: str
) -> Array:
    """Film of the cells that carry."""
    cells, modulus = loaded.cells, effective_modulus(loaded.material, loaded.material)
    radius, speed = motion.equivalent_radius[carry], motion.entrainment_speed[carry]
    if model == ELLIPTICAL:
        line_force = np.broadcast_to(loaded.line_force.sum(axis=1)[:, None], carry.shape)[carry]
        return hamrock_dowson_minimum(
            line_force,
            radius,
            cells.side_radius[carry],
            speed,
            oil.dynamic_viscosity,
            oil.pressure_viscosity_coefficient,
            modulus,
        )
    load = (loaded.line_force / cells.length)[carry]
    films = FILM_MODELS[model].films(load, radius, speed, oil, modulus)
    return np.asarray(films.central_film if films.minimum_film is None else films.minimum_film)


def _formulas() -> tuple[str, ...]:
    """Film models that are formulas."""
    return tuple(name for name in FILM_MODELS if FILM_MODELS[name].central is not None)


def _contact(
    loaded: HypoidLoadedContact,
    motion: CellMotion,
    carry: Mask,
    film: Array,
    oil: Lubricant,
    roughness: float,
) -> TribologicalContact:
    """Loaded cells as a contact of the friction laws."""
    cells = loaded.cells
    return TribologicalContact(
        load_per_width=(loaded.line_force / cells.length)[carry],
        hertz_pressure=loaded.hertz_pressure[cells.in_contact][carry],
        sliding_speed=motion.sliding_speed[carry],
        entrainment_speed=motion.entrainment_speed[carry],
        slide_to_roll_ratio=motion.slide_to_roll_ratio[carry],
        equivalent_radius=motion.equivalent_radius[carry],
        dynamic_viscosity=oil.dynamic_viscosity,
        composite_roughness=roughness,
        oil_density=oil.density,
        film_thickness=film,
    )


def _table_of(rubbed: HypoidFriction) -> MeshTable:
    """Mesh table of a pair with its friction."""
    loaded, cells = rubbed.loaded, rubbed.loaded.cells
    share, law = loaded.load_share, _force_law(loaded)
    stiffness = share * loaded.mesh_stiffness[:, None]
    pitch = 2.0 * math.pi / cells.flanks.blank.teeth_wheel * loaded.wheel_lever.mean()
    return MeshTable(
        grid=loaded.grid,
        path=pitch * (loaded.phase[:, None] + np.arange(share.shape[1])),
        in_contact=cells.in_contact,
        stiffness=stiffness,
        tooth_stiffness=stiffness,
        corner_share=np.zeros((loaded.phase.size, 2)),
        static_transmission_error=loaded.mesh_force / loaded.mesh_stiffness,
        mesh_stiffness_tangent=loaded.mesh_stiffness_tangent,
        ramp_deflection=law.knot_deflection,
        ramp_stiffness=law.knot_stiffness,
        load_share=share,
        normal_force=loaded.mesh_force[:, None] * share,
        load_per_width=loaded.load_per_width.max(axis=2),
        hertz_pressure=loaded.hertz_pressure.max(axis=2),
        central_film=None,
        film_pressure=None,
        film_stiffness=None,
        maximum_single_pair_stiffness=float(stiffness.max()),
        gear_pair=cast(Any, NoGears()),
        pinion_speed=rubbed.pinion_speed,
        pinion_torque=loaded.pinion_torque,
        composite_roughness=rubbed.composite_roughness,
        stiffness_model="hypoid",
        friction_law=rubbed.friction_law,
        film_model=rubbed.film_model,
        film_stiffness_kind="none",
        mesh_order=cells.flanks.blank.teeth_pinion,
        direction=np.hstack([loaded.pinion_direction, -loaded.wheel_direction]),
        unloaded_transmission_error=loaded.unloaded_transmission_error,
        **_friction_columns(rubbed),
        **_contact_columns(rubbed),
    )


def _contact_columns(rubbed: HypoidFriction) -> dict[str, Any]:
    """Columns of each pair from its cells: means weighted by force, and least films."""
    loaded, touch = rubbed.loaded, rubbed.loaded.cells.in_contact
    force, carries = loaded.cell_force, loaded.cell_force > 0.0
    rubs = force * rubbed.friction_coefficient
    columns = {
        name: _mean(getattr(rubbed, name), weight)
        for name, weight in (
            ("sliding_speed", rubs),
            ("entrainment_speed", rubs),
            ("equivalent_radius", force),
            ("film_load_share", force),
        )
    }
    for name in ("minimum_film", "film_ratio"):
        least = np.where(carries, getattr(rubbed, name), np.inf).min(axis=2)
        columns[name] = np.where(np.isfinite(least), least, np.nan)
    entrained = np.where(touch, columns["entrainment_speed"], 1.0)
    columns["slide_to_roll_ratio"] = columns["sliding_speed"] / entrained
    columns["sliding_direction"] = np.where(touch, 1.0, 0.0)
    return columns


def _force_law(loaded: HypoidLoadedContact) -> MeshForceLaw:
    """Force on the line of action over the deflection from the first touch on."""
    start, lever = loaded.unloaded_rotation, loaded.wheel_lever
    turn = (loaded.loaded_rotation - start) * _POINTS[:, None]
    torque = wheel_torque_at(loaded, start + turn)
    torque[0] = 0.0
    return MeshForceLaw.through(loaded.grid, (lever * turn).T, (torque / lever).T)


def _friction_columns(rubbed: HypoidFriction) -> dict[str, Any]:
    """Coefficient of each pair, the wrench of a unit friction force, and its levers.

    Without any friction the direction is that of one coefficient in all cells.
    """
    loaded, cells = rubbed.loaded, rubbed.loaded.cells
    touch = cells.in_contact
    forces = loaded.line_force * rubbed.friction_coefficient[touch]
    normal, rubs = loaded.line_force.sum(axis=1), forces.sum(axis=1)
    carries = normal > 0.0
    coefficient = np.where(carries, rubs, 0.0) / np.where(carries, normal, 1.0)
    weights = np.where((rubs > 0.0)[:, None], forces, loaded.line_force)
    along = weights[..., None] * -rubbed.friction_direction[touch]
    sums = [
        sign * wrench(cells, along, g).sum(axis=1) for g, sign in (("pinion", 1), ("wheel", -1))
    ]
    share = (loaded.mesh_force[:, None] * loaded.load_share)[touch]
    over = np.where(rubs > 0.0, coefficient, 1.0) * share
    direction = np.concatenate(sums, axis=-1) / np.where(carries, over, 1.0)[:, None]
    return {
        "friction_coefficient": cells.spread(coefficient),
        "friction_direction": cells.spread(direction),
        "pinion_curvature_radius": cells.spread(np.abs(direction[:, 4])),
        "wheel_curvature_radius": cells.spread(np.abs(direction[:, 10])),
    }


def _mean(values: Array, weight: Array) -> Array:
    """Weighted mean over the cells of each pair; the plain mean where all weights are zero."""
    weight = np.where(np.any(weight > 0.0, axis=2, keepdims=True), weight, 1.0)
    return np.asarray((weight * values).sum(axis=2) / weight.sum(axis=2))
