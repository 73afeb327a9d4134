"""``tribodyn signal``: the channels of a recording, and the analysis of one of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from cyclopts import Parameter

from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import Flag, Output, check_place, in_si, with_options
from tribodyn.errors import InputError, Problem, collected, did_you_mean
from tribodyn.nomenclature import GEARS

if TYPE_CHECKING:
    from tribodyn.measurement import Recording, SignalAnalysis
    from tribodyn.study import RecordingVerdict
    from tribodyn.study.machine.case import AnyCase

Text = str | None
_TEETH = "Write --teeth 29, or --teeth 29/67 with the mate, or name the case with --case"
#: What each text option holds: unit in SI, and how it is written.
_OPTIONS = {
    "sample_rate": "--sample-rate",
    "channels": "--channel",
    "band": "--band",
    "max_order": "--max-order",
    "tacho": "--tacho",
    "pulses_per_revolution": "--pulses",
    "speed": "--speed",
    "line": "--line",
    "mesh_frequency": "--line",
    "earlier": "--earlier",
    "limits": "--limits",
}
_PER_SAMPLE = Problem(
    "seconds and hertz are samples and cycles per sample",
    "",
    "The file has no sampling rate. Orders, mean revolutions and indicators do not depend on it, a "
    "speed in rpm has no meaning",
    'Write --sample-rate "25600 Hz" if it is known',
)
_EXAMPLES = {
    "--speed": ("rad/s", "1500 rpm"),
    "--line": ("Hz", "725 Hz"),
    "--sample-rate": ("Hz", "25600 Hz"),
    "--band": ("Hz", "2000..6000 Hz"),
    "--between": ("s", "1..8 s"),
    "--limits": ("m/s", "2.8/4.5/7.1 mm/s"),
}


@Parameter(name="*")
@dataclass
class Shaft:
    """Speed and teeth of the shaft.

    Parameters
    ----------
    tacho : str
        Channel with the pulses of a tachometer, or with the speed in rpm or rad/s.
    pulses : int
        Pulses of the tachometer in one revolution.
    speed : str
        Speed where there is no tachometer: "1500 rpm". With teeth the exact speed is found in the
        recording by its mesh lines, within 5 % of this.
    line : str
        Frequency of the mesh, or of another line, instead of the speed: "725 Hz", or "0.0283"
        cycles per sample where the file has no rate. Orders are relative to it.
    teeth : str
        Teeth of the gear on that shaft, "29", or with those of its mate, "29/67".
    case : str
        Built-in case or case file whose teeth are taken, and its speed where none is known.
    gear : str
        Gear of the case on that shaft: pinion, wheel, or its name in a machine.
    """

    tacho: Text = None
    pulses: int = 1
    speed: Text = None
    line: Text = None
    teeth: Text = None
    case: Text = None
    gear: str = GEARS[0]


@Parameter(name="*")
@dataclass
class Channel:
    """Channel and part of the recording.

    Parameters
    ----------
    channel : str
        Channel to analyse; without it the channels are listed.
    sensitivity : str
        Sensitivity of its sensor where it holds the voltage: "100 mV/g".
    sample_rate : str
        Sampling rate where the file holds none: "25600 Hz".
    between : str
        Part of the recording: "1..8 s".
    band : str
        Band that the envelope is taken of: "2000..6000 Hz"; by default about the strongest mesh
        harmonic, or the whole signal where the mesh is not known.
    max_order : float
        Highest order of the shaft.
    earlier : str
        Earlier recordings of the same channel in their order, "may.mat,june.mat": NA4, NA4* and NB4
        compare with them, and the verdict has their trend.
    limits : str
        Class of the machine in ISO 10816-1, I to IV, rating of the gear unit in ISO 20816-9, VR3.15
        to VR20, or ends of the zones A, B and C of the velocity, "2.8/4.5/7.1 mm/s", for its
        severity.
    """

    channel: Text = None
    sensitivity: Text = None
    sample_rate: Text = None
    between: Text = None
    band: Text = None
    max_order: float | None = None
    earlier: Text = None
    limits: Text = None


def signal(
    file: Path,
    /,
    *,
    chosen: Channel | None = None,
    shaft: Shaft | None = None,
    out: Output = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """List the channels of a recording, or analyse one: spectra, envelope, orders, indicators.

    Parameters
    ----------
    file : Path
        Recording: CSV, MAT, WAV, UFF 58, TDMS, HDF5 or netCDF.
    chosen : Channel
        Channel and part of the recording.
    shaft : Shaft
        Speed and teeth of the shaft.
    out : Path
        Directory for the report and the data; without it the figures are shown only.
    force : bool
        Replace an earlier report in that directory.
    json : bool
        Write channels or figures in SI as one JSON object to stdout.
    """
    options, turning = chosen or Channel(), shaft or Shaft()
    if out is not None:
        check_place(out, force)
    with collected() as warnings:
        recording = _recording(file, options, turning.line)
        name = options.channel or _only_channel(recording, options, turning, out)
        earlier = _earlier(options, turning) if name else []
        analysis = name and _analysis(recording, name, options, turning, earlier)
        verdict = _verdict(analysis, earlier, options, turning) if analysis else None
    show_warnings(warnings)
    if analysis and turning.line is not None and recording.sample_rate == 1.0:
        analysis = replace(analysis, notes=(_PER_SAMPLE, *analysis.notes))
    if not analysis:
        _list(file, recording, json)
        return
    _show(file, analysis, verdict, (out, force, json))


def _recording(file: Path, options: Channel, line: Text) -> Recording:
    from tribodyn.measurement import read

    rate = None if options.sample_rate is None else _quantity("--sample-rate", options.sample_rate)
    sensor = {}
    if options.sensitivity is not None:
        if options.channel is None:
            why, remedy = "A sensitivity is that of one channel", "Name it with --channel"
            raise InputError("no channel is named", "--sensitivity", why, remedy)
        sensor = {options.channel: options.sensitivity}
    try:
        with with_options(_OPTIONS):
            recording = read(file, sample_rate=rate, sensitivity=sensor)
    except InputError as error:
        if not any("has no sampling rate" in each.what for each in error.problems):
            raise
        recording = read(file, sample_rate=1.0, sensitivity=sensor)
        if line is None or _per_sample(line) is None:
            raise _no_rate(error.problems[0], recording, options.channel) from None
    if options.between is None:
        return recording
    start, end = _ends("--between", options.between)
    try:
        return recording.cut(start, end)
    except InputError as error:
        raise InputError([replace(each, where="--between") for each in error.problems]) from None


def _no_rate(problem: Problem, recording: Recording, channel: Text) -> InputError:
    """Error of a file without a rate, with the strongest lines of the channel to choose from."""
    from tribodyn.analysis import spectrum

    remedy = 'Write --sample-rate "25600 Hz"; for orders alone, --line with that of the mesh in '
    remedy += "cycles per sample"
    if channel is None:
        remedy += f" of one of the channels {', '.join(list(recording.channels)[:20])}"
    elif channel in recording.channels:
        peaks = spectrum(recording[channel], 1.0, window="hann").peaks(5)
        remedy += f" (the strongest are {', '.join(f'{each.frequency:.5g}' for each in peaks)})"
    return InputError(problem.what, "--sample-rate", problem.why, remedy)


def _quantity(option: str, text: str) -> float:
    """A number above zero with its unit, in SI."""
    unit, example = _EXAMPLES[option]
    value = in_si(option, text, unit, example)
    if not value > 0.0:
        why = "It must be greater than zero"
        raise InputError(f'"{text}"', option, why, f'Write {option} "{example}"')
    return value


def _per_sample(text: str) -> float | None:
    """A number without a unit, of cycles per sample."""
    try:
        return float(text)
    except ValueError:
        return None


def _line(text: Text, sample_rate: float) -> float | None:
    """Frequency of a line [Hz], also of one in cycles per sample."""
    if text is None:
        return None
    number = _per_sample(text)
    if number is None:
        return _quantity("--line", text)
    if not 0.0 < number < 0.5:
        why = "A number without unit is in cycles per sample, between 0 and 0.5"
        raise InputError(f'"{text}"', "--line", why, 'Write --line "725 Hz" or --line 0.0283')
    return number * sample_rate


def _ends(option: str, text: str) -> tuple[float, float]:
    """Two ends of a range, in SI."""
    from tribodyn.study.studies.study_axes import UnreadError, read_range
    from tribodyn.units import UnitProblemError, parse

    unit, example = _EXAMPLES[option]
    try:
        first, last, _ = read_range(f"{text}:2")
        low, high = parse(f"{first}", unit), parse(f"{last}", unit)
    except (UnreadError, UnitProblemError) as error:
        raise InputError(f'"{text}"', option, str(error), f'Write {option} "{example}"') from None
    if not 0.0 <= low < high:
        why = "It goes from a lower to a higher value"
        raise InputError(f'"{text}"', option, why, f'Write {option} "{example}"')
    return low, high


def _only_channel(
    recording: Recording, options: Channel, turning: Shaft, out: Output
) -> str | None:
    """The channel to analyse where none is named; None where the channels are to be listed."""
    if (
        out is None
        and options == Channel(sample_rate=options.sample_rate, between=options.between)
        and turning == Shaft()
    ):
        return None
    names = [name for name in recording.channels if name != turning.tacho]
    if len(names) == 1:
        return names[0]
    why = f"The recording has {', '.join(recording.channels)}"
    example = next(iter(names), next(iter(recording.channels)))
    raise InputError("no channel is named", "--channel", why, f'Write --channel "{example}"')


def _list(file: Path, recording: Recording, json: bool) -> None:
    """Write channels, units, rate and duration."""
    import numpy as np

    rows: list[tuple[Any, ...]] = [
        (name, recording.units[name], *(float(f(values)) for f in (np.min, np.max, np.std)))
        for name, values in recording.channels.items()
    ]
    size = next(iter(recording.channels.values())).size
    if json:
        keys = ("name", "unit", "least", "greatest", "alternating_rms")
        channels = [dict(zip(keys, row, strict=True)) for row in rows]
        facts = {"sample_rate": recording.sample_rate, "duration": recording.duration}
        say_json({"file": str(file), **facts, "samples": size, "channels": channels})
        return
    say(
        f"{file.name}: {size} samples at {recording.sample_rate:.6g} Hz, {recording.duration:.6g} s"
    )
    head = ["channel", "unit", "least", "greatest", "alternating rms"]
    cells: list[list[str]] = [
        [row[0], row[1] or "-", *(f"{level:.4g}" for level in row[2:])] for row in rows
    ]
    say(table([head, *cells]))
    tell(f'Analyse one: tribodyn signal {file} --channel "{rows[0][0]}" --out report')


def _analysis(
    recording: Recording,
    name: str,
    options: Channel,
    turning: Shaft,
    earlier: Sequence[Recording] = (),
) -> SignalAnalysis:
    from tribodyn.measurement import analyse_signal

    _check_channel(recording, name, "--channel")
    if turning.tacho is not None:
        _check_channel(recording, turning.tacho, "--tacho")
        if turning.tacho == name:
            why = "Pulses are not what is analysed"
            raise InputError(f"{name} is both", "--channel and --tacho", why, "Name two channels")
    if turning.pulses < 1:
        what, remedy = f"pulses = {turning.pulses}", "Give the pulses in one revolution"
        raise InputError(what, "--pulses", "It is a whole number from 1 on", remedy)
    teeth, mate, speed = _teeth_and_speed(turning)
    if turning.tacho is not None and turning.speed is not None:
        what = f'--tacho {turning.tacho} and --speed "{turning.speed}" are both given'
        raise InputError(what, "", "The tachometer measures the speed", "Keep one of them")
    band = None if options.band is None else _ends("--band", options.band)
    with with_options(_OPTIONS):
        return analyse_signal(
            recording,
            name,
            tacho=turning.tacho,
            pulses_per_revolution=turning.pulses,
            speed=speed if turning.speed or not (turning.tacho or turning.line) else None,
            teeth=teeth,
            mate_teeth=mate,
            band=band,
            max_order=options.max_order,
            line=_line(turning.line, recording.sample_rate),
            earlier=earlier,
        )


def _earlier(options: Channel, turning: Shaft) -> list[Recording]:
    files = [text.strip() for text in (options.earlier or "").split(",") if text.strip()]
    uncut = replace(options, between=None)
    return [_recording(Path(text), uncut, turning.line) for text in files]


def _verdict(
    analysis: SignalAnalysis, earlier: Sequence[Recording], options: Channel, turning: Shaft
) -> RecordingVerdict:
    """Severity, trend and suspected parts, as far as something is known for them."""
    from tribodyn.cases.load import load_case
    from tribodyn.study import judge_recordings, kinematic_frequencies

    lines = None if turning.case is None else kinematic_frequencies(load_case(turning.case))
    before = [_analysis(each, analysis.channel, options, turning) for each in earlier]
    limits: Any = options.limits
    if limits is not None and "/" in limits:
        ends, _, unit = limits.strip().rpartition(" ")
        limits = [_quantity("--limits", f"{end} {unit}") for end in ends.split("/")]
    with with_options(_OPTIONS):
        return judge_recordings([*before, analysis], lines, limits=limits)


def _check_channel(recording: Recording, name: str, option: str) -> None:
    if name not in recording.channels:
        names = list(recording.channels)
        why = f"The recording has {', '.join(names[:20])}"
        remedy = did_you_mean(name, names, "Write the name exactly as listed")
        raise InputError(f'there is no channel "{name}"', option, why, remedy)


def _teeth_and_speed(turning: Shaft) -> tuple[int | None, int | None, float | None]:
    """Teeth of both gears, and the speed, of the options or of the case."""
    speed = None if turning.speed is None else _quantity("--speed", turning.speed)
    if turning.case is None:
        return (*_written_teeth(turning.teeth), speed)
    if turning.teeth is not None:
        what = f"--teeth {turning.teeth} and --case {turning.case} are both given"
        raise InputError(what, "", "The case has its own teeth", "Keep one of them")
    from tribodyn.cases.load import load_case

    meshes = list(_meshes_of(load_case(turning.case)))
    named = [mesh for mesh in meshes if turning.gear in mesh.teeth]
    if not named:
        names = list(dict.fromkeys(name for mesh in meshes for name in mesh.teeth))
        why = f"Gears of {turning.case}: {', '.join(names)}"
        remedy = f"--gear is {GEARS[0]} unless it is given. Write for example --gear {names[0]}"
        remedy = did_you_mean(turning.gear, names, remedy)
        raise InputError(f'there is no gear "{turning.gear}"', "--gear", why, remedy)
    mesh, teeth, of_case = named[0], named[0].teeth[turning.gear], named[0].speeds[turning.gear]
    if not math.isclose(teeth * of_case, 2.0 * math.pi * mesh.frequency, rel_tol=1e-9):
        what = f"the axis of {turning.gear} or of its mate turns with a carrier"
        why = f"Its mesh repeats at {mesh.frequency:.6g} Hz, not {teeth} times a turn of the shaft"
        raise InputError(
            what, "--gear", why, f'Write --line "{mesh.frequency:.6g} Hz" in place of --case'
        )
    mates = {n for each in named for name, n in each.teeth.items() if name != turning.gear}
    # The lines of a gear with mates of several numbers of teeth belong to none of them.
    return teeth, mates.pop() if len(mates) == 1 else None, float(speed or of_case)


def gear_on(case: AnyCase, shaft: str | None) -> str | None:
    """Gear on a shaft, the input by default, whose mesh repeats with whole parts of its turn."""
    of_machine = None if case.lumped else case.machine()
    shaft = shaft or (GEARS[0] if of_machine is None else of_machine.operation.input)
    for mesh in _meshes_of(case):
        for gear, teeth in mesh.teeth.items():
            on = gear if of_machine is None else of_machine.gears[gear].shaft
            lines = teeth * mesh.speeds[gear], 2.0 * math.pi * mesh.frequency
            if on == shaft and math.isclose(*lines, rel_tol=1e-9):
                return gear
    return None


class _CaseMesh(NamedTuple):
    """Teeth and speeds [rad/s] of both gears of a mesh by name, and its frequency [Hz]."""

    teeth: dict[str, int]
    speeds: dict[str, float]
    frequency: float


def _meshes_of(case: Any) -> Iterator[_CaseMesh]:
    """Meshes of a case of any kind at its operating point."""
    if not case.lumped:
        machine = case.machine()
        for name, mesh in machine.meshes.items():
            gears = {gear: machine.gears[gear] for gear in mesh.gears}
            shafts = {n: machine.kinematics.shafts[gear.shaft] for n, gear in gears.items()}
            yield _CaseMesh(
                {n: abs(gear.teeth) for n, gear in gears.items()},
                {n: abs(shaft.speed) for n, shaft in shafts.items()},
                machine.kinematics.meshes[name].mesh_frequency,
            )
    else:
        teeth = {name: abs(int(gear.teeth)) for name, gear in case.gears.by_name.items()}
        pitch = case.operation.speed * teeth[case.operation.speed_of]
        speeds = {name: pitch / count for name, count in teeth.items()}
        yield _CaseMesh(teeth, speeds, pitch / (2.0 * math.pi))


def _written_teeth(text: Text) -> tuple[int | None, int | None]:
    if text is None:
        return None, None
    first, stroke, second = (part.strip() for part in text.partition("/"))
    counts = [first, second] if stroke else [first]
    if not all(part.isdecimal() and int(part) >= 3 for part in counts):
        why = "Teeth are whole numbers from 3 on"
        raise InputError(f'"{text}"', "--teeth", why, _TEETH)
    return int(first), int(second) if stroke else None


def _show(
    file: Path,
    analysis: SignalAnalysis,
    verdict: RecordingVerdict | None,
    output: tuple[Output, bool, bool],
) -> None:
    from tribodyn.report.signal_report import signal_report_data, write_signal_report

    out, force, json = output
    answer = signal_report_data(analysis, verdict)
    if out is not None:
        from tribodyn.study.pipeline.save import new_directory
        from tribodyn.validated_files import write_dataset

        with new_directory(out, force=force) as place:
            write_dataset(analysis.to_xarray(), place / "study.nc")
            title = f"{analysis.channel} of {file.name}"
            write_signal_report(analysis, place / "report.html", title=title, verdict=verdict)
    if json:
        say_json({"file": str(file), **answer.facts})
    else:
        say("\n".join([answer.statements[0], table([answer.head, *answer.rows])]))
        for note in answer.statements[1:]:
            tell(note if note in answer.facts.get("verdict", ()) else f"note: {note}")
    if out is not None:
        tell(f"Report: {out / 'report.html'}")
