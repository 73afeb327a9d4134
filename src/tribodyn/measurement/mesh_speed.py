"""Mesh frequency and mesh angle of a recording without a tachometer, from its mesh lines.

First the frequency is searched: in blocks of the record, the ratio of the measured to the assumed
mesh frequency at which most lines of a comb of harmonics stand above the noise between them, as
one smooth path through all blocks. Then the phases of the strong harmonics along that path are
demodulated, which leaves an angle that follows the teeth within a few hundredths of a mesh cycle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from tribodyn.arrays.linear_algebra import fast_length
from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.measurement.orders import order_spectrum
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.signals.angular_resampling import checked_signal, decimated
from tribodyn.types import Array, ComplexArray

#: Search range beyond the tolerance: lines outside the tolerance are named, not mistaken.
_WIDER = 0.07
#: Each length of the blocks over the next shorter one, and the record over the longest of them.
_LONGER, _NEARLY = 4.0, 1.5
#: Sum of k^2 times power over noise, over that k^2, from which the phase of harmonic k is known so
#: well that its amplitude is within 2.5 % (k^2 over four times the sum).
_PRECISE = 10.0
#: Variance of the power over its square up to which one harmonic alone is a line.
_EVEN = 0.2
#: Turns of the slowest shaft in a shortest block, and mesh cycles of it where no teeth are known:
#: the window of a block takes out all multiples of the turns, so that run-out is no speed.
_TURNS, _SHORTEST = 2, 64
#: Fastest change of the speed over the speed that a path follows [1/s].
_FASTEST = 0.1
#: Points of the demodulated phase in one block.
_POINTS = 16
#: Power of a harmonic over that of the noise in its band, from which its phase is used, and over
#: that of a single line of the whole record.
_CLEAR, _CLEAR_LINE = 10.0, 40.0
#: Least noise power of a line over the mean square: leakage in a computed record is no mesh line.
_FLOOR = 1e-7
#: Samples in a period of the highest frequency that is searched.
_OVERSAMPLED = 2.6
#: Least uncertainty of the ratio; the clock of a recorder is no better than a hundred times that.
_LEAST = 1e-7
#: Passes of the demodulation.
_PASSES = 3
#: Shorter blocks must gather so much more power.
_GAIN = 0.02
#: Share of the power, and of the sum of levels, from which another comb is a rival.
_RIVAL_POWER, _RIVAL_LEVEL = 0.25, 0.5
#: Largest distance of rivals, over the mesh frequency, and the one beyond which combs of other
#: ratios share single lines, so that a rival there must be stronger by the last factor. A rival so
#: much stronger says that the path follows something else than the mesh.
_RIVALS, _SEPARATE, _LARGER = 0.55, 0.15, 1.25


@dataclass(frozen=True)
class MeshSpeed:
    """Mesh frequency of a recording, and the angle of the mesh at every sample.

    Parameters
    ----------
    ratio : float
        Mean mesh frequency over the assumed one [-]; NaN where no mesh lines were found.
    uncertainty : float
        Standard uncertainty of the ratio [-]; NaN where no mesh lines were found. The sampling
        clock, some 1e-5, comes on top.
    lowest, highest : float
        Range of the ratio within the recording [-].
    mesh_frequency : float
        Mean mesh frequency [Hz].
    angle : (n,) array
        Angle of the mesh at each sample, one turn per tooth pair [rad]: that of a shaft is this
        over its teeth. At the assumed frequency where no mesh lines were found.
    harmonics : tuple of int
        Mesh harmonics whose lines were followed.
    rivals : tuple of float
        Other ratios at which a comb of lines is about as strong [-].
    method : str
        How it was found.
    angle_uncertainty : float
        Standard uncertainty of ``angle`` by noise [rad], which lowers the amplitude of mesh order m
        by half the square of m times this; NaN where no mesh lines were found. Changes of the speed
        within a block come on top.
    """

    ratio: float
    uncertainty: float
    lowest: float
    highest: float
    mesh_frequency: float
    angle: Array = field(repr=False)
    harmonics: tuple[int, ...] = ()
    rivals: tuple[float, ...] = ()
    method: str = ""
    angle_uncertainty: float = float("nan")

    @property
    def located(self) -> bool:
        """Whether mesh lines were found."""
        return bool(np.isfinite(self.ratio))


def mesh_speed(
    signal: object,
    sample_rate: float,
    mesh_frequency: float,
    *,
    harmonics: int = 5,
    tolerance: float = 0.05,
    teeth: Sequence[int] = (),
) -> MeshSpeed:
    """Find the mesh frequency of a recording, and how it wanders, from its mesh lines.

    Parameters
    ----------
    signal : (n,) or (m, n) array
        Evenly spaced samples of one channel, or of several sampled simultaneously.
    sample_rate : float
        Samples per second [Hz].
    mesh_frequency : float
        Mesh frequency at the speed that is assumed [Hz].
    harmonics : int
        Mesh harmonics that are searched; those above half the sampling rate are left out.
    tolerance : float
        Largest relative deviation of the mesh frequency from the assumed one [-].
    teeth : sequence of int
        Teeth of the gears; with them changes of speed below half the turns of the slowest shaft
        are followed, and the run-out of no gear is taken for speed; without them changes slower
        than 64 mesh cycles are.

    Returns
    -------
    MeshSpeed
        Mean ratio with its uncertainty, and the angle of the mesh. If no mesh lines exceed
        the noise within the tolerance, the ratio is NaN and ``method`` says why.

    Raises
    ------
    InputError
        If the record is not finite, lasts less than 20 mesh cycles, or an argument is out of its
        range.

    Notes
    -----
    The record is cut into blocks of several lengths. In each block the sum over harmonics and
    channels of log(1 + power over noise) is computed over the ratio, the noise being the median of
    the spectrum halfway to the next harmonics; the best path through the blocks is found by
    dynamic programming. The phases of the harmonics that stand clear of the noise are demodulated
    along the path, weighted by k^2 times their power over the noise, and added to it. Of the
    lengths that one is taken after which the harmonics hold most power. The uncertainty is that
    of the phase at both ends, from noise and from the scatter between the harmonics.
    Two steps of this kind: J. Urbanek, T. Barszcz and J. Antoni, Mechanical Systems and Signal
    Processing 38 (2013) 96.

    Examples
    --------
    >>> time = np.arange(40000) / 10000.0
    >>> angle = 2 * np.pi * (404.0 * time + 0.5 * np.sin(3 * time))
    >>> speed = mesh_speed(np.cos(angle) + 0.3 * np.cos(2 * angle), 10000.0, 400.0, harmonics=2)
    >>> mean = (angle[-1] - angle[0]) / (2 * np.pi * time[-1])
    >>> bool(abs(speed.ratio * 400.0 / mean - 1.0) < 1e-5)
    True
    """
    rows = _rows(signal)
    require_positive("sample_rate", sample_rate, "Hz")
    frequency = require_number("mesh_frequency", mesh_frequency)
    require_positive("mesh_frequency", frequency, "Hz")
    require_between("tolerance", tolerance, 1e-6, 0.2)
    count = require_whole("harmonics", harmonics)
    wide = tolerance + _WIDER
    count = min(count, int(0.5 * sample_rate / (frequency * (1.0 + wide)) - 0.5))
    if count < 1:
        what = f"mesh_frequency = {frequency:g} Hz"
        why = f"Sampled with {sample_rate:g} Hz, it and "
        why += "the noise above it are not in the record"
        raise InputError(what, Argument("mesh_frequency"), why, "Sample faster")
    cycles = rows.shape[1] / sample_rate * frequency
    if cycles < 20.0:
        what = f"the record lasts {cycles:.3g} mesh cycles"
        why = "Separating mesh harmonics from adjacent lines takes at least 20 mesh cycles"
        raise InputError(what, Argument("signal"), why, "Record longer")
    search = _Search(rows, float(sample_rate), frequency, count, wide)
    shortest = max(_TURNS * max(teeth), 32) if teeth else _SHORTEST
    path = _followed(search, round(shortest / frequency * search.rate))
    return _result(search, path, tolerance)


def _rows(signal: Any) -> Array:
    """Channels without their means, in units of their own standard deviation."""
    several = np.ndim(signal) == 2
    rows = np.stack([checked_signal(each, 64) for each in (signal if several else [signal])])
    rows = rows - rows.mean(axis=1, keepdims=True)
    size = rows.std(axis=1)
    if not size.any():
        what, why = "the signal is constant", "There is no line in it"
        raise InputError(what, Argument("signal"), why, "Look at the channel")
    return np.asarray(rows[size > 0.0] / size[size > 0.0, None])


@dataclass(frozen=True)
class _Path:
    """Angle of the mesh along the lines, as far as blocks of one length show it."""

    angle: Array
    length: int  #: samples in a block
    power: float  #: of all harmonics that are clear, summed over the channels
    floor: Array  #: noise power in the band of a block, (channels, harmonics)
    clear: Array  #: power of the clear harmonics over it
    scatter: float  #: of the mean ratio between the harmonics
    change: float  #: of the phase between both ends in the last pass [rad]

    @property
    def level(self) -> float:
        """Power over noise of the harmonics, times their number squared: precision of the phase."""
        return float(np.sum(np.arange(1, self.clear.shape[1] + 1) ** 2 * self.clear))


class _Search:
    """Lines of the mesh in a record."""

    def __init__(self, rows: Array, rate: float, frequency: float, count: int, wide: float) -> None:
        self.samples = rows.shape[1]
        top = max(count + 0.5, count * (1.0 + wide)) * frequency
        self.down = max(int(rate / (_OVERSAMPLED * top)), 1)
        self.rows = np.stack([decimated(row, self.down) for row in rows])
        self.rate, self.frequency = rate / self.down, frequency
        self.count, self.wide = count, wide
        self.orders = np.arange(1, count + 1)
        self.size = self.rows.shape[1]

    def follow(self, length: int) -> _Path | None:
        """Path of the lines seen in blocks of so many samples; None where none is clear."""
        length = min(length, self.size)
        moments, ratio, floor = self._ridge(length)
        time = np.arange(self.size)
        turn = 2.0 * np.pi * self.frequency / self.rate * np.interp(time, moments, ratio)
        angle = np.concatenate(([0.0], np.cumsum(0.5 * (turn[1:] + turn[:-1]))))
        return self.demodulated(angle, length, floor)

    def demodulated(self, angle: Array, length: int, floor: Array) -> _Path | None:
        """Path near this angle, by the phases of the harmonics that are clear in such blocks."""
        steady = length == self.size
        least = _CLEAR_LINE if steady else _CLEAR
        # A slope of the phase shows in parts of the record only.
        block = max(length // 4, 1) if steady else length
        time = np.arange(self.size)
        for _ in range(_PASSES):
            places, envelope = self._envelopes(angle, block)
            clear = np.mean(np.abs(envelope) ** 2, axis=2) / floor
            used = clear > least
            if not used.any():
                return None
            phase, scatter = self._phase(envelope, np.where(used, clear, 0.0), places, length)
            angle = angle + np.interp(time, places, phase)
        change = float(np.abs(phase[-1] - phase[0]))
        angle = np.maximum.accumulate(angle)
        power = float(self._power(angle)[used].sum())
        clear = np.where(used, clear, 0.0)
        return _Path(angle, length, power, floor, clear, scatter, change)

    def at_samples(self, angle: Array) -> Array:
        """Angle at every sample of the record, which goes on with its speed at the end."""
        place = np.arange(self.samples) / self.down
        beyond = np.maximum(place - (self.size - 1), 0.0)
        inner = np.interp(place, np.arange(self.size), angle)
        return np.asarray(inner + beyond * (angle[-1] - angle[-2]))

    def mean_ratio(self, angle: Array) -> float:
        """Mean mesh frequency over the assumed one."""
        turns = (angle[-1] - angle[0]) / (2.0 * np.pi)
        return float(turns * self.rate / ((self.size - 1) * self.frequency))

    def better(self, path: _Path | None, shorter: _Path | None) -> _Path | None:
        """The path in longer blocks, unless shorter ones gather clearly more power."""
        if path is None or shorter is None:
            return path or shorter
        gain = shorter.power - path.power
        noise = float(shorter.floor[shorter.clear > 0.0].sum())
        return shorter if gain > _GAIN * path.power + 3.0 * noise else path

    def fluctuation(self, path: _Path, length: int) -> float:
        """Relative variance of the power of the steadiest clear harmonic, without that by noise."""
        _, envelope = self._envelopes(path.angle, length)
        clear = path.clear > 0.0
        power = np.abs(envelope[clear]) ** 2
        noise = path.floor[clear] * path.length / length
        mean = power.mean(axis=1)
        variance = power.var(axis=1) - 2.0 * mean * noise + noise**2
        return float(np.min(variance / mean**2))

    def _ridge(self, length: int) -> tuple[Array, Array, Array]:
        """Ratios along the strongest comb, and the noise beneath the harmonics."""
        hop = max(length // 4, 1)
        starts = np.arange(0, self.size - length + 1, hop)
        padded = fast_length(4 * length)
        window = np.hanning(length + 1)[:-1]
        window = window / window.sum()
        bins = self.frequency * padded / self.rate  # of the mesh frequency
        steps = int(np.ceil(self.wide * self.count * self.frequency * 4.0 * length / self.rate))
        grid = 1.0 + self.wide * np.arange(-steps, steps + 1) / steps
        places = np.rint(self.orders[:, None] * grid * bins).astype(int)
        power = np.empty((self.rows.shape[0], starts.size, self.count, grid.size))
        floors = np.empty((self.rows.shape[0], starts.size, self.count))
        for row, values in enumerate(self.rows):
            for block, start in enumerate(starts):
                lines = np.abs(np.fft.rfft(window * values[start : start + length], padded)) ** 2
                power[row, block] = lines[places]
                for k in self.orders:
                    band = lines[int((k - 0.5) * bins) : int((k + 0.5) * bins) : 2]
                    floors[row, block, k - 1] = np.median(band) / np.log(2.0)
        floor = np.maximum(np.median(floors, axis=1), _FLOOR)
        score = np.log1p(power / floor[:, None, :, None]).sum(axis=(0, 2))
        hop_time, step = hop / self.rate, self.wide / steps
        path = _best_path(score, int(np.clip(np.ceil(_FASTEST * hop_time / step), 2, 60)))
        return starts + 0.5 * length, grid[path], floor

    def _envelopes(self, angle: Array, length: int) -> tuple[Array, ComplexArray]:
        """Amplitudes over time in the band of a block, of the shape (channels, harmonics, m)."""
        from scipy.signal import resample_poly

        down = max(length // _POINTS, 1)
        window = np.hanning(_POINTS + 1)[1:-1]
        turn = np.exp(-1j * angle)
        wave = np.ones(self.size, dtype=complex)
        demodulated = []
        for _ in self.orders:
            wave = wave * turn
            demodulated.append([resample_poly(row * wave, 1, down) for row in self.rows])
        envelope = np.array(demodulated).transpose(1, 0, 2)
        weight = np.convolve(np.ones(envelope.shape[2]), window, "same")
        smooth = np.apply_along_axis(np.convolve, 2, envelope, window, "same") / weight
        return down * np.arange(envelope.shape[2], dtype=float), smooth

    def _phase(
        self, envelope: ComplexArray, clear: Array, places: Array, length: int
    ) -> tuple[Array, float]:
        """Phase of the mesh that the clear harmonics leave, and the scatter of its mean slope."""
        weight = clear * self.orders**2
        rows, columns = np.nonzero(weight)
        phases = np.unwrap(np.angle(envelope[rows, columns])) / self.orders[columns, None]
        phases -= phases.mean(axis=1, keepdims=True)
        share = (weight[rows, columns] / weight.sum())[:, None]
        phase = np.sum(share * phases, axis=0)
        span = places[-1] - places[0]
        if length == self.size:
            middle = places - places.mean()
            slopes = phases @ middle / (middle @ middle)
            phase = float(share[:, 0] @ slopes) * middle
        else:
            slopes = (phases[:, -1] - phases[:, 0]) / span
        mean = float(share[:, 0] @ slopes)
        per = 2.0 * np.pi * self.frequency / self.rate
        scatter = float(np.sqrt(np.sum((share[:, 0] * (slopes - mean)) ** 2))) / per
        return phase, scatter

    def _power(self, angle: Array) -> Array:
        """Squared amplitudes over 4 of the harmonics over the whole record."""
        window = np.hanning(self.size) / np.hanning(self.size).sum()
        turn, wave, power = np.exp(-1j * angle), window.astype(complex), []
        for _ in self.orders:
            wave = wave * turn
            power.append(np.abs(self.rows @ wave) ** 2)
        return np.array(power).T


def _best_path(score: Array, max_step: int) -> Array:
    """Indices of the path with the highest score that changes by at most max_step per block."""
    shifts = np.arange(-max_step, max_step + 1)
    cost = (shifts / max_step) ** 2
    total, back = score[0].copy(), np.zeros(score.shape, dtype=int)
    size = score.shape[1]
    for block in range(1, score.shape[0]):
        wide = np.pad(total, max_step, constant_values=-np.inf)
        options = np.lib.stride_tricks.sliding_window_view(wide, 2 * max_step + 1) - cost
        pick = np.argmax(options, axis=1)
        back[block] = np.clip(np.arange(size) + shifts[pick], 0, size - 1)
        total = score[block] + options[np.arange(size), pick]
    path = np.empty(score.shape[0], dtype=int)
    path[-1] = np.argmax(total)
    for block in range(score.shape[0] - 1, 0, -1):
        path[block - 1] = back[block, path[block]]
    return path


def _followed(search: _Search, shortest: int) -> _Path | None:
    """Best path of the search in blocks of increasing length, up to the complete record."""
    best, length = None, shortest
    while length < search.size / _NEARLY:
        path = search.follow(length)
        best = search.better(path, best)
        if path is not None and path.level > _PRECISE * search.count**2:
            break
        length = round(_LONGER * length)
    best = search.better(search.follow(search.size), best)
    if best is None or best.clear.any(axis=0).sum() > 1:
        return best
    # A resonance that noise excites looks like a line that wanders.
    return best if search.fluctuation(best, min(shortest, search.size)) < _EVEN else None


def _result(search: _Search, path: _Path | None, tolerance: float) -> MeshSpeed:
    """Mesh speed of the best path, or an unknown speed with the reason."""
    turns = (search.size - 1) / search.rate * search.frequency
    if path is None:
        angle = np.linspace(0.0, 2.0 * np.pi * turns, search.size)
        method = (
            f"no steady mesh line exceeds the noise within "
            f"{100.0 * search.wide:.3g} % of {search.frequency:.6g} Hz"
        )
        return _unknown(search, angle, method)
    mean = search.mean_ratio(path.angle)
    if abs(mean - 1.0) > tolerance:
        method = (
            f"the mesh lines seem to lie at {mean:.4g} times {search.frequency:.6g} Hz, "
            f"beyond the tolerance of {100.0 * tolerance:.3g} %"
        )
        return _unknown(search, path.angle, method)
    rivals, stronger = _rivals(search, path)
    if stronger:
        method = (
            f"lines at {mean:.4g} times {search.frequency:.6g} Hz would fit, but clearly stronger "
            f"ones lie at {rivals[0]:.4g} times"
        )
        return _unknown(search, path.angle, method)
    steady = path.length == search.size
    noise = 0.5 / np.sqrt(path.level) if steady else 1.0 / (2.0 * np.pi * np.sqrt(path.level))
    step = max(path.length // _POINTS, 1)
    ratio = np.diff(path.angle[::step]) / (2.0 * np.pi * search.frequency * step / search.rate)
    used = np.flatnonzero(path.clear.any(axis=0)) + 1
    lines = "harmonic" + "s" * (used.size > 1)
    seconds = path.length / search.rate
    slower = f"{seconds:.3g} s: what repeats slower than {_TURNS / seconds:.3g} Hz counts as speed"
    blocks = "the whole record" if steady else f"blocks of {slower}"
    change = path.change / (0.5 * np.pi * turns)
    uncertainty = float(np.hypot(max(noise / turns, path.scatter, _LEAST), change))
    # A steady angle errs by its slope over the record, another one by the noise in each block.
    by_slope = 2.0 * np.pi * uncertainty * turns / np.sqrt(12.0)
    return MeshSpeed(
        mean,
        uncertainty,
        mean if steady else float(ratio.min()),
        mean if steady else float(ratio.max()),
        mean * search.frequency,
        search.at_samples(path.angle),
        tuple(used.tolist()),
        rivals,
        f"phase demodulation of mesh {lines} {', '.join(map(str, used))} in {blocks}",
        by_slope if steady else float(1.0 / np.sqrt(2.0 * path.level)),
    )


def _unknown(search: _Search, angle: Array, method: str) -> MeshSpeed:
    nan = float("nan")
    return MeshSpeed(nan, nan, nan, nan, nan, search.at_samples(angle), method=method)


def _rivals(search: _Search, path: _Path) -> tuple[tuple[float, ...], bool]:
    """Other ratios whose combs are about as strong, best first, and whether that is stronger."""
    spectra = [
        order_spectrum(row, path.angle, search.count + 0.5, window="hann") for row in search.rows
    ]
    power = np.sum([each.amplitudes**2 for each in spectra], axis=0)
    spacing = float(spectra[0].orders[1])
    zero = int(np.ceil(_RIVALS / spacing * search.count))
    away = np.arange(-zero, zero + 1) * spacing / search.count
    places = np.rint(search.orders[:, None] * (1.0 + away) / spacing).astype(int)
    lines = np.where(places < power.size, power[np.minimum(places, power.size - 1)], 0.0)
    halfway = [int((k + 0.5) / spacing) for k in range(search.count + 1)]
    floor = [np.median(power[low:high]) / np.log(2.0) for low, high in pairwise(halfway)]
    clear = lines / np.maximum(floor, 1e-15)[:, None]
    level = np.log1p(clear).sum(axis=0)
    total = np.where(clear > _CLEAR, lines, 0.0).sum(axis=0)
    separate = np.abs(away) * path.angle[-1] / (2.0 * np.pi) > 8.0
    least = np.where(np.abs(away) > _SEPARATE, _LARGER, _RIVAL_POWER)
    strong = (total >= least * total[zero]) & (level >= _RIVAL_LEVEL * level[zero]) & separate
    rivals: list[float] = []
    for shift in away[strong][np.argsort(-total[strong])]:
        if all(abs(shift - other) > 0.002 for other in rivals) and len(rivals) < 3:
            rivals.append(float(shift))
    mean = search.mean_ratio(path.angle)
    stronger = bool(np.max(total[strong], initial=0.0) > _LARGER * total[zero])
    return tuple(mean * (1.0 + shift) for shift in rivals), stronger
