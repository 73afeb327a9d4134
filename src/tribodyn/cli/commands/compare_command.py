"""``tribodyn compare``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json, table
from tribodyn.cli.settings import Flag, check_place
from tribodyn.errors import InputError
from tribodyn.validated_files import plain_number

Words = Annotated[list[str] | None, Parameter(negative="")]


def compare(
    first: Path,
    second: Path,
    /,
    *,
    channel: Words = None,
    gain: str = "1",
    harmonics: int = 5,
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
        sensitivity of the sensor, "acc=acceleration_loa_pinion, 100 mV/g"; one for each.
    gain : str
        Measured over computed signal of the transfer path, or "fit".
    harmonics : int
        Mesh harmonics that are compared with a recording.
    out : Path
        Directory for the report of the comparison with a recording.
    force : bool
        Replace an earlier report in that directory.
    json : bool
        Write values and figures in SI as one JSON object to stdout.
    """
    if not second.is_dir() and second.exists():
        _with_recording(first, second, _pairs(channel), (gain, harmonics), (out, force, json))
        return
    from tribodyn.cases.load import load_case
    from tribodyn.cases.stored_result import read_summary
    from tribodyn.study.beside import difference_rows, differing, figures_differ

    summaries = [read_summary(place) for place in (first, second)]
    cases = [dict(load_case(place / "case.toml").values()) for place in (first, second)]
    keys = differing(cases)
    figures = differing(summaries, figures_differ)
    if json:
        say_json({"values": keys, "figures": figures})
        return
    rows = [["", str(first), str(second), "change"], *difference_rows(keys, figures)]
    say(table(rows) if len(rows) > 1 else "Both results are equal.")


def _pairs(words: list[str] | None) -> tuple[dict[str, str], dict[str, str]]:
    """Computed signals and sensitivities by measured channel."""
    signals, sensitivity = {}, {}
    for word in words or []:
        name, sign, value = word.partition("=")
        signal, comma, sensor = value.partition(",")
        if not sign or not name.strip() or not signal.strip() or (comma and not sensor.strip()):
            what, why = f'"{word}" names no pair', "A sign of equality parts channel and signal"
            remedy = 'Write --channel "acc=acceleration_loa_pinion, 100 mV/g"'
            raise InputError(what, "--channel", why, remedy)
        signals[name.strip()] = signal.strip()
        if comma:
            sensitivity[name.strip()] = sensor.strip()
    return signals, sensitivity


def _with_recording(
    first: Path, second: Path, pairs: tuple[dict[str, str], ...], options: Any, output: Any
) -> None:
    from tribodyn.cases.stored_result import load_result
    from tribodyn.cli.commands.study_commands import finish
    from tribodyn.measurement import compare as compared
    from tribodyn.measurement import read
    from tribodyn.report.answers import Answer

    channels, sensitivity = pairs
    gain, harmonics = options
    out, force, json = output
    if not channels:
        remedy = 'Write --channel "acc=acceleration_loa_pinion, 100 mV/g", one for each channel'
        raise InputError("no channel of the recording is named", "--channel", "", remedy)
    number = plain_number(gain)
    if number is None and gain != "fit":
        raise InputError(f'gain = "{gain}"', "--gain", "", 'Give a number, or "fit"')
    if out is not None:
        check_place(out, force)
    result = load_result(first)
    found = compared(
        result,
        read(second, sensitivity=sensitivity),
        channels,
        harmonics=harmonics,
        gain="fit" if number is None else number,
    )
    names = ("channel", "measure", "unit", "computed", "measured", "error")
    columns = tuple(getattr(found, name) for name in names)
    rows = [
        [str(c), str(m), f"{made:.6g} {u}", f"{told:.6g} {u}", f"{100.0 * error:+.3g} %"]
        for c, m, u, made, told, error in zip(*columns, strict=True)
    ]
    head = ("channel", "figure", "computed", "measured", f"error, of the {found.base} value")
    how = "fitted" if found.fitted else "given"
    told = [f"Gain of {name}, {how}: {value:.6g}" for name, value in found.gains.items()]
    facts = {
        "gains": dict(found.gains),
        "fitted": found.fitted,
        "base": found.base,
        "rows": [
            dict(zip(names, (str(c), str(m), str(u), float(a), float(b), float(e)), strict=True))
            for c, m, u, a, b, e in zip(*columns, strict=True)
        ],
    }
    if out is None:
        say("\n".join([*told, table([head, *rows])])) if not json else say_json(facts)
        return
    caption = "Spectra of the measured channels with the computed mesh harmonics on them."
    figures = [("Computed and measured", found.plot(), caption)]
    finish(
        "comparison", result.case, out, Answer(found, figures, told, head, rows, facts), force, json
    )
