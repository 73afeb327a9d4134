"""What the search for the best tip relief found, and the map that it searched."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import draw
from tribodyn.gear import SpurPair
from tribodyn.types import Array

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False, repr=False)
class TipReliefOptimum:
    """Best tip relief over torques; made by :func:`tribodyn.stiffness.optimize_tip_relief`.

    Parameters
    ----------
    gear_pair, modified_pair : SpurPair
        As it was given, and with the relief that was found.
    gears : str
        Which gears are relieved: ``"both"``, ``"pinion"`` or ``"wheel"``.
    shape : str
        ``"linear"`` or ``"parabolic"``.
    amount, length : float [m]
        The relief that was found: material taken away at the tip, and roll length.
    torque : array (t,) [N*m]
        Torques on the pinion.
    weight : array (t,)
        Parts of the torques in a mean objective: pure numbers that sum to one.
    objective_kind : str
        ``"largest"`` or ``"mean"`` peak-to-peak transmission error over the torques.
    objective, objective_before : float [m]
        With the relief that was found, and as the pair was given.
    phase : array (p,)
        Mesh phase.
    transmission_error_before, transmission_error_after : array (t, p) [m]
        Approach of the gears along the line of action under load at rest.
    map_amount, map_length : array (a,), array (l,) [m]
        Where the objective was mapped before the search.
    map_objective : array (a, l) [m]
        The objective there; a first amount of zero is the pair without tip relief.
    """

    gear_pair: SpurPair
    modified_pair: SpurPair
    gears: str
    shape: str
    amount: float
    length: float
    torque: Array
    weight: Array
    objective_kind: str
    objective: float
    objective_before: float
    phase: Array
    transmission_error_before: Array
    transmission_error_after: Array
    map_amount: Array
    map_length: Array
    map_objective: Array

    @property
    def peak_to_peak_before(self) -> Array:
        """Peak-to-peak transmission error of the pair as it was given (t,) [m]."""
        return np.asarray(np.ptp(self.transmission_error_before, axis=1))

    @property
    def peak_to_peak_after(self) -> Array:
        """Peak-to-peak transmission error with the relief that was found (t,) [m]."""
        return np.asarray(np.ptp(self.transmission_error_after, axis=1))

    @property
    def on_edge(self) -> bool:
        """Whether amount or length is at the edge of its range: a wider one may hold a better."""
        edges = [
            abs(value - edge) < 1e-3 * np.ptp(axis)
            for value, axis in ((self.amount, self.map_amount), (self.length, self.map_length))
            for edge in axis[[0, -1]]
        ]
        return any(edges)

    def to_xarray(self) -> xarray.Dataset:
        """Convert to a labelled data set with units.

        Returns
        -------
        xarray.Dataset
            Dimensions ``torque``, ``phase``, ``amount`` and ``length``.
        """
        import xarray

        unit = {"units": "m"}
        variables: dict[str, Any] = {
            "objective": (("amount", "length"), self.map_objective, unit),
        }
        for state in ("before", "after"):
            error = getattr(self, f"transmission_error_{state}")
            peak = getattr(self, f"peak_to_peak_{state}")
            variables[f"transmission_error_{state}"] = (("torque", "phase"), error, unit)
            variables[f"peak_to_peak_{state}"] = ("torque", peak, unit)
        coordinates: dict[str, Any] = {
            "torque": ("torque", self.torque, {"units": "N*m"}),
            "phase": ("phase", self.phase, {"units": "1"}),
            "amount": ("amount", self.map_amount, unit),
            "length": ("length", self.map_length, unit),
        }
        made = {
            "gears": self.gears, "shape": self.shape, "objective_kind": self.objective_kind,
            "best_amount": self.amount, "best_length": self.length,
            "best_objective": self.objective, "objective_before": self.objective_before,
        }  # fmt: skip
        return xarray.Dataset(variables, coordinates, made)

    def plot(self) -> Any:
        """Draw the objective over amount and length, and the errors before and after.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self)

    def __repr__(self) -> str:
        """One line with the figures that matter."""
        return (
            f"TipReliefOptimum({self.shape}, {self.gears}, {self.amount * 1e6:.4g} um over "
            f"{self.length * 1e3:.4g} mm, {self.objective_kind} peak to peak "
            f"{self.objective_before * 1e6:.4g} -> {self.objective * 1e6:.4g} um from "
            f"{self.torque[0]:g} to {self.torque[-1]:g} N*m)"
        )
