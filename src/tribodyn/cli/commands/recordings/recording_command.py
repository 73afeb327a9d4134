"""``tribodyn recording``: what a sensor records of a computed motion, or a labelled set of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import (
    CaseName,
    Flag,
    Force,
    Settings,
    changed_any_case,
    changed_case,
    check_file,
    read_ranges,
)
from tribodyn.errors import Argument, InputError, Problem, TribodynError, collected

if TYPE_CHECKING:
    from tribodyn.measurement import Recording

#: Options of the command by the arguments of the functions behind it.
_OPTIONS = {
    name: f"--{name.replace('_', '-')}"
    for name in (
        *("sensor", "duration", "sample_rate", "tacho", "noise", "speed_fluctuation"),
        *("tacho_jitter", "seed", "repeats"),
    )
} | {"path": "--out", "folder": "--out"}


def recording(
    case: CaseName,
    /,
    *over: str,
    sensor: str,
    duration: str = "1 s",
    sample_rate: str = "25600 Hz",
    noise: float = 0.0,
    speed_fluctuation: float = 0.0,
    tacho_jitter: float = 0.0,
    seed: int = 0,
    repeats: int = 1,
    out: Path | None = None,
    set_: Settings = None,
    force: Force = False,
    json: Flag = False,
) -> None:
    """Record what a sensor sees of the motion of a case; over values of keys, a labelled set.

    Parameters
    ----------
    over : str
        What varies, such as "faults.crack.depth=0,1,2 mm": writes a folder of labelled recordings,
        which the same command continues after an interruption. Several make a grid.
    sensor : str
        Signals such as "pinion_y,wheel_y", "mesh_force" or "transmission_error"; one for a set.
    duration : str
        Length of a recording: "2 s".
    sample_rate : str
        Sampling rate: "25600 Hz".
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
    out : Path
        File to write, .mat, .wav, .h5, .uff or .csv, with its truth as .json of that name; of a set
        its folder. By default that of the case with "-recording".
    json : bool
        Write what was recorded as one JSON object to stdout.
    """
    settings: dict[str, Any] = {
        "duration": _quantity("--duration", duration, "s", "2 s"),
        "sample_rate": _quantity("--sample-rate", sample_rate, "Hz", "25600 Hz"),
        "noise": noise,
        "speed_fluctuation": speed_fluctuation,
        "tacho_jitter": tacho_jitter,
        "seed": seed,
    }
    with collected() as warnings:
        try:
            if over:
                if force:
                    why = "The same command continues a set, and another one is not replaced"
                    raise InputError("--force is given for a set", "--force", why, "Remove it")
                folder = out if out is not None else Path(f"{Path(case).stem}-recordings")
                _record_set(case, over, folder, sensor, repeats, set_, settings, json)
            else:
                if repeats != 1:
                    why = "One recording is made where nothing varies"
                    what, remedy = (
                        f"repeats = {repeats}",
                        'Add for example "faults.NAME.depth=0,1 mm"',
                    )
                    raise InputError(what, "--repeats", why, remedy)
                file = out if out is not None else Path(f"{Path(case).stem}-recording.mat")
                _record(case, file, sensor, set_, force, settings, json)
        except TribodynError as error:
            raise type(error)([_by_option(each) for each in error.problems]) from None
    show_warnings(warnings)


def _record(
    case: str, file: Path, sensor: str, set_: Settings, force: bool, settings: dict[str, Any],
    json: bool,
) -> None:  # fmt: skip
    """Write one recording and its truth."""
    from tribodyn.cases.load import run
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.measurement.writers import check_ending

    check_file(file, force)
    check_ending(file)
    ready = changed_any_case(case, set_ or [])
    with progress_bar() as progress:
        result: Any = run(ready, progress)
        names = [name.strip() for name in sensor.split(",")]
        made: Recording = result.recording(names, settings.pop("duration"), **settings)
    faults = getattr(ready, "faults", None)
    truth = {
        name: {key: value for key, value in vars(fault).items() if value is not None}
        for name, fault in (vars(faults) if faults is not None else {}).items()
    }
    made.save(file, truth={"title": ready.title, "faults": truth})
    if json:
        rate, size = made.sample_rate, next(iter(made.channels.values())).size
        facts = {"file": str(file), "sample_rate": rate, "samples": size, "units": dict(made.units)}
        say_json({**facts, "faults": truth})
        return
    say(f"{ready.title}\n{made}")
    tell(f"Recording: {file}, truth: {file.with_suffix('.json')}")
    tell(f"Analyse it: tribodyn signal {file} --channel {names[0]} --tacho tacho")


def _record_set(
    case: str, over: tuple[str, ...], folder: Path, sensor: str, repeats: int, set_: Settings,
    settings: dict[str, Any], json: bool,
) -> None:  # fmt: skip
    """Write a labelled set."""
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.study import record_set

    ranges, ready = read_ranges(over), changed_case(case, set_ or [])
    with progress_bar() as progress:
        labelled = record_set(
            ready, folder, ranges, sensor=sensor, repeats=repeats, progress=progress, **settings
        )
    if json:
        say_json({"folder": str(folder), "recordings": len(labelled), "card": dict(labelled.card)})
        return
    rows = [
        [key, axis["unit"], str(len(axis["values"]))] for key, axis in labelled.card["keys"].items()
    ]
    say(f"{ready.title}\n{labelled}\n{table([['key', 'unit', 'values'], *rows])}")
    tell(f"Set: {folder} with card.json and labels.csv")


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
