"""How many tooth pairs share the load, and where along the life of a pair their number changes."""

from __future__ import annotations

import math

__all__ = ["further_changes", "load_sharing"]

_WORDS = {1: "one", 2: "two", 3: "three", 4: "four", 5: "five"}


def further_changes(contact_ratio: float) -> dict[str, float]:
    """Ages of a tooth pair at which the number of pairs changes, besides A, B, D and E.

    A contact ratio of two or less has none. Above it, a pair also meets the entry of the second
    pair after it, at D2, and the exit of the second pair before it, at B2, and so on.

    Parameters
    ----------
    contact_ratio : float
        Transverse contact ratio.

    Returns
    -------
    dict of str to float
        Mesh cycles since the pair entered at A.

    Examples
    --------
    >>> further_changes(1.7)
    {}
    >>> further_changes(2.25)
    {'D2': 2.0, 'B2': 0.25}
    """
    found = {}
    for number in range(2, math.ceil(contact_ratio)):
        found[f"D{number}"] = float(number)
        found[f"B{number}"] = contact_ratio - number
    return found


def load_sharing(contact_ratio: float) -> str:
    """Say in one sentence how many tooth pairs carry the load where.

    Parameters
    ----------
    contact_ratio : float
        Transverse contact ratio.

    Returns
    -------
    str

    Examples
    --------
    >>> load_sharing(1.5)
    'Before B and after D two pairs share the load; between them one carries it alone.'
    >>> load_sharing(2.25).partition(";")[0]
    'Two or three pairs share the load everywhere'
    """
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
