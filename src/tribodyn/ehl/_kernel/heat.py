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
#: Steps of a column at most when the sweep comes to it, change at which it stays [K], and shortest
#: part of a step.
_LOCAL, _STILL, _SHORTEST = 12, 0.01, 0.1
#: Part of the temperatures of the sweep before that oil which flows back retains.
_SWIRL = 0.4


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
    steeper: Array  #: heat per change of the gradient of the pressure
    answer: Array  #: change of that stress per kelvin
    climb: Array  #: change of that gradient per kelvin
    reach: Array  #: flow per rate of shear
    before: Array  #: temperatures before the step


@nb.njit(**INNER)
def _solve_column(last: int, c: Column) -> float:
    """Newton step: the band and two products, of stress and gradient that all nodes share."""
    for j in range(1, last + 1):
        ratio = c.low[j] / c.middle[j - 1]
        c.middle[j] -= ratio * c.up[j - 1]
        c.rhs[j] -= ratio * c.rhs[j - 1]
        c.shared[j] -= ratio * c.shared[j - 1]
        c.steeper[j] -= ratio * c.steeper[j - 1]
    for j in range(last, -1, -1):
        if j < last:
            c.rhs[j] -= c.up[j] * c.rhs[j + 1]
            c.shared[j] -= c.up[j] * c.shared[j + 1]
            c.steeper[j] -= c.up[j] * c.steeper[j + 1]
        c.rhs[j] /= c.middle[j]
        c.shared[j] /= c.middle[j]
        c.steeper[j] /= c.middle[j]
    f0 = f1 = a00 = a01 = a10 = a11 = largest = 0.0
    for j in range(last + 1):
        f0 += c.answer[j] * c.rhs[j]
        f1 += c.climb[j] * c.rhs[j]
        a00 += c.answer[j] * c.shared[j]
        a01 += c.answer[j] * c.steeper[j]
        a10 += c.climb[j] * c.shared[j]
        a11 += c.climb[j] * c.steeper[j]
    det = (1.0 - a00) * (1.0 - a11) - a01 * a10
    stress = ((1.0 - a11) * f0 + a01 * f1) / det
    slope = ((1.0 - a00) * f1 + a10 * f0) / det
    for j in range(last + 1):
        c.rhs[j] += c.shared[j] * stress + c.steeper[j] * slope
        largest = max(largest, abs(c.rhs[j]))
    return largest


@nb.njit(**INNER)
def _answers(i: int, h: float, follows: float, a: Across, c: Column) -> bool:
    """Changes of stress and gradient that hold speeds and flow; whether the film is sheared."""
    last = c.rhs.size - 1
    above = steep = tilted = flow = sheared = 0.0
    for j in range(last, -1, -1):
        # Everything above a node moves with the shear below it.
        lower = above
        above += a.mass[i, j] / a.velocity[i, j] if abs(a.velocity[i, j]) > 1e-12 else 0.0
        weight = 0.5 if j == 0 or j == last else 1.0
        c.reach[j] = 0.5 * (lower + (above if j > 0 else 0.0))
        arm = h * (j / last - 0.5)
        steep += weight * a.steep[i, j]
        tilted += weight * a.steep[i, j] * arm
        sheared += c.reach[j] * a.steep[i, j]
        flow += c.reach[j] * a.steep[i, j] * arm
    if not steep > 0.0:
        c.answer[:] = 0.0
        c.climb[:] = 0.0
        return False
    det = steep * flow - tilted * sheared
    for j in range(last + 1):
        weight = 0.5 if j == 0 or j == last else 1.0
        faster = a.rate[i, j] * a.falling[i, j]
        c.climb[j] = 0.0
        if follows > 0.0 and det != 0.0:
            c.climb[j] = follows * (sheared * weight - steep * c.reach[j]) * faster / det
        c.answer[j] = -(weight * faster + tilted * c.climb[j]) / steep
    return True


