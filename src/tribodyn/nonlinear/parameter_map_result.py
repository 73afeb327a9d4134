"""What a map over two parameters is: period, rms, contact loss and a verdict at every point."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, Index, Mask


@record
class ParameterMap(Record):
    """Motions over two parameters; every array is (nx, ny) unless said otherwise.

    Parameters
    ----------
    names, units : tuple of two str
        Parameters and their units.
    first, second : (nx,), (ny,) array
        Their values [Hz or -, or as ``units`` says].
    period : int array
        Mesh cycles after which the motion repeats; 0 if it does not.
    rms : array
        Alternating rms of the signal [m or rad]; NaN for a motion that grew beyond all bounds.
    contact_loss_share : array
        Part of the time off the driving flank [-].
    steps : int array
        Steps per mesh cycle.
    step_number : array
        ``omega_max * dt`` [-].
    verdict : str array
        ``"physical"``, ``"step-limited"``, ``"undecided"``; empty if not asked for.
    signal : str
        Name of what rms and contact loss are of, a contact or a coordinate.
    finished : bool array
        Which motions are there; all of them unless the work was interrupted.
    """

    names: tuple[str, str]
    units: tuple[str, str]
    first: Array = quantity("first", axis=True)
    second: Array = quantity("second", axis=True)
    period: Index = quantity("first", "second", unit="1")
    rms: Array = quantity("first", "second", unit="m or rad")
    contact_loss_share: Array = quantity("first", "second", unit="1")
    steps: Index = quantity("first", "second", unit="1")
    step_number: Array = quantity("first", "second", unit="1")
    verdict: NDArray[np.str_] = quantity("first", "second")
    signal: str = fact()
    finished: Mask = quantity("first", "second")

    @property
    def complete(self) -> bool:
        """Whether every motion is there."""
        return bool(self.finished.all())

    @property
    def ran_away(self) -> Mask:
        """Which motions grew beyond all bounds without the step's doing, (nx, ny)."""
        lost = self.finished & ~np.isfinite(self.rms)
        return np.asarray(lost & (self.verdict != "step-limited"))

    def verdicts(self) -> dict[str, int]:
        """Count the verdicts.

        Returns
        -------
        dict of str to int
            Only those that occur.
        """
        words, counts = np.unique(self.verdict, return_counts=True)
        return {str(w): int(c) for w, c in zip(words, counts, strict=True) if w}

    def __repr__(self) -> str:
        """One line."""
        words = [f"{count} {word}" for word, count in self.verdicts().items()]
        words += [f"{lost} ran away"] if (lost := int(self.ran_away.sum())) else []
        return (
            f"ParameterMap({self.first.size} values of {self.names[0]} x {self.second.size} of "
            f"{self.names[1]}{': ' if words else ''}{', '.join(words)}"
            f"{'' if self.complete else ', interrupted'})"
        )

    def _parts(self) -> Parts:
        return super()._parts().over(self.names, self.units)
