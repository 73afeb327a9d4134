"""The response: states and contact forces over a periodic orbit or over time."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.motion import forces, has_gap, sides, with_middles
from tribodyn.dynamics.time.response_crossings import resample_crossings
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    import xarray


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
        return np.asarray(np.tensordot(self.weight, signal, axes=(0, 0)))


@dataclass(frozen=True)
class Response:
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
        Mesh cycles that were marched to find the orbit; lanes marched at a time count once.
    search_cycles : int
        Those of them that came before Newton's method found the orbit.
    extra_force : (n,) array
        Generalized force that the torque balance added [N or N*m].
    period : int
        Mesh cycles after which the orbit repeats, at most ``periods``; 0 for a transient.
    """

    time: Array
    phase: Array
    position: Array
    velocity: Array
    acceleration: Array
    deflection: Array
    contact_force: Array
    names: tuple[str, ...]
    mesh_frequency: float
    periods: int
    fine: FineSamples = field(repr=False)
    step_number: float
    error: float = float("nan")
    converged: bool = False
    floquet_multipliers: ComplexArray = field(default_factory=lambda: np.zeros(0, dtype=complex))
    cycles_used: int = 0
    search_cycles: int = 0
    extra_force: Array = field(default_factory=lambda: np.zeros(0))
    period: int = 0

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
        kind = "orbit" if self.floquet_multipliers.size else "transient"
        state = f", error {self.error:.1e}" if kind == "orbit" else ""
        return (
            f"Response({kind} of {self.periods} mesh cycle{'s' if self.periods != 1 else ''} at "
            f"{self.mesh_frequency:.6g} Hz, {self.position.shape[1]} coordinates, "
            f"{self.time.size} steps{state})"
        )

    def to_xarray(self) -> xarray.Dataset:
        """Return the series as an :class:`xarray.Dataset` with units.

        Returns
        -------
        xarray.Dataset
            Dimensions ``time``, ``coordinate`` and ``contact``.
        """
        import xarray

        coordinate, contact = ("time", "coordinate"), ("time", "contact")
        data: dict[str, Any] = {
            "position": (coordinate, self.position, {"units": "m or rad"}),
            "velocity": (coordinate, self.velocity, {"units": "m/s or rad/s"}),
            "acceleration": (coordinate, self.acceleration, {"units": "m/s^2 or rad/s^2"}),
            "deflection": (contact, self.deflection, {"units": "m"}),
            "contact_force": (contact, self.contact_force, {"units": "N"}),
        }
        coords: dict[str, Any] = {
            "time": ("time", self.time, {"units": "s"}),
            "phase": ("time", self.phase, {"units": "1"}),
            "coordinate": list(self.names),
        }
        attributes = {
            "mesh_frequency": self.mesh_frequency,
            "periods": self.periods,
            "steady_state_error": self.error,
            "omega_max_dt": self.step_number,
        }
        return xarray.Dataset(data, coords, attributes)


def build_response(
    compiled: Compiled, mesh_frequency: float, states: Array, extra_force: Array, **facts: Any
) -> Response:
    """Evaluate contact forces and accelerations along recorded states."""
    nodes, steps = compiled.nodes, compiled.grid.steps
    cycles = (states.shape[0] - 1) // steps
    size = compiled.system.size
    whole = _step_samples(compiled, mesh_frequency, states, extra_force)
    fine = _without_jumps(whole, compiled, mesh_frequency, states, extra_force)

    def left(values: Array) -> Array:
        return values.reshape(cycles * steps, 3, values.shape[-1])[:, 0]

    return Response(
        time=whole.time.reshape(-1, 3)[:, 0],
        phase=np.tile(nodes.phase[:, 0], cycles),
        position=states[:-1, :size].copy(),
        velocity=states[:-1, size:].copy(),
        acceleration=left(whole.acceleration),
        deflection=left(whole.deflection),
        contact_force=left(whole.contact_force),
        names=tuple(compiled.system.names),
        mesh_frequency=mesh_frequency,
        periods=cycles,
        fine=fine,
        step_number=compiled.step_number,
        extra_force=extra_force,
        **facts,
    )


def later(response: Response, begin: float) -> Response:
    """A response whose record begins at a time."""
    fine = replace(response.fine, time=response.fine.time + begin)
    return replace(response, time=response.time + begin, fine=fine) if begin else response


def _step_samples(
    compiled: Compiled, mesh_frequency: float, states: Array, extra_force: Array
) -> FineSamples:
    nodes, grid = compiled.nodes, compiled.grid
    cycles = (states.shape[0] - 1) // grid.steps
    ends = states[np.arange(cycles)[:, None] * grid.steps + np.arange(grid.steps + 1)]
    q, v = with_middles(grid.width / mesh_frequency, ends)
    moved = forces(compiled.system, nodes, mesh_frequency, q, v, extra=extra_force)
    phase = np.arange(cycles)[:, None, None] + nodes.phase
    weight = np.broadcast_to(nodes.weight / cycles, phase.shape)

    def flat(values: Array) -> Array:
        return values.reshape(3 * cycles * grid.steps, values.shape[-1])

    return FineSamples(
        phase=phase.reshape(-1),
        time=phase.reshape(-1) / mesh_frequency,
        weight=weight.reshape(-1),
        position=flat(q),
        velocity=flat(v),
        acceleration=flat(moved.acceleration),
        deflection=flat(moved.deflection),
        contact_force=flat(moved.contact),
    )


def _without_jumps(
    whole: FineSamples, compiled: Compiled, mesh_frequency: float, states: Array, extra: Array
) -> FineSamples:
    """Part the samples where a contact opens or closes instead of at the nearest step."""
    nodes, steps = compiled.nodes, compiled.grid.steps
    dead = has_gap(nodes)
    if not dead.any():
        return whole
    ends = whole.deflection.reshape(-1, steps, 3, dead.size)[:, :, ::2]
    at_ends = sides(ends, nodes.gap[:, ::2], dead).reshape(-1, 2, dead.size)
    new = resample_crossings(compiled, mesh_frequency, states, extra, at_ends)
    if new is None:
        return whole

    def replaced(values: Array, by: Array) -> Array:
        out = values.reshape(-1, 3, *values.shape[1:]).copy()
        out[new.step] = by
        return out.reshape(values.shape)

    phase = replaced(whole.phase, new.phase)
    return FineSamples(
        phase=phase,
        time=phase / mesh_frequency,
        weight=replaced(whole.weight, new.weight),
        position=replaced(whole.position, new.position),
        velocity=replaced(whole.velocity, new.velocity),
        acceleration=replaced(whole.acceleration, new.forces.acceleration),
        deflection=replaced(whole.deflection, new.forces.deflection),
        contact_force=replaced(whole.contact_force, new.forces.contact),
    )
