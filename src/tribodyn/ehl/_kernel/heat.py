"""The energy equation of a heated film, on the nodes of its shear."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.ehl._kernel.elementary import JIT
from tribodyn.ehl._kernel.heated_shear import (
    LEAN,
    LEAST_DENSITY,
    Across,
    Along,
    Sheared,
    shear_column,
)
from tribodyn.ehl._kernel.reynolds import PLAIN, oil_state
from tribodyn.types import Array

_DIGEST = source_digest(Path(__file__).parent, ("elementary", "reynolds", "heated_shear", "heat"))

#: Largest change of a temperature in a step [K].
_CAP = 60.0
#: Steps of a column at most when the sweep comes to it, change at which it stays [K], and shortest
#: part of a step.
_LOCAL, _STILL, _SHORTEST = 12, 0.1, 0.1
#: Part of the temperatures of the sweep before that oil which flows back retains.
_SWIRL = 0.4


@nb.njit(**LEAN)
def _exchange(flux: float, conduction: float, capacity: float) -> tuple[float, float]:
    """Heat per kelvin from above to below, and the other way: power law of Patankar (1980)."""
    carried = flux * capacity
    part = max(0.0, 1.0 - 0.1 * abs(carried) / conduction)
    spread = conduction * part**5
    return spread + max(-carried, 0.0), spread + max(carried, 0.0)


class Stations(NamedTuple):
    """Columns of the film, the first at the inlet."""

    width: Array
    pressure: Array  #: over that of Hertz
    slope: Array  #: of the pressure
    film: Array
    base: Array  #: temperature of both surfaces without the heat of this instant
    response: tuple[Array, Array]  #: rise of both surfaces at each by the heat at each


class Storage(NamedTuple):
    """Mass and heat that the film stores; of a steady film all zero but the inflow and the flux."""

    now: float  #: weight of the mass of this instant in its rate [1/s]
    inflow: float  #: at the first column, over the density at the inlet
    mass: Array  #: weighted masses of the two instants before (2, columns, nodes) [kg/(m s)]
    temperature: Array  #: at these instants
    rate: Array  #: of the pressure at each column [Pa/s]
    flux: Array  #: mass flux through the face behind each column, over the density at the inlet
    heat: Array  #: heat that the film stores [W/m]


@nb.njit(**LEAN)
def _mass(
    i: int, j: int, last: int, s: Stations, density: float, o: Sheared, temperature: float
) -> float:
    """Mass of a cell."""
    ratio = max(density - o.fall * (temperature - o.temperature), LEAST_DENSITY)
    weight = 0.5 if j == 0 or j == last else 1.0
    return weight * s.film[i] * s.width[i] / last * ratio * o.density


@nb.njit(**LEAN)
def _through(k: int, s: Stations, rho: Array, o: Sheared, T: Array, st: Storage) -> None:
    """Fluxes between the columns from what these store."""
    through, last = st.inflow, T.shape[1] - 1
    for i in range(k + 1):
        if st.now > 0.0:
            for j in range(last + 1):
                m = _mass(i, j, last, s, rho[i], o, T[i, j])
                through -= (st.now * m - st.mass[0, i, j] - st.mass[1, i, j]) / o.density
        st.flux[i] = through


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
    before: Array  #: temperatures before the step


@nb.njit(**LEAN)
def _solve_column(last: int, c: Column) -> float:
    """Newton step: the band and two products, of stress and gradient that all nodes share."""
    low, middle, up = c.low, c.middle, c.up
    rhs, shared, steeper = c.rhs, c.shared, c.steeper
    middle[0] = 1.0 / middle[0]
    for j in range(1, last + 1):
        ratio = low[j] * middle[j - 1]
        middle[j] = 1.0 / (middle[j] - ratio * up[j - 1])
        rhs[j] -= ratio * rhs[j - 1]
        shared[j] -= ratio * shared[j - 1]
        steeper[j] -= ratio * steeper[j - 1]
    rhs[last] *= middle[last]
    shared[last] *= middle[last]
    steeper[last] *= middle[last]
    for j in range(last - 1, -1, -1):
        rhs[j] = (rhs[j] - up[j] * rhs[j + 1]) * middle[j]
        shared[j] = (shared[j] - up[j] * shared[j + 1]) * middle[j]
        steeper[j] = (steeper[j] - up[j] * steeper[j + 1]) * middle[j]
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


@nb.njit(**LEAN)
def _find_changes(i: int, h: float, follows: float, a: Across, c: Column) -> bool:
    """Find changes of stress and gradient at equal speeds and flow; whether the film is sheared."""
    last, steep, tilted, flow, sheared = c.rhs.size - 1, 0.0, 0.0, 0.0, 0.0
    ease, reach, rate, falling = a.steep[i], a.reach[i], a.rate[i], a.falling[i]
    for j in range(last + 1):
        arm = h * (j / last - 0.5)
        steep += ease[j]
        tilted += ease[j] * arm
        sheared += reach[j] * ease[j]
        flow += reach[j] * ease[j] * arm
    steep -= 0.5 * (ease[0] + ease[last])
    tilted -= 0.25 * h * (ease[last] - ease[0])
    if not steep > 0.0:
        c.answer[:] = 0.0
        c.climb[:] = 0.0
        return False
    det = steep * flow - tilted * sheared
    share, inverse = (follows / det if det != 0.0 else 0.0), 1.0 / steep
    for j in range(last + 1):
        weight = 0.5 if j == 0 or j == last else 1.0
        faster = rate[j] * falling[j]
        c.climb[j] = share * (sheared * weight - steep * reach[j]) * faster
        c.answer[j] = -(weight * faster + tilted * c.climb[j]) * inverse
    return True


@nb.njit(**LEAN)
def _balance_column(
    i: int, k: int, s: Stations, density: float, west: Array, east: Array,
    rises: tuple[float, float], selfs: tuple[float, float], exact: bool, o: Sheared, st: Storage,
    a: Across, b: Along, c: Column,
) -> float:  # fmt: skip
    """Equations of a column, for Newton's method if exact; size of what is missing."""
    h, dx, slope = s.film[i], s.width[i], s.slope[i]
    last, T, unit = west.size - 1, a.temperature[i], h * dx / (west.size - 1)
    conduction, climb, even, missing = o.conductivity * dx * last / h, 0.0, 0.0, 0.0
    stress, rate, steep, falling = a.stress[i], a.rate[i], a.steep[i], a.falling[i]
    before, behind = a.temperature[i - 1], a.temperature[min(i + 1, k)]
    middle, rhs, shared = c.middle, c.rhs, c.shared
    sheared = _find_changes(i, h, b.follows[i], a, c)
    for j in range(last + 1):
        even += c.answer[j]
    for j in range(last + 1):
        volume, heating = unit * (0.5 if j == 0 or j == last else 1.0), stress[j] * rate[j]
        squeeze = a.expansion[i, j] * (a.velocity[i, j] * slope + st.rate[i]) * volume
        easing = heating * falling[j] * volume
        shared[j] = (rate[j] + stress[j] * steep[j]) * volume if sheared else 0.0
        c.steeper[j] = shared[j] * h * (j / last - 0.5)
        if not exact:
            # As if the column were evenly warmer: this never runs away.
            easing = min(easing + shared[j] * even, 0.0)
            shared[j] = c.steeper[j] = 0.0
        into, back = max(west[j], 0.0) * o.capacity, max(-east[j], 0.0) * o.capacity
        middle[j] = into + back - easing - min(squeeze, 0.0)
        rhs[j] = heating * volume + squeeze * T[j]
        rhs[j] += into * (before[j] - T[j])
        rhs[j] += back * ((behind[j] if i < k else o.temperature) - T[j])
    if st.now > 0.0:
        for j in range(last + 1):
            for n in range(2):
                stored = st.mass[n, i, j] * o.capacity
                middle[j] += stored
                rhs[j] += stored * (st.temperature[n, i, j] - T[j])
    for j in range(last):
        climb -= east[j] - west[j]
        if st.now > 0.0:
            mass = st.now * _mass(i, j, last, s, density, o, T[j])
            climb -= mass - st.mass[0, i, j] - st.mass[1, i, j]
        above, below = _exchange(climb, conduction, o.capacity)
        middle[j] += above
        middle[j + 1] += below
        c.up[j], c.low[j + 1] = -above, -below
        rhs[j] += above * (T[j + 1] - T[j])
        rhs[j + 1] += below * (T[j] - T[j + 1])
    for wall, j in ((0, 0), (1, last)):
        middle[j] += dx / selfs[wall]
        rhs[j] -= dx * (T[j] - rises[wall]) / selfs[wall]
    for j in range(last + 1):
        missing += rhs[j] * rhs[j]
    return missing


