"""What the search for the best tip relief found, and the map that it searched."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from tribodyn.gear import SpurPair
from tribodyn.record import Labels, Record, fact, quantity, record
from tribodyn.types import Array


@record
class TipReliefOptimum(Record):
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

    DERIVED: ClassVar[Mapping[str, Labels]] = {
        "peak_to_peak_before": Labels(("torque",), "m"),
        "peak_to_peak_after": Labels(("torque",), "m"),
    }

    gear_pair: SpurPair
    modified_pair: SpurPair
    gears: str = fact()
    shape: str = fact()
    amount: float = fact("best_amount")
    length: float = fact("best_length")
    torque: Array = quantity("torque", unit="N*m", axis=True)
    weight: Array
    objective_kind: str = fact()
    objective: float = fact("best_objective")
    objective_before: float = fact()
    phase: Array = quantity("phase", unit="1", axis=True)
    transmission_error_before: Array = quantity("torque", "phase", unit="m")
    transmission_error_after: Array = quantity("torque", "phase", unit="m")
    map_amount: Array = quantity("amount", unit="m", axis=True, name="amount")
    map_length: Array = quantity("length", unit="m", axis=True, name="length")
    map_objective: Array = quantity("amount", "length", unit="m", name="objective")

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

    def __repr__(self) -> str:
        """One line with the figures that matter."""
        return (
            f"TipReliefOptimum({self.shape}, {self.gears}, {self.amount * 1e6:.4g} um over "
            f"{self.length * 1e3:.4g} mm, {self.objective_kind} peak to peak "
            f"{self.objective_before * 1e6:.4g} -> {self.objective * 1e6:.4g} um from "
            f"{self.torque[0]:g} to {self.torque[-1]:g} N*m)"
        )
