"""One channel of a recording, analysed: spectra, envelope, orders, mean revolutions, indicators."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from math import gcd

import numpy as np

from tribodyn.errors import Argument, InputError, Problem, require_between, require_positive
from tribodyn.measurement.impacts import impact_figures, impacts_of
from tribodyn.measurement.orders import OrderSpectrum, order_map, order_spectrum
from tribodyn.measurement.recording import Recording, in_si
from tribodyn.measurement.shaft_speed import (
    MATE,
    SHAFT,
    ShaftSpeed,
    average_figures,
    compare_with_earlier,
    left_out,
    mean_revolutions,
    shaft_speed,
)
from tribodyn.measurement.sideband_cursors import LOBE, doubt_teeth
from tribodyn.nomenclature import require_whole
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.signals.condition_indicators import ConditionIndicators
from tribodyn.signals.cyclic_coherence import CyclicCoherence
from tribodyn.signals.envelope import Kurtogram, envelope, envelope_spectrum
from tribodyn.signals.gear_indicators import kurtosis
from tribodyn.signals.order_map import OrderMap
from tribodyn.signals.spectrum import SignalSpectrum, distinct_peaks, spectrum
from tribodyn.signals.synchronous_average import SynchronousAverage
from tribodyn.types import Array, Tree

#: Peaks of a spectrum and mesh harmonics among the figures.
_PEAKS, _HARMONICS = 5, 5
#: Highest order where no teeth are known, and its share of what the sampling resolves.
_ORDERS, _RESOLVED = 100.0, 0.95
#: Half the main lobe of the window "flattop" over the inverse of the revolutions.
_FLATTOP = 5.0
#: Revolutions of a block of the order map.
_BLOCK = 8.0
#: Lines of a spectrum over which a smeared one reads clearly low.
_SMEARED = 8.0


@record
class SignalAnalysis(Record):
    """What :func:`analyse_signal` finds in one channel.

    Parameters
    ----------
    channel : str
        Name of the channel.
    unit : str
        Unit of the signal: SI where the unit of the file is known.
    sample_rate : float
        Samples per second [Hz].
    time : (n,) array
        Time from the first sample [s].
    signal : (n,) array
        Signal.
    envelope : (n,) array
        Envelope of the band.
    spectrum : SignalSpectrum
        Amplitudes over the frequency.
    envelope_spectrum : SignalSpectrum
        Amplitudes of the envelope over the frequency.
    band : tuple of float, optional
        Ends of the band that the envelope is taken of [Hz]; None is the whole signal.
    speed : ShaftSpeed, optional
        Angle and speed of the shaft, where they are known.
    teeth : mapping of str to int
        Teeth by shaft, ``"shaft"`` and ``"mate"``, as far as they are known.
    orders : OrderSpectrum, optional
        Amplitudes over the orders of the shaft.
    order_map : OrderMap, optional
        The same over the speed, where that changes by more than 3 %.
    averages : mapping of str to SynchronousAverage
        Mean revolution of each shaft whose teeth are known.
    indicators : mapping of str to ConditionIndicators
        Condition indicators of each mean revolution.
    notes : tuple of Problem
        What could not be computed, why, and what is needed for it.
    kurtogram : Kurtogram, optional
        Kurtosis of frequency bands, where the record is long enough.
    coherence : CyclicCoherence, optional
        Modulations up to 8.5 orders of the shaft at a constant speed, without the mesh.
    """

    channel: str = fact()
    unit: str = fact()
    sample_rate: float = fact()
    time: Array = quantity("time", unit="s", axis=True)
    signal: Array = quantity("time", unit="@unit")
    envelope: Array = quantity("time", unit="@unit")
    spectrum: SignalSpectrum
    envelope_spectrum: SignalSpectrum
    band: tuple[float, float] | None = None
    speed: ShaftSpeed | None = None
    teeth: Mapping[str, int] = field(default_factory=dict)
    orders: OrderSpectrum | None = None
    order_map: OrderMap | None = None
    averages: Mapping[str, SynchronousAverage] = field(default_factory=dict)
    indicators: Mapping[str, ConditionIndicators] = field(default_factory=dict)
    notes: tuple[Problem, ...] = ()
    kurtogram: Kurtogram | None = None
    coherence: CyclicCoherence | None = None

    @property
    def mesh_frequency(self) -> float | None:
        """Mean mesh frequency [Hz]; None where speed or teeth are not known."""
        if self.speed is None or SHAFT not in self.teeth:
            return None
        return self.teeth[SHAFT] * self.speed.mean / (2.0 * np.pi)

    @property
    def smeared(self) -> bool:
        """Whether the speed changes so much that lines of the shaft are smeared over frequency."""
        if self.speed is None:
            return False
        highest_order = _HARMONICS * self.teeth.get(SHAFT, 1)
        change = (self.speed.highest - self.speed.lowest) / (2.0 * np.pi)
        return bool(highest_order * change * self.signal.size / self.sample_rate > _SMEARED)

    def figures(self) -> dict[str, float]:
        """Numbers of the analysis in SI.

        Returns
        -------
        dict of str to float
            Levels and indicators of the signal, largest peaks, speed, mesh harmonics, and of each
            mean revolution its indicators; those of the mate end with ``_mate``.
        """
        away = self.signal - self.signal.mean()
        rms = float(np.sqrt(np.mean(away**2)))
        numbers = {
            "sample_rate": self.sample_rate,
            "duration": self.signal.size / self.sample_rate,
            "mean": float(self.signal.mean()),
            "rms": float(np.sqrt(np.mean(self.signal**2))),
            "alternating_rms": rms,
            "peak_to_peak": float(np.ptp(self.signal)),
            "crest_factor": float(np.abs(away).max()) / rms,
            "kurtosis": kurtosis(self.signal),
        }
        numbers |= _peak_figures("spectrum", self.spectrum)
        numbers["envelope_mean"] = float(self.envelope.mean())
        numbers |= _peak_figures("envelope", self.envelope_spectrum)
        if self.speed is not None:
            numbers |= self._speed_figures(self.speed)
        numbers |= impact_figures(self.kurtogram, self.coherence)
        for shaft, average in self.averages.items():
            numbers |= average_figures(
                average, self.indicators.get(shaft), "" if shaft == SHAFT else f"_{shaft}"
            )
        return numbers

    def _speed_figures(self, speed: ShaftSpeed) -> dict[str, float]:
        numbers = {
            "speed": speed.mean,
            "lowest_speed": speed.lowest,
            "highest_speed": speed.highest,
        }
        if np.isfinite(speed.uncertainty):
            numbers["speed_uncertainty"] = speed.uncertainty
        if self.orders is not None:
            numbers["revolutions"] = self.orders.revolutions
            for number, (order, size) in enumerate(order_peaks(self.orders, _PEAKS), 1):
                numbers |= {f"order_peak_{number}": order, f"order_peak_{number}_amplitude": size}
        frequency, teeth = self.mesh_frequency, self.teeth.get(SHAFT)
        if frequency is not None and teeth is not None:
            numbers["mesh_frequency"] = frequency
            if self.orders is not None:
                top = int(min(_HARMONICS, self.orders.orders[-1] // teeth))
                for k in range(1, top + 1):
                    size = self.orders.amplitude(float(k * teeth))
                    numbers[f"mesh_harmonic_{k}_amplitude"] = size
        return numbers

    def __repr__(self) -> str:
        """One line."""
        parts = [f"{self.signal.size / self.sample_rate:.6g} s at {self.sample_rate:.6g} Hz"]
        parts.append(f"rms {float(np.sqrt(np.mean(self.signal**2))):.4g} {self.unit}".rstrip())
        if self.speed is not None:
            parts.append(f"{self.speed.mean * 30.0 / np.pi:.5g} rpm")
        parts += [f"{len(self.notes)} parts missing"] if self.notes else []
        return f"SignalAnalysis({self.channel}, {', '.join(parts)})"

    def _parts(self) -> Parts:
        parts, units = super()._parts(), self._units("@unit")
        for name, lines in (
            ("spectrum", self.spectrum),
            ("envelope_spectrum", self.envelope_spectrum),
        ):
            parts.coordinates["frequency"] = ("frequency", lines.frequency, {"units": "Hz"})
            parts.variables[name] = ("frequency", lines.amplitude, units)
        if self.speed is not None:
            parts.variables["shaft_angle"] = ("time", self.speed.angle, {"units": "rad"})
            parts.attributes["speed_source"] = self.speed.source
        if self.orders is not None:
            parts.coordinates["order"] = ("order", self.orders.orders, {"units": "1"})
            parts.variables["order_spectrum"] = ("order", self.orders.amplitudes, units)
        for shaft, average in self.averages.items():
            angle = f"angle_{shaft}"
            parts.coordinates[angle] = (angle, average.angle, {"units": "rad"})
            for name, values in (
                ("mean", average.signal),
                ("standard_error", average.scatter),
                ("residual", average.residual()),
                ("difference", average.difference()),
            ):
                parts.variables[f"{name}_revolution_{shaft}"] = (angle, values, units)
        parts.attributes.update(self.figures())
        return parts


def order_peaks(lines: OrderSpectrum, count: int) -> list[tuple[float, float]]:
    """Orders and amplitudes of the largest lines that are no neighbours of larger ones."""
    size = lines.amplitudes.copy()
    size[: LOBE + 1] = 0.0
    peaks: list[tuple[float, float]] = []
    while len(peaks) < count and size.max() > 0.0:
        top = int(np.argmax(size))
        peaks.append((float(lines.orders[top]), float(size[top])))
        size[max(top - LOBE, 0) : top + LOBE + 1] = 0.0
    return peaks


def _peak_figures(name: str, lines: SignalSpectrum) -> dict[str, float]:
    numbers = {}
    for number, peak in enumerate(distinct_peaks(lines, _PEAKS), 1):
        numbers[f"{name}_peak_{number}_frequency"] = peak.frequency
        numbers[f"{name}_peak_{number}_amplitude"] = peak.amplitude
    return numbers


def analyse_signal(
    recording: Recording,
    channel: str,
    *,
    tacho: str | None = None,
    pulses_per_revolution: int = 1,
    speed: float | None = None,
    teeth: int | None = None,
    mate_teeth: int | None = None,
    band: tuple[float, float] | None = None,
    max_order: float | None = None,
    line: float | None = None,
    earlier: Sequence[Recording] = (),
) -> SignalAnalysis:
    """Analyse one channel of a recording as far as speed and teeth of the shaft are known.

    Parameters
    ----------
    recording : Recording
        What :func:`read` returns.
    channel : str
        Channel to analyse.
    tacho : str, optional
        Channel with the pulses of a tachometer, or with the speed, by its unit of rpm or rad/s.
    pulses_per_revolution : int
        Its pulses in one revolution.
    speed : float, optional
        Speed of the shaft where there is no tachometer [rad/s]. With teeth it is a first guess:
        the speed is found within 5 % of it by the mesh lines of the channel.
    teeth, mate_teeth : int, optional
        Teeth of the gear on that shaft, and of the gear that it meshes with.
    band : tuple of two float, optional
        Band that the envelope is taken of [Hz]; by default the one of half a mesh frequency on both
        sides of the strongest mesh harmonic, or the whole signal where the mesh is not known.
    max_order : float, optional
        Highest order of the shaft [-]; by default half an order of the mesh above its fifth
        harmonic, or 100, as far as the sampling resolves it.
    line : float, optional
        Frequency of the mesh, or of another line, instead of the speed [Hz]: it is followed by its
        phase, and orders are relative to it; with teeth it is the order of the teeth. In cycles per
        sample for a recording without a rate, read with ``sample_rate=1``.
    earlier : sequence of Recording
        Earlier recordings of the same channel in their order, with which NA4, NA4* and NB4 compare.

    Returns
    -------
    SignalAnalysis
        Its ``notes`` list what could not be computed, and the missing input.

    Raises
    ------
    InputError
        If there is no such channel, the signal does not change, the tachometer cannot be read,
        or arguments contradict each other.

    Notes
    -----
    A unit that is known is converted to SI; ``g`` is the standard acceleration of gravity. The
    spectra have a flat-top window over the whole record: amplitudes are within 0.12 %.

    Examples
    --------
    >>> from tribodyn.measurement import synthetic_run_up
    >>> run = synthetic_run_up({29: 2.0}, 150.0, duration=4.0)
    >>> options = {"tacho": "tacho", "pulses_per_revolution": 60, "teeth": 29}
    >>> analysis = analyse_signal(run, "signal", **options)
    >>> analysis
    SignalAnalysis(signal, 4 s at 25600 Hz, rms 1.414 m/s^2, 1432.4 rpm)
    >>> round(analysis.figures()["mesh_harmonic_1_amplitude"], 2)
    2.0
    """
    values, unit = in_si(recording[channel], recording.units[channel])
    rate = recording.sample_rate
    if np.ptp(values) == 0.0:
        what, why = f"channel {channel} is constant", "It contains nothing to analyse"
        raise InputError(
            what, Argument("channel"), why, "Check the sensor, or select another channel"
        )
    counts = {SHAFT: teeth, MATE: mate_teeth}
    shafts = {k: require_whole(f"{k} teeth", n) for k, n in counts.items() if n is not None}
    notes: list[Problem] = []
    speed = _assumed_speed(tacho, speed, line, teeth)
    gears = tuple(shafts.values()) or (() if line is None else (1,))
    shaft = shaft_speed(recording, values, (tacho, pulses_per_revolution, speed), gears, notes)
    lines = spectrum(values, rate, unit=unit)
    parts: Tree = {}
    if shaft is not None:
        parts |= _orders(values, rate, unit, shaft, (max_order, teeth, mate_teeth), notes)
        parts |= mean_revolutions(values, recording.time, unit, shaft, shafts, notes)
        options = (tacho, pulses_per_revolution, speed, gears)
        compare_with_earlier(parts, [(each, channel) for each in earlier], options, shafts)
        if band is None and teeth and "orders" in parts:
            band = _mesh_band(parts["orders"], teeth, shaft, rate)
    mesh = shaft.mean * teeth / (2.0 * np.pi) if shaft is not None and teeth else None
    parts |= impacts_of(values, rate, shaft, mesh, notes)
    return SignalAnalysis(
        channel,
        unit,
        rate,
        recording.time,
        values,
        envelope(values, rate, band=band),
        lines,
        envelope_spectrum(values, rate, band=band, unit=unit),
        band,
        shaft,
        shafts,
        notes=tuple(notes),
        **parts,
    )


def _assumed_speed(
    tacho: str | None, speed: float | None, line: float | None, teeth: int | None
) -> float | None:
    """Stated speed of the shaft, or that of a line, whose order is the number of teeth [rad/s]."""
    sources = {
        f"tacho = {tacho!r}": tacho is not None,
        f"speed = {speed} rad/s": speed is not None,
        f"line = {line} Hz": line is not None,
    }
    used = [name for name, present in sources.items() if present]
    if len(used) > 1:
        what, why = f"{' and '.join(used)} are given", "Each of them is the speed"
        where = Argument("speed" if speed is not None else "line")
        raise InputError(what, where, why, "Pass only one of them")
    if line is None:
        return speed
    require_positive("line", line, "Hz")
    return 2.0 * np.pi * line / (teeth or 1)


def _orders(
    values: Array,
    rate: float,
    unit: str,
    shaft: ShaftSpeed,
    limits: tuple[float | None, int | None, int | None],
    notes: list[Problem],
) -> Tree:
    """Order spectrum, and order map where the speed changes."""
    max_order, teeth, mate_teeth = limits
    fastest = float(np.diff(shaft.angle).max())
    if max_order is None:
        wanted = (_HARMONICS + 0.5) * teeth if teeth else _ORDERS
        max_order = min(wanted, _RESOLVED * np.pi / fastest)
    else:
        require_between("max_order", max_order, 1.0, 1e6)
    pair = (teeth, mate_teeth) if teeth and mate_teeth else (1, 1)
    # The turns of a short record part neighbouring orders by a narrower window only.
    turned = float(np.ptp(shaft.angle)) / (2.0 * np.pi) * min(1.0, pair[0] / pair[1])
    window = "flattop" if turned >= _FLATTOP else "hann"
    period = pair[1] // gcd(*pair)
    try:
        parts: Tree = {
            "orders": order_spectrum(
                values, shaft.angle, max_order, window=window, unit=unit, period=period
            )
        }
        if shaft.varies:
            parts["order_map"] = order_map(
                values, shaft.angle, max_order, rate, revolutions=_BLOCK, unit=unit
            )
    except InputError as error:
        if any("max_order" in str(each.where) for each in error.problems):
            raise
        notes += [left_out("no orders", each) for each in error.problems]
        return {}
    if teeth and max_order < teeth:
        what = f"orders end at {max_order:.4g}, below the mesh at {teeth}"
        why = f"Sampled with {rate:g} Hz, higher ones are not resolved"
        notes.append(Problem(what, "", why, "Sample faster, or run slower"))
    elif teeth and np.isnan(shaft.uncertainty):  # else the speed is that of the mesh lines
        doubt = doubt_teeth(parts["orders"], teeth)
        notes += [] if doubt is None else [doubt]
    return parts


def _mesh_band(
    lines: OrderSpectrum, teeth: int, shaft: ShaftSpeed, rate: float
) -> tuple[float, float] | None:
    """Half a mesh frequency on both sides of the strongest mesh harmonic, at all speeds."""
    count = int(min(_HARMONICS, lines.orders[-1] // teeth))
    if not count:
        return None
    strongest = 1 + int(np.argmax([lines.amplitude(float(k * teeth)) for k in range(1, count + 1)]))
    low = (strongest - 0.5) * teeth * shaft.lowest / (2.0 * np.pi)
    high = (strongest + 0.5) * teeth * shaft.highest / (2.0 * np.pi)
    return (float(low), float(min(high, 0.49 * rate)))
