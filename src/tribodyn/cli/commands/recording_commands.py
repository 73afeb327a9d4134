"""``tribodyn recording`` and ``compare``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from tribodyn.cli.commands.signal_command import gear_on
from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import (
    CaseName,
    Flag,
    Force,
    Output,
    Place,
    Settings,
    changed_any_case,
    check_file,
    check_place,
    in_si,
    read_ranges,
    with_options,
)
from tribodyn.errors import InputError, collected
from tribodyn.types import Tree
from tribodyn.validated_files import plain_number

if TYPE_CHECKING:
    from tribodyn.measurement import Comparison

#: Options of the command by the arguments of the functions behind it.
_OPTIONS = {
    name: f"--{name.replace('_', '-')}"
    for name in (
        *("sensor", "duration", "sample_rate", "tacho", "noise", "speed_fluctuation"),
        *("tacho_jitter", "seed", "repeats"),
    )
} | {"path": "--out", "folder": "--out"}


@Parameter(name="*")
@dataclass
class Sampling:
    """What is recorded, and what scatters.

    Parameters
    ----------
    sensor : str
        Signals such as "acceleration_loa_pinion,acceleration_loa_wheel", "mesh_force" or
        "dynamic_transmission_error"; one for a set.
    duration : str
        Length of a recording: "2 s".
    sample_rate : str
        Sampling rate: "25600 Hz".
    tacho : str
        Gear of a pair or shaft of a machine of whose turns the channel "tacho" has a pulse each:
        the pinion or the input by default. The recordings of a set have none.
    noise : float
        Standard deviation of white noise, in the SI unit of the sensor.
    speed_fluctuation : float
        Standard deviation of slow changes of the speed, over the speed.
    tacho_jitter : float
        Standard deviation of the edges of the tacho, over a turn.
    seed : int
        Number of the draw of all that scatters.
    repeats : int
        Recordings of each variant of a set.
    """

    sensor: str
    duration: str = "1 s"
    sample_rate: str = "25600 Hz"
    tacho: str | None = None
    noise: float = 0.0
    speed_fluctuation: float = 0.0
    tacho_jitter: float = 0.0
    seed: int = 0
    repeats: int = 1

    def settings(self) -> Tree:
        """Return the arguments of a recording, all but the sensor."""
        return {
            "duration": in_si("--duration", self.duration, "s", "2 s"),
            "sample_rate": in_si("--sample-rate", self.sample_rate, "Hz", "25600 Hz"),
            "noise": self.noise,
            "speed_fluctuation": self.speed_fluctuation,
            "tacho_jitter": self.tacho_jitter,
            "seed": self.seed,
        }


def recording(
    case: CaseName,
    /,
    *over: str,
    sampling: Sampling,
    out: Output = None,
    set_: Settings = None,
    force: Force = False,
    json: Flag = False,
) -> None:
    """Record what a sensor sees of the motion of a case; over values of keys, a labelled set.

    Parameters
    ----------
    over : str
        What varies, such as "faults.crack.depth=0,1,2 mm": writes a folder of labelled recordings,
        which the same command continues. Several make a grid.
    sampling : Sampling
        What is recorded, and what scatters.
    out : Path
        File to write, .mat, .wav, .h5, .uff or .csv, with its truth as .json; of a set its folder.
        By default that of the case with "-recording".
    json : bool
        Write what was recorded as JSON to stdout.
    """
    with collected() as warnings, with_options(_OPTIONS):
        if over and force:
            why = "The same command continues a set, and another one is not replaced"
            raise InputError("--force is given for a set", "--force", why, "Remove it")
        if over and sampling.tacho is not None:
            why, remedy = "The recordings of a set have no tacho", "Remove it"
            raise InputError(f"tacho = {sampling.tacho}", "--tacho", why, remedy)
        if over:
            facts, lines = _record_set(case, over, out, sampling, set_)
        else:
            facts, lines = _record(case, out, sampling, set_, force)
    show_warnings(warnings)
    if json:
        say_json(facts)
        return
    say(lines[0])
    for text in lines[1:]:
        tell(text)


def _record(
    case: str, out: Path | None, sampling: Sampling, set_: Settings, force: bool
) -> tuple[Tree, list[str]]:
    """Write one recording and its truth; return facts and lines of text."""
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.measurement.recording import check_ending
    from tribodyn.report.signal_report import recorded_motion

    file = out if out is not None else Path(f"{Path(case).stem}-recording.mat")
    settings = sampling.settings()
    if sampling.repeats != 1:
        why, remedy = "It counts the recordings of a set", 'Add "faults.NAME.depth=0,1 mm"'
        raise InputError(f"repeats = {sampling.repeats}", "--repeats", why, remedy)
    check_file(file, force)
    check_ending(file)
    ready = changed_any_case(case, set_ or [])
    names = [name.strip() for name in sampling.sensor.split(",")]
    with progress_bar() as progress:
        recorded, truth = recorded_motion(ready, names, progress, sampling.tacho, **settings)
    recorded.save(file, truth={"title": ready.title, **truth})
    rate, size = recorded.sample_rate, next(iter(recorded.channels.values())).size
    facts = {"file": str(file), "sample_rate": rate, "samples": size}
    gear = None if set_ else gear_on(ready, sampling.tacho)
    stored = list(recorded.channels)  # sound files have no names
    first, tacho = names[0], "tacho"
    if file.suffix.lower() == ".wav":
        first, tacho = (f"channel {stored.index(name) + 1}" for name in (first, tacho))
    teeth = "" if gear is None else f" --case {quote(case)} --gear {gear}"
    return {**facts, "units": dict(recorded.units), **truth}, [
        f"{ready.title}\n{recorded}",
        f"Recording: {file}, truth: {file.with_suffix('.json')}",
        f'Analyse it: tribodyn signal {file} --channel "{first}" --tacho "{tacho}"{teeth}',
    ]


def _record_set(
    case: str, over: tuple[str, ...], out: Path | None, sampling: Sampling, set_: Settings
) -> tuple[Tree, list[str]]:
    """Write a labelled set; return facts and lines of text."""
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.study import record_set

    folder = out if out is not None else Path(f"{Path(case).stem}-recordings")
    ranges, ready = read_ranges(over), changed_any_case(case, set_ or [])
    settings = {**sampling.settings(), "sensor": sampling.sensor, "repeats": sampling.repeats}
    with progress_bar() as progress:
        labelled = record_set(ready, folder, ranges, progress=progress, **settings)
    facts = {"folder": str(folder), "recordings": len(labelled), "card": dict(labelled.card)}
    keys = labelled.card["keys"].items()
    rows = [[key, axis["unit"], str(len(axis["values"]))] for key, axis in keys]
    text = f"{ready.title}\n{labelled}\n{table([['key', 'unit', 'values'], *rows])}"
    return facts, [text, f"Set: {folder} with card.json and labels.csv"]


@Parameter(name="*")
@dataclass(frozen=True)
class RecordingOptions:
    """How a recording is compared.

    Parameters
    ----------
    gain : str
        Measured over computed signal of the transfer path, or "fit".
    harmonics : int
        Mesh harmonics that are compared with a recording.
    tacho : str
        Channel of the recording with the pulses of a tachometer. Without one, the speed is found
        from the mesh lines of the compared channels, within 5 % of the computed speed.
    pulses : int
        Pulses of the tachometer in one revolution.
    gear : str
        Gear on whose shaft the tachometer is: pinion or wheel; first or second of a mesh.
    mesh : str
        Mesh of a machine whose harmonics are compared; the first by default.
    """

    gain: str = "1"
    harmonics: int = 5
    tacho: str | None = None
    pulses: int | None = None
    gear: Literal["pinion", "wheel"] = "pinion"
    mesh: str | None = None

    def arguments(self, result: Any) -> Tree:
        """Arguments of the comparison: mesh of a machine and tachometer, where there are any."""
        arguments: Tree = {} if self.mesh is None else {"mesh": self.mesh}
        if self.tacho is None and self.pulses is None:
            return arguments
        if hasattr(result, "mesh_spectra"):
            teeth = result.mesh_spectra(self.mesh).attrs["teeth"][self.gear == "wheel"]
        else:
            teeth = getattr(result.case.gears, self.gear).teeth
        return {**arguments, "tacho": self.tacho, "pulses": self.pulses, "teeth": teeth}

    def check(self) -> None:
        """Refuse a channel without its pulses, and pulses without their channel."""
        if (self.tacho is None) == (self.pulses is None):
            return
        alone, missing = f"--tacho {self.tacho}", "--pulses"
        if self.tacho is None:
            alone, missing = f"--pulses {self.pulses}", "--tacho"
        why = "A tachometer needs its channel and its pulses in a revolution"
        remedy = "Write --tacho CHANNEL --pulses N"
        raise InputError(f"{alone} without {missing}", missing, why, remedy)


def compare(
    first: Path,
    second: Path,
    /,
    *,
    channel: Annotated[list[str] | None, Parameter(negative="")] = None,
    options: RecordingOptions = RecordingOptions(),
    out: Path | None = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """Show how two results differ, or how a result differs from a measured recording.

    Parameters
    ----------
    first : Path
        Directory that tribodyn run wrote.
    second : Path
        Another one, or a recording: CSV, MAT, WAV, UFF 58, TDMS, HDF5 or netCDF.
    channel : list of str
        Measured channel and computed signal, such as "acc=acceleration_loa_pinion", or with the
        sensitivity of the sensor, "acc=acceleration_loa_pinion, 100 mV/g"; one for each. Of a
        machine "acc=housing.seat A.acceleration_y".
    options : RecordingOptions
        How a recording is compared: gain, harmonics, mesh and tachometer.
    out : Path
        Directory for the report of the comparison with a recording.
    force : bool
        Replace an earlier report in that directory.
    json : bool
        Write values and figures in SI as one JSON object to stdout.
    """
    if not second.is_dir() and second.exists():
        options.check()
        _with_recording(first, second, _pairs(channel), options, Place(out, None, force, json))
        return
    from tribodyn.cases.load import load_case
    from tribodyn.study.pipeline.store import read_summary
    from tribodyn.study.result_comparison import difference_rows, differing, figures_differ

    summaries = [read_summary(place) for place in (first, second)]
    cases = [dict(load_case(place / "case.toml").values()) for place in (first, second)]
    keys = differing(cases)
    figures = differing(summaries, figures_differ)
    if json:
        say_json({"values": keys, "figures": figures})
        return
    rows = [["", str(first), str(second), "change"], *difference_rows(keys, figures)]
    say(table(rows) if len(rows) > 1 else "Both results are equal.")


def _pairs(texts: list[str] | None) -> tuple[dict[str, str], dict[str, str]]:
    """Computed signals and sensitivities by measured channel."""
    signals, sensitivity = {}, {}
    for text in texts or []:
        name, sign, value = text.partition("=")
        signal, comma, sensor = value.partition(",")
        if not sign or not name.strip() or not signal.strip() or (comma and not sensor.strip()):
            what = f'"{text}" names no pair'
            why = "Channel and signal are separated by an equals sign"
            remedy = 'Write --channel "acc=acceleration_loa_pinion, 100 mV/g"'
            raise InputError(what, "--channel", why, remedy)
        signals[name.strip()] = signal.strip()
        if comma:
            sensitivity[name.strip()] = sensor.strip()
    return signals, sensitivity


def _with_recording(
    first: Path,
    second: Path,
    pairs: tuple[dict[str, str], ...],
    options: RecordingOptions,
    at: Place,
) -> None:
    from tribodyn.cases.load import load_result
    from tribodyn.cli.commands.study_commands import finish
    from tribodyn.measurement import compare as compared
    from tribodyn.measurement import read
    from tribodyn.report.study_report_data import StudyReportData

    channels, sensitivity = pairs
    if not channels:
        remedy = 'Write --channel "acc=acceleration_loa_pinion, 100 mV/g", one for each channel'
        raise InputError("no channel of the recording is named", "--channel", "", remedy)
    number = plain_number(options.gain)
    if number is None and options.gain != "fit":
        raise InputError(f'gain = "{options.gain}"', "--gain", "", 'Give a number, or "fit"')
    if at.out is not None:
        check_place(at.out, at.force)
    result = load_result(first)
    comparison = compared(
        result,
        read(second, sensitivity=sensitivity),
        channels,
        harmonics=options.harmonics,
        gain="fit" if number is None else number,
        **options.arguments(result),
    )
    head = ("channel", "figure", "computed", "measured", f"error, of the {comparison.base} value")
    rows = [_cells(*row) for row in _rows(comparison)]
    how = "fitted" if comparison.fitted else "given"
    statements = [comparison.speed_text]
    statements += [
        f"Gain of {name}, {how}: {value:.6g}" for name, value in comparison.gains.items()
    ]
    facts = _facts(comparison)
    if at.out is None:
        say("\n".join([*statements, table([head, *rows])])) if not at.json else say_json(facts)
        return
    caption = "Spectra of the measured channels with the computed mesh harmonics on them."
    figures = [("Computed and measured", comparison.plot(), caption)]
    answer = StudyReportData(comparison, figures, statements, head, rows, facts)
    finish("comparison", result.case, at.out, answer, at)


#: Channel, figure, unit, computed and measured value, error and noise.
_Row = tuple[str, str, str, float, float, float, float]


def _rows(comparison: Comparison) -> list[_Row]:
    """Rows of a comparison as plain texts and numbers."""
    c = comparison
    columns = (c.channel, c.measure, c.unit, c.computed, c.measured, c.error, c.noise)
    return [
        (str(channel), str(figure), str(unit), float(a), float(b), float(e), float(n))
        for channel, figure, unit, a, b, e, n in zip(*columns, strict=True)
    ]


def _cells(
    channel: str, figure: str, unit: str, computed: float, measured: float, error: float, _: float
) -> list[str]:
    if math.isnan(measured):
        return [channel, figure, f"{computed:.6g} {unit}", "not found", ""]
    values = f"{computed:.6g} {unit}", f"{measured:.6g} {unit}", f"{100.0 * error:+.3g} %"
    return [channel, figure, *values]


def _facts(comparison: Comparison) -> Tree:
    """Figures for ``--json``; what was not found is null."""
    from tribodyn.drawing import finite
    from tribodyn.report.study_report_data import facts_of

    names = ("channel", "measure", "unit", "computed", "measured", "error", "noise")
    facts = facts_of(comparison, "speed_ratio speed_uncertainty speed_range speed_method base")
    return {
        **facts,
        "gains": dict(comparison.gains),
        "fitted": comparison.fitted,
        "harmonic_shares": dict(comparison.shares),
        "rows": [finite(dict(zip(names, row, strict=True))) for row in _rows(comparison)],
    }
