"""A line contact over time: films, loads and pressures, with what the solver did."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import draw
from tribodyn.types import Array, Index

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False)
class TransientLineContact:
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

    time: Array = field(repr=False)
    central_film: Array = field(repr=False)
    minimum_film: Array = field(repr=False)
    load_per_width: Array = field(repr=False)
    approach: Array = field(repr=False)
    maximum_pressure: Array = field(repr=False)
    outlet: Array = field(repr=False)
    equivalent_radius: Array = field(repr=False)
    entrainment_speed: Array = field(repr=False)
    position: Array = field(repr=False)
    kept: Index = field(repr=False)
    pressure: Array = field(repr=False)
    film: Array = field(repr=False)
    iterations: Index = field(repr=False)
    parts: Index = field(repr=False)
    balance_error: Array = field(repr=False)
    ruptured: Array = field(repr=False)
    half_width: float
    hertz_pressure: float
    domain: tuple[float, float]
    reference_length: float
    impose: str
    inlet: str

    @property
    def kept_time(self) -> Array:
        """Instants whose pressure and film are kept [s]."""
        return np.asarray(self.time[self.kept])

    def to_xarray(self) -> xarray.Dataset:
        """Return the series as an :class:`xarray.Dataset` with units.

        Returns
        -------
        xarray.Dataset
            Dimensions ``time``, ``kept_time`` and ``position``.
        """
        import xarray

        series = {
            "central_film": "m",
            "minimum_film": "m",
            "load_per_width": "N/m",
            "approach": "m",
            "maximum_pressure": "Pa",
            "outlet": "m",
            "equivalent_radius": "m",
            "entrainment_speed": "m/s",
            "iterations": "1",
            "parts": "1",
            "balance_error": "1",
            "ruptured": "m",
        }
        fields = {"pressure": "Pa", "film": "m"}
        data: dict[str, Any] = {
            name: ("time", getattr(self, name), {"units": unit}) for name, unit in series.items()
        }
        data |= {
            name: (("kept_time", "position"), getattr(self, name), {"units": unit})
            for name, unit in fields.items()
        }
        coords = {
            "time": ("time", self.time, {"units": "s"}),
            "kept_time": ("kept_time", self.kept_time, {"units": "s"}),
            "position": ("position", self.position, {"units": "m"}),
        }
        attributes = {
            "half_width": self.half_width,
            "hertz_pressure": self.hertz_pressure,
            "reference_length": self.reference_length,
            "impose": self.impose,
            "inlet": self.inlet,
        }
        return xarray.Dataset(data, coords, attributes)

    def plot(self) -> Any:
        """Draw films and load over time.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self)

    def __repr__(self) -> str:
        """One line with the figures that tell series apart."""
        low, high = float(self.minimum_film.min()), float(self.central_film.max())
        return (
            f"TransientLineContact({self.time.size - 1} steps over "
            f"{(self.time[-1] - self.time[0]) * 1e3:.4g} ms, imposed {self.impose}, minimum film "
            f"{low * 1e6:.4f} um, greatest central film {high * 1e6:.4f} um, "
            f"{self.position.size} nodes)"
        )
