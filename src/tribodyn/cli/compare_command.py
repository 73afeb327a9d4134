"""``tribodyn compare``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json, table

#: Relative difference of figures that are told as equal.
_SAME = 1e-9


def compare(
    first: Path, second: Path, /, *, json: Annotated[bool, Parameter(negative="")] = False
) -> None:
    """Show which values of the case and which figures differ between two results.

    Parameters
    ----------
    first : Path
        Directory that tribodyn run wrote.
    second : Path
        Another one.
    json : bool
        Write values and figures in SI as one JSON object to stdout.
    """
    from tribodyn.cases.load import load_case
    from tribodyn.cases.stored_result import read_summary
    from tribodyn.study.pipeline.summary import SUMMARY, by_topic

    summaries = [read_summary(place) for place in (first, second)]
    cases = [dict(load_case(place / "case.toml").values()) for place in (first, second)]
    keys = {k: [c.get(k) for c in cases] for k in {**cases[0], **cases[1]}
            if cases[0].get(k) != cases[1].get(k)}  # fmt: skip
    figures = {name: [s.get(name) for s in summaries] for name in {**summaries[0], **summaries[1]}
               if _differ(summaries[0].get(name), summaries[1].get(name))}  # fmt: skip
    if json:
        say_json({"values": keys, "figures": figures})
        return
    rows: list[list[str]] = [["", str(first), str(second), "change"]]
    rows += [[key, *map(_told, values), ""] for key, values in keys.items()]
    for topic, names in by_topic(figures).items():
        rows.append([topic, "", "", ""])
        for name in names:
            shown = ["-" if v is None else SUMMARY[name].show(v) for v in figures[name]]
            rows.append([f"  {name}", *shown, _change(*figures[name])])
    say(table(rows) if len(rows) > 1 else "Both results are equal.")


def _told(value: Any) -> str:
    return "-" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)


def _differ(one: float | None, other: float | None) -> bool:
    if one is None or other is None:
        return one is not other
    return abs(one - other) > _SAME * max(abs(one), abs(other))


def _change(one: float | None, other: float | None) -> str:
    """Relative change from the first to the second, where there is one."""
    if one is None or other is None or one == 0.0:
        return ""
    return f"{100.0 * (other - one) / abs(one):+.3g} %"