@nb.njit(**LEAN)
def _conducted(i: int, k: int, response: Array, heat: Array) -> float:
    """Rise of a surface at a column by the heat that goes in at all other columns."""
    rise = 0.0
    for j in range(1, k + 1):
        rise += response[i, j] * heat[j]
    return rise - (response[i, i] * heat[i] if 1 <= i <= k else 0.0)


@nb.njit(**LEAN)
def _faces(
    i: int, k: int, density: float, mass: Array, st: Storage, west: Array, east: Array
) -> None:
    """Mass flux through both faces of a column."""
    last, entering, leaving = west.size - 1, 0.0, 0.0
    for j in range(last + 1):
        west[j] = 0.5 * (mass[i - 1, j] + mass[i, j])
        east[j] = 0.5 * (mass[i, j] + mass[i + 1, j]) if i < k else mass[i, j]
        entering += west[j]
        leaving += east[j]
    if st.now > 0.0:
        entering = (st.flux[i - 1] * density - entering) / last
        leaving = (st.flux[i] * density - leaving) / last
        for j in range(last + 1):
            weight = 0.5 if j == 0 or j == last else 1.0
            west[j] += weight * entering
            east[j] += weight * leaving


@nb.njit(**LEAN)
def _relax(
    i: int, k: int, again: bool, s: Stations, rises: tuple[float, float],
    selfs: tuple[float, float], log_viscosity: float, density: float, o: Sheared, st: Storage,
    a: Across, b: Along, c: Column, work: Array, west: Array, east: Array,
) -> float:  # fmt: skip
    """Solve one column by Newton's method with shorter steps where it misses; first change."""
    last, T, h, first = west.size - 1, a.temperature, s.film[i], 0.0
    pressure, before, part, largest = s.pressure[i], np.inf, 1.0, 0.0
    exact, flux = True, 0.5 * (st.flux[i - 1] + st.flux[i])
    for local in range(_LOCAL):
        if local > 0 or again:
            shear_column(
                i, h, s.slope[i], pressure * o.hertz, log_viscosity, density, flux, o, a, b,
                work,
            )  # fmt: skip
            _faces(i, k, o.density, a.mass, st, west, east)
        missing = _balance_column(i, k, s, density, west, east, rises, selfs, exact, o, st, a, b, c)
        if not missing < before and part > _SHORTEST:
            # Back to a shorter step; one without stress and gradient where none helps.
            part *= 0.5
            for j in range(last + 1):
                T[i, j] -= part * c.before[j]
            continue
        if not missing < before and exact:
            exact = False
            _balance_column(i, k, s, density, west, east, rises, selfs, False, o, st, a, b, c)
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


