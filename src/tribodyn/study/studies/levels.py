"""Levels of a machine over its speed: forces, errors and accelerations, and their mesh lines."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.record import Record, quantity, record
from tribodyn.study.machine.modes import STRAINED, MeshOrder
from tribodyn.types import Array, Texts

if TYPE_CHECKING:
    from tribodyn.machine import MachineModes
    from tribodyn.study.machine.motion import MachineMotion

#: Harmonics of each mesh that are followed over the speed.
_HARMONICS = 4
#: Most resonances that are named, and their least weight over that of the strongest.
_MOST, _LEAST = 8, 0.08


class Resonance(NamedTuple):
    """A mesh harmonic that meets a natural mode."""

    mesh: str
    harmonic: int
    mode: int  #: counted from 1
    frequency: float  #: [Hz]
    speed: float  #: of the input [rad/s]


@record
class MachineLevels(Record):
    """Levels of a machine over the speed of its input; of steady motions, or along a run-up.

    Parameters
    ----------
    speed : (n,) array
        Speed of the input [rad/s].
    mesh, bearing, node : tuple of str
        Names of meshes, bearings and nodes of the housing.
    line : tuple of str
        Mesh harmonics that are followed: ``first x 1``, ...
    order : (k,) array
        Waves of each line in a turn of the input [1].
    mesh_force : (n, meshes) array
        Root mean square of the alternating mesh force [N].
    transmission_error : (n, meshes) array
        Greatest less least transmission error [m].
    bearing_force : (n, bearings) array
        Root mean square of the alternating radial force [N].
    acceleration : (n, nodes) array
        Root mean square of the acceleration, all directions [m/s^2].
    mesh_force_line : (n, k, meshes) array
        Amplitude at each line [N].
    transmission_error_line : (n, k, meshes) array
        Amplitude at each line [m].
    bearing_force_line : (n, k, bearings) array
        Amplitude of the radial force at each line [N].
    acceleration_line : (n, k, nodes) array
        Amplitude of the acceleration at each line, all directions [m/s^2].
    failed : (n,) array of str
        Why a speed has no motion; empty if it has one.
    time : (n,) array, optional
        Time of a run-up [s]; None for steady motions.
    modes : MachineModes, optional
        Natural modes with the mesh stiffness of one speed in the range.
    mesh_orders : tuple of MeshOrder
        Mesh harmonics, each with its share in the strain energy of the modes.

    Notes
    -----
    Of a planetary stage the meshes are ``sun`` and ``ring``, and the bearings ``pins`` and the
    supports of the members, each with the greatest value of all planets.
    """

    speed: Array = quantity("speed", unit="rad/s", axis=True)
    mesh: tuple[str, ...] = quantity("mesh", unit="", axis=True)
    bearing: tuple[str, ...] = quantity("bearing", unit="", axis=True)
    node: tuple[str, ...] = quantity("node", unit="", axis=True)
    line: tuple[str, ...] = quantity("line", unit="", axis=True)
    order: Array = quantity("line", unit="1")
    mesh_force: Array = quantity("speed", "mesh", unit="N")
    transmission_error: Array = quantity("speed", "mesh", unit="m")
    bearing_force: Array = quantity("speed", "bearing", unit="N")
    acceleration: Array = quantity("speed", "node", unit="m/s^2")
    mesh_force_line: Array = quantity("speed", "line", "mesh", unit="N")
    transmission_error_line: Array = quantity("speed", "line", "mesh", unit="m")
    bearing_force_line: Array = quantity("speed", "line", "bearing", unit="N")
    acceleration_line: Array = quantity("speed", "line", "node", unit="m/s^2")
    failed: Texts = quantity("speed", unit="")
    time: Array | None = quantity("speed", unit="s", default=None)
    modes: MachineModes | None = field(default=None, repr=False)
    mesh_orders: tuple[MeshOrder, ...] = field(default=(), repr=False)

    @property
    def resonances(self) -> list[Resonance]:
        """Mesh harmonics that meet a mode within the range, the strongest few.

        One counts by the amplitude of its line at the bearings there, and by how much the mode
        strains the mesh.
        """
        if self.modes is None:
            return []
        frequency = self.modes.frequency
        lines = self.bearing_force_line if self.bearing else self.mesh_force_line
        order = np.argsort(self.speed)
        size = dict(zip(self.line, np.sqrt((lines[order] ** 2).sum(axis=2)).T, strict=True))

        def weight(mesh: str, harmonic: int, speed: float, share: float) -> float:
            row = np.nan_to_num(size[f"{mesh} x {harmonic}"])
            return float(np.interp(speed, self.speed[order], row)) * float(np.sqrt(share))

        ends = float(self.speed.min()), float(self.speed.max())
        return resonances(frequency, self.mesh_orders, ends, weight)

    def __repr__(self) -> str:
        """One line."""
        rpm = 30.0 / np.pi
        kind = "steady motions" if self.time is None else "periods of a run-up"
        lost = int(sum(bool(text) for text in self.failed))
        return (
            f"MachineLevels({self.speed.size} {kind} at {rpm * self.speed.min():.6g} to "
            f"{rpm * self.speed.max():.6g} rpm, meshes {', '.join(self.mesh)}"
            f"{f', {lost} failed' if lost else ''})"
        )


def resonances(
    frequency: Array,
    orders: Iterable[MeshOrder],
    ends: tuple[float, float],
    weight: Callable[[str, int, float, float], float] = lambda mesh, harmonic, speed, share: (
        share / harmonic
    ),
) -> list[Resonance]:
    """Mesh harmonics that meet a mode at an input speed between two ends, the strongest few."""
    # weight: of mesh, harmonic, speed, and share of the mesh in the strain energy of the mode.
    low, high = ends
    weights: list[tuple[float, Resonance]] = []
    for mesh, harmonic, order, share in orders:
        for number, hertz in enumerate(frequency.tolist()):
            speed, part = 2.0 * np.pi * hertz / order, float(share[number])
            if low <= speed <= high and part > STRAINED:
                met = Resonance(mesh, harmonic, number + 1, hertz, speed)
                weights.append((weight(mesh, harmonic, speed, part), met))
    weights.sort(key=lambda pair: -pair[0])
    return [met for value, met in weights[:_MOST] if value >= _LEAST * weights[0][0] > 0.0]


def levels_of(motions: Iterable[MachineMotion | None], speed: Array, **more: Any) -> MachineLevels:
    """Levels of motions over the speed, which are needed one at a time; None has none."""
    rows: list[list[Array] | None] = []
    first, orders, lines = None, np.zeros(0), []
    for motion in motions:
        if motion is not None and first is None:
            first, turning = motion, abs(float(speed[len(rows)])) / (2.0 * np.pi)
            harmonics = np.arange(1, _HARMONICS + 1)
            lines = [f"{name} x {harmonic}" for name in motion.mesh for harmonic in harmonics]
            orders = np.outer(motion.mesh_frequency, harmonics).reshape(-1) / turning
        rows.append(None if motion is None else _levels(motion))
    if first is None:
        what, why = "no speed of the range has a motion", "Each of them failed"
        remedy = "Run the case at one of them, which says why"
        raise ComputationError(what, "operation.speed", why, remedy)
    blank = [np.full_like(values, np.nan) for values in next(row for row in rows if row)]
    columns = [np.stack(part) for part in zip(*(row or blank for row in rows), strict=True)]
    more = {"failed": np.full(speed.size, "", dtype=object), **more}
    parts = first.mesh, first.bearing, first.node, tuple(lines)
    fields: list[Any] = [*parts, orders, *columns]
    return MachineLevels(speed, *fields, **more)


def _levels(motion: MachineMotion) -> list[Array]:
    """Levels of one motion and amplitudes at its mesh harmonics, in the order of the fields."""
    orders = np.outer(motion.cycles, np.arange(1, _HARMONICS + 1)).reshape(-1)
    radial = motion.bearing_force[..., 1:3]
    signals = (motion.mesh_force, motion.transmission_error, radial, motion.acceleration)
    force, _, bearing, acceleration = (motion.rms(signal) for signal in signals)
    swing = np.ptp(motion.transmission_error, axis=0)
    waves = [np.abs(motion.harmonics(signal, orders)) for signal in signals]
    waves[2:] = [np.sqrt((wave**2).sum(axis=-1)) for wave in waves[2:]]
    totals = (np.sqrt((part**2).sum(axis=-1)) for part in (bearing, acceleration))
    return [force, swing, *totals, *waves]
