"""The steady line contact in plain NumPy: the whole physics on a page, dense and without loops.

Slow, but nothing is hidden: the film is a product with a full matrix, and so is the Jacobian. The
compiled solvers are tested against these equations and share none of their code.

Everything is in the units of the dry contact: ``X = x/b``, ``P = p/p_h``, ``H = h R/b^2``. The
nodes 0 to n divide the domain evenly, and node i represents the cell of width ``dX`` around it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from tribodyn.types import Array

#: Reference pressure of the Roelands law [Pa].
_ROELANDS_PRESSURE = 1.0 / 5.1e-9
#: The gap is taken as at least this much in the mobility, and there only.
_LEAST_GAP = 1e-10


class PlainOil(NamedTuple):
    """Viscosity and density over pressure, in units of the ambient values and of ``p_h``."""

    law: float
    scale: float  #: the number a: pure
    reference: float  #: the number p0, pure
    exponent: float  #: the number z, pure
    growth: float  #: density ``1 + growth P/(1 + saturation P)`` of Dowson and Higginson, both pure
    saturation: float

    def log_viscosity(self, P: Array) -> tuple[Array, Array]:
        """Logarithm of the viscosity, and its slope over pressure."""
        if self.law == 0.0:
            return 0.0 * P, 0.0 * P
        if self.law == 1.0:
            return self.scale * P, self.scale + 0.0 * P
        limited = np.maximum(P / self.reference, -0.3)
        slope = (
            self.scale * self.exponent / self.reference * (1.0 + limited) ** (self.exponent - 1.0)
        )
        moving = P / self.reference > -0.3
        return self.scale * ((1.0 + limited) ** self.exponent - 1.0), slope * moving

    def density(self, P: Array) -> tuple[Array, Array]:
        """Density, and its slope over pressure."""
        below = 1.0 + self.saturation * P
        return 1.0 + self.growth * P / below, self.growth / below**2

    @property
    def initial_slope(self) -> float:
        """Slope ``alpha p_h`` of the logarithm of the viscosity at ambient pressure."""
        return float(self.log_viscosity(np.zeros(1))[1][0])


def plain_oil(
    viscosity_law: str,
    hertz_pressure: float,
    pressure_viscosity_coefficient: float,
    pressure_viscosity_index: float = 0.68,
    *,
    compressible: bool = True,
) -> PlainOil:
    """Constants of an oil under a Hertz pressure.

    Parameters
    ----------
    viscosity_law : str
        ``"roelands"``, ``"barus"`` or ``"isoviscous"``.
    hertz_pressure : float [Pa]
        Greatest pressure of the dry contact.
    pressure_viscosity_coefficient : float [1/Pa]
        Slope of ln(viscosity) over pressure at ambient pressure.
    pressure_viscosity_index : float [-]
        Exponent z of the Roelands law.
    compressible : bool
        Whether the density follows Dowson and Higginson; otherwise it is constant.

    Returns
    -------
    PlainOil

    Source: Roelands (1966) with ``p0 = 1/5.1e-9 Pa``; Dowson and Higginson (1966).
    """
    law = {"isoviscous": 0.0, "barus": 1.0, "roelands": 2.0}[viscosity_law]
    scale = pressure_viscosity_coefficient * hertz_pressure
    reference = _ROELANDS_PRESSURE / hertz_pressure
    if law == 2.0:
        scale *= reference / pressure_viscosity_index
    growth, saturation = (0.6e-9, 1.7e-9) if compressible else (0.0, 0.0)
    return PlainOil(
        law, scale, reference, pressure_viscosity_index,
        growth * hertz_pressure, saturation * hertz_pressure,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class PlainContact:
    """A line contact on its grid."""

    intervals: int  #: number n of cells
    domain: tuple[float, float]  #: first and last node, in half widths
    speed_parameter: float  #: ``lambda = 12 eta0 u_e R^2/(b^3 p_h) = 3 pi^2/(8 M^2)``, pure
    oil: PlainOil  #: constants of the oil
    load: float = math.pi / 2.0  #: what ``dX (P_0/2 + P_1 +
    inlet_pressure: float = 0.0  #: ``P_0``, in Hertz pressures
    X: Array = field(init=False, repr=False)
    width: float = field(init=False)
    influence: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Make the nodes and the matrix that turns pressure into film."""
        X, width = np.linspace(*self.domain, self.intervals + 1, retstep=True)
        node = np.arange(self.intervals + 1)
        nearer_edge = (np.maximum(node, 1) - 0.5) * width  # nearer edge of a cell m widths away
        far = width * (np.log(nearer_edge) - 1.0) + (nearer_edge + width) * np.log1p(
            width / nearer_edge
        )
        self_influence = width * (math.log(0.5 * width) - 1.0)
        row = np.where(node == 0, self_influence, far) / -math.pi
        object.__setattr__(self, "X", X)
        object.__setattr__(self, "width", float(width))
        object.__setattr__(self, "influence", row[np.abs(node[:, None] - node)])

    def film(self, P: Array, offset: float) -> Array:
        """Gap ``H = H0 + X^2/2 - (1/pi) int P ln|X - X'| dX'``."""
        return np.asarray(offset + 0.5 * self.X**2 + self.influence @ P)

    def flux(self, P: Array, H: Array, speed: float = 1.0) -> Array:
        """Mass flux through the faces: second-order upstream with the wall, central by pressure."""
        mass = self.oil.density(P)[0] * H
        wall = np.concatenate(([0.5 * (mass[0] + mass[1])], 1.5 * mass[1:-1] - 0.5 * mass[:-2]))
        mobility = self._mobility(P, H)
        return speed * wall - 0.5 * (mobility[1:] + mobility[:-1]) * np.diff(P) / self.width

    def residual(
        self,
        P: Array,
        H: Array,
        speed: float = 1.0,
        squeeze: float = 0.0,
        history: float | Array = 0.0,
    ) -> Array:
        """What the inner nodes lose: outflow less inflow, plus the growth of the film."""
        mass = self.oil.density(P)[0] * H
        return np.asarray(np.diff(self.flux(P, H, speed)) + squeeze * mass[1:-1] - history)

    def _mobility(self, P: Array, H: Array) -> Array:
        viscous = np.exp(-self.oil.log_viscosity(P)[0])
        rho = self.oil.density(P)[0]
        return np.asarray(rho * np.maximum(H, _LEAST_GAP) ** 3 * viscous / self.speed_parameter)

    def jacobian(self, P: Array, H: Array) -> tuple[Array, Array]:
        """Derivatives of the steady residual by the pressures (full matrix) and the offset."""
        rho, rho_slope = self.oil.density(P)
        mobility = self._mobility(P, H)
        by_gap = np.where(_LEAST_GAP < H, 3.0 * mobility / H, 0.0)
        by_oil = mobility * (rho_slope / rho - self.oil.log_viscosity(P)[1])
        conductance = 0.5 * (mobility[1:] + mobility[:-1]) / self.width
        film = self._by_node(P, rho, by_gap, 0.0)
        diagonal = self._by_node(P, rho_slope * H, by_oil, conductance)
        above = np.vstack((np.zeros_like(P), self.influence))  # nodes -1 to n
        rows = len(P) - 2
        full = sum(film[s][:, None] * above[s : s + rows] for s in range(4))
        for s in range(4):
            full[np.arange(rows), np.arange(rows) + s - 1] += diagonal[s]
        return full, film.sum(axis=0)

    def _by_node(self, P: Array, mass: Array, mobility: Array, conductance: float | Array) -> Array:
        """Derivatives of the residual i by something at the nodes i - 2 to i + 1: four rows."""
        half_slope = 0.5 * np.diff(P) / self.width
        face = np.zeros((3, len(P) - 1))  # flux through i + 1/2 by the nodes i - 1, i, i + 1
        face[0, 1:], face[1, 1:] = -0.5 * mass[:-2], 1.5 * mass[1:-1]
        face[1, 0], face[2, 0] = 0.5 * mass[0], 0.5 * mass[1]
        face[1] += conductance - half_slope * mobility[:-1]
        face[2] -= conductance + half_slope * mobility[1:]
        node = np.zeros((4, len(P) - 2))
        node[1:] += face[:, 1:]
        node[:3] -= face[:, :-1]
        return node
