"""What a bifurcation diagram holds: sections, periods, rms and verdicts over a parameter."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.types import Array, Index, Mask

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Bifurcation:
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

    parameter: Array
    parameter_name: str
    parameter_unit: str
    mesh_frequency: Array = field(repr=False)
    branches: tuple[str, ...]
    signal: str
    section: Array = field(repr=False)
    period: Index = field(repr=False)
    rms: Array = field(repr=False)
    contact_loss_share: Array = field(repr=False)
    step_number: Array = field(repr=False)
    steps: Index = field(repr=False)
    verdict: NDArray[np.str_] = field(repr=False)
    refined_period: Index = field(repr=False)
    refined_rms: Array = field(repr=False)
    refined_steps: Index = field(repr=False)
    largest_exponent: Array = field(repr=False)
    finished: Mask = field(repr=False)

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

    def to_xarray(self) -> xarray.Dataset:
        """Return the diagram as an :class:`xarray.Dataset` with units.

        Returns
        -------
        xarray.Dataset
            Dimensions ``branch``, ``value`` and ``mesh_cycle``.
        """
        import xarray

        both, value = ("branch", "value"), ("value",)
        data: dict[str, Any] = {
            "section": ((*both, "mesh_cycle"), self.section, {"units": "m or rad"}),
            "period": (both, self.period, {"units": "1"}),
            "rms": (both, self.rms, {"units": "m or rad"}),
            "contact_loss_share": (both, self.contact_loss_share, {"units": "1"}),
            "verdict": (both, self.verdict),
            "finished": (both, self.finished),
            "refined_period": (both, self.refined_period, {"units": "1"}),
            "refined_rms": (both, self.refined_rms, {"units": "m or rad"}),
            "largest_exponent": (both, self.largest_exponent, {"units": "1/s"}),
            "mesh_frequency": (value, self.mesh_frequency, {"units": "Hz"}),
            "step_number": (value, self.step_number, {"units": "1"}),
            "steps": (value, self.steps, {"units": "1"}),
            "refined_steps": (value, self.refined_steps, {"units": "1"}),
            "parameter": (value, self.parameter, {"units": self.parameter_unit}),
        }
        names = {"parameter_name": self.parameter_name, "signal": self.signal}
        return xarray.Dataset(data, {"branch": list(self.branches)}, names)

    def plot(self) -> Any:
        """Draw the diagram.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        from tribodyn.plot import FIGURES

        return FIGURES["bifurcation"](self)
