"""``tribodyn experiment`` and ``tribodyn paper``: published claims checked by computation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.commands.sweep_commands import INTERRUPTED, report_exit_code, run_checkpointed
from tribodyn.cli.console import say, say_json, table, tell
from tribodyn.cli.settings import (
    USUAL,
    CaseName,
    Flag,
    Force,
    Place,
    changed_case,
    check_place,
    read_ranges,
)
from tribodyn.errors import InputError
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.cases.papers.comparison import PaperComparison
    from tribodyn.cases.papers.friction_claims import FrictionExperiment

_EXPERIMENTS = ("friction",)


def experiment(
    kind: str,
    case: CaseName = "fzg-roughness",
    /,
    *,
    roughness: str = "",
    laws: str = "",
    at: Place = USUAL,
) -> int:
    """Compare friction laws and roughnesses on one pair, and judge five published claims.

    Parameters
    ----------
    kind : str
        What is studied: friction.
    roughness : str
        Composite roughnesses such as "0.325,0.53,0.991 um".
    laws : str
        Friction laws such as "constant,xu-2007"; "none" is always among them.
    """
    if kind not in _EXPERIMENTS:
        remedy = f"Write: tribodyn experiment {_EXPERIMENTS[0]}"
        raise InputError(f'there is no experiment "{kind}"', "", "", remedy)
    ready, options = changed_case(case, at.set_ or [], "experiment"), _options(roughness, laws)

    def compute(**checkpointing: Any) -> FrictionExperiment:
        from tribodyn.cases.papers.friction_experiment import friction_experiment

        return friction_experiment(ready, **options, partial=True, **checkpointing)

    target = at.reserved(case, kind)
    result: Any = run_checkpointed(target, at.force, compute)
    claims = [dict(zip(_keys(result), row, strict=True)) for row in result.claim_rows()]
    if at.json:
        say_json({"complete": result.complete, "claims": claims, "rows": list(result.rows())})
    else:
        names = ("claim", "verdict", "holds_where")
        rows = [["Claim", "Verdict", "Holds where"], *([c[n] for n in names] for c in claims)]
        say(f"{result.case.title}\n{result.lead}\n\n{table(rows)}")
        if effects := list(result.effect_rows()):
            driver, held_torque = result.case.gears.driver, result.case.operation.torque_balance
            say(f"\nThe {driver} drives, torque held: {held_torque}\n")
            say(table([result.EFFECT_HEAD, *effects]))
        for claim in claims:
            say(
                f"\n{claim['claim']} ({claim['source_of']})\n  printed:  {claim['printed']}\n"
                f"  computed: {claim['computed']}\n  {claim['why']}."
            )
    for failed in dict.fromkeys(point.failed for point in result.points if point.failed):
        tell(f"failed: {failed}")
    return report_exit_code(result, target)


def _keys(result: FrictionExperiment) -> list[str]:
    return [name.lower().replace(" ", "_") for name in result.CLAIM_HEAD]


def _options(roughness: str, laws: str) -> Tree:
    """Return the options of the command line as arguments."""
    options: Tree = {}
    if roughness:
        values = read_ranges([f"roughness={roughness}"])["roughness"]
        if isinstance(values, tuple) or not all(isinstance(value, str) for value in values):
            remedy = 'Write --roughness "0.325,0.53,0.991 um"'
            what = f'cannot read "{roughness}"'
            raise InputError(what, "--roughness", "It is a list of lengths with a unit", remedy)
        options["roughness"] = values
    if laws:
        options["laws"] = [name.strip() for name in laws.split(",")]
    return options


def paper(
    case: str | None = None,
    /,
    *,
    all_: Annotated[bool, Parameter(name="--all", negative="")] = False,
    out: Path | None = None,
    force: Force = False,
    json: Flag = False,
) -> int:
    """Compare the printed tables of a source with computed figures, with a verdict for each figure.

    Parameters
    ----------
    case : str
        Built-in case that represents a source.
    all_ : bool
        All sources on one page.
    out : Path
        Directory to write; by default that of the case with "-paper", or "papers".
    json : bool
        Write the rows as one JSON list to stdout.
    """
    from tribodyn.cases.papers.printed import papers, printed_rows

    if (case is None) != all_:
        why = f"There are tables for {', '.join(papers())}"
        what = "name one case, or all with --all"
        raise InputError(what, "", why, "Write: tribodyn paper fzg-12dof")
    names = [] if case is None else [case]
    for name in names:
        printed_rows(name)

    def compute(**checkpointing: Any) -> PaperComparison:
        from tribodyn.cases.papers.comparison import compare_with_paper

        return compare_with_paper(*names, partial=True, **checkpointing)

    target = out if out is not None else Path(f"{case}-paper" if case else "papers")
    check_place(target, force)
    comparison: Any = run_checkpointed(target, force, compute)
    if json:
        say_json(list(comparison.rows))
    else:
        say(f"{comparison.lead}\n{table([comparison.HEAD, *comparison.table()])}")
    tell(f"Report: {target / 'report.html'}")
    return 0 if comparison.complete else INTERRUPTED
