"""Temperature of a surface that moves under a source of heat, steady or changing over time."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from tribodyn.ehl.thermal.thermal_model import BodyHeat
from tribodyn.types import Array, ComplexArray, Index

#: Euler's constant.
_EULER = 0.5772156649015329


def slowest_speed(diffusivity: float, reach: float) -> float:
    """Speed [m/s] below which a surface counts as one at rest, cooled at a distance ``reach``."""
    # A line source on a half-space at rest heats it without end. About a source at the speed u the
    # surface is as warm as if it were cooled at the distance 4 kappa exp(-gamma)/u.
    return 4.0 * diffusivity * math.exp(-_EULER) / reach


def surface_response(
    at: Index, edges: Array, interval: float, speed: float, conductivity: float, diffusivity: float
) -> Array:
    """Rise of a surface [K m^2/W] at each node by even heat between each two edges."""
    # T = 1/(pi k) int q exp(u s/2 kappa) K_0(|u s|/2 kappa) ds, with s the distance behind the
    # source, integrated exactly. Nodes and edges in intervals, in halves of them at least. Carslaw
    # and Jaeger, Conduction of Heat in Solids (1959), section 10.7.
    from scipy.special import k0e, k1e

    ratio = speed / (2.0 * diffusivity)
    reach = round(2.0 * float(edges[-1] - edges[0])) + 1
    distance = abs(ratio) * 0.5 * interval * np.arange(1, reach + 1)
    zeroth, first = k0e(distance), k1e(distance)
    behind = distance * (zeroth + first) - 1.0
    before = 1.0 + distance * np.exp(-2.0 * distance) * (zeroth - first)
    integral = np.concatenate([-before[::-1], [0.0], behind])
    if speed < 0.0:
        integral = -integral[::-1]
    places = np.rint(2.0 * (at[:, None] - edges[None, :])).astype(np.int64) + reach
    steps = integral[places]
    return np.ascontiguousarray(steps[:, :-1] - steps[:, 1:]) / (
        math.pi * conductivity * abs(ratio)
    )


#: Distance of the logarithms of the depth waves: an error of 1e-5 of the sum.
_APART = 0.4
#: Shortest and longest wave over the roots of the shortest and longest time.
_FAST, _SLOW = 4.3, 0.1
#: Length of the fields over that of the columns, part of the margin that is left as it is, and from
#: which it is empty.
_LENGTH, _UNTOUCHED, _EMPTY = 5, 0.4, 0.6
#: Points of the quadrature over the last step.
_POINTS = 48
#: Way over the margin after which the fields are cut off at its end.
_CUT = 0.1
#: Decay of a wave along that leaves nothing of it.
_FADED = 20.0
#: Empty margins that a surface moves on in a step, above which no earlier heat is left.
_MOST = 5


def depth_waves(shortest: float, longest: float) -> tuple[Array, Array]:
    """Waves s and weights w with ``sum w exp(-s^2 t) = 1/sqrt(pi t)`` between two times."""
    first, last = math.log(_FAST / math.sqrt(shortest)), math.log(_SLOW / math.sqrt(longest))
    s = np.exp(first - _APART * np.arange(math.ceil((first - last) / _APART) + 1))
    # All slower waves as one with their sums of weights and of weighted squares.
    remainder, square = s[-1] / math.expm1(_APART), s[-1] ** 3 / math.expm1(3.0 * _APART)
    waves = np.append(s, math.sqrt(square / remainder))
    return waves, 2.0 / math.pi * _APART * np.append(s, remainder)


@lru_cache(maxsize=1)
def _quadrature() -> tuple[Array, Array]:
    """Parts of the time since, as roots, and weights: the time is the fourth power of the point."""
    point, weight = np.polynomial.legendre.leggauss(_POINTS)
    # A surface answers at once where it is heated.
    part = (0.5 * (point + 1.0)) ** 2
    return part, weight * np.sqrt(part)


class SurfaceHistory:
    """Surface of one body, with the heat that it has taken up."""

    def __init__(
        self, at: Index, edges: Array, interval: float, body: BodyHeat, times: tuple[float, float],
        cooled: float,
    ) -> None:  # fmt: skip
        # The closest columns are as far apart as the nodes of the fields.
        spacing = int(np.min(np.diff(at)))
        span = int(at[-1] - at[0]) // spacing
        self.size = 2 * ((_LENGTH * (span + 1) + 1) // 2)
        margin = (self.size - span) // 2
        self.places = (at - at[0]) // spacing + margin
        self.edges = (edges - at[0]) / spacing + margin
        self.step, self.kappa = spacing * interval, body.diffusivity
        self.cooled = cooled  # distance at which a surface at rest is cooled, before the start
        self.unit = math.sqrt(body.diffusivity) / body.thermal_conductivity
        self.waves, weights = depth_waves(*times)
        self.weights = self.unit * weights
        numbers = 2.0 * math.pi * np.fft.rfftfreq(self.size, self.step)
        # Shorter waves along have faded before they could be seen.
        self.numbers = numbers[self.kappa * numbers**2 * times[0] < _FADED]
        node = np.arange(self.size)
        out = np.maximum(margin - node, node - margin - span) / margin
        past = np.clip((out - _UNTOUCHED) / (_EMPTY - _UNTOUCHED), 0.0, 1.0)
        self.window = np.cos(0.5 * math.pi * past) ** 2
        self.reach = margin * self.step
        self.fields: ComplexArray = np.zeros((self.waves.size, self.numbers.size), dtype=complex)
        self.fading = self.waves[:, None] ** 2 + self.kappa * self.numbers**2
        self.heat, self.way = np.zeros(at.size), 0.0
        distances = np.rint(2.0 * (self.places[:, None] - self.edges[None, :])).astype(np.int64)
        self.furthest = int(np.max(np.abs(distances)))
        self.distances = distances + self.furthest

    def _cells(self, heat: Array) -> Array:
        """Heat of the columns on cells of the fields."""
        total = np.concatenate([[0.0], np.cumsum(heat * np.diff(self.edges))])
        return np.diff(np.interp(np.arange(self.size + 1) - 0.5, self.edges, total))

    def _transformed(self, heat: Array) -> ComplexArray:
        cells = np.sinc(self.numbers * self.step / (2.0 * math.pi))
        return np.asarray(self._along(self._cells(heat)) * cells)

    def _along(self, values: Array) -> ComplexArray:
        """Waves along the surface, those that last."""
        return np.asarray(np.fft.rfft(values)[..., : self.numbers.size])

    def rest_on(self, heat: Array, speed: float) -> None:
        """Begin with the fields of a heat that has always been there, at a constant speed."""
        least = slowest_speed(self.kappa, self.cooled)
        speed = math.copysign(max(abs(speed), least), speed)
        drift = speed / (2.0 * self.kappa)
        root = np.sqrt(drift * drift + self.waves**2 / self.kappa)
        steep = self.waves**2 / self.kappa / (root + abs(drift))  # root less the drift
        rates = (steep, root + abs(drift))
        behind, before = rates if speed > 0.0 else rates[::-1]
        node = np.arange(1, self.size)[None, :] - 0.5
        sides = []
        for rate in (behind, before):
            fall = rate[:, None] * self.step
            sides.append(np.exp(-fall * node) * -np.expm1(-fall) / rate[:, None])
        middle = np.sum([-np.expm1(-0.5 * rate * self.step) / rate for rate in rates], axis=0)
        kernel = np.concatenate(
            [middle[:, None], sides[0], np.zeros((middle.size, 1)), sides[1][:, ::-1]], 1
        )
        kernel /= (2.0 * self.kappa * root)[:, None]
        size = kernel.shape[1]
        spread = np.fft.irfft(np.fft.rfft(kernel) * np.fft.rfft(self._cells(heat), size), size)
        self.fields = self._along(spread[:, : self.size] * self.window)
        self.heat = heat.copy()

    def _recent(self, duration: float, speed: float, gain: float) -> tuple[Array, Array]:
        """Rise by heat of the last step, that of its end and of its begin, heat linear between."""
        from scipy.special import erf

        part, weight = _quadrature()
        root = part * math.sqrt(self.last)
        since = root**2
        weight = weight * self.unit * math.sqrt(self.last / math.pi)
        place = 0.5 * self.step * np.arange(-self.furthest, self.furthest + 1)
        moved = (speed - 0.5 * gain * since) * since
        shape = erf((place[:, None] - moved) / (2.0 * math.sqrt(self.kappa) * root))
        new, every = shape @ (weight * (1.0 - since / duration)), shape @ weight
        rises = [row[self.distances] for row in (new, every - new)]
        ends, begins = (np.ascontiguousarray(r[:, :-1] - r[:, 1:]) for r in rises)
        return ends, begins

    def begin(self, duration: float, speeds: tuple[float, float]) -> tuple[Array, Array]:
        """Rise at the end of a step by all earlier heat, and response to the heat then."""
        # The fields go on in parts, or what leaves them at one end would enter at the other.
        gain = (speeds[1] - speeds[0]) / duration
        way = max(abs(speeds[0]), abs(speeds[1])) * duration / ((1.0 - _EMPTY) * self.reach)
        self.last = duration if way <= _MOST else duration * _MOST / way
        parts = max(1, math.ceil(min(way, _MOST)))
        self.part, self.duration = self.last / parts, duration
        self.speeds = speeds[1] - gain * self.part * (np.arange(parts)[::-1] + 0.5)
        response, begins = self._recent(duration, speeds[1], gain)
        fields, fade = self._before(), np.exp(-self.fading * self.part)
        turns = np.exp(-1j * self.part * self.speeds[:, None] * self.numbers)
        self.decays = [fade * turn for turn in turns]
        for i, decay in enumerate(self.decays):
            fields = decay * (self._cut(fields) if i else fields)
        earlier = np.fft.irfft(self.weights @ fields, self.size)
        return earlier[self.places] + begins @ self.heat, response

    def _before(self) -> ComplexArray:
        """Fields before the last part of the step from which heat is left under the contact."""
        return self.fields if self.last == self.duration else np.zeros_like(self.fields)

    def _cut(self, fields: ComplexArray) -> ComplexArray:
        return self._along(np.fft.irfft(fields, self.size) * self.window)

    def end(self, heat: Array) -> None:
        """Take up the heat of the step that was begun."""
        old, new = self._transformed(self.heat), self._transformed(heat)
        shares = 1.0 - self.last / self.duration * np.linspace(1.0, 0.0, len(self.decays) + 1)
        self.fields, self.heat = self._before(), heat.copy()
        for i, decay in enumerate(self.decays):
            z = (self.fading + 1j * float(self.speeds[i]) * self.numbers) * self.part
            inverse = 1.0 / z
            every = (1.0 - decay) * inverse
            begins = (every - decay) * inverse
            small = np.nonzero(np.abs(z) < 1e-3)
            every[small], begins[small] = 1.0 - 0.5 * z[small], 0.5 - z[small] / 3.0
            first, last = (old + share * (new - old) for share in shares[i : i + 2])
            self.fields = decay * self.fields
            self.fields += every * (self.part * last) + begins * (self.part * (first - last))
            self.way += abs(float(self.speeds[i])) * self.part / self.reach
            if self.way > _CUT:
                self.fields, self.way = self._cut(self.fields), 0.0
