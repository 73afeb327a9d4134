"""The solved line contact: pressure and film, and how far they can be trusted."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.film_stiffness import film_stiffness, frequency_response
from tribodyn.ehl.solver.contact_case import ContactCase, DiscreteContact
from tribodyn.ehl.solver.engines import GridError
from tribodyn.ehl.solver.fallbacks import Verified
from tribodyn.ehl.solver.grid import Domain, regime_name
from tribodyn.ehl.thermal.thermal_contact import HeatedFilm
from tribodyn.ehl.thermal.thermal_model import ThermalModel
from tribodyn.lubricant import Lubricant
from tribodyn.record import Labels, Record, fact, from_parts, quantity, record
from tribodyn.types import Array


@record
class LineContactSolution(Record):
    """Pressure and film of a lubricated line contact, steady and isothermal.

    A contact given by the numbers of Moes has the position in half widths b, pressures in Hertz
    pressures and films in b^2/R.

    Parameters
    ----------
    position : (nodes,) array [m]
        Distance from the line of centres in the direction of rolling.
    pressure : (nodes,) array [Pa]
        Pressure above ambient.
    film : (nodes,) array [m]
        Gap between the bodies.
    central_film, minimum_film : float [m]
        Film at position zero, and least film between inlet and outlet.
    hertz_pressure, half_width : float [Pa], [m]
        Maximum pressure and half width b of the dry contact.
    outlet : float [m]
        Position where the oil film parts.
    spike_pressure, spike_position : float, optional [Pa], [m]
        Local maximum of the pressure nearest to the outlet, and where it lies; ``None`` where the
        pressure has a single maximum below the Hertz pressure. Not converged on uniform grids: too
        low by 10 % and more.
    flux_error : float [-]
        Greatest relative deviation of the mass flux from its mean.
    load_error : float [-]
        Relative difference between the integral of the pressure and the load.
    cavity_residual : float [-]
        Least mass balance per length behind the outlet, in units of the dry contact; a negative
        one shows an outlet in the wrong place.
    iterations : int
        Newton steps, or multigrid cycles, on the finest grid.
    nodes : int
        Nodes of the grid.
    domain : (float, float)
        First and last position [b].
    inlet : str
        ``"flooded"`` or ``"zero"``.
    method : str
        Engine that found the solution.
    regime : str
        One of the four regimes of Moes.
    central_film_error, central_film_extrapolated : float, optional [m]
        Estimate of the error of ``central_film`` by the grid; its extrapolation to an infinitely
        fine grid, ``None`` without a coarser grid.
    attempts : tuple of str
        What was tried in vain before.
    moes_load, moes_viscosity : float [-]
        Numbers M and L of Moes.
    load_per_width, equivalent_radius, entrainment_speed : float [N/m], [m], [m/s]
        Arguments of :func:`tribodyn.ehl.solve_line_contact`.
    effective_modulus : float [Pa]
        As there.
    lubricant : Lubricant, optional
        The oil; ``None`` for a contact given by the numbers of Moes.
    viscosity_law, compressible : str, bool
        Law of the viscosity that was used, and whether the density rises with pressure.
    minimum_film_error, pressure_error : float [m], [Pa]
        Estimates of the errors of ``minimum_film`` and of the greatest pressure by the grid; the
        latter is great where that is the spike.
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {
        "viscosity": Labels(("position",), ""),
        "density": Labels(("position",), ""),
    }

    position: Array = quantity("position", unit="m", axis=True)
    pressure: Array = quantity("position", unit="Pa")
    film: Array = quantity("position", unit="m")
    central_film: float = fact()
    minimum_film: float = fact()
    hertz_pressure: float = fact()
    half_width: float = fact()
    outlet: float = fact()
    spike_pressure: float | None = fact()
    spike_position: float | None = fact()
    flux_error: float = fact()
    load_error: float = fact()
    cavity_residual: float = fact()
    iterations: int = fact()
    nodes: int = fact()
    domain: tuple[float, float]
    inlet: str = fact()
    method: str = fact()
    regime: str = fact()
    central_film_error: float = fact()
    central_film_extrapolated: float | None = fact()
    attempts: tuple[str, ...]
    moes_load: float = fact()
    moes_viscosity: float = fact()
    load_per_width: float = fact()
    equivalent_radius: float = fact()
    entrainment_speed: float = fact()
    effective_modulus: float = fact()
    lubricant: Lubricant | None
    viscosity_law: str = fact()
    compressible: bool
    _grid: DiscreteContact
    minimum_film_error: float = fact(default=float("nan"))
    pressure_error: float = fact(default=float("nan"))

    @property
    def film_unit(self) -> float:
        """Film ``b^2/R`` [m] at the dimensionless film ``H = 1``."""
        return self.half_width**2 / self.equivalent_radius

    @property
    def viscosity(self) -> Array:
        """Viscosity at the nodes over that at ambient pressure."""
        law, a, reference, z = self._grid.oil[:4]
        pressure = self._grid.P
        if law == 0.0:
            return np.ones_like(pressure)
        if law == 1.0:
            return np.asarray(np.exp(a * pressure))
        return np.asarray(np.exp(a * ((1.0 + pressure / reference) ** z - 1.0)))

    @property
    def density(self) -> Array:
        """Density at the nodes over that at ambient pressure."""
        rise, bound = self._grid.oil[4:6]
        return np.asarray(1.0 + rise * self._grid.P / (1.0 + bound * self._grid.P))

    @property
    def log_mean_viscosity(self) -> Array | None:
        """Logarithm of the viscosity across a heated film [Pa*s]; None if it is not heated."""
        return None

    def film_stiffness(self, length: float = 1.0, kind: str = "tangent") -> float:
        """Stiffness of the oil film over the length of the contact line.

        Parameters
        ----------
        length : float [m]
            Length of the contact line.
        kind : {"tangent", "approach", "secant", "seed"}
            Slope of the load over the central film; over the approach of the bodies less Hertz's;
            sum of the nodal forces over their films; that sum as one source prints it.

        Returns
        -------
        float [N/m]

        Raises
        ------
        InputError
            If the length is not positive or the kind is unknown.
        """
        return film_stiffness(self, length, kind)

    def frequency_response(
        self, frequencies: ArrayLike, length: float = 1.0
    ) -> tuple[Array, Array]:
        """Stiffness and damping of the film against small vibrations.

        Parameters
        ----------
        frequencies : float or array [Hz]
            Frequencies of the vibration.
        length : float [m]
            Length of the contact line.

        Returns
        -------
        (stiffness, damping) : arrays [N/m], [N*s/m]
            Of the shape of the frequencies.
        """
        return frequency_response(self, frequencies, length)

    def _units(self, unit: str | None) -> dict[str, str]:
        """Units; none for a contact given by the numbers of Moes."""
        return {"units": ""} if self.lubricant is None else super()._units(unit)

    def __repr__(self) -> str:
        """One line with the figures that tell contacts apart."""
        spread = f" +- {self.central_film_error / self.central_film:.1g} of it"
        if self.lubricant is None:
            films = f"central film {self.central_film:.6g}, minimum {self.minimum_film:.6g}"
        else:
            films = (
                f"central film {self.central_film * 1e6:.4f} um{spread}, "
                f"minimum {self.minimum_film * 1e6:.4f} um, "
                f"Hertz pressure {self.hertz_pressure * 1e-9:.4f} GPa"
            )
        return (
            f"LineContactSolution({films}, M {self.moes_load:.4g}, L {self.moes_viscosity:.4g}, "
            f"{self.nodes} nodes, {self.method}, {self.iterations} iterations)"
        )


