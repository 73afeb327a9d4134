"""Steady motions over the speed: a slow sweep upwards and downwards."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.running_up.run_up import read_outputs
from tribodyn.dynamics.running_up.run_up_tables import Tables, systems_by_frequency
from tribodyn.dynamics.running_up.speed_sweep_follow import Followed, Follower, SpeedFamily, follow
from tribodyn.dynamics.time.simulate import read_start
from tribodyn.errors import InputError, no_such, require_positive
from tribodyn.interrupt import in_threads
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Mesh cycles of the figures of a motion that does not repeat.
_IRREGULAR = 64
#: Motions whose rms differs by more than this are different motions.
_DIFFERENT = 1e-3


def speed_sweep(
    system: System | Mapping[float, System],
    mesh_frequency: ArrayLike,
    *,
    teeth: int = 1,
    directions: Sequence[str] = ("up", "down"),
    start: tuple[ArrayLike, ArrayLike] | None = None,
    steps: int | None = None,
    periods: Sequence[int] = (1, 2, 4),
    patience: int = 600,
    tolerance: float = 1e-8,
    outputs: Mapping[str, ArrayLike] | None = None,
    output_unit: str = "N",
    progress: Progress = SILENT,
) -> SpeedSweep:
    """Compute the steady motions over the speed, upwards and downwards, with their stability.

    Parameters
    ----------
    system : System or mapping of float to System
        One system, or several by mesh frequency [Hz]: between two of them the rows are blended.
    mesh_frequency : (p,) array
        Mesh frequencies, rising [Hz].
    teeth : int
        Mesh cycles per revolution of the shaft whose speed is reported; by default figures show
        the mesh frequency.
    directions : sequence of "up", "down"
        Directions of the sweep.
    start : (position, velocity), optional
        State from which the integration starts at the first speed of every direction [m or rad,
        m/s or rad/s]; by default the orbit without loss of contact, else rest.
    steps : int, optional
        Steps per mesh cycle at all speeds; by default each speed has as many as it needs
        (``omega_max * dt`` up to 0.35, at least 256).
    periods : sequence of int
        Numbers of mesh cycles after which motions may repeat.
    patience : int
        Mesh cycles in which a motion may settle after it has left its orbit.
    tolerance : float
        Largest certified error of an orbit.
    outputs : mapping of str to (2 n,) array, optional
        Further linear outputs of (position, velocity), for example bearing forces [N/m, N*s/m].
    output_unit : str
        Their unit.
    progress : Progress
        Receives the progress over the speeds.

    Raises
    ------
    InputError
        If the mesh frequencies do not rise, an argument is out of range or the step is too long.
    ComputationError
        If the motion grows beyond all bounds.

    Notes
    -----
    Without dead zones the map over a mesh cycle is linear: all speeds and all columns of their
    matrices are integrated in one batch, and an orbit may be unstable. With dead zones this gives
    the orbits without loss of contact; each direction then follows its motion from speed to speed
    with Newton's method. Where the motion is lost or becomes unstable, it is integrated from the
    last orbit until it repeats: a jump, or a motion of several mesh cycles. Unlike
    :func:`continuation` a sweep shows stable motions only and does not turn back at a fold.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=lambda p: 1.0 + 0.2 * np.cos(2 * np.pi * p), gap=1.0)
    >>> system = System([[1.0]], [[0.1]], [[0.0]], [0.5], [pair])
    >>> found = speed_sweep(system, np.linspace(0.82, 0.92, 21) / (2 * np.pi))
    >>> [(jump.direction, round(2 * np.pi * jump.before, 3)) for jump in found.jumps]
    [('up', 0.905), ('down', 0.835)]
    """
    frequency = np.atleast_1d(np.asarray(mesh_frequency, dtype=float))
    require_positive("mesh_frequency", frequency, "Hz")
    if frequency.ndim != 1 or np.any(np.diff(frequency) <= 0.0):
        why = "A sweep goes through them in order"
        remedy = "Sort them, and choose the direction by the argument directions"
        raise InputError("the mesh frequencies do not rise", "argument mesh_frequency", why, remedy)
    if not directions or any(each not in ("up", "down") for each in directions):
        what, why = f"directions = {directions}", '"up", "down" or both'
        raise InputError(what, "argument directions", why, "Choose one or two of these")
    require_positive("teeth", teeth)
    require_positive("patience", patience)
    table_frequencies, systems = systems_by_frequency(system)
    linear = read_outputs(outputs, systems[0])
    tables = Tables(systems, 1, float(frequency[0]), steps)
    family = SpeedFamily(tables, table_frequencies, frequency)
    progress.start("Speeds", frequency.size * (1 if family.affine else len(directions)))
    closed = family.all_at_once(tolerance)
    valid = closed.error <= tolerance
    valid = valid if family.affine else _in_contact(family, closed.point, valid)
    follower = Follower(family, closed, valid, tolerance, patience, sorted({1, *periods}))
    followed = _follow_all(follower, directions, start, progress)
    labels = _signals(systems[0], tuple(outputs or ()), output_unit)
    return _result(family, followed, linear, labels, tuple(directions), teeth)


def _follow_all(
    follower: Follower,
    directions: Sequence[str],
    start: tuple[ArrayLike, ArrayLike] | None,
    progress: Progress,
) -> list[list[Followed]]:
    """Motions of every direction in the order of the speeds."""
    family, closed, count = follower.family, follower.closed, follower.valid.size
    if family.affine:
        mapping = family.mapping(0, 1)
        orbits = [
            Followed(point, mapping.multipliers(matrix), float(error), 1)
            for point, matrix, error in zip(closed.point, closed.matrix, closed.error, strict=True)
        ]
        progress.advance(count)
        progress.finish()
        return [orbits] * len(directions)
    begin = None
    if start is not None:
        begin = family.mapping(0, 1).start(read_start(family.system, start))
    lock = Lock()

    def report_speed() -> None:
        with lock:
            progress.advance()

    def follow_direction(direction: str) -> list[Followed]:
        order = range(count) if direction == "up" else range(count)[::-1]
        met = follow(follower, order, begin, report_speed)
        return met if direction == "up" else met[::-1]

    followed = in_threads(follow_direction, directions, len(directions))
    progress.finish()
    return followed


def _in_contact(family: SpeedFamily, point: Array, converged: Mask) -> Mask:
    """Mark the speeds with a converged orbit that never leaves the driving flanks."""
    number = np.flatnonzero(converged)
    periods = np.ones(number.size, dtype=np.int64)
    no_outputs = np.zeros((0, 2 * family.system.size))
    figures = family.statistics(number, point[number], periods, 1, no_outputs)
    contacts = len(family.system.contacts)
    lost = figures[contacts : 2 * contacts, 4].max(axis=0)
    valid = np.zeros(converged.size, dtype=bool)
    valid[number] = lost <= 0.0
    return valid


def _result(
    family: SpeedFamily,
    followed: list[list[Followed]],
    linear: Array,
    labels: tuple[tuple[str, ...], tuple[str, ...]],
    directions: tuple[str, ...],
    teeth: int,
) -> SpeedSweep:
    system, count = family.system, family.frequency.size
    flat = [each for met in followed for each in met]
    number = np.tile(np.arange(count), len(followed))
    point = np.array([each.point for each in flat])
    period = np.array([each.period for each in flat], dtype=np.int64)
    figures = family.statistics(number, point, period, _IRREGULAR, linear)
    state, extra = family.split(number, point, period)
    mean, square, low, high, off = np.moveaxis(figures, 1, 0)

    def shaped(values: object) -> Any:
        """Directions, speeds and the rest."""
        values = np.asarray(values)
        return values.reshape(len(followed), count, *values.shape[1:])

    contacts = len(system.contacts)
    return SpeedSweep(
        mesh_frequency=family.frequency,
        teeth=int(teeth),
        directions=directions,
        signals=labels[0],
        units=labels[1],
        mean=shaped(mean.T),
        rms=shaped(np.sqrt(np.maximum(square - mean**2, 0.0)).T),
        peak_to_peak=shaped((high - low).T),
        maximum=shaped(high.T),
        contact_loss=shaped(off[contacts : 2 * contacts].T),
        period=shaped(period),
        stable=shaped([each.stable for each in flat]),
        floquet_multipliers=shaped([each.multipliers for each in flat]),
        error=shaped([each.error for each in flat]),
        position=shaped(state[:, : system.size]),
        velocity=shaped(state[:, system.size :]),
        extra_force=shaped(extra),
        jumps=_jumps(family.frequency, followed, directions),
        names=tuple(system.names),
        step_number=max(
            family.compiled(k).step_number / float(family.frequency[k]) for k in range(count)
        ),
    )


def _signals(
    system: System, outputs: tuple[str, ...], unit: str
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    contacts = len(system.contacts)
    ends = [""] if contacts == 1 else [f"_{j}" for j in range(contacts)]
    names = [f"{kind}{end}" for kind in ("deflection", "contact_force") for end in ends[:contacts]]
    turning = ["rad/s^2" if "theta" in name else "m/s^2" for name in system.names]
    units = [*["m"] * contacts, *["N"] * contacts, *turning, *[unit] * len(outputs)]
    return (*names, *system.names, *outputs), tuple(units)


def _jumps(
    frequency: Array, followed: list[list[Followed]], directions: tuple[str, ...]
) -> tuple[Jump, ...]:
    jumps: list[Jump] = []
    for direction, met in zip(directions, followed, strict=True):
        turn = 1 if direction == "up" else -1
        beats, orbits = frequency[::turn], met[::turn]
        for k in range(1, len(orbits)):
            new = orbits[k]
            if new.jumped and (new.period or orbits[k - 1].period):
                jumps.append(Jump(direction, float(beats[k - 1]), float(beats[k]), new.period))
    return tuple(jumps)


@dataclass(frozen=True)
class Jump:
    """Speed at which the motion of a slow sweep leaves its orbit.

    Parameters
    ----------
    direction : "up" or "down"
        Direction of the sweep.
    before, after : float
        The two neighbouring mesh frequencies [Hz].
    period : int
        Mesh cycles after which the new motion repeats; 0 if it does not.
    """

    direction: str
    before: float
    after: float
    period: int


@record
class SpeedSweep(Record):
    """Steady motions over the speed in both directions.

    Parameters
    ----------
    mesh_frequency : (p,) array
        Mesh frequencies [Hz].
    teeth : int
        Mesh cycles per revolution of the shaft whose speed is reported.
    directions : tuple of str
        The requested ones of ``"up"`` and ``"down"``; ``b`` of them.
    signals : tuple of str
        Names of the signals: compressions, contact forces, accelerations, outputs.
    units : tuple of str
        Their units.
    mean, rms, peak_to_peak : (b, p, signals) array
        Mean, alternating rms and range, in the unit of the signal.
    maximum : (b, p, signals) array
        Largest value, in the unit of the signal.
    contact_loss : (b, p, contacts) array
        Part of the time off the driving flank [-].
    period : (b, p) int array
        Mesh cycles after which the motion repeats; 0 if it does not.
    stable : (b, p) bool array
        Whether all multipliers lie inside the unit circle.
    floquet_multipliers : (b, p, m) complex array
        Over one period, the largest first; NaN for motions that do not repeat.
    error : (b, p) array
        Certified distance to the orbit over its size [-].
    position, velocity : (b, p, n) array
        State at mesh phase 0 [m or rad, m/s or rad/s].
    extra_force : (b, p, n) array
        Generalized force that balances the drive [N or N*m].
    jumps : tuple of Jump
        Speeds at which the motion left its orbit.
    names : tuple of str
        Names of the coordinates.
    step_number : float
        Largest ``omega_max * dt`` [-].
    """

    mesh_frequency: Array = quantity("mesh_frequency", unit="Hz", axis=True)
    teeth: int = fact()
    directions: tuple[str, ...] = quantity("direction", axis=True, name="direction")
    signals: tuple[str, ...] = quantity("signal", axis=True, name="signal")
    units: tuple[str, ...] = quantity("signal", axis=True, name="unit")
    mean: Array = quantity("direction", "mesh_frequency", "signal")
    rms: Array = quantity("direction", "mesh_frequency", "signal")
    peak_to_peak: Array = quantity("direction", "mesh_frequency", "signal")
    maximum: Array = quantity("direction", "mesh_frequency", "signal")
    contact_loss: Array = quantity("direction", "mesh_frequency", "contact", unit="1")
    period: Index = quantity("direction", "mesh_frequency", unit="1")
    stable: Mask = quantity("direction", "mesh_frequency")
    floquet_multipliers: ComplexArray
    error: Array = quantity("direction", "mesh_frequency", unit="1")
    position: Array = quantity("direction", "mesh_frequency", "coordinate", unit="m or rad")
    velocity: Array = quantity("direction", "mesh_frequency", "coordinate", unit="m/s or rad/s")
    extra_force: Array = quantity("direction", "mesh_frequency", "coordinate", unit="N or N*m")
    jumps: tuple[Jump, ...]
    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    step_number: float

    @property
    def speed(self) -> Array:
        """Speed of the shaft, (p,) [rad/s]."""
        return 2.0 * np.pi * self.mesh_frequency / self.teeth

    @property
    def differs(self) -> Mask:
        """Speeds at which the two directions meet different motions, (p,)."""
        if len(self.directions) < 2:
            return np.zeros(self.mesh_frequency.size, dtype=bool)
        first, second = self.rms[0, :, 0], self.rms[1, :, 0]
        largest = np.maximum(np.maximum(first, second), 1e-300)
        return np.asarray(np.abs(first - second) > _DIFFERENT * largest)

    def of(self, signal: str) -> int:
        """Column of a signal.

        Parameters
        ----------
        signal : str

        Returns
        -------
        int

        Raises
        ------
        InputError
            If there is no such signal.
        """
        if signal not in self.signals:
            raise InputError(no_such("signal", signal, self.signals, "argument signal"))
        return self.signals.index(signal)

    def __repr__(self) -> str:
        """One line."""
        low, high = self.mesh_frequency.min(), self.mesh_frequency.max()
        marks = [
            ("not stable", int(np.count_nonzero(~self.stable))),
            ("jumps", len(self.jumps)),
            ("of several cycles", int(np.count_nonzero(self.period > 1))),
            ("that do not repeat", int(np.count_nonzero(self.period == 0))),
            ("with loss of contact", int(np.count_nonzero(self.contact_loss.max(-1, initial=0)))),
        ]
        summary = ", ".join(f"{count} {label}" for label, count in marks if count)
        return (
            f"SpeedSweep({self.mesh_frequency.size} speeds, {low:.6g} to {high:.6g} Hz, "
            f"{' and '.join(self.directions)}{': ' if summary else ''}{summary})"
        )

    def _parts(self) -> Parts:
        variables, coordinates, _ = parts = super()._parts()
        axes = ("direction", "mesh_frequency", "multiplier")
        variables["multiplier_real"] = (axes, self.floquet_multipliers.real, {"units": "1"})
        variables["multiplier_imaginary"] = (axes, self.floquet_multipliers.imag, {"units": "1"})
        coordinates["speed"] = ("mesh_frequency", self.speed, {"units": "rad/s"})
        return parts
