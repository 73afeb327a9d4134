"""Shear and flow across every column of a heated film.

Nodes 0..n along the film, 0..N evenly across it, surface 1 at node 0 and surface 2 at node N. The
stress is ``tau_m + (z - h/2) dp/dx``, and ``eta du/dz = g(stress)`` with ``g`` of the shear model.
SI units.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled.jit import LEAN_OPTIONS
from tribodyn.ehl._kernel.elementary import JIT, exp_, log_
from tribodyn.types import Array

LEAN = {**JIT, **LEAN_OPTIONS}
#: Shear models by the number that the kernel has for them.
NEWTONIAN, EYRING, CARREAU, CARREAU_EYRING, BAIR_WINER = 0, 1, 2, 3, 4
#: Greatest stress over Eyring's, and part of a limit.
_HIGHEST, _NEARLY = 60.0, 1.0 - 1e-6
#: ln of the viscosity in which Roelands' curves meet, sign changed, and their pole [K].
_LOG_POLE, _POLE = 9.67, 138.0
#: Flow by a gradient of the pressure, over what is missing of the flow, and over the flow.
_EXCESS, _SPARE = 1.0, 0.002
#: Part of the flow that it drives above which the flow alone counts, part that does not matter, and
#: how often the gradient is corrected.
_DRIVEN, _NEGLIGIBLE, _BOUNDED = 0.2, 1e-5, 12
#: Flow by pressure over all flow that is lost in rounding.
_ROUNDING = 1e-6
#: Factors on density and flow beyond which the film is nonsense.
_LEAST_FLOW, LEAST_DENSITY = 1e-3, 0.3
#: Greatest factor by which the flow is scaled.
_SCALED = 10.0
#: Change of a rate over it after which stresses and rates follow in proportion.
_STEADY = 1e-4
#: Range of Carreau's law in exponents, on both sides, and intervals of its table for each.
_RANGE, _FINE = 30.0, 32


class Sheared(NamedTuple):
    """Oil and surfaces of a heated film."""

    speed_1: float
    speed_2: float
    viscosity: float  #: at the inlet
    density: float  #: at the inlet
    fall: float  #: of the density per kelvin, over the density at the inlet
    temperature: float  #: at the inlet
    thinning: float  #: fall of ln(viscosity) per kelvin at the inlet
    roelands: bool  #: whether the viscosity falls as Roelands says, or at an even rate
    conductivity: float
    capacity: float  #: heat per mass and kelvin
    hertz: float  #: unit of the pressure
    model: int
    eyring: float  #: Eyring's stress
    carreau: float  #: Carreau's stress
    exponent: float
    yasuda: float
    limit: float  #: limiting stress without pressure, infinite for none
    limit_slope: float
    table: Array  #: of :func:`carreau_table`


class Across(NamedTuple):
    """What the nodes (along, across) of the film have."""

    temperature: Array
    rate: Array  #: du/dz
    stress: Array
    steep: Array  #: d(du/dz)/d(stress) at one temperature
    falling: Array  #: fall of ln(viscosity) per kelvin
    mass: Array  #: mass flux through the height of each node
    expansion: Array  #: -d(ln density)/dT
    velocity: Array
    reach: Array  #: flow per rate of shear


class Along(NamedTuple):
    """What the nodes along the film have."""

    heat: Array  #: into surfaces 1 and 2, per area
    stress: Array  #: in the middle of the film
    factors: Array  #: logarithm of the factor on viscosity, and factor on density
    mean: Array  #: harmonic mean over the film of the viscosity at low stress
    share: Array  #: step of the factors that a flow which grows faster than the pressure allows
    slope: Array  #: of the pressure
    driven: Array  #: flow by pressure, over the flow
    growth: Array  #: of the flow with the gradient of the pressure
    follows: Array  #: part of the gradient that follows the flow at other temperatures
    moved: Array  #: greatest change of a temperature in the last sweep
    idle: Array  #: stress in the middle without a gradient of the pressure
    content: Array  #: mass across the film, over the density at the inlet


@lru_cache(maxsize=8)
def carreau_table(exponent: float, yasuda: float) -> Array:
    """ln(rate/stress) and its slope over ln(stress) from ``-_RANGE/yasuda`` on, in its stress."""
    step = exponent / (_FINE * yasuda)
    count = 2 + int(np.ceil(_RANGE * (1.0 + exponent) / yasuda / step))
    wanted = step * np.arange(count) - _RANGE / yasuda
    power, root = (exponent - 1.0) / yasuda, np.where(wanted < 0.0, wanted, wanted / exponent)
    for _ in range(30):
        bend = np.logaddexp(0.0, yasuda * root)
        slope = 1.0 + (exponent - 1.0) * np.exp(yasuda * root - bend)
        change = (wanted - root - power * bend) / slope
        root += change
        if np.max(np.abs(change)) < 1e-14 * _RANGE:
            break
    return np.stack([root - wanted, (1.0 / slope - 1.0) * step])


@nb.njit(**LEAN)
def _carreau(stress: float, o: Sheared) -> tuple[float, float]:
    """Rate over a positive stress, and slope of that logarithm over that of the stress."""
    values, slopes = o.table[0], o.table[1]
    inverse, last = _FINE * o.yasuda / o.exponent, values.size - 1
    place = (log_(stress / o.carreau) + _RANGE / o.yasuda) * inverse
    if place <= 0.0:
        return 1.0, 0.0
    if place >= last:
        return exp_(values[last] + (place - last) * slopes[last]), slopes[last] * inverse
    at = int(place)
    t, before, after = place - at, slopes[at], slopes[at + 1]
    rise = values[at + 1] - values[at]
    bend, twist = 3.0 * rise - 2.0 * before - after, before + after - 2.0 * rise
    value = values[at] + t * (before + t * (bend + t * twist))
    return exp_(value), (before + t * (2.0 * bend + 3.0 * t * twist)) * inverse


@nb.njit(**LEAN)
def _thinned(stress: float, limit: float, o: Sheared) -> tuple[float, float]:
    """``g`` of a stress, and its slope: the stress of Newton's oil at that rate."""
    sign, size, slope = (-1.0 if stress < 0.0 else 1.0), abs(stress), 1.0
    if o.model == BAIR_WINER:
        bound = min(size, _NEARLY * limit)
        slope = 1.0 / (1.0 - bound / limit)
        return sign * (limit * log_(slope) + (size - bound) * slope), slope
    if o.model == EYRING or o.model == CARREAU_EYRING:
        ratio = min(size / o.eyring, _HIGHEST)
        rising = exp_(ratio)
        slope = 0.5 * (rising + 1.0 / rising)
        if ratio > 1e-4:
            size = o.eyring * 0.5 * (rising - 1.0 / rising)
    if o.model >= CARREAU and size > 1e-9 * o.carreau:
        more, growth = _carreau(size, o)
        size *= more
        slope *= more * (1.0 + growth)
    return sign * size, slope


