"""A mesh of two gears: basic rack, place of the second gear, and force law of the teeth."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np

from tribodyn.dynamics.equations.entry import Entry, read_events, varies
from tribodyn.dynamics.equations.system import Contact, LoadFriction
from tribodyn.errors import Argument, InputError, real_numbers
from tribodyn.gear import HypoidBlank
from tribodyn.machine.fields import check_number, quoted
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.crossed import CrossedAxes, CrossedGeometry
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array

Hand = Literal["right", "left"]
#: Phases over which an entry is averaged.
PHASES = (np.arange(256) + 0.5) / 256


class Turn(NamedTuple):
    """An error of a mesh that turns with a gear."""

    error: Callable[[Array], Any]  #: over the phase of the wave, 0 where tooth 1 touches [m]
    waves: Fraction  #: in a mesh cycle: the order over the teeth of the gear
    gear: str  #: name of the gear


@dataclass(frozen=True, eq=False)
class Mesh:
    """A mesh of two gears, on parallel shafts or on shafts whose axes cross.

    Parameters
    ----------
    gears : (str, str)
        Names of the first and the second gear.
    normal_module : float
        Module in the normal section [m].
    helix_angle : float
        Helix angle at the reference circle, without a sign [rad]; zero for spur gears.
    hand : "right" or "left"
        Hand of the first gear: the tooth of a right-hand gear turns with x like a right-hand screw.
    center_distance : float, optional
        Distance of the axes [m]; of internal gears with either sign. By default that of gears
        without profile shift.
    angle : float
        Direction from the axis of the first gear to that of the second, from y towards z [rad].
    pressure_angle : float
        Pressure angle of the basic rack, in the normal section [rad].
    stiffness : float or function, optional
        Mesh stiffness along the transverse line of action, over the phase of this mesh [N/m].
    damping : float or function
        Damping along the line of action [N*s/m].
    damping_ratio : float, optional
        Damping over the critical value of the gears with the mean stiffness, in place of
        ``damping``.
    error : float or function
        Displacement error, subtracted from the compression [m].
    gap : float or function
        Half the backlash along the line of action [m]; with zero the teeth never separate.
    friction : object, optional
        The friction force over the mesh force and its moments on both gears, over the mesh phase:
        ``mesh_table.functions()``, or an object with the same three functions.
    contacts, frictions : sequence of Contact, of LoadFriction
        Force law of computed teeth, in place of damping, error, gap and friction; ``stiffness`` is
        then that of the static balance. Coordinates: x across the line of action in the direction
        of the surface speeds, y along it towards the driven gear, and rotation in the running
        sense, of the first and of the second gear. With twelve coordinates, as those of
        :func:`tribodyn.dynamics.helical12`, the force acts at the centre of the load, which moves
        over path and face: x, y, z along the axes in the running sense of the first gear, the
        rotations about x and y, and that in the running sense.
    events : tuple of float
        Mesh phases at which an entry jumps.
    offset : float
        Mesh phase when the clock of the machine is at 0, in [0, period).
    crossed : CrossedAxes, optional
        Axes and flanks of a hypoid or bevel pair, whose pinion is the first gear;
        :meth:`hypoid` makes such a mesh. Stiffness, damping, error and gap are then along the
        normal of the flanks, ``angle`` is the direction of the common perpendicular, and contacts
        and friction are those of a mesh table in space, whose pinion drives.
    period : int
        Mesh cycles after which the force law repeats, more than one where teeth differ: error,
        contacts, frictions and events are then over the phase of all these cycles, in [0, 1).
    carrier : str, optional
        Shaft with which the axes of both gears turn: the carrier of planets. The angle is that at
        the position of the carrier for which the machine is computed.
    turning : sequence of Turn
        Errors that turn with a gear, of a motion over phases; one clock needs them in ``error``.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> mesh = Mesh(("z1", "z2"), normal_module=4.5e-3, helix_angle=math.radians(21.0))
    >>> round(math.degrees(mesh.transverse_pressure_angle), 6)
    21.299064
    """

    gears: tuple[str, str]
    normal_module: float
    helix_angle: float = 0.0
    hand: Hand = "right"
    center_distance: float | None = None
    angle: float = 0.0
    pressure_angle: float = math.radians(20.0)
    stiffness: Entry | None = None
    damping: Entry = 0.0
    damping_ratio: float | None = None
    error: Entry = 0.0
    gap: Entry = 0.0
    friction: Any = None
    contacts: Sequence[Contact] = ()
    frictions: Sequence[LoadFriction] = ()
    events: tuple[float, ...] = (0.0,)
    offset: float = 0.0
    crossed: CrossedAxes | None = None
    period: int = 1
    carrier: str | None = None
    turning: Sequence[Turn] = ()

    @classmethod
    def hypoid(
        cls,
        gears: tuple[str, str],
        blank: HypoidBlank,
        *,
        apex: tuple[int, int] = (1, 1),
        **fields: Any,
    ) -> Mesh:
        """Mesh of a hypoid, spiral bevel or straight bevel pair.

        Parameters
        ----------
        gears : (str, str)
            Names of pinion and wheel.
        blank : HypoidBlank
            Dimensions of the pair.
        apex : (int, int)
            Side of pinion and wheel on which their apex lies: 1 towards x of the shaft, -1 against
            it. The position of a gear is that of the middle of its face.
        **fields : object
            Other fields of :class:`Mesh`: ``angle``, ``stiffness``, ...

        Returns
        -------
        Mesh

        Raises
        ------
        InputError
            If a value is out of range.

        Examples
        --------
        >>> from tribodyn.gear import hypoid_blank
        >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
        >>> mesh = Mesh.hypoid(("pinion", "wheel"), blank, stiffness=5.7e8)
        >>> round(1e3 * mesh.normal_module, 3)
        5.602
        """
        crossed = CrossedAxes(blank, apex)
        return cls(gears, crossed.blank.mean_normal_module, crossed=crossed, **fields)

    @cached_property
    def crossing(self) -> CrossedGeometry | None:
        """Geometry of crossed axes; None of parallel ones."""
        return None if self.crossed is None else CrossedGeometry(self.crossed, self.angle)

    @property
    def has_play(self) -> bool:
        """Whether the flanks can part."""
        gap = self.contacts[0].gap if self.contacts else self.gap
        return varies(gap) or bool(np.any(np.asarray(gap) > 0.0))

    def ratio(self, gears: tuple[Gear, Gear]) -> Fraction:
        """Speed of the second over that of the first gear, about x of their shafts.

        Parameters
        ----------
        gears : (Gear, Gear)
            Both gears.

        Returns
        -------
        Fraction
            Exact; on crossed axes its sign depends on the sides of the apexes.
        """
        sign = -1 if self.crossing is None else self.crossing.sense
        return sign * Fraction(gears[0].teeth, gears[1].teeth)

    def __post_init__(self) -> None:
        gears = () if isinstance(self.gears, str) else tuple(self.gears)
        if len(gears) != 2 or gears[0] == gears[1] or not all(isinstance(g, str) for g in gears):
            what, where = f"gears = {quoted(self.gears)}", Argument("Mesh.gears")
            remedy = 'Give the names of its first and second gear: ("z1", "z2")'
            raise InputError(what, where, "A mesh has two gears", remedy)
        object.__setattr__(self, "gears", gears)
        check_number(self, "normal_module", "m", 0.0, 1.0, above=True)
        check_number(self, "helix_angle", "rad", 0.0, math.radians(60.0))
        if self.hand not in ("right", "left"):
            what, where = f"hand = {quoted(self.hand)}", Argument("Mesh.hand")
            why = "Hand of the first gear; the other follows"
            raise InputError(what, where, why, "Choose right or left")
        if self.center_distance is not None:
            check_number(self, "center_distance", "m", -100.0, 100.0)
        check_number(self, "angle", "rad", -1e3, 1e3)
        check_number(self, "pressure_angle", "rad", math.radians(5.0), math.radians(45.0))
        if self.damping_ratio is not None:
            check_number(self, "damping_ratio", "", 0.0, 10.0)
        object.__setattr__(self, "period", require_whole("Mesh.period", self.period))
        check_number(self, "offset", "", 0.0, float(self.period))
        object.__setattr__(self, "offset", self.offset % self.period)
        object.__setattr__(self, "events", read_events(self.events, "Mesh.events"))
        for name, positive in (("stiffness", True), ("damping", False), ("gap", False)):
            _check_entry(self, name, positive)
        _check_entry(self, "error", None)

    @property
    def transverse_module(self) -> float:
        """Module in the transverse section [m]."""
        return self.normal_module / math.cos(self.helix_angle)

    @property
    def transverse_pressure_angle(self) -> float:
        """Pressure angle of the basic rack in the transverse section [rad]."""
        return math.atan(math.tan(self.pressure_angle) / math.cos(self.helix_angle))

    @property
    def base_helix_angle(self) -> float:
        """Helix angle at the base circle, without a sign [rad]."""
        return math.asin(math.sin(self.helix_angle) * math.cos(self.pressure_angle))


def mean_over_phase(entry: Any) -> float:
    """Mean of an entry of a mesh over its phase."""
    return float(np.mean(entry(PHASES) if varies(entry) else entry))


def _check_entry(mesh: Mesh, name: str, positive: bool | None) -> None:
    """Refuse a constant entry that is out of range; functions are checked where they are used."""
    entry = getattr(mesh, name)
    where = Argument(f"Mesh.{name}")
    if entry is None or varies(entry):
        if entry is None and name != "stiffness":
            what, why = f"{name} is None", "Wanted: a number or a function of the mesh phase"
            raise InputError(what, where, why, f"Leave {name} out, or give 0.0")
        return
    if real_numbers(where, entry).ndim:
        what, why = f"{name} has a shape", "Wanted: a number or a function of the mesh phase"
        raise InputError(what, where, why, "Give one number, or a function")
    unit = {"stiffness": "N/m", "damping": "N*s/m"}.get(name, "m")
    low = -1.0 if positive is None else 0.0
    check_number(mesh, name, unit, low, 1.0 if unit == "m" else 1e30, above=bool(positive))
