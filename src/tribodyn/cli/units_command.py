"""``tribodyn units``."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json, table


def units(*, json: Annotated[bool, Parameter(negative="")] = False) -> None:
    """List the units of all quantities and the spellings that are understood besides.

    Parameters
    ----------
    json : bool
        Write one JSON object to stdout.
    """
    from tribodyn.nomenclature import QUANTITIES
    from tribodyn.units import SPELLINGS

    kinds: dict[tuple[str, str], list[str]] = {}
    for quantity in QUANTITIES.values():
        if quantity.unit:
            kinds.setdefault((quantity.unit, quantity.display_unit), []).append(quantity.name)
    if json:
        listed = [{"si": si, "shown": shown, "for": n} for (si, shown), n in kinds.items()]
        say_json({"units": listed, "spellings": SPELLINGS})
        return
    say("Shown as, in SI, and what for (any unit of the same kind is understood):")
    say(table([[shown, si, ", ".join(names)] for (si, shown), names in kinds.items()]))
    say("\nSpellings understood besides the usual ones:")
    say(table([[spelling, meant] for spelling, meant in SPELLINGS.items() if spelling != meant]))