def outlet_position(grid: DiscreteContact) -> float:
    """Where the pressure ends, between the nodes."""
    k = grid.free
    pressure, pressure_before = float(grid.P[k]), float(grid.P[k - 1])
    if not pressure_before > pressure > 0.0:
        return float(grid.X[min(k + 1, grid.n)])
    share = math.sqrt(pressure) / (math.sqrt(pressure_before) - math.sqrt(pressure))
    return float(min(grid.X[k] + share * grid.dx, grid.X[-1]))


def pressure_spike(grid: DiscreteContact) -> tuple[float, float] | None:
    """Highest pressure of the local maximum nearest to the outlet, and where it lies."""
    P = grid.P
    peaks = np.flatnonzero((P[1:-1] > P[:-2]) & (P[1:-1] >= P[2:])) + 1
    if peaks.size == 0:
        return None
    last = int(peaks[-1])
    if peaks.size == 1 and P[last] <= 1.0:
        return None
    return float(P[last]), float(grid.X[last])


def assemble(
    case: ContactCase, domain: Domain, solved: Verified, error: GridError
) -> LineContactSolution:
    """Solution with its units and its errors."""
    grid, check, scales = solved.outcome.grid, solved.check, case.scales
    assert grid is not None  # a verified outcome has a grid
    films = solved.outcome.films
    thick = case.half_width**2 / case.equivalent_radius
    spike = pressure_spike(grid)
    step = None if len(films) < 2 else (films[-1] - films[-2]) / 3.0
    least = float(np.min(grid.H[: grid.free + 1]))
    return from_parts(
        LineContactSolution,
        *(case, scales, check, solved, solved.outcome),
        position=grid.X * case.half_width,
        pressure=grid.P * case.hertz_pressure,
        film=grid.H * thick,
        central_film=films[-1] * thick,
        minimum_film=least * thick,
        outlet=outlet_position(grid) * case.half_width,
        spike_pressure=None if spike is None else spike[0] * case.hertz_pressure,
        spike_position=None if spike is None else spike[1] * case.half_width,
        nodes=grid.n + 1,
        domain=(domain.start, domain.end),
        inlet=domain.inlet,
        regime=regime_name(scales.moes_load, scales.moes_viscosity),
        central_film_error=error.central * films[-1] * thick,
        central_film_extrapolated=None if step is None else (films[-1] + step) * thick,
        minimum_film_error=error.minimum * least * thick,
        pressure_error=error.pressure * float(np.max(grid.P)) * case.hertz_pressure,
        _grid=grid,
    )


