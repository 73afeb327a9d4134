"""The response: states and contact forces over a periodic orbit or over time."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.motion import (
    Forces,
    WithinSteps,
    clearance,
    forces,
    has_gap,
    sides,
    with_middles,
    within_steps,
)
from tribodyn.dynamics.equations.step_limit import LIMIT
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array, ComplexArray, Index, Mask


@dataclass(frozen=True)
class FineSamples:
    """Both ends and the middle of every step, with weights of Simpson's rule.

    At events the left and the right value are separate samples, so that means, mean squares and
    harmonics keep the fourth order of the integrator. Where a contact opens or closes, two
    neighbouring steps are sampled as the part before and the part after that.

    Parameters
    ----------
    phase, time, weight : (3 * steps,) array
        Mesh phase counted from the start [cycles], time [s], weight (sum 1).
    position, velocity, acceleration : (3 * steps, n) array
        Coordinates and their derivatives [m or rad, ...].
    deflection, contact_force : (3 * steps, contacts) array
        Compression [m] and force [N] of the contacts.
    """

    phase: Array
    time: Array
    weight: Array
    position: Array
    velocity: Array
    acceleration: Array
    deflection: Array
    contact_force: Array

    def mean(self, signal: Array) -> Array:
        """Mean over time of a signal of shape (3 * steps, ...).

        Parameters
        ----------
        signal : array
            Any signal on the samples.

        Returns
        -------
        array
            In the unit of the signal.
        """
        if signal.ndim == 1:
            return np.asarray(self.weight @ signal)
        means = self.weight @ signal.reshape(len(signal), -1)
        return np.asarray(means.reshape(signal.shape[1:]))


def sample_extremes(signal: Array) -> tuple[Array, Array]:
    """Minimum and maximum of (3 s, ...), including the vertices of the parabolas of the steps."""
    steps = signal.reshape(-1, 3, *signal.shape[1:])
    least, greatest = signal.min(axis=0), signal.max(axis=0)
    bend = steps[:, 0] - 2.0 * steps[:, 1] + steps[:, 2]
    reach = 0.5 * np.abs(bend)  # largest distance of a vertex from the middle value
    beyond = (steps[:, 1] + reach > greatest) | (steps[:, 1] - reach < least)
    rows = np.flatnonzero(beyond.any(axis=tuple(range(1, beyond.ndim))))
    (left, middle, right), bend = np.moveaxis(steps[rows], 1, 0), bend[rows]
    slope = right - left
    inside = np.abs(slope) < 2.0 * np.abs(bend)
    vertex = np.where(inside, middle - slope**2 / (8.0 * np.where(inside, bend, 1.0)), middle)
    values = np.concatenate((least[None], greatest[None], vertex))
    return values.min(axis=0), values.max(axis=0)


@record
class Response(Record):
    """Motion of a system over one periodic orbit or over time.

    Values are those at the left end of every step; at an event they are the values after it.

    Parameters
    ----------
    time : (s,) array
        Time [s].
    phase : (s,) array
        Mesh phase in [0, 1).
    position, velocity, acceleration : (s, n) array
        Coordinates and their derivatives [m or rad, ...].
    deflection : (s, contacts) array
        Compression of each contact [m].
    contact_force : (s, contacts) array
        Force of each contact [N].
    names : tuple of str
        Names of the coordinates.
    mesh_frequency : float
        Mesh frequency [Hz].
    periods : int
        Mesh cycles in the record.
    fine : FineSamples
        Samples for means and harmonics.
    step_number : float
        ``omega_max * dt`` of the integration [-].
    error : float
        Certified distance to the exact periodic orbit of the stepped system over its size [-];
        NaN for a transient.
    converged : bool
        Whether the orbit meets its tolerance; False for a transient.
    floquet_multipliers : (m,) array
        Multipliers of the orbit; empty for a transient.
    cycles_used : int
        Integrated mesh cycles in total; lanes that are integrated together count once.
    search_cycles : int
        Integrated mesh cycles before Newton's method converged.
    extra_force : (n,) array
        Generalized force that the torque balance added [N or N*m].
    period : int
        Mesh cycles after which the orbit repeats, at most ``periods``; 0 for a transient.
    step_error : float
        Distance to the orbit at half the step over its size [-]: the discretisation error;
        infinite without such an orbit, NaN for a transient and an orbit that is not converged.
    engine : str
        Method that computed the motion: the name of a time integration engine or
        "harmonic-balance".
    reason : str
        Why a case whose engine is "auto" has this one.
    """

    time: Array = quantity("time", unit="s", axis=True)
    phase: Array = quantity("time", unit="1", axis=True)
    position: Array = quantity("time", "coordinate", unit="m or rad")
    velocity: Array = quantity("time", "coordinate", unit="m/s or rad/s")
    acceleration: Array = quantity("time", "coordinate", unit="m/s^2 or rad/s^2")
    deflection: Array = quantity("time", "contact", unit="m")
    contact_force: Array = quantity("time", "contact", unit="N")
    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    mesh_frequency: float = fact()
    periods: int = fact()
    fine: FineSamples
    step_number: float = fact(name="omega_max_dt")
    error: float = fact(name="steady_state_error", default=float("nan"))
    converged: bool = False
    floquet_multipliers: ComplexArray = field(default_factory=lambda: np.zeros(0, dtype=complex))
    cycles_used: int = 0
    search_cycles: int = 0
    extra_force: Array = field(default_factory=lambda: np.zeros(0))
    period: int = 0
    step_error: float = fact(default=float("nan"))
    engine: str = fact(default="runge-kutta-4")
    reason: str = field(default="", kw_only=True)

    @property
    def duration(self) -> float:
        """Length of the record [s]."""
        return self.periods / self.mesh_frequency

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle; False for a transient.

        The free rotation of the whole drive has no multiplier.
        """
        multipliers = np.abs(self.floquet_multipliers)
        return bool(multipliers.size) and bool(multipliers.max() < 1.0)

    def index(self, name: str) -> int:
        """Column of the coordinate called ``name``.

        Parameters
        ----------
        name : str

        Returns
        -------
        int
        """
        return self.names.index(name)

    def __repr__(self) -> str:
        """One line."""
        kind = "orbit" if self.period else "transient"
        state = f", error {self.error:.1e}" if kind == "orbit" else ""
        if not np.isnan(self.step_error):
            state += f", step error {self.step_error:.1e}"
        return (
            f"Response({kind} of {self.periods} mesh cycle{'s' if self.periods != 1 else ''} at "
            f"{self.mesh_frequency:.6g} Hz, {self.position.shape[1]} coordinates, "
            f"{self.time.size} steps{state})"
        )


