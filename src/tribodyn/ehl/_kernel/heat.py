"""The energy equation of a heated film, on the nodes of its shear."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled import announced, source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.ehl._kernel.elementary import INNER, JIT
from tribodyn.ehl._kernel.heated_shear import Across, Along, Sheared, shear_column
from tribodyn.ehl._kernel.reynolds import PLAIN, oil_state
from tribodyn.types import Array

#: Largest change of a temperature in a step [K].
_CAP = 60.0
#: Change of the temperature [K] from which on Newton's method goes to the end.
_SETTLED = 5.0
#: Steps of a column at most when the sweep comes to it, and change at which it stays [K].
_LOCAL, _STILL = 6, 0.05


@nb.njit(**INNER)
def _exchange(flux: float, conduction: float, capacity: float) -> tuple[float, float]:
    """Heat per kelvin from above to below, and the other way: power law of Patankar (1980)."""
    carried = flux * capacity
    part = max(0.0, 1.0 - 0.1 * abs(carried) / conduction)
    spread = conduction * part**5
    return spread + max(-carried, 0.0), spread + max(carried, 0.0)


class Column(NamedTuple):
    """Equations of one column: a band, and the right-hand sides."""

    low: Array
    middle: Array
    up: Array
    rhs: Array  #: residual; becomes the change of the temperature
    shared: Array  #: heat per change of the stress in the middle
    answer: Array  #: change of that stress per kelvin


@nb.njit(**INNER)
def _solve_column(last: int, c: Column) -> float:
    """Newton step: the band and one product, that of the stress that all nodes share."""
    for j in range(1, last + 1):
        ratio = c.low[j] / c.middle[j - 1]
        c.middle[j] -= ratio * c.up[j - 1]
        c.rhs[j] -= ratio * c.rhs[j - 1]
        c.shared[j] -= ratio * c.shared[j - 1]
    c.rhs[last] /= c.middle[last]
    c.shared[last] /= c.middle[last]
    for j in range(last - 1, -1, -1):
        c.rhs[j] = (c.rhs[j] - c.up[j] * c.rhs[j + 1]) / c.middle[j]
        c.shared[j] = (c.shared[j] - c.up[j] * c.shared[j + 1]) / c.middle[j]
    first = second = largest = 0.0
    for j in range(last + 1):
        first += c.answer[j] * c.rhs[j]
        second += c.answer[j] * c.shared[j]
    for j in range(last + 1):
        c.rhs[j] += c.shared[j] * first / (1.0 - second)
        largest = max(largest, abs(c.rhs[j]))
    return largest


@nb.njit(**INNER)
def _heat_column(
    i: int, k: int, dx: float, h: float, slope: float, west: Array, east: Array,
    rises: tuple[float, float], selfs: tuple[float, float], exact: bool, o: Sheared, a: Across,
    b: Along, c: Column,
) -> float:  # fmt: skip
    """Change the temperatures of a column, by Newton's method if exact; its greatest change."""
    last, T = west.size - 1, a.temperature
    dz, unit = h / last, h * dx / last
    conduction = o.conductivity * dx / dz
    steepness = climb = answer = 0.0
    for j in range(last + 1):
        weight = 0.5 if j == 0 or j == last else 1.0
        steepness += weight * a.steep[i, j]
        answer -= weight * a.rate[i, j] * a.falling[i, j]
        c.middle[j] = c.rhs[j] = c.low[j] = c.up[j] = 0.0
    answer = answer / steepness if steepness > 0.0 else 0.0
    for j in range(last + 1):
        weight = 0.5 if j == 0 or j == last else 1.0
        volume, heating = weight * unit, a.stress[i, j] * a.rate[i, j]
        squeeze = a.expansion[i, j] * a.velocity[i, j] * slope * volume
        own, stress = heating * a.falling[i, j] * volume, a.stress[i, j] * a.steep[i, j]
        c.shared[j] = (a.rate[i, j] + stress) * volume if steepness > 0.0 else 0.0
        c.answer[j] = -weight * a.rate[i, j] * a.falling[i, j] / max(steepness, 1e-300)
        if not exact:
            # As if the column were evenly warmer: this never runs away.
            own = min(own + c.shared[j] * answer, 0.0)
            c.shared[j] = 0.0
        into, back = max(west[j], 0.0) * o.capacity, max(-east[j], 0.0) * o.capacity
        behind = T[i + 1, j] if i < k else o.temperature
        c.middle[j] += into + back - own - min(squeeze, 0.0)
        c.rhs[j] += heating * volume + squeeze * T[i, j]
        c.rhs[j] += into * (T[i - 1, j] - T[i, j]) + back * (behind - T[i, j])
        if j < last:
            climb -= east[j] - west[j]
            above, below = _exchange(climb, conduction, o.capacity)
            c.middle[j] += above
            c.middle[j + 1] += below
            c.up[j], c.low[j + 1] = -above, -below
            c.rhs[j] += above * (T[i, j + 1] - T[i, j])
            c.rhs[j + 1] += below * (T[i, j] - T[i, j + 1])
    for wall, j in ((0, 0), (1, last)):
        c.middle[j] += dx / selfs[wall]
        c.rhs[j] -= dx * (T[i, j] - rises[wall]) / selfs[wall]
    largest = _solve_column(last, c)
    damped = 1.0 if largest <= _CAP else _CAP / largest
    for j in range(last + 1):
        T[i, j] += damped * c.rhs[j]
    b.heat[0, i] = (T[i, 0] - rises[0]) / selfs[0]
    b.heat[1, i] = (T[i, last] - rises[1]) / selfs[1]
    return largest


