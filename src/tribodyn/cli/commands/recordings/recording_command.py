"""``tribodyn recording``: what a sensor records of a computed motion, or a labelled set of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import (
    CaseName,
    Force,
    Settings,
    changed_any_case,
    check_file,
    read_ranges,
)
from tribodyn.errors import Argument, InputError, Problem, TribodynError, collected

#: Options of the command by the arguments of the functions behind it.
_OPTIONS = {
    name: f"--{name.replace('_', '-')}"
    for name in (
        *("sensor", "duration", "sample_rate", "tacho", "noise", "speed_fluctuation"),
        *("tacho_jitter", "seed", "repeats"),
    )
} | {"path": "--out", "folder": "--out"}


def _help(text: str) -> Any:
    return Parameter(help=text)


@Parameter(name="*")
@dataclass
class Sampling:
    """What is recorded, and what scatters."""

    sensor: Annotated[
        str,
        _help(
            'Signals such as "acceleration_loa_pinion,acceleration_loa_wheel", "mesh_force" or '
            '"dynamic_transmission_error"; one for a set.'
        ),
    ]
    duration: Annotated[str, _help('Length of a recording: "2 s".')] = "1 s"
    sample_rate: Annotated[str, _help('Sampling rate: "25600 Hz".')] = "25600 Hz"
    noise: Annotated[
        float, _help("Standard deviation of white noise, in the SI unit of the sensor.")
    ] = 0.0
    speed_fluctuation: Annotated[
        float, _help("Standard deviation of slow changes of the speed, over the speed.")
    ] = 0.0
    tacho_jitter: Annotated[
        float, _help("Standard deviation of the edges of the tacho, over a turn.")
    ] = 0.0
    seed: Annotated[int, _help("Number of the draw of all that scatters.")] = 0
    repeats: Annotated[int, _help("Recordings of each variant of a set.")] = 1

    def settings(self) -> dict[str, Any]:
        """Return the arguments of a recording, all but the sensor."""
        return {
            "duration": _quantity("--duration", self.duration, "s", "2 s"),
            "sample_rate": _quantity("--sample-rate", self.sample_rate, "Hz", "25600 Hz"),
            "noise": self.noise,
            "speed_fluctuation": self.speed_fluctuation,
            "tacho_jitter": self.tacho_jitter,
            "seed": self.seed,
        }


def recording(
    case: CaseName,
    /,
    *over: Annotated[
        str,
        _help(
            'What varies, such as "faults.crack.depth=0,1,2 mm": writes a folder of labelled '
            "recordings, which the same command continues. Several make a grid."
        ),
    ],
    sampling: Sampling,
    out: Annotated[
        Path | None,
        _help(
            "File to write, .mat, .wav, .h5, .uff or .csv, with its truth as .json; of a set its "
            'folder. By default that of the case with "-recording".'
        ),
    ] = None,
    set_: Settings = None,
    force: Force = False,
    json: Annotated[
        bool, Parameter(negative="", help="Write what was recorded as JSON to stdout.")
    ] = False,
) -> None:
    """Record what a sensor sees of the motion of a case; over values of keys, a labelled set."""
    with collected() as warnings:
        try:
            if over:
                if force:
                    why = "The same command continues a set, and another one is not replaced"
                    raise InputError("--force is given for a set", "--force", why, "Remove it")
                facts, lines = _record_set(case, over, out, sampling, set_)
            else:
                facts, lines = _record(case, out, sampling, set_, force)
        except TribodynError as error:
            raise type(error)([_by_option(each) for each in error.problems]) from None
    show_warnings(warnings)
    if json:
        say_json(facts)
        return
    say(lines[0])
    for text in lines[1:]:
        tell(text)


def _record(
    case: str, out: Path | None, sampling: Sampling, set_: Settings, force: bool
) -> tuple[dict[str, Any], list[str]]:
    """Write one recording and its truth; return facts and lines of text."""
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.measurement.writers import check_ending
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
        recorded, truth = recorded_motion(ready, names, progress, **settings)
    recorded.save(file, truth={"title": ready.title, **truth})
    rate, size = recorded.sample_rate, next(iter(recorded.channels.values())).size
    facts = {"file": str(file), "sample_rate": rate, "samples": size}
    return {**facts, "units": dict(recorded.units), **truth}, [
        f"{ready.title}\n{recorded}",
        f"Recording: {file}, truth: {file.with_suffix('.json')}",
        f"Analyse it: tribodyn signal {file} --channel {names[0]} --tacho tacho",
    ]


def _record_set(
    case: str, over: tuple[str, ...], out: Path | None, sampling: Sampling, set_: Settings
) -> tuple[dict[str, Any], list[str]]:
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


def _quantity(option: str, text: str, unit: str, example: str) -> float:
    from tribodyn.units import UnitProblemError, parse

    try:
        return parse(text, unit)
    except UnitProblemError as error:
        raise InputError(f'"{text}"', option, str(error), f'Write {option} "{example}"') from None


def _by_option(problem: Problem) -> Problem:
    """A problem with the option of the command line instead of the argument."""
    for argument, option in _OPTIONS.items():
        if problem.where in (Argument(argument), f"argument {argument}"):
            return Problem(problem.what, option, problem.why, problem.remedy)
    return problem