@record
class ThermalLineContactSolution(LineContactSolution):
    """Pressure, film and temperatures of a lubricated line contact.

    Everything of :class:`LineContactSolution`, whose film is that of the heated oil, and:

    Parameters
    ----------
    sliding_speed : float [m/s]
        Speed of surface 1 less that of surface 2.
    height : (across,) array [1]
        Distance of the nodes from surface 1 over the film.
    film_temperature : (nodes, across) array [K]
        Temperature of the oil from surface 1 to surface 2; behind the outlet, where the oil has
        parted, even between the surfaces.
    surface_temperatures : (2, nodes) array [K]
        Temperature of both surfaces.
    shear_stress : (nodes,) array [Pa]
        Shear stress in the middle of the film, with which surface 2 drags surface 1 along.
    surface_heat : (2, nodes) array [W/m^2]
        Heat that each surface takes up.
    traction : float [N/m]
        Sliding traction, of the sign of the sliding.
    friction_coefficient : float
        Size of the traction over the load.
    shear_heat, compression_heat, carried_heat : float [W/m]
        Heat made by shear, and by compression less expansion; heat that the oil takes out.
    body_heat : (2,) array [W/m]
        Heat into both bodies.
    heat_balance_error : float [1]
        Heat made less heat led away, over the heat made by shear.
    thermal_passes : int
        Passes between film and temperatures.
    thermal_model : ThermalModel
        Shear of the oil, and bodies.
    """

    sliding_speed: float = fact(default=0.0)
    height: Array = quantity("height", unit="1", axis=True, default=None)
    film_temperature: Array = quantity("position", "height", unit="K", default=None)
    surface_temperatures: Array = quantity("surface", "position", unit="K", default=None)
    shear_stress: Array = quantity("position", unit="Pa", default=None)
    surface_heat: Array = quantity("surface", "position", unit="W/m^2", default=None)
    traction: float = fact(default=0.0)
    friction_coefficient: float = fact(default=0.0)
    shear_heat: float = fact(default=0.0)
    compression_heat: float = fact(default=0.0)
    carried_heat: float = fact(default=0.0)
    body_heat: Array = quantity("surface", unit="W/m", default=None)
    heat_balance_error: float = fact(default=0.0)
    thermal_passes: int = fact(default=0)
    thermal_model: ThermalModel = ThermalModel()
    _mean_viscosity: Array = None  # type: ignore[assignment]

    @property
    def log_mean_viscosity(self) -> Array:
        """Logarithm of the mean viscosity across the film at low stress [Pa*s]."""
        return np.log(self._mean_viscosity)


def with_heat(
    solution: LineContactSolution, heated: HeatedFilm, model: ThermalModel, sliding_speed: float
) -> ThermalLineContactSolution:
    """A solution with the temperatures that belong to it."""
    shear, compression, first, second, carried = heated.balance.tolist()
    generated = shear + compression
    temperature = heated.temperature
    return from_parts(
        ThermalLineContactSolution,
        *(solution, heated),
        sliding_speed=sliding_speed,
        height=np.linspace(0.0, 1.0, temperature.shape[1]),
        film_temperature=temperature,
        surface_temperatures=np.ascontiguousarray(temperature[:, [0, -1]].T),
        surface_heat=heated.heat,
        friction_coefficient=abs(heated.traction) / solution.load_per_width,
        shear_heat=shear,
        compression_heat=compression,
        carried_heat=carried,
        body_heat=np.array([first, second]),
        heat_balance_error=(generated - first - second - carried) / max(shear, 1e-300),
        thermal_passes=heated.passes,
        thermal_model=model,
        _mean_viscosity=heated.viscosity,
    )
