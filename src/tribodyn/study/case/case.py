"""The case: user input, checked and in SI, with derived objects as properties."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import replace
from functools import cached_property, partial
from inspect import Signature
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from tribodyn.aliases import with_old_names
from tribodyn.errors import InputError, Problem
from tribodyn.study.case import to_models
from tribodyn.study.case.case_data import CaseData
from tribodyn.study.case.changes import changed_tables
from tribodyn.study.case.checks import cross_problems
from tribodyn.study.case.gears import is_needed, with_gear_defaults
from tribodyn.study.case.hypoid import torque_problem
from tribodyn.study.case.provenance import (
    changed_after,
    effective_values,
    read_stated,
    reason_faults,
    settled,
    spec_at,
    spec_of,
    tables,
    without_records,
)
from tribodyn.study.case.section import choices, section_at, signature_of
from tribodyn.study.case.user_input import (
    Source,
    UserInput,
    plain,
    unsound,
    without_spread,
)
from tribodyn.study.case.values import (
    FaultError,
    Plain,
    correct_keys,
    read_fields,
    read_value,
    unknown_key,
    with_typed_keys,
)

if TYPE_CHECKING:
    from tribodyn.model import Option

#: Attributes derived from the tables, which are not pickled.
_DERIVED = {
    "_shared",
    *(name for name, attribute in vars(CaseData).items() if isinstance(attribute, cached_property)),
}


@with_old_names
class Case(CaseData, case=True):
    """One gear pair under one load: frozen, checked, in SI.

    Created by :func:`tribodyn.load_case`, or from nested keywords: a float is SI, text and pint
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
        Listing every problem with its location, the allowed range and the remedy.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> case.gears.pinion.teeth
    16
    """

    __signature__: ClassVar[Signature]
    lumped: ClassVar[Literal[True]] = True  #: whether ``[dynamics]`` names a lumped structure

    def __init__(self, source: Source | None = None, /, **data: Any) -> None:
        problems = list(unsound(data))
        if problems:
            raise InputError((source or Source()).place(problems))
        data, misspelt, typed_keys = correct_keys(data)
        central_values, self._spread, spread_faults = without_spread(data)
        inputs = UserInput(central_values if source is not None else plain(central_values))
        source = source or Source()
        stated, problems = read_stated(inputs.data, partial(spec_at, inputs))
        complete = with_gear_defaults(inputs)
        body = without_records(complete.data)
        marks = body.pop("assumed", {})
        chosen = choices(complete)
        vars(self).update(read_fields(type(self), body, "", chosen, problems))
        problems = [
            (key, torque_problem(key, problem, inputs))
            for key, problem in problems
            if is_needed(key, inputs.get("gears.kind"))
        ]
        problems += [*misspelt, *reason_faults(marks)]
        spread_keys = {key for key, _ in spread_faults}
        problems = [fault for fault in problems if fault[0] not in spread_keys] + spread_faults
        problems += self._spread_faults({key for key, _ in problems})
        readable = not any(key.startswith("gears") for key, _ in problems)
        problems += cross_problems(inputs, chosen, {key for key, _ in problems})
        if not problems:
            problems = to_models.case_problems(self)
        elif readable and self.gears is not None:
            reported = {key for key, _ in problems}
            problems += [
                fault for fault in to_models.gear_problems(self.gears) if fault[0] not in reported
            ]
        if problems:
            raise InputError(source.place(with_typed_keys(problems, typed_keys)))
        self._source, self._assumed = source, dict(marks)
        self._effective = effective_values(self)
        self._stated, stale = settled(self, marks, inputs, stated)
        for key in stale:
            del self._assumed[key]
        self._user_input = UserInput({**inputs.data, **tables(self._stated, self._assumed)})

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without derived attributes."""
        return {key: value for key, value in vars(self).items() if key not in _DERIVED}

    def replace(self, changes: Mapping[str, Any], *, by: str = "") -> Case:
        """Return a new case with some values changed; it is checked as a whole.

        Parameters
        ----------
        changes : mapping
            Dotted key to value: a float in SI, text with a unit, a pint quantity, or None to go
            back to the default. A changed value is no longer marked as assumed or documented by
            the origin of the case.
        by : str
            Source of the change, for messages, for example ``"--set"``; then a bare number for
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
        if not by and (changed := self._with_numbers(changes)) is not None:
            return changed
        source = self._source.with_replaced(changes, by or "replace:")
        inputs = self._user_input.data
        return type(self)(source, **changed_tables(Case, inputs, changes, self._spread, by))

    def _with_numbers(self, changes: Mapping[str, Any]) -> Case | None:
        """Return a copy with changed numbers, checked by a fast path; None if that does not apply.

        It applies where numbers replace numbers outside ``[gears]`` without other effects: which
        keys are present decides the rest of a case.
        """
        base = self._stated.base
        if not base or self.origin not in (None, base.get("origin")):
            return None
        changed: Case = object.__new__(type(self))
        vars(changed).update(self.__getstate__(), _shared=vars(self).setdefault("_shared", {}))
        numbers = {}
        # Convert NumPy floats.
        changes = {key: float(v) if isinstance(v, float) else v for key, v in changes.items()}
        for key, value in changes.items():
            table, _, name = key.partition(".")
            spec, old = spec_of(self, key), self._user_input.get(key)
            numeric = type(value) is float and spec is not None and spec.kind == "number"
            indirect = table in ("gears", "faults") or key in self._spread or key in self._assumed
            if not numeric or indirect or old is None or self._effective.get(key) is None:
                return None
            try:
                numbers[key] = read_value(spec, name, Plain(value)) if spec else value
            except FaultError:
                return None
            section = copy(getattr(changed, table))
            vars(section)[name] = numbers[key]
            vars(changed)[table] = section
        if to_models.case_problems(changed):
            return None
        changed._files = self._named_files()
        changed._effective, changed._changed = self._effective | numbers, None
        changed._user_input = self._user_input.with_numbers(changes)
        changed._source = self._source.with_replaced(changes, "replace:")
        changed_after(self, changed, numbers)
        return changed

    def option_of(self, key: str) -> Option | None:
        """Unit and range of a key.

        Parameters
        ----------
        key : str
            Dotted, such as ``"operation.torque"``.

        Returns
        -------
        Option or None
            None where the case has no such key.
        """
        return spec_of(self, key)

    def _unknown_key(self, key: str) -> Problem:
        path = tuple(key.split("."))
        if (section := section_at(path)) is not None:
            remedy = f"Name one of its keys, such as {key}.{next(iter(section.fields))}"
            return Problem(f"{key} is a table", "", "", remedy)
        while section_at(path[:-1]) is None:
            path = path[:-1]
        return replace(unknown_key(path, None), what=f"{'.'.join(path)}: unknown key")


Case.__signature__ = signature_of(Case)
Case.root = Case