@nb.njit(**LEAN)
def _fill_rates(
    i: int, middle: float, half: float, limit: float, fluidity: Array, o: Sheared, a: Across
) -> tuple[float, float]:
    """Rates across a column at a stress in its middle; their mean, and its growth with that."""
    last, mean, growth = fluidity.size - 1, 0.0, 0.0
    stress, rate, steep = a.stress[i], a.rate[i], a.steep[i]
    even = 2.0 / last
    for j in range(last + 1):
        stress[j] = middle + half * (even * j - 1.0)
    if o.model == NEWTONIAN:
        for j in range(last + 1):
            rate[j] = stress[j] * fluidity[j]
            steep[j] = fluidity[j]
    elif o.model == EYRING and abs(middle) + abs(half) < _HIGHEST * o.eyring:
        # Exponentials of evenly spaced stresses are powers of one.
        up, more = exp_((middle - half) / o.eyring), exp_(even * half / o.eyring)
        down, less, unit = 1.0 / up, 1.0 / more, 0.5 * o.eyring
        for j in range(last + 1):
            rate[j] = unit * (up - down) * fluidity[j]
            steep[j] = 0.5 * (up + down) * fluidity[j]
            up *= more
            down *= less
    else:
        for j in range(last + 1):
            g, slope = _thinned(stress[j], limit, o)
            rate[j] = g * fluidity[j]
            steep[j] = slope * fluidity[j]
    for j in range(last + 1):
        mean += rate[j]
        growth += steep[j]
    mean -= 0.5 * (rate[0] + rate[last])
    growth -= 0.5 * (steep[0] + steep[last])
    return mean / last, growth / last


