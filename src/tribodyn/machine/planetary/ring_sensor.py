"""Signal of a sensor on the ring, which planets pass: modulation and sidebands."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, real_numbers, require_between, require_positive
from tribodyn.machine.planetary.positions import read_angles
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array


@record
class RingSensorSignal(Record):
    """Signal of a sensor on the ring over one turn of the carrier relative to it.

    Parameters
    ----------
    turn : (s,) array
        Rotation of the carrier, in turns [1].
    signal : (s,) array
        Sum of the ring mesh forces, weighted by the distance of the planets from the sensor [N].
    order : (k,) array
        Cycles in a turn of the carrier relative to the ring [1].
    amplitude : (k,) array
        Amplitude of each order [N].
    ring_teeth : int
        Order of the mesh frequency.
    carrier_frequency : float
        Turns of the carrier relative to the ring per second [Hz].
    """

    turn: Array = quantity("turn", unit="1", axis=True)
    signal: Array = quantity("turn", unit="N")
    order: Array = quantity("order", unit="1", axis=True)
    amplitude: Array = quantity("order", unit="N")
    ring_teeth: int = fact()
    carrier_frequency: float = fact()

    def sidebands(self, harmonic: int = 1, reach: int = 6) -> dict[int, float]:
        """Amplitudes of the orders about a harmonic of the mesh frequency.

        Parameters
        ----------
        harmonic : int
            Of the mesh frequency.
        reach : int
            Orders of the carrier on both sides.

        Returns
        -------
        dict of int to float
            Distance from the harmonic in orders of the carrier to amplitude [N].
        """
        middle = harmonic * self.ring_teeth
        return {m: float(self.amplitude[middle + m]) for m in range(-reach, reach + 1)}


def ring_sensor_signal(
    *,
    ring_mesh_force: ArrayLike,
    ring_teeth: int,
    angles: ArrayLike | None = None,
    sensor_angle: float = 0.0,
    window: float | Callable[[Array], Array] | None = None,
    carrier_frequency: float = 1.0,
    backwards: bool = False,
) -> RingSensorSignal:
    """Compute the signal of a sensor on the held ring from the forces of the ring meshes.

    Parameters
    ----------
    ring_mesh_force : (s, N) array
        Force of every ring mesh at equal steps of a mesh cycle [N].
    ring_teeth : int
        Number of teeth of the ring, with or without its minus sign.
    angles : (N,) array, optional
        Angles of the planets at the beginning [rad]; equally spaced by default.
    sensor_angle : float
        Angle of the sensor [rad].
    window : float or function, optional
        Angle over which the sensor feels a passing planet, with the weight of Hann [rad], by
        default a whole turn; or the weight as a function of the angle from the planet to the
        sensor between -pi and pi.
    carrier_frequency : float
        Turns of the carrier relative to the ring per second [Hz].
    backwards : bool
        Whether the carrier turns towards smaller angles relative to the ring.

    Returns
    -------
    RingSensorSignal

    Raises
    ------
    InputError
        If an argument is out of range.

    Notes
    -----
    The signal is ``sum_i w(theta - psi_i) F_i``, periodic with a turn of the carrier. With the
    Fourier coefficients ``w_m`` of the weight, planet i adds ``F_il w_m exp(-i m psi_i)`` to
    order ``l z_r + m``. At equal spacing all add up where ``(l z_r + m)/N`` is whole, and cancel
    elsewhere: the sidebands are not symmetric about a harmonic unless ``l z_r/N`` is
    whole, and the harmonic itself is missing. Sources: McFadden and Smith (1985); Inalpolat and
    Kahraman (2009), whose weight has a width of 2 pi/N.

    Examples
    --------
    >>> phase = np.arange(64) / 64
    >>> force = np.cos(2 * np.pi * (phase[:, None] + np.array([0, 1, 2]) * 61 / 3))
    >>> signal = ring_sensor_signal(ring_mesh_force=force, ring_teeth=61)
    >>> {m: round(a, 3) for m, a in signal.sidebands(reach=2).items()}
    {-2: 0.0, -1: 0.75, 0: 0.0, 1: 0.0, 2: 0.0}
    """
    force = real_numbers(Argument("ring_mesh_force"), ring_mesh_force, "forces in N")
    if force.ndim != 2 or force.shape[0] < 8:
        what = f"ring_mesh_force has the shape {force.shape}"
        remedy = "Give at least 8 equal steps of a mesh cycle by planets"
        raise InputError(what, Argument("ring_mesh_force"), "It is (steps, planets)", remedy)
    teeth = require_whole("ring_teeth", abs(ring_teeth), 4)
    require_positive("carrier_frequency", carrier_frequency, "Hz")
    steps, count = force.shape
    at = read_angles(count, angles)
    turn = np.arange(teeth * steps) / (teeth * steps)
    weight = passing_weights(at, -turn if backwards else turn, sensor_angle, window)
    signal = (weight * np.tile(force, (teeth, 1))).sum(axis=1)
    amplitude = 2.0 * np.abs(np.fft.rfft(signal)) / signal.size
    amplitude[0] *= 0.5
    order = np.arange(amplitude.size, dtype=float)
    return RingSensorSignal(turn, signal, order, amplitude, teeth, float(carrier_frequency))


def passing_weights(
    angles: Array, turn: Array, sensor_angle: float, window: float | Callable[[Array], Array] | None
) -> Array:
    """Weight of each planet at a sensor on the ring over the turns of the carrier (s, N)."""
    away = require_number("sensor_angle", sensor_angle) - angles - 2.0 * np.pi * turn[:, None]
    return _weight(window)((away + np.pi) % (2.0 * np.pi) - np.pi)


def _weight(window: float | Callable[[Array], Array] | None) -> Callable[[Array], Array]:
    """Weight over the angle between planet and sensor."""
    if callable(window):
        return window
    width = 2.0 * np.pi if window is None else require_number("window", window)
    require_between("window", width, 1e-3, 2.0 * np.pi, "rad")
    inside = 0.5 * width

    def hann(angle: Array) -> Array:
        """Weight of Hann within the window."""
        return np.where(np.abs(angle) < inside, 0.5 + 0.5 * np.cos(np.pi * angle / inside), 0.0)

    return hann
