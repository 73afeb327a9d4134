"""Read the measured deviation of a flank from a CSV file."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

from tribodyn import units
from tribodyn.errors import Argument, InputError
from tribodyn.validated_files import plain_number, read_bytes

if TYPE_CHECKING:
    from tribodyn.gear import ProfileMap


_PLACES = ("roll_length", "diameter")
_FORM = (
    "The first row names the columns roll_length or diameter, face_position (if there are several) "
    "and deviation; the second their units, for example mm,mm,um; each further row is one point. "
    "Maps of several teeth have a column tooth, with the unit 1"
)


def _fault(path: str, line: int, what: str, why: str, remedy: str) -> InputError:
    place = f"{Path(path).name}, line {line}" if line else Path(path).name
    return InputError(f"{what} ({place})", Argument("profile_map"), why, remedy)


def read_profile_map(path: str, interpolation: str) -> ProfileMap:
    """Read the map of all teeth of a gear."""
    maps = read_tooth_maps(path, interpolation)
    if 0 not in maps:
        what, why = "the profile map has a column tooth", "This map is that of all teeth"
        remedy = 'Remove the column, or give the file to a fault of kind = "flank-topographies"'
        raise _fault(path, 1, what, why, remedy)
    return maps[0]


def read_tooth_maps(path: str, interpolation: str) -> dict[int, ProfileMap]:
    """Read maps by tooth, 0 where none is named; a file is read again when it has changed."""
    try:
        state = Path(path).stat()
    except (OSError, ValueError) as error:
        reason = (getattr(error, "strerror", None) or str(error)).lower()
        what, remedy = f"the file cannot be read: {reason}", f"Correct the path: {path}"
        raise _fault(path, 0, what, _FORM, remedy) from None
    return _read(path, interpolation, (state.st_mtime_ns, state.st_size))


@lru_cache(maxsize=16)
def _read(path: str, interpolation: str, _: tuple[int, int]) -> dict[int, ProfileMap]:
    try:
        text = read_bytes(path, "profile map").decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no text in UTF-8"
        what, remedy = f"the file cannot be read: {reason}", "Give a text file in UTF-8"
        raise _fault(path, 0, what, _FORM, remedy) from None
    rows = list(_rows(text))
    if len(rows) < 3:
        raise _fault(path, 0, "the profile map holds no points", _FORM, "Add what is missing")
    names, factors = _head(path, rows[0], rows[1])
    maps: dict[int, dict[tuple[float, float], float]] = {}
    for line, cells in rows[2:]:
        values = dict(zip(names, _values(path, line, cells, factors), strict=True))
        place = values.get("roll_length", values.get("diameter", 0.0))
        at = (place, values.get("face_position", 0.0))
        tooth = values.get("tooth", 0.0)
        if "tooth" in names and (tooth < 1.0 or tooth != int(tooth)):
            what, why = f"tooth = {tooth:g}", "Teeth are numbered in the order of contact from 1"
            raise _fault(path, line, what, why, "Correct the number")
        points = maps.setdefault(int(tooth), {})
        if at in points:
            what, why = "this point comes twice", "Each place has one deviation"
            raise _fault(path, line, what, why, "Remove one of them")
        points[at] = values["deviation"]
    coordinate = "diameter" if "diameter" in names else "roll_length"
    return {tooth: _grid(path, coordinate, interpolation, maps[tooth]) for tooth in sorted(maps)}


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Cells of the lines that hold something, with the number of each line."""
    separator = ";" if ";" in text else ","
    for number, line in enumerate(text.splitlines(), start=1):
        content = line.partition("#")[0].strip()
        if content:
            yield number, [cell.strip().strip('"').strip() for cell in content.split(separator)]


def _head(
    path: str, first: tuple[int, list[str]], second: tuple[int, list[str]]
) -> tuple[list[str], list[float]]:
    """Names of the columns, and the factor of each to metres."""
    names = [name.lower().replace(" ", "_") for name in first[1]]
    text = sorted(name for name in names if name not in (*_PLACES, "tooth"))
    sound = text in (["deviation"], ["deviation", "face_position"])
    if not sound or len(names) != len(text) + 1 + ("tooth" in names):
        # What is no profile map at all is not for everyone to read.
        labels = set(names) & {*_PLACES, "deviation"}
        what = f"the columns are {', '.join(first[1])}" if labels else "this is no profile map"
        raise _fault(path, first[0], what, _FORM, "Correct the first row")
    lengths = [u for n, u in zip(names, second[1], strict=False) if n != "tooth"]
    if len(second[1]) != len(names) or any(_number(cell) is not None for cell in lengths):
        what = "the row of units is missing"
        raise _fault(path, second[0], what, _FORM, "Add for example mm,mm,um as the second row")
    factors = []
    for name, unit in zip(names, second[1], strict=True):
        try:
            factors.append(1.0 if name == "tooth" else units.convert(1.0, unit, "m"))
        except units.UnitProblemError as error:
            what = f'"{unit}" is no unit of {name}'
            raise _fault(path, second[0], what, str(error), "Write mm or um") from None
    return names, factors


def _number(cell: str) -> float | None:
    return plain_number(cell)


def _values(path: str, line: int, cells: list[str], factors: list[float]) -> list[float]:
    if len(cells) != len(factors):
        what = f"this row has {len(cells)} entries and the first row {len(factors)}"
        remedy = "Complete the row; the decimal sign is a point"
        raise _fault(path, line, what, "Each row is one point", remedy)
    values = []
    for cell, factor in zip(cells, factors, strict=True):
        value = _number(cell)
        if value is None:
            why = "Below the units there are numbers, with a decimal point"
            raise _fault(path, line, f'"{cell}" is no number', why, "Correct the row")
        values.append(value * factor)
    return values


def _grid(
    path: str, coordinate: str, interpolation: str, points: dict[tuple[float, float], float]
) -> ProfileMap:
    from tribodyn.gear import ProfileMap

    places, faces = (sorted({at[axis] for at in points}) for axis in (0, 1))
    absent = next((at for at in product(places, faces) if at not in points), None)
    if absent:
        place, face = (1e3 * value for value in absent)
        what = f"the profile map has {len(points)} points, which make no full grid of "
        what += f"{len(places)} x {len(faces)} places"
        why = f"There is none at {coordinate} {place:.6g} mm and face_position {face:.6g} mm"
        raise _fault(path, 0, what, why, "Complete the map, or take the odd points out")
    rows = tuple(tuple(points[place, face] for face in faces) for place in places)
    try:
        return ProfileMap(tuple(places), tuple(faces), rows, coordinate, interpolation)
    except InputError as error:
        problem = error.problems[0]
        raise _fault(path, 0, problem.what, problem.why, problem.remedy) from None
