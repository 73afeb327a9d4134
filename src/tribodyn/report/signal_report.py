"""Report of the analysis of a recorded channel: figures, table and sentences."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn import plot
from tribodyn.drawing import report_of
from tribodyn.measurement.shaft_speed import MATE, SHAFT, attempt
from tribodyn.measurement.sideband_cursors import (
    explain_modulation,
    modulating_shaft,
    sideband_cursors,
)
from tribodyn.plot.signals.recorded import visible_frequency
from tribodyn.plot.theme.labels import readable, significant
from tribodyn.progress import SILENT, Progress
from tribodyn.report.study import write_study_report
from tribodyn.report.study_report_data import StudyReportData, figure_with_caption
from tribodyn.signals import cepstrum, narrowband_demodulation
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.drawing import Drawing
    from tribodyn.errors import Problem
    from tribodyn.measurement import Recording, SignalAnalysis
    from tribodyn.measurement.shaft_speed import ShaftSpeed
    from tribodyn.signals.synchronous_average import SynchronousAverage
    from tribodyn.study import RecordingVerdict

#: Keys of the truth other than the faults, in SI.
_OPERATION = tuple(f"operation.{key}" for key in ("torque", "speed", "speed_of", "input", "output"))
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
    "coherence_of_noise": ("Cyclic coherence, noise", "", "mean of noise alone"),
    "coherence_limit": ("Cyclic coherence, limit", "", "largest of noise in 95 % of records"),
}
_SMEARED = (
    " The speed varies: shaft-synchronous lines are smeared in this figure and too "
    "low. Read their amplitudes from the orders."
)
_NAMES = {SHAFT: "Shaft", MATE: "Mate"}


def signal_report_data(
    analysis: SignalAnalysis, verdict: RecordingVerdict | None = None
) -> StudyReportData:
    """Figures, sentences, table and numbers in SI of an analysed channel, and a verdict on it."""
    numbers = analysis.figures()
    facts: Tree = {"channel": analysis.channel, "unit": analysis.unit, **numbers}
    if analysis.speed is not None:
        facts["speed_source"] = analysis.speed.source
    notes = list(analysis.notes)
    verdicts = attempt("verdict on the gears", partial(_verdicts, analysis), notes) or []
    verdicts += _modulation(numbers)
    pictures = [
        (heading, *picture)
        for heading, draw in _figures(analysis)
        if (picture := attempt(f'figure "{heading}"', draw, notes)) is not None
    ]
    judged = [] if verdict is None else verdict.statements
    if verdict is not None and (verdict.findings or verdict.kurtosis.size > 1):
        pictures.insert(0, figure_with_caption(plot.recording_verdict, verdict))
    facts["notes"] = [sentence(each) for each in notes]
    if judged:
        facts["verdict"] = judged
    return StudyReportData(
        analysis,
        pictures,
        [_lead(analysis), *judged, *verdicts, *facts["notes"]],
        HEAD,
        _rows(analysis, numbers),
        facts,
    )


@report_of("SignalAnalysis")
def write_signal_report(
    analysis: SignalAnalysis,
    path: str | os.PathLike[str],
    *,
    title: str = "",
    verdict: RecordingVerdict | None = None,
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
    verdict : RecordingVerdict, optional
        What :func:`tribodyn.study.judge_recordings` returns, for its sentences and its figure.

    Raises
    ------
    InputError
        If the place cannot be written to.
    """
    answer = signal_report_data(analysis, verdict)
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
        fm4 = analysis.indicators[name].fm4
        if fm4 > _LOCAL:
            verdicts.append(
                f"FM4 of the {name} is {fm4:.3g}, 3 or less for sound teeth: "
                + _local_fault(analysis.averages[name], analysis.speed)
            )
    return [text for text in verdicts if text]


def _modulation(numbers: dict[str, float]) -> list[str]:
    """Whether a random modulation is more than noise."""
    if "coherence" not in numbers:
        return []
    size, limit = (significant(numbers[key]) for key in ("coherence", "coherence_limit"))
    if not numbers["coherence"] > numbers["coherence_limit"]:
        return [
            f"No cyclic coherence above that of noise: {size} at most, and noise reaches {limit} "
            "in one of 20 records."
        ]
    rate = significant(numbers["coherence_frequency"], _DIGITS)
    return [f"Vibration is modulated at {rate} Hz: cyclic coherence {size}, of noise {limit} at "
            "most in 19 of 20 records."]  # fmt: skip