@nb.njit(**LEAN)
def _eyring_stress(half: float, rate: float, fluidity: Array, o: Sheared) -> float:
    """Stress in the middle of a film of Eyring's oil, in closed form."""
    last, even, odd = fluidity.size - 1, 0.0, 0.0
    up, more = exp_(-half / o.eyring), exp_(2.0 * half / (last * o.eyring))
    down, less = 1.0 / up, 1.0 / more
    for j in range(last + 1):
        weight = fluidity[j] * (0.25 if j == 0 or j == last else 0.5) / last
        even += weight * (up + down)
        odd += weight * (up - down)
        up *= more
        down *= less
    # even sinh(s) + odd cosh(s) = rate, with s the stress in the middle over Eyring's.
    root = np.sqrt((even - odd) * (even + odd))
    return float(o.eyring * (np.arcsinh(rate / (o.eyring * root)) - np.arctanh(odd / even)))


@nb.njit(**LEAN)
def _fill_sheared(
    i: int, half: float, rate: float, limit: float, fluidity: Array, o: Sheared, a: Across, b: Along
) -> None:
    """Stress and rates across a column that is sheared at a rate on the mean."""
    last, fluid, moment = fluidity.size - 1, 0.0, 0.0
    for j in range(last + 1):
        weight = fluidity[j] * (0.5 if j == 0 or j == last else 1.0) / last
        fluid += weight
        moment += weight * half * (2.0 * j / last - 1.0)
    if o.model == NEWTONIAN or (o.model == EYRING and abs(half) < _HIGHEST * o.eyring):
        middle = (rate - moment) / fluid
        if o.model == EYRING:
            middle = _eyring_stress(half, rate, fluidity, o)
        b.stress[i] = middle
        _fill_rates(i, middle, half, limit, fluidity, o, a)
        return
    # An oil that thins has at most the stress of Newton's oil.
    high = abs(rate) / fluid + abs(half)
    low, middle = -high, min(max(b.stress[i], -high), high)
    # Over the logarithms of large rates, which grow as fast as the sinh or the power law.
    unit = fluid * min(o.eyring, o.carreau)
    wanted = np.arcsinh(rate / unit)
    for _ in range(100):
        value, slope = _fill_rates(i, middle, half, limit, fluidity, o, a)
        if value > rate:
            high = middle
        else:
            low = middle
        change = (rate - value) / slope
        if abs(rate - value) <= _STEADY * np.hypot(value, unit):
            for j in range(last + 1):
                a.stress[i, j] += change
                a.rate[i, j] += change * a.steep[i, j]
            middle += change
            break
        step = middle + (wanted - np.arcsinh(value / unit)) * np.hypot(value, unit) / slope
        middle = step if low < step < high else 0.5 * (low + high)
    b.stress[i] = middle


@nb.njit(**LEAN)
def _growth(h: float, ease: Array, reach: Array) -> float:
    """Flow by a gradient of the pressure, over the gradient, that rates of an ease drive."""
    last, fluid, tilted, moved, driven = ease.size - 1, 0.0, 0.0, 0.0, 0.0
    for j in range(last + 1):
        arm = h * (j / last - 0.5)
        fluid += ease[j]
        tilted += ease[j] * arm
        moved += reach[j] * ease[j]
        driven += reach[j] * ease[j] * arm
    fluid -= 0.5 * (ease[0] + ease[last])
    tilted -= 0.25 * h * (ease[last] - ease[0])
    return tilted / fluid * moved - driven


