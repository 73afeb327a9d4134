"""The columns of a mesh table: what is stored, and what follows from it at once."""

from __future__ import annotations

import math
from dataclasses import field
from functools import cached_property

import numpy as np

from tribodyn.ehl import lubrication_regime
from tribodyn.mesh.gears import GearData, Gears, NoGears, column_of, gear_data, lever
from tribodyn.mesh.grid import PhaseGrid
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array, Mask

#: Columns that a film model may fill, and those that follow from the film and the friction law.
FILM_COLUMNS = ("central_film", "minimum_film", "film_ratio", "film_pressure", "film_stiffness")
MIXED_COLUMNS = ("film_load_share", "asperity_friction_coefficient")


@record
class MeshColumns(Record):
    """Arrays over mesh phase and the figures that they were made with.

    Columns have the shape (n, pairs), where n counts the knots: pair ``i`` entered contact ``i``
    cycles before phase 0. They are zero where the pair is not in contact; only ``path`` goes on.
    Phase 0 is where a pair enters contact at A.

    Parameters
    ----------
    grid : PhaseGrid
        Knots on the mesh phase, twice at each event.
    path : array (n, pairs) [m]
        Distance from the pinion's base tangent point along the line of action.
    in_contact : bool array (n, pairs)
        Whether the pair is in contact.
    sliding_speed, entrainment_speed : array (n, pairs) [m/s]
        Difference (pinion minus wheel) and half the sum of the surface speeds.
    slide_to_roll_ratio : array (n, pairs)
        Sliding over entrainment speed.
    sliding_direction : array (n, pairs)
        Sign of the sliding speed, constant between two events.
    equivalent_radius, pinion_curvature_radius, wheel_curvature_radius : array (n, pairs) [m]
        Radii of curvature in the contact.
    stiffness : array (n, pairs) [N/m]
        Secant stiffness of the pair at its quasi-static load; teeth and film in series where the
        film counts.
    tooth_stiffness : array (n, pairs) [N/m]
        Stiffness of the teeth of the pair alone.
    corner_share : array (n, 2)
        Part of the total normal force on tip corners that touch before A, and after E.
    static_transmission_error : array (n,) [m]
        Approach of the gears along the line of action under the quasi-static load, without
        ``unloaded_transmission_error`` where the table has that.
    mesh_stiffness_tangent : array (n,) [N/m]
        Slope of the force of all pairs over that approach.
    ramp_deflection, ramp_stiffness : array (n, ramps) [m], [N/m]
        The force law of the mesh as a sum of ramps: where each begins, and its stiffness.
    load_share : array (n, pairs)
        Part of the total normal force on the pair.
    normal_force : array (n, pairs) [N]
        Quasi-static force on the pair along the transverse line of action.
    load_per_width : array (n, pairs) [N/m]
        Normal force over the common face width.
    hertz_pressure : array (n, pairs) [Pa]
        Maximum Hertzian pressure.
    friction_coefficient : array (n, pairs)
        Friction force over normal force.
    central_film, minimum_film : array (n, pairs) [m] or None
        Oil film, where the film model gives it; NaN, as the four after it, where a pair carries
        less than a thousandth of the load, or where the film is not known to 2 %.
    film_ratio : array (n, pairs) or None
        Least known film over the composite roughness.
    film_pressure : array (n, pairs) [Pa] or None
        Greatest pressure in the film, where it is solved.
    film_stiffness : array (n, pairs) [N/m] or None
        Stiffness of the film of the pair, of the requested kind. A film that does not fall with
        the load counts as rigid: its stiffness has a bound.
    maximum_single_pair_stiffness : float [N/m]
        Greatest stiffness of one pair that carries the whole load alone.
    gear_pair : Gears
        Both gears in their working position. A table of another program has none and raises when
        they are accessed.
    pinion_speed : float [rad/s]
        Speed of the pinion.
    pinion_torque : float [N*m]
        Torque on the pinion.
    composite_roughness : float [m]
        Root of the sum of squares of both roughnesses.
    stiffness_model, friction_law, film_model : str
        Which models made the table.
    film_stiffness_kind : str
        Kind of film stiffness: all but ``"none"`` and ``"seed"`` are in series with the teeth,
        ``"none"`` and ``"seed"`` are not.
    mesh_order : int
        Mesh cycles in one turn of the pinion; by default its number of teeth.
    direction : array (6,) or (n, 6) or (n, 12)
        Change of the compression with the coordinates ``pinion_x``, ``pinion_y``,
        ``pinion_theta``, ``wheel_x``, ``wheel_y``, ``wheel_theta`` [1 or m]: y along, x across
        the line of action. By default that of the base radii. Of gears that move in space the
        coordinates are ``x, y, z, theta_x, theta, theta_z`` of pinion and wheel, each in a frame
        whose y axis is that of the gear; theta is about y.
    friction_direction : array (n, pairs, 6 or 12) or None
        Generalized force of one newton of friction of each contact, with the sign of sliding
        [1 or m]. Where None, friction acts across the line of action, with the radii of curvature
        as levers.
    unloaded_transmission_error : array (n,) [m] or None
        Transmission error without load that is no part of the force law, taken off the
        compression.
    film_load_share : array (n, pairs) or None
        Part of the load of the pair on its film: as the friction law has it, or that of
        :func:`tribodyn.ehl.film_load_share` at the film ratio.
    asperity_friction_coefficient : array (n, pairs) or None
        Part of the friction coefficient that asperities cause, where the friction law has it.
    tooth_load_share, tooth_corner_share : array (n, pairs), (n, 2) or None
        ``load_share`` and ``corner_share`` of the teeth alone, without the oil film. None where no
        film is in series with the teeth: there they are the same.
    tooth_transmission_error : array (n,) [m] or None
        Static transmission error of the teeth alone; None as above.
    face_position : array (pairs,) [m] or None
        Where the contacts are slices of lines of contact: the middle of each slice, from the
        middle of the face. Slices of one pair follow each other.
    contact_width : array (n, pairs) [m] or None
        Face width of each slice that is on the path of contact.
    film_offset : float [m]
        Distance before perfect rigid flanks touch at which the first oil film in series begins to
        carry; ``static_transmission_error`` and the force law are counted from there.
    flash_temperature : array (n, pairs) [K] or None
        Greatest rise of the surface temperature in the contact above that of the gears, by
        :func:`tribodyn.ehl.blok_flash_temperature`. None in tables of other programs.
    """

    grid: PhaseGrid
    path: Array = quantity("knot", "pair")
    in_contact: Mask = quantity("knot", "pair")
    sliding_speed: Array = quantity("knot", "pair")
    entrainment_speed: Array = quantity("knot", "pair")
    slide_to_roll_ratio: Array = quantity("knot", "pair")
    sliding_direction: Array = quantity("knot", "pair")
    equivalent_radius: Array = quantity("knot", "pair")
    pinion_curvature_radius: Array = quantity("knot", "pair", of="curvature_radius")
    wheel_curvature_radius: Array = quantity("knot", "pair", of="curvature_radius")
    stiffness: Array = quantity("knot", "pair", of="pair_stiffness")
    tooth_stiffness: Array = quantity("knot", "pair")
    corner_share: Array = quantity("knot", "end")
    static_transmission_error: Array = quantity("knot")
    mesh_stiffness_tangent: Array = quantity("knot")
    ramp_deflection: Array = quantity("knot", "ramp")
    ramp_stiffness: Array = quantity("knot", "ramp")
    load_share: Array = quantity("knot", "pair")
    normal_force: Array = quantity("knot", "pair")
    load_per_width: Array = quantity("knot", "pair")
    hertz_pressure: Array = quantity("knot", "pair")
    friction_coefficient: Array = quantity("knot", "pair")
    central_film: Array | None = quantity("knot", "pair")
    minimum_film: Array | None = quantity("knot", "pair")
    film_ratio: Array | None = quantity("knot", "pair")
    film_pressure: Array | None = quantity("knot", "pair")
    film_stiffness: Array | None = quantity("knot", "pair")
    maximum_single_pair_stiffness: float = fact()
    gear_pair: Gears
    pinion_speed: float = fact()
    pinion_torque: float = fact()
    composite_roughness: float = fact()
    stiffness_model: str = fact()
    friction_law: str = fact()
    film_model: str = fact()
    film_stiffness_kind: str = fact()
    mesh_order: int = fact(default=0)
    direction: Array = field(default_factory=lambda: np.zeros(0))
    friction_direction: Array | None = quantity("knot", "pair", "coordinate", default=None)
    unloaded_transmission_error: Array | None = quantity("knot", default=None)
    film_load_share: Array | None = quantity("knot", "pair", default=None)
    asperity_friction_coefficient: Array | None = quantity("knot", "pair", default=None)
    tooth_load_share: Array | None = quantity("knot", "pair", of="load_share", default=None)
    tooth_corner_share: Array | None = quantity("knot", "end", of="corner_share", default=None)
    tooth_transmission_error: Array | None = quantity(
        "knot", of="static_transmission_error", default=None
    )
    face_position: Array | None = quantity("pair", default=None)
    contact_width: Array | None = quantity("knot", "pair", of="face_width", default=None)
    film_offset: float = fact(default=0.0)
    flash_temperature: Array | None = quantity("knot", "pair", default=None)

    def __post_init__(self) -> None:
        if self.gears is not None:
            object.__setattr__(self, "direction", self.gears.direction)
            object.__setattr__(self, "mesh_order", self.gears.pair.pinion.teeth)

    @cached_property
    def gears(self) -> GearData | None:
        """The spur gears behind the table; None if another program made it."""
        return None if isinstance(self.gear_pair, NoGears) else gear_data(self.gear_pair)

    @property
    def driver(self) -> str:
        """Which gear drives: ``"pinion"`` or ``"wheel"``."""
        along = column_of(self.direction, "pinion_theta")
        return "pinion" if float(along.mean()) > 0.0 else "wheel"

    @property
    def transverse_contact_ratio(self) -> float:
        """Mean number of pairs in contact."""
        return self.gear_pair.transverse_contact_ratio

    @property
    def common_face_width(self) -> float:
        """Face width in which both gears are in contact [m]."""
        return self.gear_pair.common_face_width

    @property
    def base_radius_pinion(self) -> float:
        """Lever of the normal force on the pinion: for spur gears the base radius [m]."""
        return lever(self.direction, "pinion_theta", self.grid)

    @property
    def base_radius_wheel(self) -> float:
        """Lever of the normal force on the wheel: for spur gears the base radius [m]."""
        return lever(self.direction, "wheel_theta", self.grid)

    @property
    def line_force_ratio(self) -> float:
        """Force along the normal of the flanks over its transverse part, ``1/cos(beta_b)``.

        Friction acts under the force along the normal; ``normal_force``, ``load_share`` and the
        stiffnesses of helical gears count the part along the transverse line of action.
        """
        gears = self.gears
        return 1.0 if gears is None else 1.0 / math.cos(gears.pair.base_helix_angle)

    @property
    def mesh_frequency(self) -> float:
        """Tooth engagements per second [Hz]."""
        return self.pinion_speed * self.mesh_order / (2.0 * math.pi)

    @property
    def total_normal_force(self) -> float:
        """Quasi-static force of all pairs together [N]."""
        return self.pinion_torque / self.base_radius_pinion

    @property
    def phase(self) -> Array:
        """Mesh phase of the knots (n,), each event twice."""
        return self.grid.phase

    @property
    def segments(self) -> tuple[slice, ...]:
        """Knots between two events."""
        return self.grid.segments

    @property
    def event_phases(self) -> tuple[float, ...]:
        """Phases where a pair enters, leaves or passes the pitch point."""
        return self.grid.event_phases

    @property
    def mesh_stiffness(self) -> Array:
        """Secant stiffness of all pairs together, tip corners included (n,) [N/m]."""
        return self._mesh_stiffness

    @cached_property
    def _mesh_stiffness(self) -> Array:
        return whole_stiffness(self.stiffness, self.load_share, self.corner_share)

    @property
    def lubrication_regime(self) -> Array | None:
        """Regime of each pair: 0 boundary, 1 mixed, 2 full film; NaN where there is no film."""
        if self.film_ratio is None:
            return None
        return np.where(self.in_contact, lubrication_regime(self.film_ratio), np.nan)

    @property
    def friction_sum(self) -> Array:
        """Friction over normal force of all pairs together, with direction (n,)."""
        if self.friction_direction is not None:
            return column_of(self.friction, "pinion_x")
        return np.asarray(self._plane_friction[0])

    @property
    def asperity_friction_sum(self) -> Array | None:
        """Part of ``friction_sum`` from asperities (n,); None where the friction law has none."""
        part = self.asperity_friction_coefficient
        if part is None:
            return None
        if self.friction_direction is None:
            return self.by_share(self.sliding_direction * part * self.line_force_ratio)
        each = (part * self.load_share)[:, :, None] * self.friction_direction
        return column_of(each.sum(axis=1), "pinion_x")

    @property
    def friction_moment_pinion(self) -> Array:
        """Friction moment on the pinion over total normal force (n,) [m]."""
        if self.friction_direction is not None:
            return column_of(self.friction, "pinion_theta")
        return np.asarray(self._plane_friction[1])

    @property
    def friction_moment_wheel(self) -> Array:
        """Friction moment on the wheel over total normal force (n,) [m]."""
        if self.friction_direction is not None:
            return -column_of(self.friction, "wheel_theta")
        return np.asarray(self._plane_friction[2])

    @property
    def friction_couple(self) -> Array:
        """Moment of friction about the line of action over total normal force (n,) [m].

        It tilts gears whose contacts are slices of lines of contact; zero for whole pairs.
        """
        if self.face_position is None:
            return np.zeros(self.phase.size)
        sense = 1.0 if self.driver == "pinion" else -1.0
        return sense * self.by_share(self._directed_friction * self.face_position)

    @property
    def friction(self) -> Array:
        """Generalized friction force of all pairs over their normal force (n, 6 or 12) [1 or m]."""
        if self.friction_direction is None:
            across, zero = self.friction_sum, np.zeros(self.phase.size)
            levers = (self.friction_moment_pinion, -self.friction_moment_wheel)
            return np.stack((across, zero, levers[0], -across, zero, levers[1]), axis=1)
        share = self.friction_coefficient * self.load_share
        return np.asarray((share[:, :, None] * self.friction_direction).sum(axis=1))

    @property
    def _directed_friction(self) -> Array:
        return self.sliding_direction * self.friction_coefficient * self.line_force_ratio

    @cached_property
    def _last_touch(self) -> tuple[int, int]:
        """Knot and pair of the last contact before the pair leaves."""
        last = int(np.flatnonzero(self.in_contact.any(axis=0))[-1])
        return int(np.flatnonzero(self.in_contact[:, last])[-1]), last

    def by_share(self, column: Array) -> Array:
        """Sum a column over all pairs and tip corners, each with its part of the load.

        Parameters
        ----------
        column : array (n, pairs) [any unit]
            Values; a tip corner beyond the path of contact has that of the end which
            is next to it.

        Returns
        -------
        array (n,)
        """
        return sum_by_share(column, self.load_share, self.corner_share, self._last_touch)

    @cached_property
    def _plane_friction(self) -> Array:
        share, corners = self.load_share, self.corner_share
        # Rotations count in the running sense, so that the negative radius of a ring does not.
        levers = self.pinion_curvature_radius, np.abs(self.wheel_curvature_radius)
        return plane_friction(self._directed_friction, levers, share, corners, self._last_touch)


