"""Convert flank modifications of a REXS model to those of a case, as far as a case has them.

REXS attaches components such as ``tip_relief`` to the flanks of a gear (1.2 and later). Amounts are
removed material. A form that a case cannot express is left out completely, with a remark.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from tribodyn.exchange.rexs_file import Component, RexsFile

_FACES = ("datum_face", "non_datum_face")
#: Kind -> supported attributes; a form with any other value except zero is left out.
_READ = {
    "tip_relief": ("tip_relief_depth", "tip_relief_datum_length", "tip_relief_datum_diameter"),
    "root_relief": ("root_relief_depth", "root_relief_datum_length"),
    "profile_crowning": ("profile_crowning_at_root", "profile_crowning_at_tip"),
    "helix_crowning": ("helix_crowning_amount_datum_face", "helix_crowning_amount_non_datum_face"),
    **{
        f"end_relief_{face}": (f"end_relief_depth_{face}", f"end_relief_length_{face}")
        for face in _FACES
    },
}
#: Forms whose sign or place depends on conventions that differ between programs -> key of a case
#: that does the same; empty where there is none.
_NOT_READ = {
    "profile_slope": "profile_slope",
    "helix_slope": "lead_slope",
    "helix_deviation": "",
    "profile_deviation": "",
    "profile_twist": "flank_twist",
    "triangular_tip_relief": "",
    "triangular_root_relief": "",
    "topographical_modification": "",
}
_KINDS = (*_READ, *_NOT_READ)


def forms_of(
    file: RexsFile, gear: Component, flanks: list[int], radii: tuple[float, float] | None
) -> tuple[dict[str, float], list[str]]:
    """Keys of a gear's modification table in SI, and remarks; radii of base and tip circle [m]."""
    modification, remarks = {}, []
    for kind in _KINDS:
        sides = [_on(file, number, kind) for number in flanks or [gear.id]]
        parts = {part.id: part for part in (*_on(file, gear.id, kind), *(sides[0] or sides[-1]))}
        if len(parts) > 1:
            remarks.append(f"{gear}: there are {len(parts)} {kind} on one flank; all are ignored")
            continue
        for part in parts.values():
            keys, why = _read(part, radii)
            if why:
                remarks.append(f"{gear}: {part} is ignored: {why}")
            elif any(_values(side) != _values(sides[0]) for side in sides):
                remarks.append(f"{gear}: {kind} of its flanks differs; the left one is used")
            modification.update(keys)
    ends = [_take_end(modification, face) for face in _FACES]
    if ends[0] == ends[1]:
        modification.update(ends[0])
    else:
        sizes = (" over ".join(f"{1e3 * value:.4g} mm" for value in end.values()) for end in ends)
        remarks.append(f"{gear}: end_relief is ignored: {' and '.join(s or '0 mm' for s in sizes)} "
                       "at both ends of the face, while a case relieves both equally")  # fmt: skip
    return modification, remarks


def _take_end(modification: dict[str, float], face: str) -> dict[str, float]:
    """Remove the relief of one end of the face; its keys as a case has them for both ends."""
    keys = [key for key in modification if key.startswith(f"end_relief_{face}")]
    return {key.replace(f"_{face}", ""): modification.pop(key) for key in keys}


def _on(file: RexsFile, number: int, kind: str) -> list[Component]:
    """Components of a kind that are attached to a flank or a gear."""
    linked = {
        other: file.components[other]
        for relation in file.relations
        if relation.kind in ("reference", "ordered_reference", "assembly")
        and number in (ids := [n for _, n in relation.refs])
        for other in ids
    }
    return [part for part in linked.values() if part.kind == kind]


def _values(parts: list[Component]) -> list[dict[str, object]]:
    return [{name: v for name, v in part.values.items() if v.content} for part in parts]


def _read(part: Component, radii: tuple[float, float] | None) -> tuple[dict[str, float], str]:
    """Keys of one form, or the reason why it is ignored."""
    if part.kind not in _READ:
        if not (key := _NOT_READ[part.kind]):
            return {}, "a case does not have this form"
        amount = part.number(part.kind, "m")
        size = "" if amount is None else f" of {1e6 * amount:.4g} um"
        return {}, f"its sign{size} differs between programs; check it, and set {key} of the gear"
    odd = [name for name in _odd(part) if name not in _READ[part.kind]]
    if odd:
        return {}, f"a case has no key for {odd[0]}"
    amounts = [part.number(name, "m") for name in _READ[part.kind]]
    if part.kind.endswith("crowning"):
        crownings = [amount for amount in amounts if amount is not None]
        if len(set(crownings)) != 1:
            return {}, "its amounts at both ends differ" if crownings else "it has no amount"
        return {"crowning" if part.kind == "helix_crowning" else part.kind: crownings[0]}, ""
    amount, length, *diameter = amounts
    if amount is None:
        return {}, "it has no depth"
    if length is None and diameter and diameter[0] is not None:
        if radii is None or not radii[0] < 0.5 * diameter[0] < radii[1]:
            return {}, "its diameter is not on the flank of the gear"
        length = _roll(radii[1], radii[0]) - _roll(0.5 * diameter[0], radii[0])
    return {part.kind: amount} | ({f"{part.kind}_length": length} if length else {}), ""


def _odd(part: Component) -> Iterator[str]:
    """Attributes with a value, supported or not."""
    return (name for name, v in part.values.items() if v.content not in (None, "", 0.0, False))


def _roll(radius: float, base: float) -> float:
    return math.sqrt(radius**2 - base**2)
