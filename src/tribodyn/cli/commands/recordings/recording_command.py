"""``tribodyn recording``: what a sensor records of a computed motion, or a labelled set of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cyclopts import Parameter

from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import (
    CaseName,
    Flag,
    Force,
    Output,
    Settings,
    changed_any_case,
    check_file,
    in_si,
    read_ranges,
    with_options,
)
from tribodyn.errors import InputError, collected

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
    noise: float = 0.0
    speed_fluctuation: float = 0.0
    tacho_jitter: float = 0.0
    seed: int = 0
    repeats: int = 1

    def settings(self) -> dict[str, Any]:
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
) -> tuple[dict[str, Any], list[str]]:
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
