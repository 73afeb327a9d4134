"""Report of the analysis of a recorded channel: figures, table and sentences."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn import plot
from tribodyn.drawing import report_of
from tribodyn.errors import ComputationError, InputError
from tribodyn.measurement.mean_revolutions import MATE, SHAFT
from tribodyn.measurement.modulating_shaft import explain_modulation, modulating_shaft
from tribodyn.measurement.sideband_cursors import sideband_cursors
from tribodyn.plot.signals.analysed import visible_frequency
from tribodyn.plot.theme.labels import readable, significant
from tribodyn.report.study import write_study_report
from tribodyn.report.study_report_data import Picture, StudyReportData
from tribodyn.signals import cepstrum, narrowband_demodulation

if TYPE_CHECKING:
    from tribodyn.drawing import Drawing
    from tribodyn.errors import Problem
    from tribodyn.measurement import SignalAnalysis

HEAD = ("Figure", "Value", "Unit", "Meaning")
_RPM = 30.0 / np.pi
#: Digits of a number in the table, and number of marked mesh harmonics.
_DIGITS, _MARKED = 5, 5
#: FM4 from which a fault is local: noise alone stays below it.
_LOCAL = 5.0
#: Sidebands on both sides of the mesh.
_CURSORS = 5
_LEVELS = {
    "mean": ("Mean", "of all samples"),
    "rms": ("Rms", "root mean square, the mean included"),
    "alternating_rms": ("Alternating rms", "without the mean"),
    "peak_to_peak": ("Peak to peak", "largest minus smallest sample"),
}
_SHAPES = {
    "crest_factor": ("Crest factor", "largest deviation from the mean over the alternating rms"),
    "kurtosis": ("Kurtosis", "1.5 for a sine, 3 for noise, more for impacts"),
}
_AVERAGE = {
    "average_revolutions": ("revolutions", "", "averaged"),
    "average_peak_to_peak": ("peak to peak", "unit", "of the mean revolution"),
    "average_standard_error": ("standard error", "unit", "falls with the root of the revolutions"),
    "residual_rms": ("residual, rms", "unit", "without mesh harmonics and the lowest shaft orders"),
    "difference_rms": ("difference, rms", "unit", "without the first sidebands too"),
    "average_crest_factor": ("crest factor", "", "of the mean revolution"),
    "average_kurtosis": ("kurtosis", "", "of the mean revolution"),
    "fm0": ("FM0", "", "peak to peak over the sum of the mesh amplitudes"),
    "fm4": ("FM4", "", "kurtosis of the difference: 3 or less for sound teeth"),
    "m6a": ("M6A", "", "sixth moment of the difference: 15 or less for sound teeth"),
    "m8a": ("M8A", "", "eighth moment of the difference: 105 or less for sound teeth"),
    "na4": ("NA4", "", "fourth moment of the residual: 3 or less for sound teeth"),
    "na4_star": ("NA4*", "", "the same over the variance before damage began"),
    "nb4": ("NB4", "", "fourth moment of the envelope of the strongest mesh harmonic"),
    "energy_ratio": ("energy ratio", "", "rms of the difference over that of the regular mesh"),
    "sideband_index": ("sideband index", "unit", "mean of the first sidebands of the mesh"),
    "sideband_level_factor": ("sideband level factor", "", "their sum over the rms"),
}
_IMPACTS = {
    "kurtogram_centre": ("Kurtogram, centre", "Hz", "of the band with the most impulsive content"),
    "kurtogram_bandwidth": ("Kurtogram, bandwidth", "Hz", "of that band"),
    "kurtogram_kurtosis": ("Kurtogram, kurtosis", "", "0 for noise, more for impacts"),
    "kurtogram_limit": ("Kurtogram, limit", "", "kurtosis that noise alone does not exceed"),
    "coherence_frequency": ("Cyclic coherence, rate", "Hz", "strongest modulation, mesh removed"),
    "coherence": ("Cyclic coherence", "", "mean over the carriers in that band, or over all"),
    "coherence_of_noise": ("Cyclic coherence, noise", "", "of noise alone"),
}
_SMEARED = (
    " The speed varies: shaft-synchronous lines are smeared in this figure and too "
    "low. Read their amplitudes from the orders."
)
_NAMES = {SHAFT: "Shaft", MATE: "Mate"}


def signal_report_data(analysis: SignalAnalysis) -> StudyReportData:
    """Figures, sentences, table and numbers in SI of an analysed channel."""
    numbers = analysis.figures()
    facts: dict[str, Any] = {"channel": analysis.channel, "unit": analysis.unit, **numbers}
    if analysis.speed is not None:
        facts["speed_source"] = analysis.speed.source
    facts["notes"] = [sentence(each) for each in analysis.notes]
    return StudyReportData(
        analysis,
        _pictures(analysis),
        [_lead(analysis), *_verdicts(analysis), *facts["notes"]],
        HEAD,
        _rows(analysis, numbers),
        facts,
    )


@report_of("SignalAnalysis")
def write_signal_report(
    analysis: SignalAnalysis, path: str | os.PathLike[str], *, title: str = ""
) -> Path:
    """Write the analysis of a recorded channel to a file.

    Parameters
    ----------
    analysis : SignalAnalysis
        What :func:`tribodyn.measurement.analyse_signal` returns.
    path
        As :func:`write_report` takes it.
    title : str
        Title of the report; that of the channel by default.

    Raises
    ------
    InputError
        If the place cannot be written to.
    """
    answer = signal_report_data(analysis)
    return write_study_report(
        None,
        path,
        kind="signal analysis",
        results=answer.statements,
        figures=answer.figures,
        head=answer.head,
        rows=answer.rows,
        title=title or analysis.channel,
        cards=_cards(analysis),
    )


def sentence(note: Problem) -> str:
    """Format a note as a sentence."""
    text = f"{note.what[:1].upper()}{note.what[1:]}: {note.why[:1].lower()}{note.why[1:]}."
    return f"{text} {note.remedy}." if note.remedy else text


def _lead(analysis: SignalAnalysis) -> str:
    seconds = analysis.signal.size / analysis.sample_rate
    lead = f"{analysis.channel}: {seconds:.5g} s at {analysis.sample_rate:.6g} Hz"
    if analysis.speed is None:
        return lead + "."
    speed = analysis.speed
    rpm = f"{speed.mean * _RPM:.6g}"
    if np.isfinite(speed.uncertainty):
        rpm += f" +- {speed.uncertainty * _RPM:.1g}"
    if speed.varies:
        rpm += f" ({speed.lowest * _RPM:.5g} to {speed.highest * _RPM:.5g})"
    return f"{lead}; shaft at {rpm} rpm, by {speed.source}."


def _verdicts(analysis: SignalAnalysis) -> list[str]:
    """Which gear modulates the mesh, and whether at one tooth."""
    teeth, mate, orders = analysis.teeth.get(SHAFT), analysis.teeth.get(MATE), analysis.orders
    verdicts, suspects = [], list(analysis.indicators)
    if orders is not None and teeth and mate and teeth != mate:
        of_gears = modulating_shaft(orders, teeth, mate)
        verdicts.append(explain_modulation(of_gears, teeth, mate, readable(analysis.unit)))
        lines = dict(zip((SHAFT, MATE), of_gears, strict=True))
        suspects = [name for name in suspects if lines[name].stands_out]
    for name in suspects:
        average, fm4 = analysis.averages[name], analysis.indicators[name].fm4
        if fm4 > _LOCAL:
            place = np.degrees(average.angle[np.argmax(np.abs(average.difference()))])
            verdicts.append(
                f"FM4 of the {name} is {fm4:.3g}, 3 or less for sound teeth: its difference "
                f"signal is local, as of one tooth, and largest at {place:.0f}\N{DEGREE SIGN}."
            )
    return [text for text in verdicts if text]


def _cards(analysis: SignalAnalysis) -> list[tuple[str, str]]:
    numbers = analysis.figures()
    unit = readable(analysis.unit)
    cards = [
        ("Alternating rms", f"{significant(numbers['alternating_rms'], 4)} {unit}".rstrip()),
        ("Crest factor", significant(numbers["crest_factor"])),
        ("Kurtosis", significant(numbers["kurtosis"])),
    ]
    if "speed" in numbers:
        cards.append(("Speed", f"{significant(numbers['speed'] * _RPM, 5)} rpm"))
    if "mesh_frequency" in numbers:
        cards.append(("Mesh frequency", f"{significant(numbers['mesh_frequency'], 5)} Hz"))
    cards += [
        (f"FM4 of the {shaft}", significant(each.fm4))
        for shaft, each in analysis.indicators.items()
    ]
    return cards


def _rows(analysis: SignalAnalysis, numbers: dict[str, float]) -> list[list[str]]:
    """Table of all indicators and peaks."""
    unit = readable(analysis.unit)

    def row(name: str, value: float, unit: str, meaning: str) -> list[str]:
        return [name, significant(value, _DIGITS), unit, meaning]

    rows = [row(n, numbers[k], unit, m) for k, (n, m) in _LEVELS.items()]
    rows += [row(n, numbers[k], "", m) for k, (n, m) in _SHAPES.items()]
    for key, name in (("spectrum", "Spectrum"), ("envelope", "Envelope")):
        for k in range(1, 6):
            if f"{key}_peak_{k}_frequency" in numbers:
                at = significant(numbers[f"{key}_peak_{k}_frequency"], _DIGITS)
                size = numbers[f"{key}_peak_{k}_amplitude"]
                meaning = f"peak amplitude at {at} Hz"
                meaning += ", smeared by the changing speed" if analysis.smeared else ""
                rows.append(row(f"{name}, peak {k}", size, unit, meaning))
    if analysis.speed is not None:
        rows.append(row("Speed", numbers["speed"] * _RPM, "rpm", f"by {analysis.speed.source}"))
        ends = [numbers[f"{end}_speed"] * _RPM for end in ("lowest", "highest")]
        if analysis.speed.varies:
            rows += [
                row(f"Speed, {end}", value, "rpm", "mean over a revolution")
                for end, value in zip(("lowest", "highest"), ends, strict=True)
            ]
    rows += [row(n, numbers[k], u, m) for k, (n, u, m) in _IMPACTS.items() if k in numbers]
    rows += _order_rows(numbers, unit)
    for shaft in analysis.averages:
        ending = "" if shaft == SHAFT else f"_{shaft}"
        for key, (name, kind, meaning) in _AVERAGE.items():
            if f"{key}{ending}" in numbers:
                size = numbers[f"{key}{ending}"]
                rows.append(row(f"{_NAMES[shaft]}, {name}", size, unit if kind else "", meaning))
    return rows


def _order_rows(numbers: dict[str, float], unit: str) -> list[list[str]]:
    rows = []
    if "mesh_frequency" in numbers:
        value = significant(numbers["mesh_frequency"], _DIGITS)
        rows.append(["Mesh frequency", value, "Hz", "mean over the recording"])
    for k in range(1, 6):
        if f"mesh_harmonic_{k}_amplitude" in numbers:
            size = significant(numbers[f"mesh_harmonic_{k}_amplitude"], _DIGITS)
            rows.append([f"Mesh harmonic {k}", size, unit, "peak amplitude over the orders"])
    for k in range(1, 6):
        if f"order_peak_{k}" in numbers:
            size = significant(numbers[f"order_peak_{k}_amplitude"], _DIGITS)
            order = significant(numbers[f"order_peak_{k}"], _DIGITS)
            rows.append([f"Orders, peak {k}", size, unit, f"peak amplitude at order {order}"])
    return rows


def _sketched(figure: Drawing, result: Any) -> Picture:
    """Heading, figure and caption; sketches avoid the slow import of plotly."""
    return figure.heading, figure.sketch(result), figure.caption_of(result)


def _pictures(analysis: SignalAnalysis) -> Sequence[Picture]:
    """Figures of all computed results."""
    steady = analysis.speed is not None and not analysis.speed.varies
    frequency, teeth = analysis.mesh_frequency, analysis.teeth.get(SHAFT)
    mesh = [("mesh" if k == 1 else str(k), float(k)) for k in range(1, _MARKED + 1)]
    marks: list[tuple[str, float]] = []
    if steady and frequency is not None:
        top = analysis.spectrum.frequency[-1]
        marks = [(name, k * frequency) for name, k in mesh if k * frequency < top]
    shafts: list[tuple[str, float]] = []
    reach = visible_frequency(analysis)
    if steady and analysis.speed is not None:
        turn = analysis.speed.mean / (2.0 * np.pi)
        ratios = {SHAFT: 1.0} | {
            name: teeth / count for name, count in analysis.teeth.items() if teeth and name == MATE
        }
        shafts = [(name, turn * ratio) for name, ratio in ratios.items() if turn * ratio < reach]
    hull = analysis.envelope_spectrum
    band = "the whole signal"
    if analysis.band is not None:
        band = f"the band from {analysis.band[0]:.5g} to {analysis.band[1]:.5g} Hz"
    pictures = [
        _sketched(plot.signal_history, analysis),
        (
            "Spectrum",
            plot.signal_spectrum.sketch(analysis.spectrum, marks=marks),
            plot.signal_spectrum.caption_of(analysis.spectrum)
            + (" Dotted lines are mesh harmonics." if marks else "")
            + (_SMEARED if analysis.smeared else ""),
        ),
        (
            "Envelope spectrum",
            plot.signal_spectrum.sketch(hull, marks=shafts, to=reach),
            f"The frequencies that modulate {band}; its mean of {hull.amplitude[0]:.4g} "
            f"{readable(analysis.unit)} is left out. A line at the shaft frequency indicates a "
            "load that varies with the rotation, its multiples indicate an impact per revolution. "
            "The axis ends where the lines become small.",
        ),
    ]
    if analysis.orders is not None:
        top = analysis.orders.orders[-1]
        orders = [(name, k * teeth) for name, k in mesh if teeth and k * teeth < top]
        caption = plot.order_spectrum.caption_of(analysis.orders)
        sketch = plot.order_spectrum.sketch(analysis.orders, marks=orders)
        pictures.append(("Orders", sketch, caption))
    if analysis.order_map is not None:
        pictures.append(_sketched(plot.order_map, analysis.order_map))
    for shaft, average in analysis.averages.items():
        heading, sketch, caption = _sketched(plot.synchronous_average, average)
        of = "" if len(analysis.averages) == 1 else f" of the {shaft}, {average.teeth} teeth"
        pictures.append((f"{heading}{of}", sketch, caption))
    return [*pictures, *_diagnosis(analysis)]


def _itself(result: Any) -> Any:
    return result


def _diagnosis(analysis: SignalAnalysis) -> list[Picture]:
    """Figures of diagnosis that the recording is long enough for."""
    teeth, orders = analysis.teeth.get(SHAFT), analysis.orders
    parts: list[tuple[Drawing, str, Callable[[], Any]]] = []
    if orders is not None and teeth is not None:
        for name, count in analysis.teeth.items():
            cursors = partial(sideband_cursors, orders, teeth, teeth / count, count=_CURSORS)
            parts.append((plot.sideband_cursors, f", distance of the {name}", cursors))
    for name, average in analysis.averages.items():
        demodulated = partial(narrowband_demodulation, average)
        parts.append((plot.narrowband_demodulation, f" over a turn of the {name}", demodulated))
    parts.append((plot.cepstrum, "", partial(cepstrum, analysis.signal, analysis.sample_rate)))
    for figure, result in (
        (plot.kurtogram, analysis.kurtogram),
        (plot.cyclic_coherence, analysis.coherence),
    ):
        if result is not None:
            parts.append((figure, "", partial(_itself, result)))
    pictures = []
    for figure, of, compute in parts:
        with suppress(InputError, ComputationError):  # too short, or too few lines
            heading, sketch, caption = _sketched(figure, compute())
            pictures.append((f"{heading}{of}", sketch, caption))
    return pictures
