"""Film and friction in every cell of a loaded hypoid pair, and their sums."""

from __future__ import annotations

from dataclasses import field
from types import SimpleNamespace

import numpy as np

from tribodyn.ehl import FILM_MODELS, lubrication_regime
from tribodyn.errors import require_between, require_one_of
from tribodyn.gear.hypoid.kinematics import ENTRAINMENTS, CellMotion, cell_motion
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.film.film_columns import smallest_film
from tribodyn.mesh.hypoid.cells import wrench
from tribodyn.mesh.hypoid.film import ELLIPTICAL, CellFilms, cell_films
from tribodyn.mesh.hypoid.loaded_contact import HypoidLoadedContact
from tribodyn.mesh.hypoid.table import mesh_table_of
from tribodyn.mesh.sharing import ToothContact
from tribodyn.mesh.table import MeshTable
from tribodyn.model import NO_OPTIONS
from tribodyn.nomenclature import require_number
from tribodyn.record import Record, fact, figure_method, from_parts, quantity, record
from tribodyn.types import Array, ByName, Mask

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
    asperity_friction_coefficient : array (phase, pair, cell)
        Part of the coefficient from asperities; zero where the friction law knows none.
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
    friction_law, film_model, film_stiffness_kind, entrainment : str
        What was chosen.
    loaded : HypoidLoadedContact
        The contact under load, with the oil films in series if the film model has a stiffness.
    teeth : HypoidLoadedContact
        The contact of the teeth alone under the same load.
    central_film : array (phase, pair, cell) [m] or None
        Central film, where the film model has it.
    film_pressure : array (phase, pair, cell) [Pa] or None
        Greatest pressure in a solved film; NaN in most cells, see :class:`tribodyn.mesh.MeshTable`.
    film_stiffness : array (phase, pair, cell) [N/m] or None
        Stiffness of the film of the cell, where the film model has it.
    """

    phase: Array = quantity(*_PHASES, unit="1", axis=True)
    sliding_speed: Array = quantity(*_CELLS, unit="m/s")
    entrainment_speed: Array = quantity(*_CELLS, unit="m/s")
    equivalent_radius: Array = quantity(*_CELLS, unit="m")
    minimum_film: Array = quantity(*_CELLS, unit="m")
    film_ratio: Array = quantity(*_CELLS, unit="1")
    friction_coefficient: Array = quantity(*_CELLS, unit="1")
    film_load_share: Array = quantity(*_CELLS, unit="1")
    asperity_friction_coefficient: Array = quantity(*_CELLS, unit="1")
    friction_direction: Array = quantity(*_CELLS, "component", unit="1")
    pinion_friction: Array = quantity(*_PHASES, "component6", unit="1")
    wheel_friction: Array = quantity(*_PHASES, "component6", unit="1")
    power: Array = quantity(*_PHASES, unit="W")
    mean_coefficient: Array = quantity(*_PHASES, unit="1")
    pinion_speed: float = fact()
    composite_roughness: float = fact()
    friction_law: str = fact()
    film_model: str = fact()
    film_stiffness_kind: str = fact()
    entrainment: str = fact()
    loaded: HypoidLoadedContact = field()
    teeth: HypoidLoadedContact = field()
    central_film: Array | None = quantity(*_CELLS, unit="m", default=None)
    film_pressure: Array | None = quantity(*_CELLS, unit="Pa", default=None)
    film_stiffness: Array | None = quantity(*_CELLS, unit="N/m", default=None)

    @property
    def mean_friction_coefficient(self) -> float:
        """Mean over the cycle of friction over normal forces."""
        return float(self.loaded.grid.mean(self.mean_coefficient))

    @property
    def minimum_film_ratio(self) -> float:
        """Least film over the composite roughness."""
        return float(np.nanmin(self.film_ratio))

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
        return mesh_table_of(self)

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
    friction_options: ByName = NO_OPTIONS,
    film_model: str = ELLIPTICAL,
    film_options: ByName = NO_OPTIONS,
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
        the radii of the gap in each cell; others are those of ``tribodyn.ehl.FILM_MODELS``, which
        take each cell as a slice of a line under its load per length.
    film_options : mapping
        Options of that model; its ``stiffness`` puts the film of each cell in series with the
        teeth. ``positions`` has no effect.
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
    film_model = require_one_of(
        "film_model", film_model, (ELLIPTICAL, *(name for name in FILM_MODELS if name != "none"))
    )
    settings = from_parts(
        ToothContact,
        SimpleNamespace(**locals()),
        material=loaded.material,
        composite_roughness=require_number("composite_roughness", composite_roughness),
        film_model="none" if film_model == ELLIPTICAL else film_model,
    )
    return friction_in_cells(loaded, pinion_speed, settings, entrainment)


def friction_in_cells(
    loaded: HypoidLoadedContact, pinion_speed: float, settings: ToothContact, entrainment: str
) -> HypoidFriction:
    """Film and friction of a loaded pair by the settings of a tooth contact."""
    speed = require_number("pinion_speed", pinion_speed)
    require_between("pinion_speed", speed, 1e-9, 1e5, "rad/s", remedy="3000 rpm is 314.16 rad/s")
    chosen = require_one_of("entrainment", entrainment, ENTRAINMENTS)
    cells = loaded.cells
    motion = cell_motion(cells.flanks.conjugate, cells.touch, cells.curvature, speed, chosen)
    solved = cell_films(loaded, motion, settings)
    return HypoidFriction(
        phase=loaded.phase,
        sliding_speed=cells.spread(motion.sliding_speed),
        entrainment_speed=cells.spread(motion.entrainment_speed),
        equivalent_radius=cells.spread(motion.equivalent_radius),
        friction_direction=cells.spread(motion.friction_direction),
        **_in_carrying_cells(solved),
        **_sums(solved.loaded, motion, solved.carries, solved.friction.coefficient),
        pinion_speed=speed,
        composite_roughness=settings.composite_roughness,
        friction_law=settings.friction_law,
        film_model=ELLIPTICAL if settings.film_model == "none" else settings.film_model,
        film_stiffness_kind=settings.film["stiffness"],
        entrainment=chosen,
        loaded=solved.loaded,
        teeth=loaded,
    )


def _in_carrying_cells(solved: CellFilms) -> dict[str, Array]:
    """Film and friction of the loaded cells, spread over all cells."""
    parts, films, columns = solved.friction, solved.films, {}
    ratio = solved.contact.film_ratio
    certain = np.isfinite(np.asarray(smallest_film(films)))
    line_values = {
        "minimum_film": (films.central_film if films.minimum_film is None else films.minimum_film,
                         0.0),
        "central_film": (films.central_film, 0.0),
        "film_pressure": (films.film_pressure, 0.0),
        "film_stiffness": (films.film_stiffness, 0.0),
        "film_ratio": (np.where(certain, ratio, np.nan), np.inf),
        "friction_coefficient": (parts.coefficient, 0.0),
        "asperity_friction_coefficient": (parts.asperities, 0.0),
        "film_load_share": (parts.film_load_share, 1.0),
    }  # fmt: skip
    for name, (values, empty) in line_values.items():
        if values is not None:
            all_lines = np.full(solved.carries.shape, empty)
            all_lines[solved.carries] = values
            columns[name] = solved.loaded.cells.spread(all_lines, empty)
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