def build_response(
    compiled: Compiled,
    mesh_frequency: float,
    states: Array,
    extra_force: Array,
    within: tuple[Array, Array] | None = None,
    **facts: Any,
) -> Response:
    """Evaluate contact forces and accelerations along recorded states."""
    # within: position and velocity at both ends and in the middle of all steps, each
    # (cycles, steps, 3, n), in place of an interpolation between the states.
    nodes = compiled.nodes
    cycles = (states.shape[0] - 1) // compiled.grid.steps
    size = compiled.system.size
    samples = _step_samples(compiled, mesh_frequency, states, extra_force, within)
    fine = _without_jumps(samples, compiled, mesh_frequency, states, extra_force)

    return Response(
        time=samples.time[::3],
        phase=np.tile(nodes.phase[:, 0], cycles),
        position=states[:-1, :size].copy(),
        velocity=states[:-1, size:].copy(),
        acceleration=samples.acceleration[::3],
        deflection=samples.deflection[::3],
        contact_force=samples.contact_force[::3],
        names=tuple(compiled.system.names),
        mesh_frequency=mesh_frequency,
        periods=cycles,
        fine=fine,
        step_number=compiled.step_number,
        extra_force=extra_force,
        **facts,
    )


def later(response: Response, begin: float) -> Response:
    """Shift the times of a response by ``begin``."""
    fine = replace(response.fine, time=response.fine.time + begin)
    return replace(response, time=response.time + begin, fine=fine) if begin else response


