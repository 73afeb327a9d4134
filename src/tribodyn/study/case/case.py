"""The case: what the user typed, checked and in SI, with everything derived one call away."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from functools import cached_property
from inspect import Signature
from typing import Any, ClassVar

from tribodyn.errors import InputError, Problem
from tribodyn.study.case import derive
from tribodyn.study.case.checks import cross_problems, left_behind
from tribodyn.study.case.data import CaseData
from tribodyn.study.case.gears import is_needed
from tribodyn.study.case.given import (
    Given,
    Source,
    plain,
    spread_problem,
    unsound,
    without_spread,
)
from tribodyn.study.case.provenance import (
    changed_after,
    effective_values,
    provenance,
    read_stated,
    reason_faults,
    settled,
    spec_of,
    tables,
    without_records,
)
from tribodyn.study.case.section import Table, choices, signature_of
from tribodyn.study.case.values import (
    FaultError,
    Plain,
    as_meant,
    as_typed,
    read_fields,
    read_value,
)
from tribodyn.study.case.write import case_rows, case_table, case_toml

#: What a case keeps that follows from its tables.
_DERIVED = {
    "_shared",
    *(name for name, each in vars(CaseData).items() if isinstance(each, cached_property)),
}
#: Keys whose choice decides which other keys of their table are allowed, beside those that name
#: models.
_DECIDES = ("solver.method",)


class Case(CaseData, whole=True):
    """One gear pair under one load: frozen, checked, in SI.

    Made by :func:`tribodyn.load_case`, or from nested keywords: a float is SI, text and pint
    quantities carry their unit.

    Parameters
    ----------
    source : Source, optional
        Where the values come from; then a bare number for a dimension is refused.
    **data : object
        The tables of the case file.

    Raises
    ------
    InputError
        Listing every fault with its place, the allowed range and the remedy.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> case.gears.pinion.teeth
    16
    """

    __signature__: ClassVar[Signature]

    def __init__(self, source: Source | None = None, /, **data: Any) -> None:
        found = list(unsound(data))
        if found:
            raise InputError((source or Source()).place(found))
        data, misspelt, meant = as_meant(data)
        middles, self._spread, spread_faults = without_spread(data)
        given = Given(middles if source is not None else plain(middles))
        source = source or Source()
        stated, found = read_stated(given)
        body = without_records(given.data)
        marks = body.pop("assumed", {})
        chosen = choices(given)
        vars(self).update(read_fields(type(self), body, "", chosen, found))
        found = [fault for fault in found if is_needed(fault[0], given.get("gears.kind"))]
        found += [*misspelt, *reason_faults(marks)]
        found = [fault for fault in found if fault[0] not in dict(spread_faults)] + spread_faults
        found += self._spread_faults({key for key, _ in found})
        readable = not any(key.startswith("gears") for key, _ in found)
        found += cross_problems(given, chosen, {key for key, _ in found})
        if not found:
            found = derive.case_problems(self)
        elif readable and self.gears is not None:
            told = {key for key, _ in found}
            found += [fault for fault in derive.gear_problems(self.gears) if fault[0] not in told]
        if found:
            raise InputError(source.place(as_typed(found, meant)))
        self._source, self._assumed = source, dict(marks)
        self._effective = effective_values(self)
        self._stated, stale = settled(self, self._effective, given, stated)
        for key in stale:
            del self._assumed[key]
        self._given = Given({**given.data, **tables(self._stated, self._assumed)})

    def _spread_faults(self, faulty: set[str]) -> list[tuple[str, Problem]]:
        """Spread values that reach beyond the range of their key."""
        faults = []
        for key, text in self._spread.items():
            spec = None if key in faulty else spec_of(self, key)
            problem = spread_problem(spec, key, text) if spec else None
            faults += [(key, problem)] if problem else []
        return faults

    def __getstate__(self) -> dict[str, Any]:
        """What makes a case, without what is derived from it."""
        return {key: value for key, value in vars(self).items() if key not in _DERIVED}

    def replace(self, changes: Mapping[str, Any], *, by: str = "") -> Case:
        """Return a new case with some values changed; it is checked as a whole.

        Parameters
        ----------
        changes : mapping
            Dotted key to value: a float in SI, text with a unit, a pint quantity, or None to go
            back to the default. A changed value is no longer marked as assumed, and the origin of
            the case no longer stands for it.
        by : str
            What made the change, for messages, for example ``"--set"``; then a bare number for
            a dimension is refused as in a file.

        Raises
        ------
        InputError
            As for a case file.

        Examples
        --------
        >>> import tribodyn
        >>> rough = tribodyn.load_case("fzg-roughness").replace(
        ...     {"gears.composite_roughness": "0.991 um"})
        >>> round(rough.gears.composite_roughness * 1e6, 3)
        0.991
        """
        if not by and (found := self._with_numbers(changes)) is not None:
            return found
        ready = changes if by else {key: Plain(value) for key, value in changes.items()}
        gone = left_behind(self._given, ready, self._chosen_by(ready))
        spread = {key: text for key, text in self._spread.items() if key not in gone}
        data = self._given.merged({**spread, **dict.fromkeys(gone), **ready})
        if "assumed" in data:
            kept = {k: w for k, w in data["assumed"].items() if k not in changes and k not in gone}
            data["assumed"] = kept
        source = self._source.with_replaced(changes, by or "replace:")
        return type(self)(source, **data)

    def _with_numbers(self, changes: Mapping[str, Any]) -> Case | None:
        """Put numbers in the place of numbers; None where that may change more, or is a fault.

        What is there and what is not decides everything else in a case, but for its gears.
        """
        base = self._stated.base
        if not base or self.origin not in (None, base.get("origin")):
            return None
        found: Case = object.__new__(type(self))
        vars(found).update(self.__getstate__(), _shared=vars(self).setdefault("_shared", {}))
        numbers = {}
        # An item of an array is a number like any other.
        changes = {key: float(v) if isinstance(v, float) else v for key, v in changes.items()}
        for key, value in changes.items():
            table, _, name = key.partition(".")
            spec, old = spec_of(self, key), self._given.get(key)
            same = type(value) is float and spec is not None and spec.kind == "number"
            apart = table == "gears" or key in self._spread or key in self._assumed
            if not same or apart or old is None or self._effective.get(key) is None:
                return None
            try:
                numbers[key] = read_value(spec, name, Plain(value)) if spec else value
            except FaultError:
                return None
            section = copy(getattr(found, table))
            vars(section)[name] = numbers[key]
            vars(found)[table] = section
        if derive.case_problems(found):
            return None
        found._files = self._named_files()
        found._effective, found._changed = self._effective | numbers, None
        found._given = self._given.with_numbers(changes)
        found._source = self._source.with_replaced(changes, "replace:")
        changed_after(self, found, numbers)
        return found

    def _chosen_by(self, changes: Mapping[str, Any]) -> dict[str, str]:
        """Models, laws and methods that changes choose anew, by key; unknown names are left out."""
        selectors = [
            f"{name}.{t.kind.selector}"
            for name, t in self.fields.items()
            if isinstance(t, Table) and t.kind.selector
        ]
        chosen = {}
        for key in (*selectors, *_DECIDES):
            if key not in changes:
                continue
            section, _, name = key.partition(".")
            spec = type(getattr(self, section)).fields[name]
            value = changes[key]
            value = value.value if isinstance(value, Plain) else value
            value = spec.default if value is None else value
            if value in spec.names():
                chosen[key] = value
        return chosen

    def to_toml(self) -> str:
        """Write the complete commented case file; it reads back to an equal case.

        Returns
        -------
        str
            TOML text with value, unit, symbol, meaning and range of every key.
        """
        return case_toml(self)

    def __eq__(self, other: object) -> bool:
        """Cases are equal when all values and what is known of their origin are."""
        if not isinstance(other, Case):
            return NotImplemented
        same = self._effective == other._effective and self._spread == other._spread
        return same and provenance(self) == provenance(other)

    def __hash__(self) -> int:
        """Hash of all values in force."""
        return hash(tuple(self._effective.items()))

    def __repr__(self) -> str:
        """Show a table of all values with units."""
        return case_table(self)

    __str__ = __repr__

    def _repr_html_(self) -> str:
        """Table of all values for notebooks."""
        from tribodyn.record import html_table

        return html_table(f"Case: {self.title}", ("key", "value", "origin"), case_rows(self))


Case.__signature__ = signature_of(Case)
