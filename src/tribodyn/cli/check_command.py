"""``tribodyn check``."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from tribodyn.cli.changes import changed_case
from tribodyn.cli.screen import say, say_json, show_warnings, table, tell


def check(
    case: str,
    /,
    *,
    set_: Annotated[list[str] | None, Parameter(name="--set", negative="")] = None,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Check a case and show the geometry that follows from it; nothing is computed beyond.

    Parameters
    ----------
    case : str
        Built-in case or path of a case file.
    set_ : list of str
        Values to change, for example "operation.torque=120 N*m".
    json : bool
        Write one flat JSON object in SI to stdout.
    """
    from tribodyn.study.case.provenance import assumptions
    from tribodyn.study.pipeline.cautions import case_cautions
    from tribodyn.study.pipeline.geometry import geometry
    from tribodyn.study.pipeline.summary_names import SUMMARY

    checked = changed_case(case, set_ or [])
    values = geometry(checked)
    if json:
        say_json(values)
    else:
        rows = [[n, SUMMARY[n].show(v), SUMMARY[n].meaning] for n, v in values.items()]
        say(f"{checked.title}\n{table(rows)}")
    show_warnings((warning.code, warning.message) for warning in case_cautions(checked))
    kinds = [assumption.kind for assumption in assumptions(checked)]
    tell(
        f"The case is in order; {kinds.count('assumed')} values are assumed, "
        f"{kinds.count('default')} are defaults."
    )
