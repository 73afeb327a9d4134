"""Solutions checked against the discrete equations, apart from the code that found them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.ehl.steady.contact_problem import DiscreteContact
from tribodyn.types import Array

#: Least value of the mass balance in the cavity that still counts as none.
_CAVITY = -1e-8


@dataclass(frozen=True)
class Verification:
    """How well a solution meets the equations."""

    flux_error: float
    load_error: float  #: relative difference between the sum of the pressure and the load
    cavity_residual: float  #: least mass balance per length behind the outlet
    lowest_pressure: float  #: least pressure, in Hertz pressures
    film_error: float  #: greatest difference from the film of the pressure, over the least film

    def complaint(self, flux_tolerance: float, load_tolerance: float = 1e-6) -> str:
        """What is wrong, or nothing."""
        complaints = []
        if not self.lowest_pressure >= 0.0:
            complaints.append(f"least pressure {self.lowest_pressure:.3g} p_h is negative")
        if not self.cavity_residual >= _CAVITY:
            complaints.append(
                f"mass balance behind the outlet {self.cavity_residual:.3g} is negative"
            )
        if not self.flux_error <= flux_tolerance:
            complaints.append(f"flux error {self.flux_error:.3g} exceeds {flux_tolerance:.3g}")
        if not self.load_error <= load_tolerance:
            complaints.append(f"load error {self.load_error:.3g} exceeds {load_tolerance:.3g}")
        if not self.film_error <= 1e-6:
            complaints.append(f"film differs from that of the pressure by {self.film_error:.3g}")
        return "; ".join(complaints)


def _transform(n: int, dx: float) -> tuple[int, Array]:
    """Length of the circular sum, and transform of the influence."""
    from scipy.fft import next_fast_len, rfft

    size = next_fast_len(2 * n + 2, real=True)
    edge = (np.arange(n + 2) - 0.5) * dx
    integral = edge * (np.log(np.abs(edge)) - 1.0)
    influence = -np.diff(integral) / np.pi
    circular = np.zeros(size)
    circular[: n + 1] = influence
    circular[size - n :] = influence[1 : n + 1][::-1]
    return size, rfft(circular)


def _film(grid: DiscreteContact) -> Array:
    from scipy.fft import irfft, rfft

    size, spectrum = _transform(grid.n, grid.dx)
    deflection = irfft(rfft(grid.P, size) * spectrum, size)[: grid.n + 1]
    return np.asarray(grid.H0 + grid.shape + deflection)


def verify(grid: DiscreteContact) -> Verification:
    """Check a solution against the discrete equations, from its pressure alone."""
    P, dx, k = grid.P, grid.dx, grid.free
    H = _film(grid)
    law, a, reference, z, rise, bound = grid.oil
    density = 1.0 + rise * P / (1.0 + bound * P)
    if law == 2.0:
        growth = a * (np.maximum(1.0 + P / reference, 0.7) ** z - 1.0)
    else:
        growth = a * P if law == 1.0 else 0.0 * P
    mobility = density * np.maximum(H, 1e-10) ** 3 * np.exp(-np.minimum(growth, 700.0)) / grid.lam
    mass = density * H
    carried = 1.5 * mass[:-1]
    carried[1:] -= 0.5 * mass[:-2]
    carried[0] = 0.5 * (mass[0] + mass[1])
    flux = carried - 0.5 * (mobility[:-1] + mobility[1:]) * np.diff(P) / dx
    wetted = flux[: k + 1]
    mean = float(np.mean(wetted))
    cavity = np.diff(flux)[k:] / dx
    total = dx * (float(np.sum(P)) - 0.5 * P[0])
    return Verification(
        flux_error=float(np.max(np.abs(wetted / mean - 1.0))),
        load_error=float(abs(total / grid.load - 1.0)),
        cavity_residual=float(np.min(cavity)) if cavity.size else 0.0,
        lowest_pressure=float(np.min(P)),
        film_error=float(np.max(np.abs(H - grid.H)) / np.min(H)),
    )