@nb.njit(**LEAN)
def _rises(i: int, k: int, s: Stations, heat: Array) -> tuple[float, float]:
    """Temperatures of both surfaces at a column that takes up no heat itself."""
    first = s.base[0, i] + _conducted(i, k, s.response[0], heat[0])
    return first, s.base[1, i] + _conducted(i, k, s.response[1], heat[1])


@nb.njit(**LEAN)
def _sweep(
    k: int, s: Stations, o: Sheared, st: Storage, a: Across, b: Along, c: Column, lneta: Array,
    rho: Array, earlier: Array, rows: Array,
) -> float:  # fmt: skip
    """Solve the columns downstream, then upstream those into which oil flows back."""
    T, last, largest, west, east = a.temperature, rows.shape[1] - 1, 0.0, rows[3], rows[4]
    both_ahead = o.speed_1 > 0.0 and o.speed_2 > 0.0
    for i in range(k + 1):
        for j in range(last + 1):
            earlier[i, j] = T[i, j]
    for step in range(2 * k):
        i = step + 1 if step < k else 2 * k - step
        _faces(i, k, o.density, a.mass, st, west, east)
        backwards = False
        for j in range(last + 1):
            backwards = backwards or east[j] < 0.0
        if i == 1:
            for j in range(last + 1):
                T[0, j] = o.temperature if west[j] > 0.0 else T[1, j]
        if step >= k and both_ahead and not backwards:
            continue
        rises = _rises(i, k, s, b.heat)
        selfs = (s.response[0][i, i], s.response[1][i, i])
        moved = _relax(
            i, k, step >= k, s, rises, selfs, lneta[i], rho[i], o, st, a, b, c, rows[:3], west,
            east,
        )  # fmt: skip
        largest = max(largest, moved)
        if step >= k and backwards:
            # Oil that runs around in the inlet would swing between hot and cold.
            for j in range(last + 1):
                T[i, j] += _SWIRL * (earlier[i, j] - T[i, j])
            b.heat[0, i] = (T[i, 0] - rises[0]) / selfs[0]
            b.heat[1, i] = (T[i, last] - rises[1]) / selfs[1]
    return largest


