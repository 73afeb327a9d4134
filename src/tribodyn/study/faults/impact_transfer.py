"""What a sensor of a machine receives of an impact in a bearing, through the machine."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribodyn.dynamics.linear.linear_system import linear_system
from tribodyn.study.faults.recording import anti_alias
from tribodyn.types import Array, ComplexArray, Index

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.study.faults.machine_signals import MachineTurningMotion
    from tribodyn.study.faults.sensors import SensorPlace

#: Eigenvalues below this share of the largest are those of free motions.
_FREE = 1e-12
#: Size to which a response decays, and its longest duration [s].
_DECAYED, _LONGEST = 1e-3, 4.0
#: Samples of a response for each of the recording, and those before the impact: the filter is not
#: causal.
_OVERSAMPLED, _BEFORE = 16, 64


class FreeStructure:
    """A machine with closed meshes at their mean stiffness, under forces on its coordinates."""

    def __init__(self, system: System) -> None:
        from scipy.linalg import eigh

        linear = linear_system(system)
        squares, shape = eigh(linear.stiffness, linear.mass)
        swings = squares > _FREE * squares.max()
        damping = linear.damping + (0.0 if linear.gyroscopic is None else linear.gyroscopic)
        # Free rotations have velocities alone: their positions act on nothing.
        self.shape, self.swings = shape, swings
        self.rate = float(np.sqrt(squares.max()))
        count, size = int(swings.sum()), len(squares)
        state = np.zeros((count + size, count + size))
        state[:count, count:] = self.rate * np.eye(size)[swings]
        state[count:, :count] = -np.diag(squares)[:, swings] / self.rate
        state[count:, count:] = -shape.T @ damping @ shape
        self.values, self.right = np.linalg.eig(state)
        self.left = np.linalg.inv(self.right)

    @property
    def duration(self) -> float:
        """Time after which the slowest vibration has decayed [s]."""
        rates = -self.values.real[np.abs(self.values.imag) > 0.0]
        slowest = float(rates.min(initial=np.inf))
        return min(-math.log(_DECAYED) / slowest, _LONGEST) if slowest > 0.0 else _LONGEST

    def motion(self, frequency: Array, force: Array) -> tuple[ComplexArray, ComplexArray]:
        """Positions, without free rotations, and velocities (k, n) under a unit force (n,)."""
        count = int(self.swings.sum())
        loads = self.left[:, count:] @ (self.shape.T @ force)
        state = (loads / (2j * np.pi * frequency[:, None] - self.values)) @ self.right.T
        position = (state[:, :count] / self.rate) @ self.shape[:, self.swings].T
        return position, state[:, count:] @ self.shape.T


def impact_spectrum(
    motion: MachineTurningMotion, bearing: str, place: SensorPlace, frequency: Array
) -> ComplexArray:
    """Signal of a sensor per newton of a force that presses the rings of a bearing apart (k,)."""
    structure, free = motion.sound.structure, motion.free_structure
    relative = structure.bearing(bearing)
    along = np.zeros(6)
    along[:3] = load_direction(motion, bearing)
    position, velocity = free.motion(frequency, -relative.T @ along)
    omega = 2.0 * np.pi * frequency
    if place.quantity == "acceleration":
        row = place.direction @ structure.housing_node(place.part)[:3]
        return np.asarray(1j * omega * (velocity @ row))
    if place.quantity == "force":
        part = motion.machine.bearings[place.part]
        move = structure.bearing(place.part).T
        springs = (position @ move @ part.stiffness_matrix)[:, :3] @ place.direction
        dampers = (velocity @ move @ part.damping_matrix)[:, :3] @ place.direction
        direct = float(along[:3] @ place.direction) if place.part == bearing else 0.0
        force = springs + dampers + direct
        return np.asarray(force if place.seat is None else force * place.seat(frequency))
    if place.quantity == "mesh_force":
        return np.asarray(position @ structure.mesh(place.part)) * structure.mesh_stiffness(
            place.part
        )
    from tribodyn.study.machine.motion import mesh_rotation

    return np.asarray(position @ mesh_rotation(structure, place.part))


def load_direction(motion: MachineTurningMotion, bearing: str) -> Array:
    """Direction in which the shaft presses on a bearing across its axis; y without a load."""
    sound = motion.sound.motion
    force = sound.mean(sound.bearing_force[:, sound.bearing.index(bearing)])[:3]
    force[0] = 0.0
    size = float(np.linalg.norm(force))
    return np.asarray(force / size) if size > 0.0 else np.array([0.0, 1.0, 0.0])


def pulse(frequency: Array, force: float, duration: float) -> ComplexArray:
    """Spectrum of half a sine of a force [N*s]."""
    turns = frequency * duration
    offset = 1.0 - (2.0 * turns) ** 2
    pole = np.abs(offset) < 1e-9
    size = np.where(pole, 0.25 * np.pi, np.cos(np.pi * turns) / np.where(pole, 1.0, offset))
    return np.asarray(2.0 / np.pi * force * duration * size * np.exp(-1j * np.pi * turns))


class ImpactResponse(NamedTuple):
    """Response of a sensor to an impact, filtered as the recording is."""

    at: Callable[[Array], Array]  #: over the time since a little before the impact [s]
    duration: float  #: [s]


def impact_response(
    motion: MachineTurningMotion,
    bearing: str,
    place: SensorPlace,
    half_sine: tuple[float, float],
    sample_rate: float,
) -> ImpactResponse:
    """Response of a sensor to half a sine of force and duration in a bearing."""
    count = int(2 ** np.ceil(np.log2(motion.free_structure.duration * sample_rate + 4 * _BEFORE)))
    frequency: Array = np.arange(count // 2 + 1, dtype=float) * (sample_rate / count)
    lines = impact_spectrum(motion, bearing, place, frequency) * pulse(frequency, *half_sine)
    lines *= anti_alias(frequency / sample_rate)
    lines *= np.exp(-2j * np.pi * frequency * (_BEFORE / sample_rate))
    dense = _OVERSAMPLED * sample_rate
    values = np.fft.irfft(lines, _OVERSAMPLED * count) * dense
    length: Index = np.arange(values.size)

    def at(since: Array) -> Array:
        return np.interp(since * dense, length, values)

    return ImpactResponse(at, count / sample_rate)