@nb.njit(**INNER)
def _conducted(i: int, k: int, response: Array, heat: Array) -> float:
    """Rise of a surface at a column by the heat that goes in at all other columns."""
    rise = 0.0
    for j in range(1, k + 1):
        rise += response[i, j] * heat[j]
    return rise - (response[i, i] * heat[i] if 1 <= i <= k else 0.0)


@nb.njit(**INNER)
def _faces(i: int, k: int, mass: Array, west: Array, east: Array) -> None:
    """Mass flux through both faces of a column."""
    for j in range(west.size):
        west[j] = 0.5 * (mass[i - 1, j] + mass[i, j])
        east[j] = 0.5 * (mass[i, j] + mass[i + 1, j]) if i < k else mass[i, j]


class Stations(NamedTuple):
    """Columns of the film, the first at the inlet."""

    width: Array
    pressure: Array  #: over that of Hertz
    slope: Array  #: of the pressure
    film: Array
    response: tuple[Array, Array]  #: rise of both surfaces at each by the heat at each


def _build(digest: str) -> Any:
    @cached_njit(**JIT)
    def heat_film(
        k: int, oil: Array, s: Stations, o: Sheared, flux: float, a: Across, b: Along,
        sweeps: int, balance: Array,
    ) -> float:  # fmt: skip
        """Temperatures up to column k, and the balance of heat; change in the last sweep."""
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        count, last = s.film.size, a.temperature.shape[1] - 1
        lneta, dlneta, rho, drho = np.empty((4, count))
        fluidity, west, east, q0, q1, q2, q3, q4, q5 = np.empty((9, last + 1))
        c = Column(q0, q1, q2, q3, q4, q5)
        oil_state(count - 1, s.pressure, oil[:PLAIN], lneta, dlneta, rho, drho)
        T, largest = a.temperature, 0.0
        both_ahead = o.speed_1 > 0.0 and o.speed_2 > 0.0
        for sweep in range(sweeps + 1):
            balance[:] = 0.0
            for i in range(k + 1):
                pressure = s.pressure[i] * o.hertz
                shear_column(
                    i, s.film[i], s.slope[i], pressure, lneta[i], rho[i], flux, o, a, b, fluidity
                )
            if sweep == sweeps:
                for i in range(1, k + 1):
                    _faces(i, k, a.mass, west, east)
                    _count(i, k, s.width[i], s.film[i], s.slope[i], west, east, o, a, b, balance)
                break
            largest = 0.0
            for step in range(2 * k):
                i = step + 1 if step < k else 2 * k - step
                _faces(i, k, a.mass, west, east)
                if i == 1:
                    for j in range(last + 1):
                        T[0, j] = o.temperature if west[j] > 0.0 else T[1, j]
                if step >= k and both_ahead and np.min(east) >= 0.0:
                    continue
                rises = (
                    o.surface_1 + _conducted(i, k, s.response[0], b.heat[0]),
                    o.surface_2 + _conducted(i, k, s.response[1], b.heat[1]),
                )
                selfs = (s.response[0][i, i], s.response[1][i, i])
                for local in range(_LOCAL):
                    if local > 0 or step >= k:
                        pressure = s.pressure[i] * o.hertz
                        shear_column(
                            i, s.film[i], s.slope[i], pressure, lneta[i], rho[i], flux, o, a, b,
                            fluidity,
                        )  # fmt: skip
                        _faces(i, k, a.mass, west, east)
                    exact = b.moved[i] < _SETTLED
                    b.moved[i] = _heat_column(
                        i, k, s.width[i], s.film[i], s.slope[i], west, east, rises, selfs, exact,
                        o, a, b, c,
                    )  # fmt: skip
                    if local == 0 and step < k:
                        largest = max(largest, b.moved[i])
                    if b.moved[i] < _STILL:
                        break
        for i in range(count):
            if i <= k and i > 0:
                continue
            first = o.surface_1 + _conducted(i, k, s.response[0], b.heat[0])
            second = o.surface_2 + _conducted(i, k, s.response[1], b.heat[1])
            for j in range(last + 1):
                if i > k or j == 0 or j == last:
                    T[i, j] = first + (second - first) * j / last
            if i > k:
                b.stress[i] = b.heat[0, i] = b.heat[1, i] = 0.0
                b.factors[0, i], b.factors[1, i] = b.factors[0, k], b.factors[1, k]
                b.mean[i], b.share[i], b.driven[i] = b.mean[k], 1.0, 0.0
        return largest

    return heat_film


@nb.njit(**INNER)
def _count(
    i: int, k: int, dx: float, h: float, slope: float, west: Array, east: Array, o: Sheared,
    a: Across, b: Along, balance: Array,
) -> None:  # fmt: skip
    """Add the heat of a column to the balance."""
    last, T = west.size - 1, a.temperature
    for j in range(last + 1):
        volume = h * dx / last * (0.5 if j == 0 or j == last else 1.0)
        balance[0] += a.stress[i, j] * a.rate[i, j] * volume
        balance[1] += a.expansion[i, j] * a.velocity[i, j] * slope * T[i, j] * volume
        if i == 1:
            balance[4] -= west[j] * o.capacity * (T[0, j] - o.temperature)
        if i == k:
            leaving = T[i, j] if east[j] > 0.0 else o.temperature
            balance[4] += east[j] * o.capacity * (leaving - o.temperature)
    balance[2] += b.heat[0, i] * dx
    balance[3] += b.heat[1, i] * dx


_DIGEST = source_digest(Path(__file__).parent, ("elementary", "reynolds", "heated_shear", "heat"))
heat_film = announced(_build(_DIGEST), "the heated film", "fifteen seconds")
