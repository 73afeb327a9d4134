"""Shear and flow across every column of a heated film.

Nodes 0..n along the film, 0..N evenly across it, surface 1 at node 0 and surface 2 at node N. The
stress is ``tau_m + (z - h/2) dp/dx``, and ``eta du/dz = g(stress)`` with ``g`` of the shear model.
SI units.
"""

from __future__ import annotations

from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import INNER, exp_, log_
from tribodyn.types import Array

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
_DRIVEN, _NEGLIGIBLE, _BOUNDED = 0.2, 1e-6, 12
#: Flow by pressure over all flow that is lost in rounding.
_NEGLIGIBLE_FLOW = 1e-6
#: Factors on density and flow beyond which the film is nonsense.
_LEAST_FLOW, _LEAST_DENSITY = 1e-3, 0.3


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
    surface_1: float  #: temperature far before the contact
    surface_2: float
    model: int
    eyring: float  #: Eyring's stress
    carreau: float  #: Carreau's stress
    exponent: float
    yasuda: float
    limit: float  #: limiting stress without pressure, infinite for none
    limit_slope: float


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


@nb.njit(**INNER)
def _thinned(stress: float, limit: float, o: Sheared) -> tuple[float, float]:
    """``g`` of a stress, and its slope: the stress of Newton's oil at that rate."""
    sign, size, slope = (-1.0 if stress < 0.0 else 1.0), abs(stress), 1.0
    if o.model == BAIR_WINER:
        bound = min(size, _NEARLY * limit)
        slope = 1.0 / (1.0 - bound / limit)
        return sign * (limit * np.log(slope) + (size - bound) * slope), slope
    if o.model == EYRING or o.model == CARREAU_EYRING:
        ratio = min(size / o.eyring, _HIGHEST)
        rising = exp_(ratio)
        slope = 0.5 * (rising + 1.0 / rising)
        if ratio > 1e-4:
            size = o.eyring * 0.5 * (rising - 1.0 / rising)
    if o.model >= CARREAU and size > 1e-9 * o.carreau:
        wanted, power = np.log(size / o.carreau), (o.exponent - 1.0) / o.yasuda
        root, steep = (wanted if wanted < 0.0 else wanted / o.exponent), 1.0
        for _ in range(30):
            bend = exp_(min(o.yasuda * root, 600.0))
            steep = 1.0 + o.yasuda * power * bend / (1.0 + bend)
            change = (wanted - root - power * np.log1p(bend)) / steep
            root += change
            if abs(change) < 1e-12:
                break
        before = size
        size = o.carreau * exp_(root)
        slope *= size / (before * steep)
    return sign * size, slope


@nb.njit(**INNER)
def _sheared(
    middle: float, half: float, limit: float, fluidity: Array, o: Sheared
) -> tuple[float, float]:
    """Speed difference over the film height at a mean stress, and its slope."""
    last, speed, slope = fluidity.size - 1, 0.0, 0.0
    for j in range(last + 1):
        weight = fluidity[j] * (0.5 if j == 0 or j == last else 1.0) / last
        g, steep = _thinned(middle + half * (2.0 * j / last - 1.0), limit, o)
        speed += weight * g
        slope += weight * steep
    return speed, slope


@nb.njit(**INNER)
def _mean_stress(
    guess: float, half: float, rate: float, limit: float, fluidity: Array, o: Sheared
) -> float:
    """Stress in the middle of the film at which it is sheared at a rate on the mean."""
    last, fluid, moment = fluidity.size - 1, 0.0, 0.0
    for j in range(last + 1):
        weight = fluidity[j] * (0.5 if j == 0 or j == last else 1.0) / last
        fluid += weight
        moment += weight * half * (2.0 * j / last - 1.0)
    if o.model == NEWTONIAN:
        return (rate - moment) / fluid
    if o.model == EYRING and half < _HIGHEST * o.eyring:
        even = odd = 0.0
        for j in range(last + 1):
            weight = fluidity[j] * (0.5 if j == 0 or j == last else 1.0) / last
            rising = exp_(half / o.eyring * (2.0 * j / last - 1.0))
            even += 0.5 * weight * (rising + 1.0 / rising)
            odd += 0.5 * weight * (rising - 1.0 / rising)
        # even sinh(s) + odd cosh(s) = rate, with s the stress in the middle over Eyring's.
        root = np.sqrt((even - odd) * (even + odd))
        return o.eyring * (np.arcsinh(rate / (o.eyring * root)) - np.arctanh(odd / even))
    # An oil that thins has at most the stress of Newton's oil.
    high = abs(rate) / fluid + abs(half)
    low, stress = -high, min(max(guess, -high), high)
    for _ in range(100):
        value, slope = _sheared(stress, half, limit, fluidity, o)
        if value > rate:
            high = stress
        else:
            low = stress
        # Over the logarithms of large rates, which grow as fast as the sinh or the power law.
        unit = fluid * min(o.eyring, o.carreau)
        step = stress + (np.arcsinh(rate / unit) - np.arcsinh(value / unit)) * (
            np.hypot(value, unit) / slope
        )
        if not low < step < high:
            step = 0.5 * (low + high)
        if abs(step - stress) <= 1e-10 * abs(step) + 1e-3:
            return step
        stress = step
    return stress