@nb.njit(**LEAN)
def _flow(
    i: int, h: float, slope: float, limit: float, o: Sheared, a: Across, b: Along, work: Array
) -> tuple[float, bool]:
    """Flow of a column sheared at a gradient of the pressure, and whether it yields."""
    fluidity, reach, last = work[0], a.reach[i], work.shape[1] - 1
    rate, half = (o.speed_2 - o.speed_1) / h, 0.5 * h * slope
    _fill_sheared(i, half, rate, limit, fluidity, o, a, b)
    slips = False
    if limit < np.inf and o.model != BAIR_WINER:
        # The film yields where the stress at one of its walls reaches the limit.
        most = max(limit - abs(half), 0.0)
        if abs(b.stress[i]) > most:
            b.stress[i] = np.copysign(most, b.stress[i])
            slip = rate - _fill_rates(i, b.stress[i], half, limit, fluidity, o, a)[0]
            slips = slip != 0.0
            for j in range(last + 1):
                a.rate[i, j] += slip
                if slips:
                    a.steep[i, j] = 0.0
                # The oil of a film that yields flows as it does cold.
                stress = max(abs(a.stress[i, j]), 1e-3)
                work[2, j] = max(abs(a.rate[i, j]) / stress, fluidity[j])
    b.growth[i] = _growth(h, work[2] if slips else a.steep[i], reach)
    total = 0.0
    for j in range(last + 1):
        total += reach[j] * a.rate[i, j]
    return b.content[i] * o.speed_1 + total, slips


@nb.njit(**LEAN)
def shear_column(
    i: int, h: float, slope: float, pressure: float, log_viscosity: float, density: float,
    flux: float, o: Sheared, a: Across, b: Along, work: Array,
) -> None:  # fmt: skip
    """Stress, rate, velocity, mass flux and factors of one column at its temperatures."""
    limit = np.inf
    if o.limit < np.inf:
        limit = o.limit + o.limit_slope * max(pressure, 0.0)
    _fill_oil(i, h, log_viscosity, density, o, a, b, work)
    b.stress[i], before = b.idle[i], b.stress[i]
    idle, slips = _flow(i, h, 0.0, limit, o, a, b, work)
    b.idle[i], b.stress[i] = b.stress[i], before
    # While pressure and temperatures are not settled, the gradient that the mass flux needs
    # counts where it drives much of it, and elsewhere no more than could be needed: else heat
    # and flow would run away. Both are roots of a flow that rises with the gradient.
    missing, size = idle - flux, max(abs(flux), _LEAST_FLOW * abs(idle))
    b.driven[i] = abs(missing) / size
    part = min(max(b.driven[i] / _DRIVEN - 0.5, 0.0), 1.0)
    most, needed, better, b.follows[i] = _EXCESS * abs(missing) + _SPARE * size, 0.0, slope, 1.0
    total, at = idle, 0.0
    if part > 0.0:
        needed = _gradient(i, h, limit, idle, missing, o, a, b, work)
        at = np.nan
    if part < 1.0:
        total, slips = _flow(i, h, slope, limit, o, a, b, work)
        at = slope
        if abs(idle - total) > most:
            better = _gradient(i, h, limit, idle, np.copysign(most, slope), o, a, b, work)
            at = np.nan
        else:
            b.follows[i] = part
    b.slope[i] = part * needed + (1.0 - part) * better
    if at != b.slope[i]:
        total, slips = _flow(i, h, b.slope[i], limit, o, a, b, work)
    # Flow by pressure is what the flow without a gradient has more, in the limit that it grows by.
    secant = b.growth[i]
    if abs(idle - total) > _ROUNDING * size and (idle > total) == (b.slope[i] > 0.0):
        secant = (idle - total) / b.slope[i]
    moved = total + secant * b.slope[i]
    b.factors[1, i] = max(moved / (density * h * 0.5 * (o.speed_1 + o.speed_2)), _LEAST_FLOW)
    # The sum over the nodes has this part of the integral for a cold film.
    exact = 1.0 - 1.0 / (work.shape[1] - 1) ** 2
    unit = 12.0 * o.viscosity * exp_(log_viscosity) / (density * h * h * h * exact)
    b.factors[0, i] = np.log(b.factors[1, i] / max(unit * secant, _LEAST_FLOW))
    b.share[i] = min(secant / b.growth[i], 1.0)
    _carry(i, h, flux, total, slips, o, a, work)