def _step_samples(
    compiled: Compiled,
    mesh_frequency: float,
    states: Array,
    extra_force: Array,
    within: tuple[Array, Array] | None,
) -> FineSamples:
    nodes, grid = compiled.nodes, compiled.grid
    cycles = (states.shape[0] - 1) // grid.steps
    rows = [states[c * grid.steps : (c + 1) * grid.steps + 1] for c in range(cycles)]
    ends = np.stack(rows) if cycles > 1 else states[None]
    q, v = with_middles(grid.width / mesh_frequency, ends) if within is None else within
    moved = forces(compiled.system, nodes, mesh_frequency, q, v, extra=extra_force)
    phase = np.arange(cycles)[:, None, None] + nodes.phase
    weight = np.broadcast_to(nodes.weight / cycles, phase.shape)
    parts = _named(phase, q, v, moved) | {"weight": weight}
    count = 3 * cycles * grid.steps
    flat = {name: values.reshape(count, *values.shape[3:]) for name, values in parts.items()}
    return FineSamples(time=flat["phase"] / mesh_frequency, **flat)


def _named(phase: Array, q: Array, v: Array, moved: Forces) -> dict[str, Array]:
    """Samples by their names in :class:`FineSamples`."""
    return {
        "phase": phase, "position": q, "velocity": v, "acceleration": moved.acceleration,
        "deflection": moved.deflection, "contact_force": moved.contact,
    }  # fmt: skip


def _without_jumps(
    samples: FineSamples, compiled: Compiled, mesh_frequency: float, states: Array, extra: Array
) -> FineSamples:
    """Divide the samples where a contact opens or closes instead of at the nearest step."""
    nodes, steps = compiled.nodes, compiled.grid.steps
    dead = has_gap(nodes)
    if not dead.any():
        return samples
    ends = samples.deflection.reshape(-1, steps, 3, dead.size)[:, :, ::2]
    if np.all(ends > nodes.gap[:, ::2]):
        return samples
    at_ends = sides(ends, nodes.gap[:, ::2], dead).reshape(-1, 2, dead.size)
    new = resample_crossings(compiled, mesh_frequency, states, extra, at_ends)
    if new is None:
        return samples
    step, parts = new
    for name, values in parts.items():
        old = getattr(samples, name)
        every = old.reshape(-1, 3, *old.shape[1:]).copy()
        every[step] = values
        parts[name] = every.reshape(old.shape)
    return FineSamples(time=parts["phase"] / mesh_frequency, **parts)


_HALVINGS = 48
#: Contacts that cross within this fraction of a step cross together.
_TOGETHER = 1e-9


def resample_crossings(
    compiled: Compiled, mesh_frequency: float, states: Array, extra_force: Array, sides: Array
) -> tuple[Index, dict[str, Array]] | None:
    """Three samples for each step in which a contact opens or closes, and for a neighbour of it."""
    crossed = np.any(sides[:, 0] != sides[:, 1], axis=1)
    if not crossed.any() or compiled.step_number > LIMIT:
        return None
    step, forward = _with_neighbours(crossed, compiled.grid.after_event)
    parts = compiled.system, compiled.nodes, compiled.grid
    points = WithinSteps(*parts, mesh_frequency, extra_force)
    tau = _crossing(points, step, states[step], sides[step, 0], sides[step, 1])
    inside = (tau > 1e-6) & (tau < 1.0 - 1e-6)
    step, forward, tau = step[inside], forward[inside], tau[inside]
    if step.size == 0:
        return None
    before, after = sides[step, 0], sides[step, 1]
    middle = points.advance(step, np.zeros(step.size), tau, states[step], before)
    grid = compiled.grid
    at = np.concatenate((grid.left, [1.0]))[step % grid.steps]
    cycle = step // grid.steps
    cut = cycle + at + tau * grid.width[step % grid.steps]
    first = np.where(forward, step, step - 1)
    outer = grid.left[first % grid.steps]
    end = cycle + outer + grid.width[first % grid.steps] + grid.width[(first + 1) % grid.steps]
    left = _part(points, step, (cycle + outer, cut), (states[first], middle), before)
    right = _part(points, step, (cut, end), (middle, states[first + 2]), after)
    new = {name: np.concatenate((values, right[name])) for name, values in left.items()}
    width = new["phase"][:, 2] - new["phase"][:, 0]
    new["weight"] = np.multiply.outer(width, [1.0, 4.0, 1.0])
    new["weight"] *= grid.steps / (6.0 * len(sides))
    return np.concatenate((first, first + 1)), new


