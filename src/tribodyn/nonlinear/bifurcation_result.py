"""What a bifurcation diagram holds: sections, periods, rms and verdicts over a parameter."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, Index, Mask


@record
class Bifurcation(Record):
    """Motions over a parameter; the first axis of every result is the branch.

    Parameters
    ----------
    parameter : (points,) array
        Values of the parameter, in the unit of ``parameter_unit``.
    parameter_name, parameter_unit : str
        What it is.
    mesh_frequency : (points,) array
        Mesh frequency [Hz].
    branches : tuple of str
        ``"up"``, ``"down"`` or ``"independent"``.
    signal : str
        Name of what was looked at, a contact or a coordinate.
    section : (branches, points, keep) array
        It once per mesh cycle, at the mesh phase 0 [m or rad].
    period : (branches, points) int array
        Mesh cycles after which the motion repeats; 0 if it does not repeat within 16.
    rms : (branches, points) array
        Its alternating rms [m or rad]; NaN for a motion that grew beyond all bounds.
    contact_loss_share : (branches, points) array
        Part of the time off the driving flank [-].
    step_number : (points,) array
        ``omega_max * dt`` [-].
    steps : (points,) int array
        Steps per mesh cycle.
    verdict : (branches, points) str array
        ``"physical"``, ``"step-limited"``, ``"undecided"``; empty words if not asked for.
    refined_period : (branches, points) int array
        Period of the same computation with ``refined_steps`` steps.
    refined_rms : (branches, points) array
        Rms of the same computation [m or rad].
    refined_steps : (points,) int array
        Twice the steps, or more where that is not yet stable.
    largest_exponent : (branches, points) array
        Largest Lyapunov exponent [1/s]; NaN if not asked for.
    finished : (branches, points) bool array
        Which motions are there; all of them unless the work was interrupted. The others have NaN,
        period 0 and an empty verdict.
    """

    parameter: Array = quantity("value", unit="@parameter_unit")
    parameter_name: str = fact()
    parameter_unit: str
    mesh_frequency: Array = quantity("value", unit="Hz")
    branches: tuple[str, ...]
    signal: str = fact()
    section: Array = quantity("branch", "value", "mesh_cycle", unit="m or rad")
    period: Index = quantity("branch", "value", unit="1")
    rms: Array = quantity("branch", "value", unit="m or rad")
    contact_loss_share: Array = quantity("branch", "value", unit="1")
    step_number: Array = quantity("value", unit="1")
    steps: Index = quantity("value", unit="1")
    verdict: NDArray[np.str_] = quantity("branch", "value")
    refined_period: Index = quantity("branch", "value", unit="1")
    refined_rms: Array = quantity("branch", "value", unit="m or rad")
    refined_steps: Index = quantity("value", unit="1")
    largest_exponent: Array = quantity("branch", "value", unit="1/s")
    finished: Mask = quantity("branch", "value")

    @property
    def complete(self) -> bool:
        """Whether every motion is there."""
        return bool(self.finished.all())

    @property
    def ran_away(self) -> Mask:
        """Which motions grew beyond all bounds without the step's doing, (branches, points)."""
        lost = self.finished & ~np.isfinite(self.rms)
        return np.asarray(lost & (self.verdict != "step-limited"))

    def __repr__(self) -> str:
        """One line."""
        low, high = self.parameter.min(), self.parameter.max()
        words = [f"{count} {word}" for word, count in self.verdicts().items()]
        words += [f"{lost} ran away"] if (lost := int(self.ran_away.sum())) else []
        return (
            f"Bifurcation({self.parameter.size} values of {self.parameter_name} from {low:.6g} to "
            f"{high:.6g} {self.parameter_unit}, {' and '.join(self.branches)}"
            f"{': ' if words else ''}{', '.join(words)}{'' if self.complete else ', interrupted'})"
        )

    def verdicts(self) -> dict[str, int]:
        """Count the verdicts.

        Returns
        -------
        dict of str to int
            Only those that occur.
        """
        words, counts = np.unique(self.verdict, return_counts=True)
        return {str(w): int(c) for w, c in zip(words, counts, strict=True) if w}

    def _parts(self) -> Parts:
        parts = super()._parts()
        parts.coordinates["branch"] = list(self.branches)
        parts.variables["parameter"] = ("value", self.parameter, {"units": self.parameter_unit})
        return parts
