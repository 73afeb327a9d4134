"""A line contact over time: films, loads and pressures, with what the solver did."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from tribodyn.record import Labels, Record, fact, quantity, record
from tribodyn.types import Array, Index


@record
class TransientLineContact(Record):
    """Film and load of a lubricated line contact over time, isothermal.

    Parameters
    ----------
    time : (m,) array [s]
        Instants.
    central_film : (m,) array [m]
        Film on the line of centres.
    minimum_film : (m,) array [m]
        Least film between the inlet and the outlet.
    load_per_width : (m,) array [N/m]
        Integral of the pressure; the imposed load, or the answer to the imposed approach.
    approach : (m,) array [m]
        Approach of the bodies since their undeformed flanks touched, where the deflection
        is counted from ``reference_length``; the imposed one, or the answer to the load.
    maximum_pressure : (m,) array [Pa]
        Highest pressure.
    outlet : (m,) array [m]
        Last position with pressure.
    equivalent_radius : (m,) array [m]
        Reduced radius of curvature.
    entrainment_speed : (m,) array [m/s]
        HALF the sum of the surface speeds.
    position : (n,) array [m]
        Nodes of the grid: distance from the line of centres in the direction of rolling.
    kept : (k,) array of int
        Instants whose pressure and film are kept.
    pressure : (k, n) array [Pa]
        Pressure at these instants.
    film : (k, n) array [m]
        Film at these instants.
    iterations : (m,) array of int
        Newton steps of each time step.
    parts : (m,) array of int
        Parts that each time step was divided into; one unless it failed as a whole.
    balance_error : (m,) array [1]
        Sum of the mass balances over the mean flux.
    ruptured : (m,) array [m]
        Width of the cavities inside the film, before the outlet. A fast unloading tears it.
    half_width : float [m]
        Half width of the widest dry contact, the unit of the grid.
    hertz_pressure : float [Pa]
        Hertz pressure of that contact.
    domain : (float, float) [b]
        First and last position, b being ``half_width``.
    reference_length : float [m]
        Distance from the line of centres at which a half space has the deflection zero.
    impose : str
        ``"load"`` or ``"approach"``.
    inlet : str
        ``"flooded"`` or ``"zero"``.
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {"kept_time": Labels(("kept_time",), "s", axis=True)}

    time: Array = quantity("time", unit="s", axis=True)
    central_film: Array = quantity("time", unit="m")
    minimum_film: Array = quantity("time", unit="m")
    load_per_width: Array = quantity("time", unit="N/m")
    approach: Array = quantity("time", unit="m")
    maximum_pressure: Array = quantity("time", unit="Pa")
    outlet: Array = quantity("time", unit="m")
    equivalent_radius: Array = quantity("time", unit="m")
    entrainment_speed: Array = quantity("time", unit="m/s")
    position: Array = quantity("position", unit="m", axis=True)
    kept: Index
    pressure: Array = quantity("kept_time", "position", unit="Pa")
    film: Array = quantity("kept_time", "position", unit="m")
    iterations: Index = quantity("time", unit="1")
    parts: Index = quantity("time", unit="1")
    balance_error: Array = quantity("time", unit="1")
    ruptured: Array = quantity("time", unit="m")
    half_width: float = fact()
    hertz_pressure: float = fact()
    domain: tuple[float, float]
    reference_length: float = fact()
    impose: str = fact()
    inlet: str = fact()

    @property
    def kept_time(self) -> Array:
        """Instants whose pressure and film are kept [s]."""
        return np.asarray(self.time[self.kept])

    def __repr__(self) -> str:
        """One line with the figures that tell series apart."""
        low, high = float(self.minimum_film.min()), float(self.central_film.max())
        return (
            f"TransientLineContact({self.time.size - 1} steps over "
            f"{(self.time[-1] - self.time[0]) * 1e3:.4g} ms, imposed {self.impose}, minimum film "
            f"{low * 1e6:.4f} um, greatest central film {high * 1e6:.4f} um, "
            f"{self.position.size} nodes)"
        )