def _with_neighbours(crossed: Mask, after_event: Mask) -> tuple[Index, Mask]:
    """Steps with a crossing that have a free neighbour, and whether it is the next one."""
    count, steps = crossed.size, after_event.size
    used = crossed.copy()
    chosen, forward = [], []
    for step in np.flatnonzero(crossed):
        following = step + 1
        if following < count and not after_event[following % steps] and not used[following]:
            used[following] = True
            chosen.append(step)
            forward.append(True)
        elif step > 0 and not after_event[step % steps] and not used[step - 1]:
            used[step - 1] = True
            chosen.append(step)
            forward.append(False)
    return np.array(chosen, dtype=np.int64), np.array(forward, dtype=bool)


def _crossing(points: WithinSteps, step: Index, state: Array, before: Array, after: Array) -> Array:
    """Fraction of each step at which its contacts leave their sides; 0 if they differ."""
    end = points.advance(step, np.zeros(step.size), np.ones(step.size), state, before)
    of, contact = np.nonzero(before != after)  # all crossings in one batch
    ends = (each[of] for each in (*np.split(state, 2, axis=1), *np.split(end, 2, axis=1)))
    (q0, v0, q1, v1), h = ends, points.duration(step)[of, None]
    pressed = points.contact_of_each(step[of], contact)
    sides_of_crossing = before[of, contact], after[of, contact]

    def distance(tau: Array) -> Array:
        """Clearance of the contacts at fractions of the steps in which they cross."""
        t = tau[:, None]
        q = (1.0 + 2.0 * t) * (1.0 - t) ** 2 * q0 + t**2 * (3.0 - 2.0 * t) * q1
        q = q + h * t * (1.0 - t) * ((1.0 - t) * v0 - t * v1)
        return clearance(*pressed(tau, q), *sides_of_crossing)

    low, high = np.zeros(of.size), np.ones(of.size)
    beyond = distance(low) <= 0.0
    for _ in range(_HALVINGS):
        tau = 0.5 * (low + high)
        inside = distance(tau) > 0.0
        low, high = np.where(inside, tau, low), np.where(inside, high, tau)
    places = np.full(before.shape, np.nan)
    places[of, contact] = np.where(beyond, 0.0, low)
    first, last = np.nanmin(places, axis=1), np.nanmax(places, axis=1)
    return np.where(last - first < _TOGETHER, first, 0.0)


def _part(
    points: WithinSteps,
    step: Index,
    phase: tuple[Array, Array],
    ends: tuple[Array, Array],
    side: Array,
) -> dict[str, Array]:
    """Both ends and the middle of a part of two steps, on one side of the contacts."""
    duration = (phase[1] - phase[0])[:, None] / points.beat
    q, v = (item[:, 0] for item in with_middles(duration, np.stack(ends, axis=1)))
    at = np.stack((phase[0], 0.5 * (phase[0] + phase[1]), phase[1]), axis=1)
    number, tau = within_steps(points.grid, step // points.grid.steps, at)
    return _named(at, q, v, points.forces(number, tau, q, v, side[:, None]))
