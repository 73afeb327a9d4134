"""Campbell diagram: where mesh harmonics meet natural frequencies."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.linear.linear_system import ModePhase
from tribodyn.dynamics.linear.natural_modes import natural_modes
from tribodyn.errors import InputError, require_positive
from tribodyn.record import Parts, Record, quantity, record
from tribodyn.types import Array


@dataclass(frozen=True)
class Resonance:
    """One speed at which a mesh harmonic meets a natural frequency.

    Parameters
    ----------
    speed : float
        Speed of the shaft [rad/s].
    mesh_frequency : float
        Mesh frequency there [Hz].
    frequency : float
        Natural frequency [Hz].
    order : int
        Mesh harmonic.
    mode : int
        Number of the mode, counted with the rigid ones from 0.
    contact_share : float
        Share of the contacts in the strain energy: errors of the mesh excite a mode through it.
    damping_ratio : float
        Part of the critical damping of the mode [1].
    """

    speed: float
    mesh_frequency: float
    frequency: float
    order: int
    mode: int
    contact_share: float
    damping_ratio: float

    def __repr__(self) -> str:
        """One line, in the units of engineers."""
        return (
            f"Resonance(order {self.order} meets mode {self.mode} of {self.frequency:.6g} Hz at "
            f"{30.0 / np.pi * self.speed:.6g} rpm)"
        )


@record
class Campbell(Record):
    """Natural frequencies over speed, mesh-order lines and where they cross.

    Parameters
    ----------
    speed : (s,) array
        Speeds of the shaft [rad/s].
    mesh_frequency : (s,) array
        Mesh frequencies [Hz].
    orders : tuple of int
        Mesh harmonics.
    frequency : (s, modes) array
        Elastic natural frequencies [Hz].
    contact_share : (s, modes) array
        Share of the contacts in the strain energy.
    damping_ratio : (s, modes) array
        Part of the critical damping [1].
    first_mode : int
        Number of the first elastic mode, which is the number of rigid ones.
    resonances : tuple of Resonance
        All crossings, sorted by speed.
    operating_speed : float, optional
        Speed that the figure marks [rad/s].

    Examples
    --------
    >>> from tribodyn.dynamics import System
    >>> one = System([[1.0]], [[0.0]], [[(2 * np.pi * 100.0) ** 2]], [0.0])
    >>> campbell(one, [1.0, 40.0], teeth=20, orders=(1, 2))
    Campbell(1 elastic mode, 2 orders, 2 resonances)
    """

    speed: Array = quantity("speed", unit="rad/s", axis=True)
    mesh_frequency: Array = quantity("speed", unit="Hz")
    orders: tuple[int, ...]
    frequency: Array = quantity("speed", "mode", unit="Hz")
    contact_share: Array = quantity("speed", "mode", unit="1")
    damping_ratio: Array = quantity("speed", "mode", unit="1")
    first_mode: int
    resonances: tuple[Resonance, ...]
    operating_speed: float | None = None

    def __repr__(self) -> str:
        """One line."""
        modes, lines, met = self.frequency.shape[1], len(self.orders), len(self.resonances)

        def several(count: int, noun: str) -> str:
            return f"{count} {noun}{'s' if count != 1 else ''}"

        return (
            f"Campbell({several(modes, 'elastic mode')}, {several(lines, 'order')}, "
            f"{several(met, 'resonance')})"
        )

    def _parts(self) -> Parts:
        parts = super()._parts()
        parts.coordinates["mode"] = self.first_mode + np.arange(self.frequency.shape[1])
        return parts


def campbell(
    system: System | Callable[[float], System],
    speed: ArrayLike,
    *,
    teeth: int,
    orders: Iterable[int] = (1, 2, 3, 4, 5),
    phase: ModePhase = "mean",
) -> Campbell:
    """Find the speeds at which mesh harmonics meet natural frequencies.

    Parameters
    ----------
    system : System or function
        A function takes the speed [rad/s] and returns the system there, for a stiffness or
        gyroscopic moments that change with speed.
    speed : (s,) array
        Rising speeds of the shaft [rad/s].
    teeth : int
        Teeth of the gear on that shaft.
    orders : iterable of int
        Mesh harmonics.
    phase : "mean" or float
        Contact stiffness: mean over the mesh cycle, or that at one mesh phase in [0, 1).

    Raises
    ------
    InputError
        If the speeds are not positive and rising, fewer than two, ``teeth`` or an order is not
        positive, or there is no order.

    Notes
    -----
    Gyroscopic moments of the system count; as they change with speed, give a function of the speed.
    Between two speeds the frequencies of a function are interpolated linearly.

    Examples
    --------
    >>> one = System([[1.0]], [[0.0]], [[(2 * np.pi * 100.0) ** 2]], [0.0])
    >>> diagram = campbell(one, [1.0, 40.0], teeth=20, orders=(1, 2))
    >>> [round(met.mesh_frequency, 9) for met in diagram.resonances]
    [50.0, 100.0]
    """
    lines = tuple(int(order) for order in orders)
    if not lines:
        what, why = "orders is empty", "Each line of the diagram belongs to one order"
        raise InputError(what, "argument orders", why, "Give for example orders=(1, 2, 3)")
    require_positive("teeth", teeth, "")
    require_positive("orders", np.asarray(lines), "")
    speeds = _rising(speed)
    if callable(system):
        modes = [natural_modes(system(float(each)), phase=phase) for each in speeds]
    else:
        modes = [natural_modes(system, phase=phase)] * speeds.size
    first = max(each.rigid for each in modes)
    mesh = teeth * speeds / (2.0 * np.pi)
    frequency = np.array([each.frequency[first:] for each in modes])
    share = np.array([each.contact_share[first:] for each in modes])
    ratio = np.array([each.damping_ratio[first:] for each in modes])
    met = [
        Resonance(at, beat, order * beat, order, first + mode, float(part), float(damped))
        for order in lines
        for mode in range(frequency.shape[1])
        for place in _crossings(order * mesh - frequency[:, mode])
        for at, beat, part, damped in [
            tuple(_between(row, place) for row in (speeds, mesh, share[:, mode], ratio[:, mode]))
        ]
    ]
    return Campbell(
        speed=speeds,
        mesh_frequency=mesh,
        orders=lines,
        frequency=frequency,
        contact_share=share,
        damping_ratio=ratio,
        first_mode=first,
        resonances=tuple(sorted(met, key=lambda each: (each.speed, each.order))),
    )


def _rising(speed: ArrayLike) -> Array:
    speeds = np.atleast_1d(np.asarray(speed, dtype=float))
    require_positive("speed", speeds, "rad/s")
    if speeds.size < 2 or np.any(np.diff(speeds) <= 0.0):
        raise InputError(
            "the speeds do not rise" if speeds.size > 1 else "there is only one speed",
            where="argument speed",
            why="The diagram spans a range of speeds",
            remedy="Give at least two rising speeds",
        )
    return speeds


def _crossings(distance: Array) -> list[float]:
    """Positions, counted in samples, at which a distance changes its sign."""
    below = distance < 0.0
    positions = []
    for left in np.flatnonzero(below[1:] != below[:-1]):
        a, b = float(distance[left]), float(distance[left + 1])
        positions.append(float(left) + a / (a - b))
    return positions


def _between(values: Array, place: float) -> float:
    left = min(int(place), values.size - 2)
    part = place - left
    return float((1.0 - part) * values[left] + part * values[left + 1])