@nb.njit(**LEAN)
def _carry(
    i: int, h: float, flux: float, total: float, slips: bool, o: Sheared, a: Across, work: Array
) -> None:
    """Velocity and mass flux of a column that is sheared, with the flow that the film has."""
    last, u, scale, added = work.shape[1] - 1, o.speed_1, flux / total, 0.0
    if not 1.0 / _SCALED < scale < _SCALED:
        # A film that is squeezed may have none.
        scale, added = 1.0, (flux - total) / last * o.density
    scale *= o.density
    half = 0.5 * h / last
    for j in range(last + 1):
        if j > 0:
            u += half * (a.rate[i, j - 1] + a.rate[i, j])
        a.velocity[i, j] = u
        a.mass[i, j] = scale * work[1, j] * u + (0.5 if j == 0 or j == last else 1.0) * added
        if slips:
            # A film that yields makes the same heat at any temperature.
            a.falling[i, j] = 0.0


@nb.njit(**LEAN)
def _gradient(
    i: int, h: float, limit: float, idle: float, wanted: float, o: Sheared, a: Across, b: Along,
    work: Array,
) -> float:  # fmt: skip
    """Gradient of the pressure that drives a flow, by Newton's method over the logarithms."""
    size, low = abs(wanted), 0.0
    # An oil that thins needs no more than Newton's oil, up to the effect of uneven density.
    flow = _growth(h, work[0], a.reach[i])
    high = 1.5 * size / flow
    if o.model == NEWTONIAN or high == 0.0:
        return wanted / flow
    gradient = min(abs(b.slope[i]), 0.7 * high)
    if gradient == 0.0:
        gradient = min(size / b.growth[i], 0.7 * high)
    for _ in range(_BOUNDED):
        driven = abs(idle - _flow(i, h, np.copysign(gradient, wanted), limit, o, a, b, work)[0])
        if abs(driven - size) < _NEGLIGIBLE * size:
            break
        if driven > size:
            high = gradient
        else:
            low = gradient
        step = np.log(size / driven) * driven / (gradient * b.growth[i]) if driven > 0.0 else 9.0
        gradient *= np.exp(min(max(step, -9.0), 9.0))
        if not low < gradient < high:
            gradient = np.sqrt(low * high) if low > 0.0 else 0.05 * high
    return float(np.copysign(gradient, wanted))


@nb.njit(**LEAN)
def _fill_oil(
    i: int, h: float, log_viscosity: float, density: float, o: Sheared, a: Across, b: Along,
    work: Array,
) -> None:  # fmt: skip
    """Fluidity at low stress, its rise with the temperature, and mass across a column."""
    fluidity, mass, last = work[0], work[1], work.shape[1] - 1
    T, falling, expansion, reach = a.temperature[i], a.falling[i], a.expansion[i], a.reach[i]
    cold, mean, dz = np.log(o.viscosity), 0.0, h / last
    above, height = o.temperature - _POLE, log_viscosity + cold + _LOG_POLE
    exponent, inverse = o.thinning * above / (cold + _LOG_POLE), 1.0 / above
    if o.roelands:
        for j in range(last + 1):
            warm = max(T[j] - _POLE, 1.0)
            hot = height * exp_(-exponent * log_(warm * inverse))
            falling[j] = exponent * hot / warm
            fluidity[j] = exp_(_LOG_POLE - hot)
    else:
        for j in range(last + 1):
            falling[j] = o.thinning
            fluidity[j] = exp_(o.thinning * (T[j] - o.temperature) - log_viscosity - cold)
    for j in range(last + 1):
        ratio = max(density - o.fall * (T[j] - o.temperature), LEAST_DENSITY)
        expansion[j] = o.fall / ratio
        mass[j] = ratio * dz
        mean += fluidity[j]
    mass[0] *= 0.5
    mass[last] *= 0.5
    b.mean[i] = last / (mean - 0.5 * (fluidity[0] + fluidity[last]))
    above = 0.0
    for j in range(last, -1, -1):
        # Everything above a node moves with the shear below it.
        lower = above
        above += mass[j]
        reach[j] = 0.5 * dz * (lower + (above if j > 0 else 0.0))
    b.content[i] = above
