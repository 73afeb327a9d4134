"""A contact over time, ready for the solver: checked series, scale, grid, and the first state."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact.hertz import dry_half_width
from tribodyn.ehl.formulas.dimensionless_groups import Groups, survey_film
from tribodyn.ehl.roughness import RoughnessProfile, warn_if_unresolved
from tribodyn.ehl.solver.contact_case import ContactScales, contact_scales, moes_numbers
from tribodyn.ehl.steady.line_contact import solve_line_contact
from tribodyn.ehl.thermal.thermal_contact import MOST_SLIDING
from tribodyn.ehl.thermal.thermal_model import ThermalModel
from tribodyn.errors import ComputationError, InputError, require_one_of, require_positive
from tribodyn.interrupt import stoppable
from tribodyn.lubricant import Lubricant
from tribodyn.types import Array

#: A number, an array over time, or a function of time.
Series = ArrayLike | Callable[[Array], ArrayLike]

_RAMP = "Begin and end at 1 to 2 % of the load instead of zero"


@dataclass(frozen=True, eq=False)
class TransientInputs:
    """Inputs of a transient contact, all of the shape of the time."""

    time: Array  #: instants [s]
    load: Array  #: load per width, or its estimate where the approach is imposed [N/m]
    radius: Array  #: reduced radius of curvature [m]
    entrainment_speed: Array  #: HALF the sum of the surface speeds [m/s]
    approach: Array | None  #: imposed approach [m]
    surface_speeds: Array  #: of the two surfaces [m/s]
    travel: Array  #: distances that the two surfaces have travelled [m]
    profiles: tuple[RoughnessProfile | None, RoughnessProfile | None]


def read_inputs(
    time: ArrayLike,
    load_per_width: Series,
    equivalent_radius: Series,
    entrainment_speed: Series,
    *,
    impose: str,
    approach: Series | None,
    surface_speeds: tuple[Series, Series] | None,
    roughness: tuple[RoughnessProfile | None, RoughnessProfile | None],
) -> TransientInputs:
    """Evaluate all inputs at the instants and check them."""
    t = _time(time)
    load = _series("load_per_width", load_per_width, t)
    radius = _series("equivalent_radius", equivalent_radius, t)
    speed = _series("entrainment_speed", entrainment_speed, t)
    require_positive("load_per_width", load, "N/m", remedy=_RAMP)
    require_positive("equivalent_radius", radius, "m")
    _require_speed(speed)
    _require_impose(impose, approach)
    approach_series = None if approach is None else _series("approach", approach, t)
    speeds = _surface_speeds(t, speed, surface_speeds, roughness)
    steps = 0.5 * (speeds[:, 1:] + speeds[:, :-1]) * np.diff(t)
    travel = np.concatenate((np.zeros((2, 1)), np.cumsum(steps, axis=1)), axis=1)
    return TransientInputs(t, load, radius, speed, approach_series, speeds, travel, roughness)


def _time(time: ArrayLike) -> Array:
    t = np.asarray(time, dtype=float).reshape(-1)
    if t.size < 2 or not np.all(np.isfinite(t)) or np.any(np.diff(t) <= 0.0):
        raise InputError(
            f"{t.size} instants"
            + ("" if t.size < 2 else f", least step {np.min(np.diff(t)):.4g} s"),
            where="argument time",
            why="time must hold at least two finite instants that rise",
            remedy="200 to 800 steps over the time of contact, as numpy.linspace(0, duration, 401)",
        )
    return t


def _series(name: str, series: Series, t: Array) -> Array:
    values = np.asarray(series(t) if callable(series) else series, dtype=float)
    if values.ndim > 0 and values.shape != t.shape:
        what = f"{name} has the shape {values.shape}"
        remedy = "Give a number, one value per instant, or a function of time"
        raise InputError(what, f"argument {name}", f"time has the shape {t.shape}", remedy)
    bad = np.flatnonzero(~np.isfinite(np.atleast_1d(values)))
    if bad.size:
        what = f"{name} is {np.atleast_1d(values)[bad[0]]} at instant {bad[0]}"
        why = "all values must be finite"
        raise InputError(what, f"argument {name}", why, "Find the instant without a value")
    return np.ascontiguousarray(np.broadcast_to(values, t.shape))


def _require_speed(speed: Array) -> None:
    if np.any(speed < 0.0):
        i = int(np.argmin(speed))
        raise InputError(
            f"entrainment_speed = {speed[i]:.6g} m/s at instant {i}",
            where="argument entrainment_speed",
            why="the oil enters at the negative end of the grid: the speed must be zero or "
            "positive",
            remedy="Mirror the contact, so that the surfaces roll in positive direction",
        )


def _require_impose(impose: str, approach: Series | None) -> None:
    require_one_of("impose", impose, ("load", "approach"))
    if (impose == "approach") != (approach is not None):
        raise InputError(
            f'impose = "{impose}" with '
            + ("an approach" if approach is not None else "no approach"),
            where="arguments impose and approach",
            why="exactly one of load and approach is imposed, the other is the answer",
            remedy='Give approach together with impose = "approach", and only then',
        )


def _surface_speeds(
    t: Array,
    speed: Array,
    surface_speeds: tuple[Series, Series] | None,
    roughness: tuple[RoughnessProfile | None, RoughnessProfile | None],
) -> Array:
    """Speeds of both surfaces, those of rolling without any."""
    if surface_speeds is None:
        if any(profile is not None for profile in roughness):
            what = "a roughness profile without surface speeds"
            why = "each surface carries its roughness at its own speed"
            remedy = "Give (u_1, u_2); both are entrainment_speed in pure rolling"
            raise InputError(what, "argument surface_speeds", why, remedy)
        return np.stack([speed, speed])
    speeds = np.array([_series("surface_speeds", item, t) for item in surface_speeds])
    mean = 0.5 * (speeds[0] + speeds[1])
    mismatch = np.abs(mean - speed)
    if np.any(mismatch > 1e-6 * np.max(np.abs(speeds))):
        i = int(np.argmax(mismatch))
        raise InputError(
            f"surface speeds {speeds[0, i]:.6g} and {speeds[1, i]:.6g} m/s, "
            f"entrainment_speed {speed[i]:.6g} m/s at instant {i}",
            where="arguments surface_speeds and entrainment_speed",
            why="the entrainment speed is HALF the sum of the surface speeds",
            remedy="Give (u1 + u2)/2",
        )
    return speeds


@dataclass(frozen=True)
class ReferenceScale:
    """Units of a transient contact: those of its widest dry contact."""

    instant: int  #: index of the widest dry contact
    load: float  #: load there [N/m]
    radius: float  #: radius there [m]
    entrainment_speed: float  #: greatest entrainment speed [m/s]
    half_width: float  #: half width of the dry contact [m]
    pressure: float  #: hertz pressure [Pa]

    @property
    def time(self) -> float:
        """Time ``b/u`` [s]."""
        return self.half_width / self.entrainment_speed

    @property
    def film(self) -> float:
        """Film ``b^2/R`` [m]."""
        return self.half_width**2 / self.radius


def reference_scale(
    time: Array, load: Array, radius: Array, entrainment_speed: Array, effective_modulus: float
) -> ReferenceScale:
    """Scale of the widest dry contact of a series, after Hertz (1881)."""
    width = dry_half_width(load, radius, effective_modulus)
    instant = int(np.argmax(width))
    b = float(width[instant])
    fastest = float(np.max(entrainment_speed))
    if fastest == 0.0:
        fastest = b / float(time[-1] - time[0])
    pressure = 2.0 * float(load[instant]) / (np.pi * b)
    return ReferenceScale(
        instant, float(load[instant]), float(radius[instant]), fastest, b, pressure
    )


def flooded_domain(
    scale: ReferenceScale,
    load: Array,
    radius: Array,
    entrainment_speed: Array,
    lubricant: Lubricant,
    effective_modulus: float,
) -> tuple[float, float]:
    """Grid that holds the wedge of every instant, in half widths of the reference."""
    moving = np.maximum(entrainment_speed, 1e-6 * scale.entrainment_speed)
    stiffness = effective_modulus * radius
    groups = Groups(
        speed=lubricant.dynamic_viscosity * moving / stiffness,
        material=np.asarray(lubricant.pressure_viscosity_coefficient * effective_modulus),
        load=load / stiffness,
        equivalent_radius=radius,
    )
    film = survey_film(groups.moes_load, groups.moes_material) * groups.moes_film_unit
    width = dry_half_width(load, radius, effective_modulus)
    local = np.minimum(film * radius / width**2, 1.0)
    round_width = np.sqrt(2.0 * radius * film)
    first = np.maximum((4.0 + 1.2 * local) * width, 3.6 * round_width)
    last = np.maximum((1.5 + 0.4 * np.maximum(local - 0.5, 0.0)) * width, 1.1 * round_width)
    return -float(np.max(first)) / scale.half_width, float(np.max(last)) / scale.half_width


#: Reason for the failure of the solver, by its status.
REASONS = {
    1: "Newton's method used up its steps",
    2: "the gap closed for every step length",
    3: "the linear system is singular",
    4: "a value is not finite",
    5: "rounding keeps the mass balance above its tolerance",
}


@dataclass(eq=False)
class State:
    """State of the contact at one instant, dimensionless."""

    P: Array
    H: Array
    instant: Any  #: offset, last free node and load, as the kernel returns them


#: Greatest factor of load, speed or curvature from one steady state to the next of the start.
_RATIO = 1.25


@dataclass(frozen=True, eq=False)
class MovingContact:
    """A transient contact in its dimensionless form."""

    inputs: TransientInputs  #: checked series
    scale: ReferenceScale  #: units
    lubricant: Lubricant  #: the oil
    modulus: float  #: effective modulus [Pa]
    nodes: int  #: nodes of the grid
    domain: tuple[float, float]  #: first and last position, in half widths
    inlet: str  #: condition at the first node
    law: str  #: viscosity law
    compressible: bool  #: whether the density rises with pressure
    length: float  #: distance at which the deflection is zero [m]
    tolerance: float  #: relative change of the pressure, and flux error, at convergence
    thermal: ThermalModel | None = None  #: how the film is heated

    @property
    def dx(self) -> float:
        """Width of an interval, in half widths."""
        return (self.domain[1] - self.domain[0]) / (self.nodes - 1)

    @cached_property
    def X(self) -> Array:
        """Positions of the nodes, in half widths."""
        return np.linspace(*self.domain, self.nodes)

    @property
    def flooded(self) -> bool:
        """Whether the first node carries the pressure of the inlet before it."""
        return self.inlet == "flooded"

    @cached_property
    def numbers(self) -> ContactScales:
        """Factor lambda of the equation and the oil for the kernel, at the reference."""
        scale, oil = self.scale, self.lubricant
        M, L = moes_numbers(scale.load, scale.radius, scale.entrainment_speed, oil, self.modulus)
        return contact_scales(
            M,
            L,
            scale.pressure,
            oil.pressure_viscosity_coefficient,
            oil.roelands_index,
            self.law,
            self.compressible,
        )

    @property
    def depth(self) -> float:
        """Distance at which the deflection is zero, in half widths."""
        return self.length / self.scale.half_width

    @property
    def time(self) -> Array:
        """Instants, in b/u."""
        return self.inputs.time / self.scale.time

    def table(self) -> Array:
        """Inputs of the kernel over time."""
        from tribodyn.ehl._kernel.transient import (
            CURVATURE,
            FIRST_SHIFT,
            HEIGHT,
            INPUTS,
            LOAD,
            OFFSET,
            SECOND_SHIFT,
            SPEED,
        )

        inputs, scale = self.inputs, self.scale
        table = np.zeros((inputs.time.size, INPUTS))
        table[:, LOAD] = inputs.load / scale.load
        table[:, SPEED] = inputs.entrainment_speed / scale.entrainment_speed
        table[:, CURVATURE] = scale.radius / inputs.radius
        table[:, FIRST_SHIFT : SECOND_SHIFT + 1] = inputs.travel.T / scale.half_width
        table[:, HEIGHT] = 1.0
        if inputs.approach is not None:
            table[:, OFFSET] = -inputs.approach / scale.film
        return table

    def kernel_contact(self, imposed: bool, depth: float) -> Any:
        """Contact for the kernel, with the load or the offset imposed."""
        from tribodyn.ehl._kernel.newton import Limits
        from tribodyn.ehl._kernel.transient import Profiles, TransientContact

        b, ends, heights = self.scale.half_width, np.zeros((2, 3)), [np.zeros(0), np.zeros(0)]
        for side, profile in enumerate(self.inputs.profiles):
            if profile is not None:
                heights[side] = -profile.height / self.scale.film
                periodic = float(profile.beyond == "periodic")
                ends[side] = profile.position[0] / b, profile.spacing / b, periodic
        return TransientContact(
            self.nodes - 1,
            self.domain[0],
            self.dx,
            float(depth),
            self.numbers.lam,
            self.numbers.oil,
            imposed,
            self.flooded,
            Profiles(heights[0], heights[1], ends),
            Limits(self.tolerance, self.tolerance, 40, 1e-3, 0.3),
        )

    def require_rolling(self) -> None:
        """Refuse a heated film that is not carried along."""
        first, second = self.inputs.surface_speeds
        speed = self.inputs.entrainment_speed
        bad = np.flatnonzero(np.abs(first - second) > MOST_SLIDING * speed)
        bad = bad if bad.size else np.flatnonzero(speed == 0.0)
        if bad.size:
            i = int(bad[0])
            raise InputError(
                f"surface speeds {first[i]:.6g} and {second[i]:.6g} m/s at instant {i}",
                where="arguments thermal and surface_speeds",
                why=f"a heated film slides at most {MOST_SLIDING:g} times as fast as it is "
                "entrained: without rolling it stores all its heat",
                remedy="Leave these instants out, or solve the film without thermal",
            )

    def check_roughness(self) -> None:
        """Warn of waves that the grid does not resolve."""
        b = self.scale.half_width
        for side, profile in enumerate(self.inputs.profiles):
            if isinstance(profile, RoughnessProfile):
                travel = self.inputs.travel[side]
                first = self.domain[0] * b - float(np.max(travel))
                profile.require_range(first, self.domain[1] * b - float(np.min(travel)))
                warn_if_unresolved(profile, self.dx * b, stacklevel=4)

    def steady(self) -> State:
        """Steady state under the inputs of the first instant."""
        table, imposed = self.table(), self.inputs.approach is None
        if not self.inputs.entrainment_speed[0] > 0.0:
            raise InputError(
                "entrainment_speed = 0 at the first instant",
                where="arguments entrainment_speed and start",
                why="without rolling no steady film carries the load",
                remedy='Begin with a positive speed, or with start = "unloaded" and an '
                "imposed approach",
            )
        state, row = self._reference_state(), table[0].copy()
        first = row.copy()
        first[[0, 3]], first[6] = 1.0, 0.0
        self._carry(state, first, row, True, 1.0)
        if not imposed:
            # The offset counts the deflection from another distance than the kernel's own, b.
            shift = self.dx * float(np.sum(state.P)) * np.log(self.depth) / np.pi
            state.instant = state.instant._replace(offset=state.instant.offset - shift)
            first = row.copy()
            first[1] = state.instant.offset
            self._carry(state, first, row, False, self.depth)
        return state

    def unloaded(self) -> State:
        """Film at rest in the open gap of the first instant."""
        from tribodyn.ehl._kernel.transient import Instant

        if self.inputs.approach is None:
            what = 'start = "unloaded" with an imposed load'
            remedy = 'Use start = "steady", or impose the approach'
            raise InputError(what, "argument start", "an unloaded film carries no load", remedy)
        n, row = self.nodes - 1, self.table()[0]
        X = self.X
        H = row[1] + 0.5 * row[3] * X**2
        for travel, profile in zip(self.inputs.travel, self.inputs.profiles, strict=True):
            if profile is not None:
                H += profile(X * self.scale.half_width - travel[0]) / self.scale.film
        if not float(H.min()) > 0.0:
            raise InputError(
                f"approach = {-row[1] * self.scale.film:.6g} m at the first instant",
                where="arguments approach and start",
                why="an unloaded start needs an open gap: a negative approach, beyond the "
                "highest peaks",
                remedy='Begin earlier, or take start = "steady"',
            )
        width = min(0.5 * np.sqrt(2.0 * row[1] / row[3]), 0.9 * self.domain[1])
        last = int((width - self.domain[0]) / self.dx)
        return State(np.zeros(n + 1), H, Instant(float(row[1]), last, 0.0, 0, 0.0))

    def _reference_state(self) -> State:
        """Steady state of the widest dry contact at the speed of the first instant."""
        from tribodyn.ehl._kernel.transient import Instant

        solution = solve_line_contact(
            self.scale.load,
            self.scale.radius,
            float(self.inputs.entrainment_speed[0]),
            self.lubricant,
            self.modulus,
            nodes=self.nodes,
            domain=self.domain,
            inlet=self.inlet,
            viscosity_law=self.law,
            compressible=self.compressible,
        )
        grid = solution._grid
        instant = Instant(grid.H0, grid.free, 0.5 * np.pi, 0, 0.0)
        return State(grid.P.copy(), grid.H.copy(), instant)

    def _carry(self, state: State, first: Array, row: Array, imposed: bool, depth: float) -> None:
        """Carry a steady state from one set of inputs to another, in place."""
        from tribodyn.ehl._kernel.transient import follow_contact

        none, ends = np.zeros((0, 0)), np.stack((first, row))
        status, _, state.instant = stoppable(
            follow_contact, self.kernel_contact(imposed, depth), _RATIO, np.zeros(0), ends, 0, 0,
            np.zeros(0), state.P, state.H, state.instant, none, none, none,
        )  # fmt: skip
        if status != 0:
            raise self.start_failure(REASONS[status])

    def start_failure(self, reason: str) -> ComputationError:
        """Error of a steady state of the first instant that was not reached."""
        inputs = self.inputs
        return ComputationError(
            f"The steady state of the first instant, t = {inputs.time[0]:.6g} s, was "
            f"not found: {reason}",
            why=f"load {inputs.load[0]:.6g} N/m, radius {inputs.radius[0]:.6g} m, "
            f"entrainment speed {inputs.entrainment_speed[0]:.6g} m/s",
            remedy="Begin with a moderate load and without roughness, or take more nodes",
        )
