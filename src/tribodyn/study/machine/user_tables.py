"""Tables of a case of parts as the user writes them: values, changes, reasons, and the file."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from copy import deepcopy
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from tribodyn.errors import InputError, Problem, did_you_mean
from tribodyn.machine.fields import display
from tribodyn.study.case.case_data import BaseCase
from tribodyn.study.case.changes import with_values
from tribodyn.study.case.provenance import (
    Assumption,
    read_stated,
    settled,
    without_records,
)
from tribodyn.study.case.section import flat_keys, option_at, section_at, table_in
from tribodyn.study.case.to_models import USUAL_GEARS
from tribodyn.study.case.user_input import (
    Source,
    Stated,
    UserInput,
    plain,
    si_value,
    unsound,
    without_spread,
)
from tribodyn.study.case.values import (
    FaultError,
    KeyedProblems,
    Plain,
    unmarked,
)
from tribodyn.study.case.write import written_value
from tribodyn.study.machine.tables import GROUPS, OperationTable
from tribodyn.study.machine.unused_keys import changed_machine
from tribodyn.study.machine_tables import STIFF, MachineTables

if TYPE_CHECKING:
    from tribodyn.model import Option
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.case import MachineCase


class PartsBase(BaseCase):
    """Case of parts with names: its keys, their values, and the file."""

    data: dict[str, Any]  #: tables of the case file, without spreads
    __init__: Callable[..., None]
    _records = Stated({}, {})  #: values that reasons and origin were given for, before the case

    def _take(self, source: Source | None, typed: dict[str, Any]) -> KeyedProblems:
        """Set the tables as the user typed them, in SI where they come from Python."""
        self._source = source or Source()
        if unreadable := list(unsound(typed)):
            raise InputError(self._source.place(unreadable))
        typed = deepcopy(typed) if source is not None else plain(typed)
        ready = for_each_planet(without_records(typed))
        self.data, self._spread, problems = without_spread(ready)
        return problems

    def _read_records(self, typed: Mapping[str, Any]) -> None:
        """Read the values that reasons and origin were given for; drop reasons of other values."""
        self._records, faults = read_stated(typed, self.option_of, tuple(MachineTables.fields))
        if faults:
            raise InputError(self._source.place(faults))
        for key in self._settled[1] if self._records.marks else ():
            del self.data["assumed"][key]

    @cached_property
    def _options(self) -> dict[str, Option | None]:
        """Option of each key that is given."""
        tables = {k: v for k, v in self.data.items() if k != "assumed"}
        return {key: self.option_of(key) for key, _ in flat_keys(tables)}

    @cached_property
    def _typed(self) -> dict[str, Any]:
        """Values as typed, by dotted key."""
        return {key: value for key, value in flat_keys(self.data) if key in self._options}

    @cached_property
    def _effective(self) -> dict[str, Any]:  # type: ignore[override]
        files = self._named_files()
        return {
            key: _in_si(self._options[key], key, value)
            for key, value in self._typed.items()
            if key not in files
        }

    @cached_property
    def _user_input(self) -> UserInput:  # type: ignore[override]
        return UserInput(with_values(self.data, self._spread))

    @cached_property
    def _settled(self) -> tuple[Stated, set[str]]:
        return settled(self, self._assumed, self._user_input, self._records)

    @property
    def _stated(self) -> Stated:  # type: ignore[override]
        return self._settled[0]

    @property
    def _assumed(self) -> dict[str, str]:  # type: ignore[override]
        reasons: dict[str, str] = self.data.get("assumed", {})
        return reasons

    def _named_files(self) -> dict[str, Path]:
        options = self._options
        files = [key for key, option in options.items() if option and option.kind == "file"]
        return {key: Path(str(unmarked(self._typed[key]))) for key in files}

    def _unknown_key(self, key: str) -> Problem:
        keys = [
            f"{group}.{part}.{name}"
            for group in (*GROUPS, "planets")
            for part, body in table_in(self.data, group).items()
            for name in section_at((group, part), MachineTables).keys_for(body)  # type: ignore[union-attr]
        ]
        keys += [f"operation.{name}" for name in OperationTable.fields]
        keys += [name for name, _ in self.values()]
        what, why = f'there is no key "{key}"', "Keys name the part and its value"
        part = next((name for name in keys if name.startswith("planets.")), "")
        example = (
            f"{part.rpartition('.')[0]}.pin_stiffness" if part else "bearings.A.radial_stiffness"
        )
        remedy = f'Write, for example, "{example}" or "operation.speed"'
        return Problem(what, "", why, did_you_mean(key, list(dict.fromkeys(keys)), remedy))

    @abstractmethod
    def mesh_pairs(self) -> Iterator[tuple[str, Case, tuple[str, str]]]:
        """Iterate over key, pair and names of both gears of the meshes with computed teeth."""

    def values(self) -> Iterator[tuple[str, Any]]:
        """Iterate over dotted keys and their values in SI; of files their names."""
        files = {key: path.name for key, path in self._named_files().items()}
        return ((key, files.get(key, self._effective.get(key))) for key in self._typed)

    def option_of(self, key: str) -> Option | None:
        """Unit and range of a dotted key; of the second value of a list it ends with ``.2``."""
        return option_at(MachineTables, self.data, key)

    def replace(self, changes: Mapping[str, Any], *, by: str = "") -> Self:
        """Return a case with values changed by dotted key, as that of a pair does."""
        source = self._source.with_replaced(changes, by or "replace:")
        tables = changed_machine(self.data, changes, self._spread, by)
        changed: Self = type(self)(source, **tables)
        changed._records = self._stated
        return changed


def _in_si(option: Option | None, key: str, value: Any) -> Any:
    """Value of a key in SI; a list of values, or a text in place of a number, as it is."""
    if option is not None:
        with suppress(FaultError):
            return si_value(option, key.rpartition(".")[2], value)
    return unmarked(value)


def for_each_planet(tables: dict[str, Any]) -> dict[str, Any]:
    """Tables in which one text for the errors of all planets is a list with one for each."""
    stages = tables.get("planets")
    for body in stages.values() if isinstance(stages, dict) else ():
        for name in ("pin_errors", "thickness_errors"):
            count = body.get("count") if isinstance(body, dict) else None
            count = count.value if isinstance(count, Plain) else count
            if isinstance(count, int) and isinstance(body.get(name), str):
                body[name] = [body[name]] * min(max(count, 1), 99)
    return tables


def stated_assumptions(case: PartsBase) -> Iterator[Assumption]:
    """Reasons in ``[assumed]`` with the values they refer to."""
    for key, why in case.data.get("assumed", {}).items():
        *names, name = key.split(".")
        value: Any = case.data
        for each in (*names, name):
            value = value.get(each) if isinstance(value, Mapping) else None
        blank = value is None or isinstance(value, Mapping)
        text = "" if blank else written_value(value, case.option_of(key)).strip('"')
        yield Assumption(key, text, "assumed", why)


def default_assumptions(case: MachineCase) -> Iterator[Assumption]:
    """What the case does not give, and what is estimated in its place."""
    for name, shaft in case.shafts.items():
        if shaft.is_rigid:
            why = "a shaft without sections"
            yield Assumption(f"shafts.{name}", "rigid", "default", why)
    for name, bearing in case.bearings.items():
        if bearing.is_default:
            why = "a bearing without stiffness or type is stiff"
            yield Assumption(f"bearings.{name}", "1e9 N/m", "default", why)
        for key, value, why in _estimates(getattr(bearing.rolling, "assumptions", ())):
            yield Assumption(f"bearings.{name}.{key}", value, "default", why)
    for name, stage in case.stages.items():
        for role in ("sun", "ring", "carrier"):
            support = case.bearings.get(f"{name}_{role}")
            if support is not None and support.radial_stiffness is not None:
                value = f"{support.radial_stiffness:g} N/m"
                reason = f"support of shaft {stage.shaft_of(role)}, which has no bearing"
                yield Assumption(f"bearings.{name}_{role}", value, "default", reason)
        if case.lone_stage is None:
            reason = "planets stay at their angles while teeth turn: Coriolis forces are left out"
            yield Assumption(f"planets.{name}: carrier", "fixed position", "default", reason)
        yield from _of_stage(case, f"planets.{name}", case.data["planets"][name])
        if stage.is_stepped:
            reason = "ring meshes begin their cycle with the sun mesh of the first planet"
            yield Assumption(f"planets.{name}: phase of both gears", "0", "default", reason)
    yield from backlash_assumptions(case)
    if case.housing is None:
        yield Assumption("housing", "rigid", "default", "without [housing]")


def _of_stage(case: MachineCase, key: str, body: Mapping[str, Any]) -> Iterator[Assumption]:
    """What a stage does not give of its pins, its carrier and its gears."""
    if "pin_stiffness" not in body:
        yield Assumption(f"{key}.pin_stiffness", f"{STIFF:g} N/m", "default", "stiff")
    if "pin_clearance" not in body:
        yield Assumption(f"{key}.pin_clearance", "0 um", "default", "planets without clearance")
    for name in ("carrier_mass", "carrier_moment_of_inertia"):
        if name not in body:
            reason = "a steel disc of the radius of the pins and the face width of the planets"
            yield Assumption(f"{key}.{name}", "", "default", reason)
    for role in ("sun", "planet", "ring_planet", "ring"):
        gear = body.get(role)
        if gear is not None and "mass" not in case.data["gears"][str(gear)]:
            yield Assumption(f"gears.{gear}.mass", "", "default", "a solid body")
    if case.lone_stage is not None and not body.get("helix_angle"):
        why = "axial motion and tilting of the members are left out"
        yield Assumption(f"{key}: motion", "in the plane", "default", why)


def backlash_assumptions(case: PartsBase) -> Iterator[Assumption]:
    """Usual backlash of the meshes with computed teeth for which the case gives none."""
    usual = {}
    for key, pair, _ in case.mesh_pairs():
        group, _, name = key.partition(".")
        tables = case.data.get("dynamics", {}), case.data[group][name]
        if pair.gears.kind == "spur" and not any("backlash" in table for table in tables):
            usual[f"{key}.backlash"] = pair.dynamics.backlash
    for key, value in usual.items():
        if value is not None:
            yield Assumption(key, display(value, "m"), "default", USUAL_GEARS)


def _estimates(texts: Iterable[str]) -> Iterator[tuple[str, str, str]]:
    """Key, value and reason of estimates such as ``balls = 8, estimated: usual filling``."""
    for text in texts:
        key, _, value_and_reason = text.partition(" = ")
        value, _, why = value_and_reason.partition(", ")
        yield key, value, why
