"""Steady motions over the speed, as met on the way up and on the way down."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Motions whose rms differs by more than this are different motions.
_DIFFERENT = 1e-3


@dataclass(frozen=True)
class Jump:
    """Where the motion of a slow sweep leaves its orbit.

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
        Mesh cycles per revolution of the shaft whose speed is told.
    directions : tuple of str
        ``"up"`` and ``"down"``, as far as they were asked for; ``b`` of them.
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
        Mesh cycles after which the motion repeats; 0 if it was not found to.
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
        Where the motion left its orbit.
    names : tuple of str
        Names of the coordinates.
    step_number : float
        Largest ``omega_max * dt`` [-].
    """

    mesh_frequency: Array = quantity("mesh_frequency", unit="Hz", axis=True)
    teeth: int = fact()
    directions: tuple[str, ...]
    signals: tuple[str, ...]
    units: tuple[str, ...]
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
    names: tuple[str, ...]
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
            raise InputError(
                Problem(
                    what=f'no signal "{signal}"',
                    where="argument signal",
                    why=f"There are {', '.join(self.signals)}",
                )
            )
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
        told = ", ".join(f"{count} {words}" for words, count in marks if count)
        return (
            f"SpeedSweep({self.mesh_frequency.size} speeds, {low:.6g} to {high:.6g} Hz, "
            f"{' and '.join(self.directions)}{': ' if told else ''}{told})"
        )

    def _parts(self) -> Parts:
        variables, coordinates, _ = parts = super()._parts()
        both = ("direction", "mesh_frequency", "multiplier")
        variables["multiplier_real"] = (both, self.floquet_multipliers.real, {"units": "1"})
        variables["multiplier_imaginary"] = (both, self.floquet_multipliers.imag, {"units": "1"})
        coordinates["direction"] = list(self.directions)
        coordinates["speed"] = ("mesh_frequency", self.speed, {"units": "rad/s"})
        coordinates["signal"], coordinates["coordinate"] = list(self.signals), list(self.names)
        coordinates["unit"] = ("signal", list(self.units))
        return parts