def _local_fault(average: SynchronousAverage, speed: ShaftSpeed | None) -> str:
    """Sentence about the place of a local difference and its tooth, if it is no chance."""
    if not average.difference_is_clear:
        return (
            "but its difference signal varies from turn to turn as much as it is large, so that "
            "no tooth is named. Record longer, or at a steadier speed."
        )
    place, tooth = average.local_place()
    zero = "the first sample" if speed is None else speed.zero
    return (
        "its difference signal is local, as of one tooth, and largest about "
        f"{np.degrees(place):.0f}\N{DEGREE SIGN} from {zero}: tooth {tooth} of {average.teeth}, "
        "counted in the order of contact from the one whose contact begins there."
    )


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


def _row(name: str, value: float, unit: str, meaning: str) -> list[str]:
    return [name, significant(value, _DIGITS), unit, meaning]


def _rows(analysis: SignalAnalysis, numbers: dict[str, float]) -> list[list[str]]:
    """Table of all indicators and peaks."""
    unit = readable(analysis.unit)
    rows = [_row(n, numbers[k], unit, m) for k, (n, m) in _LEVELS.items()]
    rows += [_row(n, numbers[k], "", m) for k, (n, m) in _SHAPES.items()]
    for key, name in (("spectrum", "Spectrum"), ("envelope", "Envelope")):
        for k in range(1, 6):
            if f"{key}_peak_{k}_frequency" in numbers:
                at = significant(numbers[f"{key}_peak_{k}_frequency"], _DIGITS)
                size = numbers[f"{key}_peak_{k}_amplitude"]
                meaning = f"peak amplitude at {at} Hz"
                meaning += ", smeared by the changing speed" if analysis.smeared else ""
                rows.append(_row(f"{name}, peak {k}", size, unit, meaning))
    if analysis.speed is not None:
        rows.append(_row("Speed", numbers["speed"] * _RPM, "rpm", f"by {analysis.speed.source}"))
        for end in ("lowest", "highest") if analysis.speed.varies else ():
            value = numbers[f"{end}_speed"] * _RPM
            rows.append(_row(f"Speed, {end}", value, "rpm", "mean over a revolution"))
    rows += [_row(n, numbers[k], u, m) for k, (n, u, m) in _IMPACTS.items() if k in numbers]
    rows += _order_rows(numbers, unit)
    for shaft in analysis.averages:
        ending = "" if shaft == SHAFT else f"_{shaft}"
        for key, (name, kind, meaning) in _AVERAGE.items():
            if f"{key}{ending}" in numbers:
                size = numbers[f"{key}{ending}"]
                rows.append(_row(f"{_NAMES[shaft]}, {name}", size, unit if kind else "", meaning))
    return rows


def _order_rows(numbers: dict[str, float], unit: str) -> list[list[str]]:
    rows = []
    if "mesh_frequency" in numbers:
        mean = numbers["mesh_frequency"]
        rows.append(_row("Mesh frequency", mean, "Hz", "mean over the recording"))
    for k in range(1, 6):
        if (size := numbers.get(f"mesh_harmonic_{k}_amplitude")) is not None:
            rows.append(_row(f"Mesh harmonic {k}", size, unit, "peak amplitude over the orders"))
    for k in range(1, 6):
        if (order := numbers.get(f"order_peak_{k}")) is not None:
            size, meaning = numbers[f"order_peak_{k}_amplitude"], "peak amplitude at order "
            meaning += significant(order, _DIGITS)
            rows.append(_row(f"Orders, peak {k}", size, unit, meaning))
    return rows


#: Heading of a figure, and what draws it and writes its caption.
Figure = tuple[str, Callable[[], tuple[Any, str]]]


def _sketched(figure: Drawing, result: object, of: str = "") -> Figure:
    """Figure of a result; sketches avoid the slow import of plotly."""
    return figure.heading + of, lambda: (figure.sketch(result), figure.caption_of(result))


def _computed(figure: Drawing, compute: Callable[[], Any], of: str = "") -> Figure:
    """Figure of a result that is computed for it alone."""
    return figure.heading + of, lambda: _sketched(figure, compute())[1]()


def _figures(analysis: SignalAnalysis) -> list[Figure]:
    """Figures of all computed results."""
    figures: list[Figure] = [
        _sketched(plot.signal_history, analysis),
        ("Spectrum", partial(_spectrum, analysis)),
        ("Envelope spectrum", partial(_envelope_spectrum, analysis)),
    ]
    if analysis.orders is not None:
        figures.append(("Orders", partial(_orders, analysis)))
    if analysis.order_map is not None:
        figures.append(_sketched(plot.order_map, analysis.order_map))
    for shaft, average in analysis.averages.items():
        of = "" if len(analysis.averages) == 1 else f" of the {shaft}, {average.teeth} teeth"
        figures.append(_sketched(plot.synchronous_average, average, of))
    return [*figures, *_diagnosis(analysis)]