@nb.njit(**INNER)
def _balance_column(
    i: int, k: int, dx: float, h: float, slope: float, west: Array, east: Array,
    rises: tuple[float, float], selfs: tuple[float, float], exact: bool, o: Sheared, a: Across,
    b: Along, c: Column,
) -> float:  # fmt: skip
    """Equations of a column, for Newton's method if exact; size of what is missing."""
    last, T = west.size - 1, a.temperature
    dz, unit = h / last, h * dx / last
    conduction, climb, even, missing = o.conductivity * dx / dz, 0.0, 0.0, 0.0
    sheared = _answers(i, h, b.follows[i], a, c)
    for j in range(last + 1):
        c.middle[j] = c.rhs[j] = c.low[j] = c.up[j] = 0.0
        even += c.answer[j]
    for j in range(last + 1):
        weight = 0.5 if j == 0 or j == last else 1.0
        volume, heating = weight * unit, a.stress[i, j] * a.rate[i, j]
        squeeze = a.expansion[i, j] * a.velocity[i, j] * slope * volume
        own, stress = heating * a.falling[i, j] * volume, a.stress[i, j] * a.steep[i, j]
        c.shared[j] = (a.rate[i, j] + stress) * volume if sheared else 0.0
        c.steeper[j] = c.shared[j] * h * (j / last - 0.5)
        if not exact:
            # As if the column were evenly warmer: this never runs away.
            own = min(own + c.shared[j] * even, 0.0)
            c.shared[j] = c.steeper[j] = 0.0
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
    for j in range(last + 1):
        missing += c.rhs[j] * c.rhs[j]
    return missing


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


@nb.njit(**INNER)
def _relax(
    i: int, k: int, again: bool, s: Stations, rises: tuple[float, float],
    selfs: tuple[float, float], log_viscosity: float, density: float, flux: float, o: Sheared,
    a: Across, b: Along, c: Column, fluidity: Array, west: Array, east: Array,
) -> float:  # fmt: skip
    """Solve one column by Newton's method with shorter steps where it misses; first change."""
    last, T, h, dx, first = west.size - 1, a.temperature, s.film[i], s.width[i], 0.0
    pressure, before, part, largest = s.pressure[i], np.inf, 1.0, 0.0
    exact = True
    for local in range(_LOCAL):
        if local > 0 or again:
            shear_column(
                i, h, s.slope[i], pressure * o.hertz, log_viscosity, density, flux, o, a, b,
                fluidity,
            )  # fmt: skip
            _faces(i, k, a.mass, west, east)
        missing = _balance_column(
            i, k, dx, h, s.slope[i], west, east, rises, selfs, exact, o, a, b, c
        )
        if not missing < before and part > _SHORTEST:
            # Back to a shorter step; one without stress and gradient where none helps.
            part *= 0.5
            for j in range(last + 1):
                T[i, j] -= part * c.before[j]
            continue
        if not missing < before and exact:
            exact = False
            _balance_column(i, k, dx, h, s.slope[i], west, east, rises, selfs, False, o, a, b, c)
            missing = np.inf
        largest = _solve_column(last, c)
        part, before = (1.0 if largest <= _CAP else _CAP / largest), missing
        for j in range(last + 1):
            c.before[j] = c.rhs[j]
            T[i, j] += part * c.rhs[j]
        b.heat[0, i] = (T[i, 0] - rises[0]) / selfs[0]
        b.heat[1, i] = (T[i, last] - rises[1]) / selfs[1]
        first = largest if local == 0 else first
        if largest < _STILL:
            break
        exact = True
    b.moved[i] = largest
    return first


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
        fluidity, west, east, q0, q1, q2, q3, q4, q5, q6, q7, q8, q9 = np.empty((13, last + 1))
        c = Column(q0, q1, q2, q3, q4, q5, q6, q7, q8, q9)
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
            largest, earlier = 0.0, T.copy()
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
                moved = _relax(
                    i, k, step >= k, s, rises, selfs, lneta[i], rho[i], flux, o, a, b, c, fluidity,
                    west, east,
                )  # fmt: skip
                largest = max(largest, moved)
                if step >= k and np.min(east) < 0.0:
                    # Oil that runs around in the inlet would swing between hot and cold.
                    for j in range(last + 1):
                        T[i, j] += _SWIRL * (earlier[i, j] - T[i, j])
                    b.heat[0, i] = (T[i, 0] - rises[0]) / selfs[0]
                    b.heat[1, i] = (T[i, last] - rises[1]) / selfs[1]
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
