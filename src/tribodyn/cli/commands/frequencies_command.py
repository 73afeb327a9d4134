"""``tribodyn frequencies``."""

from __future__ import annotations

from tribodyn.cli.console import say, say_json, table, tell
from tribodyn.cli.settings import CaseName, Flag, Words, changed_any_case
from tribodyn.errors import InputError
from tribodyn.units import UnitProblemError, parse


def frequencies(
    case: CaseName,
    /,
    *,
    near: str | None = None,
    sidebands: int = 1,
    set_: Words = None,
    json: Flag = False,
) -> None:
    """List the frequencies of shafts, meshes, bearings and planets; nothing is computed.

    Parameters
    ----------
    near : str
        Frequency of a peak such as "312 Hz": only what lies within 1 % of it, with harmonics.
    sidebands : int
        Sidebands on each side of each mesh frequency.
    set_ : list of str
        Values to change, for example "operation.speed=1450 rpm".
    json : bool
        Write the lines in Hz as one JSON array to stdout.
    """
    from tribodyn.analysis.part_frequencies import PartFrequency
    from tribodyn.study.frequencies import kinematic_frequencies

    ready = changed_any_case(case, set_ or [])
    lines = kinematic_frequencies(ready, sidebands=sidebands)
    columns = lines.part, lines.symbol, lines.frequency.tolist(), lines.meaning
    listed = [PartFrequency(*line) for line in zip(*columns, strict=True)]
    if near is not None:
        try:
            listed = lines.near(parse(near, "Hz"))
        except UnitProblemError as error:
            raise InputError(f"{error}", "--near", "", 'Write --near "312 Hz"') from None
    orders = [line.frequency / lines.input_frequency for line in listed]
    if json:
        say_json([{**line._asdict(), "order": o} for line, o in zip(listed, orders, strict=True)])
        return
    head = ("part", "", "Hz", "order", "what")
    say(f"{ready.title}, input at {lines.input_frequency:.6g} Hz")
    body = [
        (line.part, line.symbol, f"{line.frequency:.6g}", f"{order:.6g}", line.meaning)
        for line, order in zip(listed, orders, strict=True)
    ]
    say(
        table([head, *body])
        if body
        else f"No part has {near}, alone or as one of its first ten harmonics."
    )
    if lines.without_elements:
        names = ", ".join(lines.without_elements)
        tell(f"Without frequencies, for they have no type with elements: bearings {names}.")
