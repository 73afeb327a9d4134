"""A spectrum of a recorded signal: its lines, their meaning and their peaks."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.spectrum_peaks import Peak, interpolated_peaks
from tribodyn.types import Array


@record
class SignalSpectrum(Record):
    """Single-sided spectrum of a recorded signal.

    Parameters
    ----------
    frequency : (k,) array
        Frequency [Hz].
    amplitude : (k,) array
        Peak amplitude in the unit of the signal, or what ``scaling`` says.
    phase : (k,) array or None
        Phase of the cosine at the first sample [rad]; None for an average.
    scaling : str
        ``"amplitude"``, ``"power"`` (mean square) or ``"density"`` (mean square per hertz).
    window : str
        Name of the window.
    noise_bandwidth : float
        Width of the ideal filter that passes as much noise as one line [Hz].
    averages : int
        Number of blocks.
    window_length : int
        Samples of one block.
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    frequency: Array = quantity("frequency", unit="Hz", axis=True)
    amplitude: Array = quantity("frequency", unit="@value_unit")
    phase: Array | None = None
    scaling: str = "amplitude"
    window: str = fact(default="boxcar")
    noise_bandwidth: float = fact(default=0.0)
    averages: int = fact(default=1)
    window_length: int = 0
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        start = 1 if self.frequency[0] == 0.0 else 0
        top = start + int(np.argmax(self.amplitude[start:]))
        return (
            f"SignalSpectrum({self.frequency.size} lines to {self.frequency[-1]:.6g} Hz, largest "
            f"{self.amplitude[top]:.4g} {self.value_unit} at {self.frequency[top]:.6g} Hz)"
        ).replace("  ", " ")

    @property
    def value_unit(self) -> str:
        """Unit of the values: of the signal, its square, or its square per hertz."""
        square = f"({self.unit})^2" if self.unit else ""
        density = f"{square}/Hz" if square else "1/Hz"
        return {"amplitude": self.unit, "power": square, "density": density}[self.scaling]

    def peaks(self, count: int = 5) -> list[Peak]:
        """Largest peaks, with the frequency and the amplitude between the lines.

        Parameters
        ----------
        count : int
            Most peaks to return.

        Returns
        -------
        list of Peak
            From the largest down.

        Raises
        ------
        InputError
            If the values are no amplitudes of the lines of a whole block.

        Notes
        -----
        The three lines of a peak are those that one sine makes through the window: exact for a
        sine alone, and good while the next one is further away than the main lobe.
        """
        require_positive("count", count)
        if self.scaling != "amplitude" or not self.window_length:
            raise InputError(
                Problem(
                    what=f"peaks of a spectrum with the scaling {self.scaling}",
                    where="SignalSpectrum.peaks",
                    why="They are interpolated on amplitudes over the lines of a whole block",
                    remedy='Use scaling="amplitude" of tribodyn.analysis.spectrum',
                )
            )
        return interpolated_peaks(
            self.frequency, self.amplitude, self.phase, self.window, self.window_length, count
        )

    def _array_name(self) -> str:
        return self.scaling