def whole_stiffness(stiffness: Array, share: Array, corners: Array) -> Array:
    """Stiffness of all pairs together (n,), tip corners included, from those on the path."""
    pair_stiffness, columns = sum_of_few(stiffness), (corners, share)
    carried, on_path = map(sum_of_few, columns)
    return np.asarray(pair_stiffness + pair_stiffness * carried / on_path)


def sum_of_few(columns: Array) -> Array:
    """Sum over a last axis of few values, for which a sum of NumPy takes three times as long."""
    return np.asarray(columns @ np.ones(columns.shape[-1]))


def sum_by_share(column: Array, share: Array, corners: Array, last: tuple[int, int]) -> Array:
    """Sum columns (..., n, pairs) over the pairs and tip corners (..., n)."""
    sums = sum_of_few(column * share)
    for end, place in enumerate(((0, 0), last)):
        sums += corners[..., end] * column[(..., *place, None)]
    return np.asarray(sums)


def plane_friction(
    directed: Array,
    levers: tuple[Array, Array],
    share: Array,
    corners: Array,
    last: tuple[int, int],
) -> Array:
    """Friction over the normal force, and its moments on pinion and wheel (3, ..., n)."""
    columns = np.stack((directed, *(directed * lever for lever in levers)))
    return sum_by_share(columns, share, corners, last)