@nb.njit(**INNER)
def shear_column(
    i: int, h: float, slope: float, pressure: float, log_viscosity: float, density: float,
    flux: float, o: Sheared, a: Across, b: Along, fluidity: Array,
) -> None:  # fmt: skip
    """Stress, rate, velocity, mass flux and factors of one column at its temperatures."""
    last, T = fluidity.size - 1, a.temperature[i]
    _fluidity(i, log_viscosity, T, o, a, b, fluidity)
    _stresses(i, h, 0.0, pressure, o, a, b, fluidity)
    flow, idle = _flow(i, h, density, o, a, b, fluidity)
    # While pressure and temperatures are not settled, the gradient that the mass flux needs
    # counts where it drives much of it, and elsewhere no more than could be needed: else heat
    # and flow would run away. Both are roots of a flow that rises with the gradient.
    missing = idle - flux
    b.driven[i] = abs(missing) / flux
    part = min(max(b.driven[i] / _DRIVEN - 0.5, 0.0), 1.0)
    most, needed, better, b.follows[i] = _EXCESS * abs(missing) + _SPARE * flux, 0.0, slope, 1.0
    if part > 0.0:
        needed = _gradient(i, h, pressure, density, idle, missing, flow, o, a, b, fluidity)
    if part < 1.0:
        _stresses(i, h, slope, pressure, o, a, b, fluidity)
        moved = idle - _flow(i, h, density, o, a, b, fluidity)[1]
        if abs(moved) > most:
            better = _gradient(
                i, h, pressure, density, idle, np.copysign(most, slope), flow, o, a, b, fluidity
            )
        else:
            b.follows[i] = part
    b.slope[i] = part * needed + (1.0 - part) * better
    slips = _stresses(i, h, b.slope[i], pressure, o, a, b, fluidity)
    _, total = _flow(i, h, density, o, a, b, fluidity)
    # Flow by pressure is what the flow without a gradient has more, in the limit that it grows by.
    secant = b.growth[i]
    if abs(idle - total) > _NEGLIGIBLE_FLOW * flux:
        secant = min(max((idle - total) / b.slope[i], _LEAST_FLOW * secant), secant)
    moved = total + secant * b.slope[i]
    b.factors[1, i] = max(moved / (density * h * 0.5 * (o.speed_1 + o.speed_2)), _LEAST_FLOW)
    # The sum over the nodes has this part of the integral for a cold film.
    exact = 1.0 - 1.0 / (last * last)
    unit = 12.0 * o.viscosity * exp_(log_viscosity) / (density * h * h * h * exact)
    b.factors[0, i] = np.log(b.factors[1, i] / max(unit * secant, _LEAST_FLOW))
    b.share[i] = secant / b.growth[i]
    scale = flux / total
    for j in range(last + 1):
        # The same flow everywhere, to the last digit.
        a.mass[i, j] *= scale * o.density
        if slips:
            # A film that yields makes the same heat at any temperature.
            a.falling[i, j] = 0.0


@nb.njit(**INNER)
def _gradient(
    i: int, h: float, pressure: float, density: float, idle: float, wanted: float, flow: float,
    o: Sheared, a: Across, b: Along, fluidity: Array,
) -> float:  # fmt: skip
    """Gradient of the pressure that drives a flow, by Newton's method over the logarithms."""
    size, low = abs(wanted), 0.0
    # An oil that thins needs no more than Newton's oil, up to the effect of uneven density.
    high = 1.5 * size / flow
    if o.model == NEWTONIAN or high == 0.0:
        return wanted / flow
    gradient = min(abs(b.slope[i]), 0.7 * high)
    if gradient == 0.0:
        gradient = 0.5 * high
    for _ in range(_BOUNDED):
        _stresses(i, h, np.copysign(gradient, wanted), pressure, o, a, b, fluidity)
        driven = abs(idle - _flow(i, h, density, o, a, b, fluidity)[1])
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


