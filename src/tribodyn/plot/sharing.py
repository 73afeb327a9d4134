"""How many tooth pairs share the load, and where along the life of a pair their number changes."""

from __future__ import annotations

import math

_WORDS = {1: "one", 2: "two", 3: "three", 4: "four", 5: "five"}


def further_changes(contact_ratio: float) -> dict[str, float]:
    """Ages of a tooth pair at which the number of pairs changes, besides A, B, D and E."""
    found = {}
    for number in range(2, math.ceil(contact_ratio)):
        found[f"D{number}"] = float(number)
        found[f"B{number}"] = contact_ratio - number
    return found


def load_sharing(contact_ratio: float) -> str:
    """Say in one sentence how many tooth pairs carry the load where."""
    least = math.floor(contact_ratio)
    if least == contact_ratio:
        return f"The number of pairs that carry the load is the same everywhere: {least}."
    if least == 1:
        return "Before B and after D two pairs share the load; between them one carries it alone."
    few, many = (_WORDS.get(number, str(number)) for number in (least, least + 1))
    return (
        f"{few.capitalize()} or {many} pairs share the load everywhere; their number changes at "
        "the marks other than C: another pair enters at each D and leaves at each B."
    )
