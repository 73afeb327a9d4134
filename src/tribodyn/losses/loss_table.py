"""Tables of measured torque losses: in memory, read from a file, and those of the package."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn import units
from tribodyn.errors import (
    Argument,
    InputError,
    Problem,
    quiet,
    real_numbers,
    require_between,
    require_one_of,
    require_positive,
    warn,
)
from tribodyn.friction.measured import FZG_POINTS
from tribodyn.losses.gearbox import gear_loss_factor
from tribodyn.types import Array, Tree
from tribodyn.units import RPM
from tribodyn.validated_files import plain_number, read_bytes

#: Columns of a table and their units.
COLUMNS = {"speed": "rad/s", "torque": "N*m", "torque_loss": "N*m"}
#: Columns that a file may have besides.
_MORE = {"other_loss": "N*m"}
#: How a file may name each.
_NAMED = {"speed": "speed [rpm]", **{n: f"{n} [N*m]" for n in (*list(COLUMNS)[1:], *_MORE)}}


def _quantity_text(value: float, unit: str) -> str:
    """A value as users write it: speeds in rpm."""
    rpm = unit == "rad/s"
    return f"{value / RPM:.6g} rpm" if rpm else f"{value:.6g} {unit}"


@dataclass(frozen=True)
class PowerLossTable:
    """Measured torque losses, one row for each run, repeats as rows of one speed and torque.

    All torques are of one shaft. Rows of at most ``no_load_torque`` tell the loss without load at
    their speed, which is taken off the others.

    Parameters
    ----------
    speed : array [rad/s]
        Speed of each run, shape (n,).
    torque : array [N*m]
        Torque of each run.
    torque_loss : array [N*m]
        Torque of the loss.
    gear_loss_factor : float
        H_V of the gears, see :func:`gear_loss_factor`.
    no_load_torque : float [N*m]
        Torque up to which a row counts as without load.
    other_loss : array or float [N*m]
        What bearings and seals lose more than without load, in each row, as torque.
    gear_sets : float
        Gear sets in the loop that share the loss, a pure number: 1 where the slave gears are in
        ``other_loss``, 2 where they are like those tested.
    torque_loss_uncertainty : float [N*m]
        Standard uncertainty of one reading; by default that of the repeats.
    torque_uncertainty : float [N*m]
        Standard uncertainty of the torque.
    other_loss_uncertainty : float [N*m]
        Standard uncertainty of ``other_loss``.
    gear_loss_factor_uncertainty : float
        Standard uncertainty of H_V, a pure number.
    places : tuple of str
        What messages call each row; by default "row 1", "row 2" and so on.
    source : str
        Where the values come from.

    Raises
    ------
    InputError
        Listing every row that is not as long as the others, not finite or not positive.

    Examples
    --------
    >>> table = PowerLossTable([146.6, 146.6], [5.0, 150.0], [1.0, 3.0], gear_loss_factor=0.3)
    >>> len(table.speed)
    2
    """

    speed: Array
    torque: Array
    torque_loss: Array
    gear_loss_factor: float
    no_load_torque: float = 5.0
    other_loss: Any = 0.0
    gear_sets: float = 1.0
    torque_loss_uncertainty: float | None = None
    torque_uncertainty: float = 0.0
    other_loss_uncertainty: float = 0.0
    gear_loss_factor_uncertainty: float = 0.0
    places: tuple[str, ...] = ()
    source: str = ""

    def __post_init__(self) -> None:
        """Make arrays of the columns and look at every row."""
        for name in (*COLUMNS, "other_loss"):
            object.__setattr__(
                self, name, np.atleast_1d(real_numbers(Argument(name), getattr(self, name)))
            )
        counts = {name: np.size(getattr(self, name)) for name in COLUMNS}
        if len(set(counts.values())) > 1 or not counts["speed"]:
            listed = ", ".join(f"{count} of {name}" for name, count in counts.items())
            why, remedy = "Each row has one of each", "Give columns of one length"
            raise InputError(listed, where="PowerLossTable", why=why, remedy=remedy)
        object.__setattr__(self, "other_loss", np.broadcast_to(self.other_loss, self.speed.shape))
        limits = {"speed": "above 0", **dict.fromkeys((*COLUMNS, *_MORE)[1:], "not negative")}
        problems = [
            Problem(
                f"{name} = {_quantity_text(value, unit)}",
                self.place(row),
                f"A run has a {name.replace('_', ' ')} that is finite and {limits[name]}",
                "Mend the row, or leave it out",
            )
            for name, unit in {**COLUMNS, **_MORE}.items()
            for row, value in enumerate(getattr(self, name))
            if not (np.isfinite(value) and (value > 0.0 or (value == 0.0 and name != "speed")))
        ]
        if problems:
            raise InputError(problems)
        require_positive("gear_loss_factor", self.gear_loss_factor)
        require_between("gear_sets", self.gear_sets, 1.0, 2.0)
        for name in (
            "torque_uncertainty",
            "other_loss_uncertainty",
            "gear_loss_factor_uncertainty",
        ):
            require_between(name, getattr(self, name), 0.0, np.inf)
        if self.torque_loss_uncertainty is not None:
            require_between(
                "torque_loss_uncertainty", self.torque_loss_uncertainty, 0.0, np.inf, "N*m"
            )

    def place(self, row: int) -> str:
        """What messages call a row.

        Parameters
        ----------
        row : int
            Its number, from 0.

        """
        return self.places[row] if self.places else f"row {row + 1}"


def read_power_loss_table(path: str | Path, gear_loss_factor: float, **more: Any) -> PowerLossTable:
    r"""Read measured torque losses from a CSV file.

    Parameters
    ----------
    path : str or Path
        File whose first line names ``speed``, ``torque`` and ``torque_loss`` with their units in
        brackets, and ``other_loss`` where it differs from row to row; lines with # are left out.
        Semicolons part columns as well as commas do.
    gear_loss_factor : float
        H_V of the gears.
    **more : object
        Further arguments of :class:`PowerLossTable`.

    Raises
    ------
    InputError
        Naming file and line of what is no number, or the column that is missing.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "losses.csv"
    ...     _ = file.write_text("speed [rpm], torque [N*m], torque_loss [N*m]\n1400, 50, 2.5\n")
    ...     print(read_power_loss_table(file, 0.3).speed.round(1))
    [146.6]
    """
    file = Path(path)
    try:
        text = read_bytes(file, "table").decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        why = getattr(error, "strerror", None) or str(error)
        remedy = "Give the path of a CSV file"
        raise InputError("the table cannot be read", str(file), why, remedy) from None
    numbered = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not numbered:
        raise InputError("the table is empty", str(file), "", "Write a head and its rows")
    part = next((sign for sign in ";\t" if sign in numbered[0][1]), ",")
    cells = csv.reader((line for _, line in numbered), delimiter=part)
    (_, head), *lines = zip((n for n, _ in numbered), cells, strict=True)
    columns, problems = _columns(file, head), _too_long(file, head, lines)
    values: Tree = {
        name: _column(file, lines, column, problems) for name, column in columns.items()
    }
    if problems:
        raise InputError(problems)
    if not lines:
        raise InputError("the table has no rows", str(file), "", "Write rows below its head")
    return PowerLossTable(
        **values,
        gear_loss_factor=gear_loss_factor,
        **{"places": tuple(f"{file}:{number}" for number, _ in lines), "source": str(file), **more},
    )


def _columns(file: Path, head: Sequence[str]) -> Mapping[str, tuple[int, float]]:
    """Place of each column and what its unit is in SI."""
    columns, bare, units_of = {}, list[str](), {**COLUMNS, **_MORE}
    for place, cell in enumerate(head):
        name, _, unit = (part.strip() for part in cell.partition("["))
        if name in columns:
            raise InputError(
                f"two columns {name}", f"{file}:1", "Each column must occur once", "Keep one"
            )
        if name in units_of:
            written = unit.rstrip("] ") or units_of[name]
            bare += [] if unit else [name]
            try:
                columns[name] = (place, units.parse(f"1 {written}", units_of[name]))
            except units.UnitProblemError as error:
                what = f'column "{cell.strip()}"'
                remedy = 'Name the column as "speed [rpm]", with a unit that is known'
                raise InputError(what, f"{file}:1", str(error), remedy) from None
    missing = [name for name in COLUMNS if name not in columns]
    if missing:
        remedy = f"Name the columns: {', '.join(_NAMED[name] for name in COLUMNS)}"
        raise InputError(f"no column {', '.join(missing)}", f"{file}:1", "", remedy)
    if bare:
        assumed_units = ", ".join(f"{name} in {units_of[name]}" for name in bare)
        named = ", ".join(_NAMED[name] for name in bare)
        warn(
            "friction-from-loss",
            f"{file}: columns without a unit are read in SI: {assumed_units}. Write {named}, for "
            "example",
            stacklevel=4,
        )
    return columns


def _too_long(
    file: Path, head: Sequence[str], lines: Iterable[tuple[int, list[str]]]
) -> list[Problem]:
    """Rows with more cells than the head, as a comma as decimal sign makes them."""
    return [
        Problem(
            f"{len(cells)} cells below {len(head)} columns",
            f"{file}:{number}",
            "A comma as decimal sign parts a number in two",
            "Write numbers with a point, or part the cells by semicolons",
        )
        for number, cells in lines
        if any(cell.strip() for cell in cells[len(head) :])
    ]


def _column(
    file: Path,
    lines: Iterable[tuple[int, list[str]]],
    column: tuple[int, float],
    problems: list[Problem],
) -> Array:
    """Values of a column in SI; every cell that is no number is added to the problems."""
    values = []
    for number, cells in lines:
        text = cells[column[0]].strip() if column[0] < len(cells) else ""
        value = plain_number(text)
        if value is None:
            what = f'"{text}" is not a number' if text else "a number is missing"
            why = f"Column {column[0] + 1} holds a number, with a point as decimal sign"
            problems.append(Problem(what, f"{file}:{number}", why, remedy="Correct this line"))
        values.append(value or 0.0)
    return np.array(values) * column[1]


def _wheel_driven() -> PowerLossTable:
    """Printed friction coefficients of an FZG rig, as the torque losses that correspond to them."""
    from tribodyn.gear import spur_pair

    with quiet():
        pair = spur_pair(
            pinion_teeth=16,
            wheel_teeth=24,
            normal_module=4.5e-3,
            normal_pressure_angle=math.radians(20.0),
            center_distance=91.5e-3,
            driver="wheel",
            pinion_profile_shift_coefficient=0.8532,
            wheel_profile_shift_coefficient=-0.5,
            pinion_face_width=20e-3,
        )
    factor = gear_loss_factor(pair)
    torque, speed, coefficient = map(np.array, FZG_POINTS)
    idle = np.unique(speed)
    return PowerLossTable(
        speed=np.concatenate([idle, speed]),
        torque=np.concatenate([np.full(idle.size, 5.0), torque]),
        torque_loss=np.concatenate([np.zeros(idle.size), coefficient * torque * factor]),
        gear_loss_factor=factor,
        torque_loss_uncertainty=0.1,
        places=tuple(f"point {number}" for number in range(1, idle.size + speed.size + 1)),
        source="Prediction of Vibration Characteristics in Spur Gear Drives Considering "
        "Elastohydrodynamic Lubrication, friction coefficients at five points; their torque losses "
        "are computed back with H_V by integration, the loss without load taken off, and 0.1 N*m "
        "of uncertainty is assumed: neither is printed",
    )


#: Tables of the package by name.
TABLES: Mapping[str, Callable[[], PowerLossTable]] = {"fzg-wheel-driven": _wheel_driven}


def power_loss_table(name: str) -> PowerLossTable:
    """Return a table of the package.

    Parameters
    ----------
    name : str
        ``"fzg-wheel-driven"``: the printed friction of a back-to-back rig whose wheel drives, which
        the friction law ``measured`` has too.

    Returns
    -------
    PowerLossTable
        With its ``source``.

    Raises
    ------
    InputError
        If there is no such table.

    Examples
    --------
    >>> from tribodyn.losses import friction_from_power_loss
    >>> found = friction_from_power_loss(power_loss_table("fzg-wheel-driven"))
    >>> found.friction_coefficient.round(4).tolist()
    [0.0271, 0.0692, 0.119, 0.1505, 0.0554]
    """
    return TABLES[require_one_of("name", name, TABLES)]()
