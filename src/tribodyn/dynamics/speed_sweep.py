"""Steady motions over the speed: what a slow sweep meets on the way up and on the way down."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.run_up import read_outputs
from tribodyn.dynamics.run_up_tables import Tables, systems_by_frequency
from tribodyn.dynamics.simulate import read_start
from tribodyn.dynamics.speed_sweep_family import SpeedFamily
from tribodyn.dynamics.speed_sweep_follow import Followed, follow
from tribodyn.dynamics.speed_sweep_result import Jump, SpeedSweep
from tribodyn.dynamics.system import System
from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.interrupt import in_threads
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, Mask

#: Mesh cycles of the figures of a motion that does not repeat.
_IRREGULAR = 64


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
    """Find the steady motions over the speed, up and down, with their stability.

    Parameters
    ----------
    system : System or mapping of float to System
        One system, or several by mesh frequency [Hz]: between two of them the rows are blended.
    mesh_frequency : (p,) array
        Mesh frequencies, rising [Hz].
    teeth : int
        Mesh cycles per revolution of the shaft whose speed is told.
    directions : sequence of "up", "down"
        Ways to go.
    start : (position, velocity), optional
        State from which the first speed of every direction is marched [m or rad, m/s or rad/s];
        by default the orbit without loss of contact, else rest.
    steps : int, optional
        Steps per mesh cycle at all speeds; by default each speed has as many as it needs
        (``omega_max * dt`` up to 0.35, at least 256).
    periods : sequence of int
        Numbers of mesh cycles after which motions may repeat.
    patience : int
        Mesh cycles that a motion gets to settle after it has left its orbit.
    tolerance : float
        Largest certified error of an orbit.
    outputs : mapping of str to (2 n,) array, optional
        Further linear outputs of (position, velocity), for example bearing forces [N/m, N*s/m].
    output_unit : str
        Their unit.
    progress : Progress
        Told about the speeds.

    Returns
    -------
    SpeedSweep

    Raises
    ------
    InputError
        If the mesh frequencies do not rise, an argument is out of range or the step is too long.
    ComputationError
        If the motion grows beyond all bounds.

    Notes
    -----
    Without dead zones the map over a mesh cycle is linear: all speeds and all columns of their
    matrices are marched side by side, and an orbit may be unstable. With dead zones this gives
    the orbits without loss of contact; each direction then follows its motion from speed to speed
    with Newton's method, and where it is lost or becomes unstable, the motion is marched on from
    the last one until it repeats: a jump, or a motion of several mesh cycles. Unlike
    :func:`continuation` it shows stable motions only and does not turn back at a fold.

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
        raise InputError(
            Problem(
                what="the mesh frequencies do not rise",
                where="argument mesh_frequency",
                remedy="Sort them; the direction is the matter of directions",
            )
        )
    if not directions or any(each not in ("up", "down") for each in directions):
        raise InputError(
            Problem(f"directions = {directions}", "argument directions", '"up", "down" or both')
        )
    require_positive("teeth", teeth)
    require_positive("patience", patience)
    known, systems = systems_by_frequency(system)
    linear = read_outputs(outputs, systems[0])
    tables = Tables(systems, 1, float(frequency[0]), steps)
    family = SpeedFamily(tables, known, frequency)
    found = _follow_all(
        family, directions, start, tolerance, patience, sorted({1, *periods}), progress
    )
    return _result(
        family, found, linear, tuple(outputs or ()), output_unit, tuple(directions), teeth
    )


