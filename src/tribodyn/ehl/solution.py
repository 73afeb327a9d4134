"""The solved line contact: pressure and film, and how far they can be trusted."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.drawing import draw
from tribodyn.ehl.discrete import DiscreteContact
from tribodyn.errors import InputError, Problem
from tribodyn.types import Array

if TYPE_CHECKING:
    import xarray

    from tribodyn.lubricant import Lubricant


@dataclass(frozen=True, eq=False)
class LineContactSolution:
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
    central_film : float [m]
        Film at position zero.
    minimum_film : float [m]
        Least film between inlet and outlet.
    hertz_pressure : float [Pa]
        Maximum pressure of the dry contact.
    half_width : float [m]
        Half width b of the dry contact.
    outlet : float [m]
        Position where the oil film parts.
    spike_pressure : float, optional [Pa]
        Local maximum of the pressure nearest to the outlet; ``None`` where the pressure has a
        single maximum below the Hertz pressure. Not converged on uniform grids: too low by
        10 % and more.
    spike_position : float, optional [m]
        Where the spike lies.
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
    central_film_error : float, optional [m]
        Estimate of the discretisation error of ``central_film``; ``None`` without a coarser grid.
    central_film_extrapolated : float, optional [m]
        Central film extrapolated to an infinitely fine grid; ``None`` without a coarser grid.
    attempts : tuple of str
        What was tried in vain before.
    moes_load, moes_viscosity : float [-]
        Numbers M and L of Moes.
    load_per_width : float [N/m]
        Load that was asked for.
    equivalent_radius : float [m]
        Reduced radius of curvature.
    entrainment_speed : float [m/s]
        HALF the sum of the surface speeds.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    lubricant : Lubricant, optional
        The oil; ``None`` for a contact given by the numbers of Moes.
    viscosity_law : str
        ``"roelands"``, ``"barus"`` or ``"isoviscous"``.
    compressible : bool
        Whether the density rises with pressure.
    """

    position: Array = field(repr=False)
    pressure: Array = field(repr=False)
    film: Array = field(repr=False)
    central_film: float
    minimum_film: float
    hertz_pressure: float
    half_width: float
    outlet: float
    spike_pressure: float | None
    spike_position: float | None
    flux_error: float
    load_error: float
    cavity_residual: float
    iterations: int
    nodes: int
    domain: tuple[float, float]
    inlet: str
    method: str
    regime: str
    central_film_error: float | None
    central_film_extrapolated: float | None
    attempts: tuple[str, ...]
    moes_load: float
    moes_viscosity: float
    load_per_width: float
    equivalent_radius: float
    entrainment_speed: float
    effective_modulus: float
    lubricant: Lubricant | None = field(repr=False)
    viscosity_law: str
    compressible: bool
    _grid: DiscreteContact = field(repr=False)

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

    def film_stiffness(self, length: float = 1.0, kind: str = "tangent") -> float:
        """Stiffness of the oil film over the length of the contact line.

        Parameters
        ----------
        length : float [m]
            Length of the contact line.
        kind : {"tangent", "secant", "seed"}
            Slope of the load over the central film; sum of the nodal forces over their films;
            that sum as one source prints it.

        Returns
        -------
        float [N/m]

        Raises
        ------
        InputError
            If the length is not positive or the kind is unknown.
        """
        from tribodyn.ehl import film_stiffness

        kinds = {
            "tangent": film_stiffness.tangent_stiffness,
            "secant": film_stiffness.secant_stiffness,
            "seed": film_stiffness.seed_stiffness,
        }
        if kind not in kinds:
            raise InputError(
                Problem(
                    what=f'kind = "{kind}"',
                    where="argument kind",
                    why=f"Known: {', '.join(kinds)}",
                )
            )
        return float(kinds[kind](self, length))

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
        from tribodyn.ehl.frequency import frequency_response

        return frequency_response(self, frequencies, length)

    def to_xarray(self) -> xarray.Dataset:
        """Convert to a labelled data set.

        Returns
        -------
        xarray.Dataset
            Dimension ``position``; scalars are attributes.
        """
        import xarray

        names = {"pressure": "Pa", "film": "m", "viscosity": "", "density": ""}
        plain = self.lubricant is None
        variables = {
            name: ("position", getattr(self, name), {"units": "" if plain else unit})
            for name, unit in names.items()
        }
        attributes = {
            name: value
            for name, value in vars(self).items()
            if isinstance(value, str | int | float) and not isinstance(value, bool)
        }
        position = ("position", self.position, {"units": "" if plain else "m"})
        return xarray.Dataset(variables, coords={"position": position}, attrs=attributes)

    def plot(self) -> Any:
        """Draw pressure and film over the position.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self)

    def __repr__(self) -> str:
        """One line with the figures that tell contacts apart."""
        error = self.central_film_error
        spread = "" if error is None else f" +- {error / self.central_film:.1g} of it"
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