@nb.njit(**LEAN)
def _heat(
    k: int, s: Stations, o: Sheared, st: Storage, a: Across, b: Along, c: Column, lneta: Array,
    rho: Array, sweeps: int, earlier: Array, rows: Array, balance: Array,
) -> float:  # fmt: skip
    """Sweeps over the columns, and the state that they lead to; change in the last sweep."""
    T, west, east = a.temperature, rows[3], rows[4]
    count, last, largest = lneta.size, rows.shape[1] - 1, 0.0
    for sweep in range(sweeps + 1):
        _through(k, s, rho, o, T, st)
        for i in range(k + 1):
            pressure, flux = s.pressure[i] * o.hertz, st.inflow
            if i > 0:
                flux = 0.5 * (st.flux[i - 1] + st.flux[i])
            shear_column(
                i, s.film[i], s.slope[i], pressure, lneta[i], rho[i], flux, o, a, b, rows[:3]
            )
        if sweep < sweeps:
            largest = _sweep(k, s, o, st, a, b, c, lneta, rho, earlier, rows)
    for term in range(balance.size):
        balance[term] = 0.0
    for i in range(1, k + 1):
        _faces(i, k, o.density, a.mass, st, west, east)
        _count(i, k, s, rho[i], west, east, o, st, a, b, balance)
    for i in range(count):
        if i <= k and i > 0:
            continue
        first, second = _rises(i, k, s, b.heat)
        for j in range(last + 1):
            if i > k or j == 0 or j == last:
                T[i, j] = first + (second - first) * j / last
        if i > k:
            b.stress[i] = b.heat[0, i] = b.heat[1, i] = 0.0
            b.factors[0, i], b.factors[1, i] = b.factors[0, k], b.factors[1, k]
            b.mean[i], b.share[i], b.driven[i] = b.mean[k], 1.0, 0.0
    return largest


@cached_njit(_DIGEST, "the heated film", "fifteen seconds", **JIT)
def heat_film(
    k: int, oil: Array, s: Stations, o: Sheared, st: Storage, a: Across, b: Along,
    sweeps: int, balance: Array,
) -> float:  # fmt: skip
    """Temperatures up to column k, and the balance of heat; change in the last sweep."""
    count, across = s.film.size, a.temperature.shape[1]
    lneta, dlneta, rho, drho = np.empty((4, count))
    oil_state(count - 1, s.pressure, oil[:PLAIN], lneta, dlneta, rho, drho)
    rows, earlier = np.empty((14, across)), np.empty((count, across))
    c = Column(rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7], rows[8])
    return _heat(k, s, o, st, a, b, c, lneta, rho, sweeps, earlier, rows[9:], balance)


@nb.njit(**LEAN)
def _count(
    i: int, k: int, s: Stations, density: float, west: Array, east: Array, o: Sheared, st: Storage,
    a: Across, b: Along, balance: Array,
) -> None:  # fmt: skip
    """Add the heat of a column to the balance."""
    last, T, dx, h, slope = west.size - 1, a.temperature, s.width[i], s.film[i], s.slope[i]
    if i == 1:
        st.heat[0] = 0.0
    for j in range(last + 1):
        volume = h * dx / last * (0.5 if j == 0 or j == last else 1.0)
        balance[0] += a.stress[i, j] * a.rate[i, j] * volume
        pressing = a.velocity[i, j] * slope + st.rate[i]
        balance[1] += a.expansion[i, j] * pressing * T[i, j] * volume
        stored = st.now * _mass(i, j, last, s, density, o, T[i, j]) * (T[i, j] - o.temperature)
        for n in range(2):
            stored -= st.mass[n, i, j] * (st.temperature[n, i, j] - o.temperature)
        st.heat[0] += o.capacity * stored
        if i == 1:
            balance[4] -= west[j] * o.capacity * (T[0, j] - o.temperature)
        if i == k:
            leaving = T[i, j] if east[j] > 0.0 else o.temperature
            balance[4] += east[j] * o.capacity * (leaving - o.temperature)
    balance[2] += b.heat[0, i] * dx
    balance[3] += b.heat[1, i] * dx