def _follow_all(
    family: SpeedFamily, directions: Sequence[str],
    start: tuple[ArrayLike, ArrayLike] | None, tolerance: float, patience: int,
    periods: Sequence[int], progress: Progress,
) -> list[list[Followed]]:  # fmt: skip
    """Motions of every direction in the order of the speeds."""
    count = family.frequency.size
    progress.start("Sweeping the speed", count * (1 if family.affine else len(directions)))
    closed = family.all_at_once(tolerance)
    if family.affine:
        mapping = family.mapping(0, 1)
        orbits = [
            Followed(point, mapping.multipliers(matrix), float(error), 1)
            for point, matrix, error in zip(closed.point, closed.matrix, closed.error, strict=True)
        ]
        progress.advance(count)
        progress.finish()
        return [orbits] * len(directions)
    valid = _shut(family, closed.point, closed.error <= tolerance)
    begin = None
    if start is not None:
        begin = family.coordinates.reduce(read_start(family.system, start))
        begin = begin if family.balance is None else np.append(begin, 0.0)
    lock = Lock()

    def told() -> None:
        with lock:
            progress.advance()

    def one(direction: str) -> list[Followed]:
        order = range(count) if direction == "up" else range(count)[::-1]
        met = follow(
            family, order, closed, valid, start=begin, tolerance=tolerance, patience=patience,
            periods=periods, told=told,
        )  # fmt: skip
        return met if direction == "up" else met[::-1]

    found = in_threads(one, directions, len(directions))
    progress.finish()
    return found


def _shut(family: SpeedFamily, point: Array, converged: Mask) -> Mask:
    """Tell at which speeds an orbit was found that never leaves the driving flanks."""
    number = np.flatnonzero(converged)
    one, none = np.ones(number.size, dtype=np.int64), np.zeros((0, 2 * family.system.size))
    figures = family.statistics(number, point[number], one, 1, none)
    contacts = len(family.system.contacts)
    lost = figures[contacts : 2 * contacts, 4].max(axis=0)
    valid = np.zeros(converged.size, dtype=bool)
    valid[number] = lost <= 0.0
    return valid


def _result(
    family: SpeedFamily, found: list[list[Followed]], linear: Array, outputs: tuple[str, ...],
    output_unit: str, directions: tuple[str, ...], teeth: int,
) -> SpeedSweep:  # fmt: skip
    system, count = family.system, family.frequency.size
    flat = [each for met in found for each in met]
    number = np.tile(np.arange(count), len(found))
    point = np.array([each.point for each in flat])
    period = np.array([each.period for each in flat], dtype=np.int64)
    figures = family.statistics(number, point, period, _IRREGULAR, linear)
    state, extra = np.empty((len(flat), 2 * system.size)), np.empty((len(flat), system.size))
    for length in np.unique(np.maximum(period, 1)):
        lanes = np.maximum(period, 1) == length
        beat = family.frequency[number[lanes]]
        state[lanes], extra[lanes] = family.split(point[lanes], beat, int(length))
    mean, square, low, high, off = np.moveaxis(figures, 1, 0)

    def shaped(values: Any) -> Any:
        """Directions, speeds and the rest."""
        values = np.asarray(values)
        return values.reshape(len(found), count, *values.shape[1:])

    contacts = len(system.contacts)
    names, units = _signals(system, outputs, output_unit)
    return SpeedSweep(
        mesh_frequency=family.frequency,
        teeth=int(teeth),
        directions=directions,
        signals=names,
        units=units,
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
        jumps=_jumps(family.frequency, found, directions),
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
    turning = ["rad/s^2" if name.endswith("theta") else "m/s^2" for name in system.names]
    units = [*["m"] * contacts, *["N"] * contacts, *turning, *[unit] * len(outputs)]
    return (*names, *system.names, *outputs), tuple(units)


def _jumps(
    frequency: Array, found: list[list[Followed]], directions: tuple[str, ...]
) -> tuple[Jump, ...]:
    jumps: list[Jump] = []
    for direction, met in zip(directions, found, strict=True):
        turn = 1 if direction == "up" else -1
        beats, orbits = frequency[::turn], met[::turn]
        for k in range(1, len(orbits)):
            new = orbits[k]
            if new.jumped and (new.period or orbits[k - 1].period):
                jumps.append(Jump(direction, float(beats[k - 1]), float(beats[k]), new.period))
    return tuple(jumps)
