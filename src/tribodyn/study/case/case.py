"""The case: user input, checked and in SI, with derived objects as properties."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import replace
from functools import cached_property
from inspect import Signature
from typing import Any, ClassVar, Literal, Self

from tribodyn.aliases import with_old_names
from tribodyn.errors import InputError, Problem
from tribodyn.study.case import to_models
from tribodyn.study.case.case_data import CaseData
from tribodyn.study.case.checks import cross_problems
from tribodyn.study.case.gears import is_needed, with_gear_defaults
from tribodyn.study.case.hypoid import torque_problem
from tribodyn.study.case.provenance import (
    changed_after,
    effective_values,
    reason_faults,
    without_records,
)
from tribodyn.study.case.section import choices, section_at, signature_of
from tribodyn.study.case.user_input import Source, UserInput, unsound
from tribodyn.study.case.values import (
    FaultError,
    Plain,
    correct_keys,
    read_fields,
    read_value,
    unknown_key,
    with_typed_keys,
)

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
        origin = source or Source()
        if problems := list(unsound(data)):
            raise InputError(origin.place(problems))
        data, misspelt, typed_keys = correct_keys(data, Case)
        stated, problems, spread_faults = self._take(source, data)
        records = {name: data[name] for name in ("assumed",) if name in data}
        inputs = UserInput({**self.data, **records})
        complete = with_gear_defaults(inputs)
        body = {name: value for name, value in complete.data.items() if name != "assumed"}
        chosen = choices(complete)
        vars(self).update(read_fields(type(self), body, "", chosen, problems))
        problems = [
            (key, torque_problem(key, problem, inputs))
            for key, problem in problems
            if is_needed(key, inputs.get("gears.kind"))
        ]
        problems += [*misspelt, *reason_faults(self.data.get("assumed", {}))]
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
            raise InputError(origin.place(with_typed_keys(problems, typed_keys)))
        self._effective = effective_values(self)
        self._settle(stated)

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without derived attributes."""
        return {key: value for key, value in vars(self).items() if key not in _DERIVED}

    def _with_numbers(self, changes: Mapping[str, Any]) -> Self | None:
        """Return a copy with changed numbers, checked by a fast path; None if that does not apply.

        It applies where numbers replace numbers outside ``[gears]`` without other effects: which
        keys are present decides the rest of a case.
        """
        base = self._stated.base
        if not base or self.origin not in (None, base.get("origin")):
            return None
        changed: Self = object.__new__(type(self))
        vars(changed).update(self.__getstate__(), _shared=vars(self).setdefault("_shared", {}))
        numbers = {}
        # Convert NumPy floats.
        changes = {key: float(v) if isinstance(v, float) else v for key, v in changes.items()}
        for key, value in changes.items():
            table, _, name = key.partition(".")
            spec, old = self.option_of(key), self._user_input.get(key)
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
        changed._effective, changed._changed = self._effective | numbers, None
        changed._user_input = self._user_input.with_numbers(changes)
        vars(changed)["data"] = without_records(changed._user_input.data)
        changed._source = self._source.with_replaced(changes, "replace:")
        changed_after(self, changed, numbers)
        return changed

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