@nb.njit(**INNER)
def _fluidity(
    i: int, log_viscosity: float, T: Array, o: Sheared, a: Across, b: Along, fluidity: Array
) -> None:
    """Fluidity at low stress and its rise with the temperature across a column."""
    last, cold, mean = fluidity.size - 1, np.log(o.viscosity), 0.0
    above, height = o.temperature - _POLE, log_viscosity + cold + _LOG_POLE
    exponent = o.thinning * above / (cold + _LOG_POLE)
    for j in range(last + 1):
        if o.roelands:
            warm = max(T[j] - _POLE, 1.0)
            hot = height * exp_(-exponent * log_(warm / above))
            a.falling[i, j] = exponent * hot / warm
            fluidity[j] = exp_(_LOG_POLE - hot)
        else:
            a.falling[i, j] = o.thinning
            fluidity[j] = exp_(o.thinning * (T[j] - o.temperature) - log_viscosity - cold)
        mean += fluidity[j] * (0.5 if j == 0 or j == last else 1.0) / last
    b.mean[i] = 1.0 / mean


@nb.njit(**INNER)
def _stresses(
    i: int, h: float, slope: float, pressure: float, o: Sheared, a: Across, b: Along,
    fluidity: Array,
) -> bool:  # fmt: skip
    """Stress and rate across a column; whether the film yields."""
    last = fluidity.size - 1
    rate, half, limit = (o.speed_2 - o.speed_1) / h, 0.5 * h * slope, np.inf
    if o.limit < np.inf:
        limit = o.limit + o.limit_slope * max(pressure, 0.0)
    middle = _mean_stress(b.stress[i], half, rate, limit, fluidity, o)
    slip = 0.0
    if limit < np.inf and o.model != BAIR_WINER:
        # The film yields where the stress at one of its walls reaches the limit.
        most = max(limit - abs(half), 0.0)
        if abs(middle) > most:
            middle = most if middle > 0.0 else -most
            slip = rate - _sheared(middle, half, limit, fluidity, o)[0]
    b.stress[i] = middle
    for j in range(last + 1):
        stress = middle + half * (2.0 * j / last - 1.0)
        g, steep = _thinned(stress, limit, o)
        a.stress[i, j] = stress
        a.rate[i, j] = g * fluidity[j] + slip
        a.steep[i, j] = steep * fluidity[j] if slip == 0.0 else 0.0
    return slip != 0.0


@nb.njit(**INNER)
def _flow(
    i: int, h: float, density: float, o: Sheared, a: Across, b: Along, fluidity: Array
) -> tuple[float, float]:
    """Flow by pressure over its gradient, and all flow."""
    last, T = fluidity.size - 1, a.temperature[i]
    dz = h / last
    fluid = tilted = by_shear = by_pressure = before = total = eased = 0.0
    steep_fluid = steep_tilted = steep_shear = steep_pressure = steep_before = 0.0
    u = o.speed_1
    for j in range(last + 1):
        weight = 0.5 if j == 0 or j == last else 1.0
        stress, ease = a.stress[i, j], fluidity[j]
        if abs(stress) > 1e-3:
            ease = max(a.rate[i, j] / stress, ease)
        now = ease * h * (j / last - 0.5)
        steep_now = a.steep[i, j] * h * (j / last - 0.5)
        if j > 0:
            steep_fluid += 0.5 * dz * (a.steep[i, j - 1] + a.steep[i, j])
            steep_tilted += 0.5 * dz * (steep_before + steep_now)
            fluid += 0.5 * dz * (eased + ease)
            tilted += 0.5 * dz * (before + now)
            u += 0.5 * dz * (a.rate[i, j - 1] + a.rate[i, j])
        before, steep_before, eased = now, steep_now, ease
        ratio = max(density - o.fall * (T[j] - o.temperature), _LEAST_DENSITY)
        a.expansion[i, j] = o.fall / ratio
        rho = weight * dz * ratio
        a.velocity[i, j] = u
        a.mass[i, j] = rho * u
        total += rho * u
        by_shear += rho * fluid
        by_pressure += rho * tilted
        steep_shear += rho * steep_fluid
        steep_pressure += rho * steep_tilted
    flow = by_shear * tilted / fluid - by_pressure
    # Growth of the flow with the gradient; the oil of a film that yields flows as it does cold.
    steep = flow
    if steep_fluid > 0.0:
        steep = max(steep_shear * steep_tilted / steep_fluid - steep_pressure, flow)
    b.growth[i] = steep
    return flow, total