def _spectrum(analysis: SignalAnalysis) -> tuple[Any, str]:
    """Spectrum with the mesh harmonics of a steady speed."""
    frequency = None if _unsteady(analysis) else analysis.mesh_frequency
    marks = [] if frequency is None else _mesh_marks(frequency, analysis.spectrum.frequency[-1])
    caption = plot.signal_spectrum.caption_of(analysis.spectrum)
    caption += " Dotted lines are mesh harmonics." if marks else ""
    caption += _SMEARED if analysis.smeared else ""
    return plot.signal_spectrum.sketch(analysis.spectrum, marks=marks), caption


def _envelope_spectrum(analysis: SignalAnalysis) -> tuple[Any, str]:
    """Spectrum of the envelope with the shafts of a steady speed."""
    hull, reach, teeth = analysis.envelope_spectrum, visible_frequency(analysis), analysis.teeth
    shafts: list[tuple[str, float]] = []
    if analysis.speed is not None and not _unsteady(analysis):
        turn = analysis.speed.mean / (2.0 * np.pi)
        rates = {SHAFT: turn}
        if teeth.get(SHAFT) and MATE in teeth:
            rates[MATE] = turn * teeth[SHAFT] / teeth[MATE]
        shafts = [(name, rate) for name, rate in rates.items() if rate < reach]
    band = "the whole signal"
    if analysis.band is not None:
        band = f"the band from {analysis.band[0]:.5g} to {analysis.band[1]:.5g} Hz"
    return plot.signal_spectrum.sketch(hull, marks=shafts, to=reach), (
        f"The frequencies that modulate {band}; its mean of {hull.amplitude[0]:.4g} "
        f"{readable(analysis.unit)} is left out. A line at the shaft frequency indicates a "
        "load that varies with the rotation, its multiples indicate an impact per revolution. "
        "The axis ends where the lines become small."
    )


def _orders(analysis: SignalAnalysis) -> tuple[Any, str]:
    """Orders with the mesh harmonics."""
    lines, teeth = analysis.orders, analysis.teeth.get(SHAFT)
    assert lines is not None
    marks = [] if teeth is None else _mesh_marks(teeth, lines.orders[-1])
    return plot.order_spectrum.sketch(lines, marks=marks), plot.order_spectrum.caption_of(lines)


def _unsteady(analysis: SignalAnalysis) -> bool:
    """Whether the speed is not known, or changes."""
    return analysis.speed is None or analysis.speed.varies


def _mesh_marks(mesh: float, top: float) -> list[tuple[str, float]]:
    """Names and places of the mesh harmonics below the end of an axis."""
    harmonics = range(1, _MARKED + 1)
    return [("mesh" if k == 1 else str(k), k * mesh) for k in harmonics if k * mesh < top]


def _diagnosis(analysis: SignalAnalysis) -> list[Figure]:
    """Figures of diagnosis."""
    teeth, orders = analysis.teeth.get(SHAFT), analysis.orders
    figures = []
    if orders is not None and teeth is not None:
        for name, count in analysis.teeth.items():
            cursors = partial(sideband_cursors, orders, teeth, teeth / count, count=_CURSORS)
            figures.append(_computed(plot.sideband_cursors, cursors, f", distance of the {name}"))
    for name, average in analysis.averages.items():
        demodulated = partial(narrowband_demodulation, average)
        of = f" over a turn of the {name}"
        figures.append(_computed(plot.narrowband_demodulation, demodulated, of))
    of_signal = partial(cepstrum, analysis.signal, analysis.sample_rate)
    figures.append(_computed(plot.cepstrum, of_signal))
    if analysis.kurtogram is not None:
        figures.append(_sketched(plot.kurtogram, analysis.kurtogram))
    if analysis.coherence is not None:
        figures.append(_sketched(plot.cyclic_coherence, analysis.coherence))
    return figures


def recorded_motion(
    case: Any,
    sensors: Sequence[str],
    progress: Progress = SILENT,
    tacho: str | None = None,
    **settings: Any,
) -> tuple[Recording, Tree]:
    """Record the motion of a case; return the recording and its operation and faults in SI."""
    from tribodyn.cases.load import run
    from tribodyn.study.faults.sensors import check_sensors, sensors_of

    check_sensors(sensors_of(case), sensors, tacho)
    recording: Recording = run(case, progress).recording(sensors, tacho=tacho, **settings)
    faults: Any = getattr(case, "faults", None) or {}
    truth = {
        name: {key: value for key, value in vars(fault).items() if value is not None}
        for name, fault in (faults if isinstance(faults, dict) else vars(faults)).items()
    }
    operation = {key: value for key, value in case.values() if key in _OPERATION}
    return recording, {**operation, "faults": truth}


def recording_report_data(recording: Recording, channel: str) -> StudyReportData:
    """Analysis of a channel of a recording with its tacho."""
    from tribodyn.measurement import analyse_signal

    return signal_report_data(analyse_signal(recording, channel, tacho="tacho"))
