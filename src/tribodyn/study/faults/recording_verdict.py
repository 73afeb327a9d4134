"""Verdict on recordings: severity, trend, and the parts whose lines stand out of the noise."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import combinations
from typing import NamedTuple

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.measurement import SignalAnalysis, mesh_speed
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.envelope import envelope_spectrum
from tribodyn.signals.spectrum import SignalSpectrum, spectrum
from tribodyn.study.frequencies import KinematicFrequencies
from tribodyn.types import Array

#: Upper ends of the zones A, B and C by class of machine [m/s]: ISO 10816-1:1995, table B.1.
ZONES: dict[str, tuple[float, ...]] = {
    "I": (0.71e-3, 1.8e-3, 4.5e-3),
    "II": (1.12e-3, 2.8e-3, 7.1e-3),
    "III": (1.8e-3, 4.5e-3, 11.2e-3),
    "IV": (2.8e-3, 7.1e-3, 18.0e-3),
}
#: Ratings of gear units in ISO 20816-9:2020, table 3: ends of zone B between its neighbours [mm/s].
#: From a public copy of the table, not compared with the standard itself.
_RATINGS = (2.0, 3.15, 5.0, 8.0, 12.5, 20.0, 31.5)
ZONES |= {
    f"VR{ends[1]:g}": tuple(1e-3 * end for end in ends)
    for ends in zip(_RATINGS, _RATINGS[1:], _RATINGS[2:], strict=False)
}
_MEANINGS = {
    "A": "as of a newly commissioned machine",
    "B": "acceptable for long-term operation",
    "C": "not for long-term operation; plan a remedy",
    "D": "severe enough to cause damage",
}
#: Band of the severity [Hz], and a change of it that counts, over the end of zone B (ISO 10816-3).
_BAND, _CHANGE = (10.0, 1000.0), 0.25
#: Amplitude of a line over the median about it, which noise exceeds once in 3e7 lines.
_CLEAR = 5.0
#: Depth of a modulation from which it is taken for impacts: noise of a minute has lines as deep.
_DEPTH = 5e-3
#: Deviation of lines that follow from teeth, and of bearings, which slip.
_EXACT, _SLIP = 1e-3, 0.02
#: Lines of a spectrum in the main lobe of its window on each side, and those of the noise about it.
_LOBE, _ABOUT = 3, 60
#: Sidebands over the mesh, and a share of the mean square, from which they are worth a look.
_SIDEBAND, _DOMINANT = 0.1, 0.5
#: Octaves that are searched for impacts, below this share of the sampling rate.
_OCTAVES, _TOP = 4, 0.45
_BURSTS = ("BPFO", "BPFI", "BSF", "FTF", "TF")
#: Part of a machine by the symbol of its line, and what is checked next.
_CHECKS = {
    "BPFO": ("outer ring", "look at its raceway and seat, and for particles in the oil"),
    "BPFI": ("inner ring", "look at its raceway and fit, and for particles in the oil"),
    "BSF": ("rolling elements", "look at them, and for particles in the oil"),
    "FTF": ("cage", "look at it, and at the lubrication of the bearing"),
    "TF": ("tooth of the", "inspect every tooth of it for spalls and cracks"),
    "GMF - f": ("gear", "inspect its teeth, run-out and seat, and take its mean revolution"),
    "GMF": ("", "look at contact pattern, backlash and oil, and compare with a computation"),
    "f": ("", "check the balance and straightness of it, and the alignment of its couplings"),
}  # fmt: skip


class Finding(NamedTuple):
    """A part whose lines stand out: what shows it, and what to check next."""

    part: str
    evidence: str
    check: str
    frequency: float  #: of the line [Hz]
    amplitudes: tuple[float, ...]  #: of the line in each recording, of the signal or its envelope


@record
class RecordingVerdict(Record):
    """Severity, trend and findings of recordings of one sensor.

    Parameters
    ----------
    velocity : (n,) array
        Rms of the velocity from 10 to 1000 Hz in each recording [m/s]; NaN where the signal is no
        acceleration or velocity, or its band ends below 1000 Hz.
    alternating_rms : (n,) array
        Rms of the signal without its mean.
    kurtosis : (n,) array
        Kurtosis of the signal [-].
    limits : tuple of float
        Upper ends of the zones A, B and C [m/s]; empty where none were named.
    zone : str
        Zone of the last recording, ``A`` to ``D``; empty without limits or velocity.
    findings : tuple of Finding
        Parts whose lines stand out in the last recording.
    speed_ratio : float
        Speed of the last recording over that of the lines [-]; NaN where it is not known.
    """

    velocity: Array = quantity("recording", unit="m/s")
    alternating_rms: Array = quantity("recording", unit="")
    kurtosis: Array = quantity("recording", unit="1")
    limits: tuple[float, ...] = ()
    zone: str = fact(default="")
    findings: tuple[Finding, ...] = ()
    speed_ratio: float = fact(default=float("nan"))

    @property
    def statements(self) -> list[str]:
        """The verdict in sentences: severity, its trend, and each finding with its check."""
        has_speed = bool(np.isfinite(self.speed_ratio)) or not self.findings
        unknown = [] if has_speed else ["Speed: not known; that of the lines is taken."]
        return [*self._severity(), *self._trend(), *unknown, *map(_sentence, self.findings)]

    def _severity(self) -> Iterator[str]:
        now = 1e3 * float(self.velocity[-1])
        if self.zone:
            ends = "/".join(f"{1e3 * end:g}" for end in self.limits)
            yield (
                f"Severity: zone {self.zone}, {_MEANINGS[self.zone]}: {now:.3g} mm/s rms from 10 "
                f"to 1000 Hz; the zones A/B/C end at {ends} mm/s."
            )
        elif self.limits:
            needed = "it needs an acceleration or velocity up to 1000 Hz"
            remedy = 'A channel in volts needs the sensitivity of its sensor, such as "100 mV/g"'
            yield f"Severity: not known; {needed}. {remedy}."

    def _trend(self) -> Iterator[str]:
        if self.kurtosis.size < 2:
            return
        names = (("velocity", self.velocity), ("alternating rms", self.alternating_rms),
                 ("kurtosis", self.kurtosis))  # fmt: skip
        changes = [
            f"{name} x{values[-1] / values[0]:.3g}"
            for name, values in names
            if np.isfinite(values[[0, -1]]).all() and values[0]
        ]
        text = f"Trend over {self.kurtosis.size} recordings, last over first: {', '.join(changes)}."
        if self.zone and abs(self.velocity[-1] - self.velocity[0]) > _CHANGE * self.limits[1]:
            text += (
                f" The velocity changed by more than {100.0 * _CHANGE:g} % of the end of zone B."
            )
        yield text


def judge_recordings(
    analyses: Sequence[SignalAnalysis],
    lines: KinematicFrequencies | None = None,
    *,
    limits: str | Sequence[float] | None = None,
) -> RecordingVerdict:
    """Judge recordings of one sensor: severity, trend, and parts whose lines stand out.

    Parameters
    ----------
    analyses : sequence of SignalAnalysis
        Results of :func:`tribodyn.measurement.analyse_signal`, the oldest first; the last one is
        judged.
    lines : KinematicFrequencies, optional
        Result of :func:`kinematic_frequencies` of the machine, within 5 % of the same speed. It is
        scaled to the speed of each recording: by its mesh frequency where that is known, else by
        the mesh lines in its signal.
    limits : str or sequence of three float, optional
        Class of the machine in ISO 10816-1, ``"I"`` to ``"IV"``, rating of the gear unit in
        ISO 20816-9, ``"VR3.15"`` to ``"VR20"``, or upper ends of the zones A, B and C [m/s].

    Returns
    -------
    RecordingVerdict

    Raises
    ------
    InputError
        If there is no analysis, their channels differ, or the limits do not rise.

    Notes
    -----
    A bearing is named if the line of its defect, within 2 % for slip, and a second harmonic stand
    five times above the median of an envelope spectrum about them, away from lines of shafts and
    meshes, in one of four octaves; several where their lines are as near. A gear is named if both
    first sidebands at its turns do so in the spectrum and have a tenth of the mesh, a shaft or
    mesh if it holds half the mean square of a velocity beyond zone A, from half the turns of the
    slowest shaft up where these are below 10 Hz and from 10 Hz else. Zones: ISO
    10816-1:1995, table B.1, by class: I small machines up to 15 kW, II up to 75 kW, or 300 kW on
    special foundations, III large on rigid and IV on soft foundations.

    Examples
    --------
    >>> import numpy as np
    >>> from tribodyn.measurement import Recording, analyse_signal
    >>> time = np.arange(20_000) / 10_000.0
    >>> shaking = 2.0 * np.pi * 50.0 * 4e-3 * np.sqrt(2.0) * np.cos(2.0 * np.pi * 50.0 * time)
    >>> rig = Recording({"acc": shaking}, 10_000.0, {"acc": "m/s^2"})
    >>> judge_recordings([analyse_signal(rig, "acc")], limits="II").zone
    'C'
    """
    if not analyses:
        raise InputError("there is no analysis", Argument("analyses"), "", "Pass one or more")
    if len(channels := {each.channel for each in analyses}) > 1:
        why, names = "A trend is that of one sensor", ", ".join(sorted(channels))
        raise InputError(
            f"the channels are {names}", Argument("analyses"), why, "Pass those of one"
        )
    ends = _ends(limits)
    velocity = np.array([_velocity(each) for each in analyses])
    numbers = [each.figures() for each in analyses]
    zone = ""
    if ends and np.isfinite(velocity[-1]):
        zone = "ABCD"[int(np.searchsorted(ends, velocity[-1]))]
    scales = [float("nan") if lines is None else _speed_ratio(each, lines) for each in analyses]
    findings = () if lines is None else tuple(_findings(analyses, lines, scales, ends))
    rms, kurtosis = (np.array([n[key] for n in numbers]) for key in ("alternating_rms", "kurtosis"))
    return RecordingVerdict(velocity, rms, kurtosis, ends, zone, findings, scales[-1])


def _ends(limits: str | Sequence[float] | None) -> tuple[float, ...]:
    """Upper ends of the zones A, B and C."""
    if limits is None:
        return ()
    named = limits.replace(" ", "") if isinstance(limits, str) else ""
    ends = ZONES.get(named, ()) if isinstance(limits, str) else tuple(map(float, limits))
    if len(ends) != 3 or not 0.0 < ends[0] < ends[1] < ends[2]:
        why = "It is a class of ISO 10816-1, a rating of ISO 20816-9, or three velocities that rise"
        remedy = f"Write one of {', '.join(ZONES)}, or the ends of the zones A, B and C in m/s"
        raise InputError(f"limits = {limits!r}", Argument("limits"), why, remedy)
    return ends


def _velocity(analysis: SignalAnalysis, lowest: float = _BAND[0]) -> float:
    """Rms of the velocity in the band of the severity [m/s]; NaN where it is not known."""
    power = {"m/s": 0, "m/s^2": 1}.get(analysis.unit)
    if power is None or 0.5 * analysis.sample_rate < _BAND[1]:
        return float("nan")
    lines = spectrum(analysis.signal, analysis.sample_rate, window="hann", scaling="density")
    inside = (lines.frequency >= lowest) & (lines.frequency <= _BAND[1])
    squares = lines.amplitude[inside] / (2.0 * np.pi * lines.frequency[inside]) ** (2 * power)
    width = lines.frequency[1] - lines.frequency[0]
    return float(np.sqrt(squares.sum() * width))


class _Line(NamedTuple):
    frequency: float
    amplitude: float
    clear: float  #: amplitude over the median about it


def _line(lines: SignalSpectrum, frequency: float, within: float) -> _Line:
    """Largest line near a frequency; none is clear where all are the skirt of one beside them."""
    step = lines.frequency[1] - lines.frequency[0]
    reach = max(within * frequency, _LOBE * step)
    distance = np.abs(lines.frequency - frequency)
    searched, about = distance <= reach, distance <= max(3.0 * reach, _ABOUT * step)
    if frequency + reach > lines.frequency[-1] or frequency <= 2.0 * reach:
        return _Line(frequency, 0.0, 0.0)
    peak = int(np.flatnonzero(searched)[np.argmax(lines.amplitude[searched])])
    size, floor = lines.amplitude[peak], np.median(lines.amplitude[about])
    stands = floor and size >= lines.amplitude[peak - 1 : peak + 2].max()
    return _Line(float(lines.frequency[peak]), float(size), float(size / floor) if stands else 0.0)


def _findings(
    analyses: Sequence[SignalAnalysis],
    lines: KinematicFrequencies,
    ratios: Sequence[float],
    ends: tuple[float, ...],
) -> Iterator[Finding]:
    """Parts whose lines stand out in the last recording, with those of the earlier ones."""
    scales = [float(np.nan_to_num(ratio, nan=1.0)) for ratio in ratios]
    yield from _impacts([_bands(each) for each in analyses], lines, scales)
    plain = [
        spectrum(n.signal - n.signal.mean(), n.sample_rate, window="hann", unit=n.unit)
        for n in analyses
    ]
    rows = list(zip(lines.part, lines.symbol, lines.frequency.tolist(), strict=True))
    carriers = {part: frequency for part, symbol, frequency in rows if symbol == "GMF"}
    turns = [frequency for _, symbol, frequency in rows if _kind(symbol) == "f" and frequency > 0.0]
    lowest = min(_BAND[0], 0.5 * scales[-1] * min(turns, default=_BAND[1]))
    bands = {low: _velocity(analyses[-1], low) for low in (lowest, _BAND[0])}
    for part, symbol, frequency in rows:
        now, kind, evidence = frequency * scales[-1], _kind(symbol), ""
        if symbol.startswith("GMF - f("):
            carrier = carriers[part] * scales[-1]
            evidence = _sidebands(plain[-1], carrier, carrier - now)
        elif kind in ("f", "GMF"):
            band_level = bands[lowest if now < _BAND[0] else _BAND[0]]
            if band_level > min(ends, default=0.0):
                evidence = _dominance(plain[-1], now, band_level, analyses[-1].unit)
        if evidence:
            history = tuple(
                _line(each, frequency * scale, _EXACT).amplitude
                for each, scale in zip(plain, scales, strict=True)
            )
            yield Finding(_name(part, symbol), evidence, _CHECKS[kind][1], now, history)


def _impacts(
    bursts: list[list[SignalSpectrum]], lines: KinematicFrequencies, scales: list[float]
) -> Iterator[Finding]:
    """Parts that strike: one finding for each rate, with all parts that it may belong to."""
    rates = list(_rates(lines))
    turns = [
        f * scales[-1]
        for s, f in zip(lines.symbol, lines.frequency, strict=True)
        if _kind(s) == "f"
    ]
    for band, of_band in enumerate(bursts[-1]):
        exact = _exact_lines(lines, of_band, scales[-1], band)
        reach, peaks = _LOBE * float(of_band.frequency[1]), list[float]()
        clear: list[tuple[float, str]] = []
        inner = list[tuple[float, float]]()
        for _, kind, rate in rates:
            peak, evidence = _bursts(of_band, rate * scales[-1], _within(kind), exact)
            if evidence and kind == "BPFI":
                inner.append((peak, _line(of_band, peak, 0.0).amplitude))
            if evidence and all(abs(peak - other) > reach for other, _ in clear):
                clear.append((peak, evidence))
        for peak, evidence in sorted(clear):
            if any(abs(peak - round(peak / p) * p) <= reach * peak / p for p in peaks):
                continue  # a harmonic of a lower rate
            size = _line(of_band, peak, 0.0).amplitude
            if any(abs(abs(peak - p) - f) <= reach for p, a in inner if a > size for f in turns):
                continue  # a sideband of a defect that turns through the load
            peaks.append(peak)
            within = [max(_within(kind) * rate * scales[-1], reach) for _, kind, rate in rates]
            candidates = [
                row
                for row, width in zip(rates, within, strict=True)
                if abs(row[2] * scales[-1] - peak) <= width
            ]
            candidates.sort(key=lambda row: abs(row[2] * scales[-1] - peak))
            history = tuple(
                _line(each[band], candidates[0][2] * scale, _within(candidates[0][1])).amplitude
                for each, scale in zip(bursts, scales, strict=True)
            )
            parts = ", or ".join(name for name, _, _ in candidates)
            yield Finding(parts, evidence, _CHECKS[candidates[0][1]][1], peak, history)
        if peaks:
            return


def _rates(lines: KinematicFrequencies) -> Iterator[tuple[str, str, float]]:
    """Part, kind and rate of the impacts [Hz]; an element strikes at twice its spin."""
    for part, symbol, frequency in zip(lines.part, lines.symbol, lines.frequency, strict=True):
        if (kind := _kind(symbol)) in _BURSTS:
            yield _name(part, symbol), kind, float(frequency) * (2.0 if kind == "BSF" else 1.0)


def _within(kind: str) -> float:
    return _EXACT if kind == "TF" else _SLIP


def _name(part: str, symbol: str) -> str:
    """Name of what a line belongs to."""
    kind = _kind(symbol)
    inner = "" if kind == "f" else symbol.partition("(")[2].rstrip(")")
    return f"{part}, {_CHECKS[kind][0]} {inner}".strip(", ")


def _kind(symbol: str) -> str:
    """Symbol without the part that it is of; GMF - f for sidebands."""
    return symbol.partition("(")[0]


def _speed_ratio(analysis: SignalAnalysis, lines: KinematicFrequencies) -> float:
    """Speed of a recording over that of the lines by its meshes; NaN where none is found."""
    meshes = sorted({f for s, f in zip(lines.symbol, lines.frequency, strict=True) if s == "GMF"})
    if analysis.mesh_frequency is not None:
        ratios = analysis.mesh_frequency / np.array(meshes)
        return float(ratios[np.argmin(np.abs(np.log(ratios)))])
    measured = []
    for frequency in meshes:
        with suppress(InputError):  # a record that is too short, or sampled too slowly
            measured.append(mesh_speed(analysis.signal, analysis.sample_rate, frequency).ratio)
    ratios = np.array([ratio for ratio in measured if np.isfinite(ratio)])
    if not ratios.size:
        return float("nan")
    return float(ratios[np.argmin(np.abs(ratios[:, None] - ratios).sum(axis=1))])


def _bands(analysis: SignalAnalysis) -> list[SignalSpectrum]:
    """Envelope spectra of the octaves below the end of the band, which impacts excite."""
    rate = analysis.sample_rate
    return [
        envelope_spectrum(analysis.signal, rate, band=_octave(rate, k), window="hann")
        for k in range(_OCTAVES)
    ]


def _octave(sample_rate: float, number: int) -> tuple[float, float]:
    """Ends of an octave, counted from the highest [Hz]."""
    top = _TOP * sample_rate / 2**number
    return 0.5 * top, top


def _exact_lines(
    lines: KinematicFrequencies, envelope: SignalSpectrum, scale: float, octave: int
) -> Array:
    """Frequencies of shafts and meshes with their harmonics, sidebands and beats in a band [Hz].

    Of a shaft all harmonics only where its own line is clear; otherwise the first three.
    """
    band = _octave(2.0 * float(envelope.frequency[-1]), octave)[0]
    rows = [(s, f * scale) for s, f in zip(lines.symbol, lines.frequency.tolist(), strict=True)]
    turns = [f for symbol, f in rows if symbol.startswith("f(")]
    meshes = [k * f for symbol, f in rows if symbol == "GMF" for k in range(1, 6)]
    sides = [m + k * f for m in meshes for f in turns for k in (-2, -1, 0, 1, 2)]
    last = {f: max(10, int(2.0 * band / f)) for symbol, f in rows if symbol == "GMF"}
    tones = [k * f for f, count in last.items() for k in range(1, count + 1)]
    beats = [abs(first - second) for first, second in combinations(tones, 2)]
    multiples = [
        k * f
        for f in turns
        for k in range(1, 21 if _line(envelope, f, _EXACT).clear >= _CLEAR else 4)
    ]
    return np.array([*multiples, *sides, *beats])


def _bursts(
    lines: SignalSpectrum, frequency: float, slip: float, exact: Array
) -> tuple[float, str]:
    """Rate of impacts and its evidence; empty without, or where a shaft or mesh explains it."""
    step = lines.frequency[1] - lines.frequency[0]
    first = _line(lines, frequency, slip)
    mean = float(lines.amplitude[0])
    if (
        first.clear < _CLEAR
        or first.amplitude < _DEPTH * mean
        or np.abs(exact - first.frequency).min(initial=np.inf) <= step
    ):
        return first.frequency, ""
    others = [_line(lines, k * first.frequency, 0.5 * _EXACT) for k in (2, 3)]
    clear = [first, *(each for each in others if each.clear >= _CLEAR)]
    heights = " and ".join(f"{each.clear:.3g} times at {each.frequency:.5g} Hz" for each in clear)
    evidence = f"the envelope spectrum exceeds the noise around it {heights}"
    return first.frequency, evidence if len(clear) > 1 else ""


def _sidebands(lines: SignalSpectrum, mesh: float, turns: float) -> str:
    """Evidence of sidebands of a mesh on both sides; empty where there is none."""
    carrier = _line(lines, mesh, _EXACT)
    sides = [_line(lines, carrier.frequency + sign * turns, 0.0) for sign in (-1.0, 1.0)]
    size = 0.5 * sum(each.amplitude for each in sides)
    separate = turns > 2.0 * _LOBE * (lines.frequency[1] - lines.frequency[0])
    if not separate or min(each.clear for each in (carrier, *sides)) < _CLEAR:
        return ""
    if size < _SIDEBAND * carrier.amplitude:
        return ""
    share = 100.0 * size / carrier.amplitude
    return (
        f"sidebands {turns:.4g} Hz on both sides of the mesh at {carrier.frequency:.5g} Hz have "
        f"{share:.3g} % of it"
    )


def _dominance(lines: SignalSpectrum, frequency: float, velocity: float, unit: str) -> str:
    """Evidence that one line holds most of the velocity; empty where it does not."""
    line, power = _line(lines, frequency, _EXACT), {"m/s": 0, "m/s^2": 1}.get(unit)
    if power is None or not velocity > 0.0 or frequency > _BAND[1]:
        return ""
    size = line.amplitude / (2.0 * np.pi * frequency) ** power / np.sqrt(2.0)
    share = (size / velocity) ** 2
    if line.clear < _CLEAR or share < _DOMINANT:
        return ""
    return f"{100.0 * min(share, 1.0):.3g} % of the mean square velocity is at {frequency:.5g} Hz"


def _sentence(finding: Finding) -> str:
    text = f"{finding.part[:1].upper()}{finding.part[1:]}: {finding.evidence}"
    first, last = finding.amplitudes[0], finding.amplitudes[-1]
    if len(finding.amplitudes) > 1 and first > 0.0:
        text += f", x{last / first:.3g} since the first recording"
    return f"{text}. Next: {finding.check}."
