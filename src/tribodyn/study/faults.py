"""Translate what pydantic reports into problems that name key, limit and remedy."""

from __future__ import annotations

import difflib
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from tribodyn.errors import Problem
from tribodyn.study.section import Section
from tribodyn.study.values import written


def section_at(model: type[BaseModel], path: tuple[str, ...]) -> type[Section] | None:
    """Return the section class at a dotted path below ``model``, or None."""
    section: Any = model
    for name in path:
        field = section.model_fields.get(name)
        kinds = getattr(field.annotation, "__args__", (field.annotation,)) if field else ()
        section = next((k for k in kinds if isinstance(k, type) and issubclass(k, Section)), None)
        if section is None:
            return None
    return section  # type: ignore[no-any-return]


def _homes(model: type[BaseModel], name: str, path: tuple[str, ...] = ()) -> list[str]:
    """List the tables that have a key called ``name``."""
    section = section_at(model, path)
    found = []
    for key in section.model_fields if section else ():
        if section_at(model, (*path, key)) is not None:
            found += _homes(model, name, (*path, key))
        elif key == name:
            found.append(f"[{'.'.join(path)}]")
    return found


def _unknown(model: type[BaseModel], path: tuple[str, ...], value: Any) -> Problem:
    *table, name = path
    section = section_at(model, tuple(table))
    known = list(section.model_fields) if section else []
    shown = f"{name} = {written(value)}" if not isinstance(value, dict) else f"table [{name}]"
    place = f"[{'.'.join(table)}]" if table else "the top of the file"
    why = f"{place} has: {', '.join(known)}"
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.6)
    if near:
        return Problem(f"{shown}: unknown key", "", why, f'Did you mean "{near[0]}"?')
    homes = _homes(model, name)
    remedy = f"It belongs to {' or '.join(homes)}" if homes else "Remove it"
    return Problem(f"{shown}: unknown key", "", why, remedy)


def _missing(model: type[BaseModel], path: tuple[str, ...]) -> Problem:
    *table, name = path
    wanted = section_at(model, path)
    if wanted is not None:
        needed = [key for key, field in wanted.model_fields.items() if field.is_required()]
        remedy = f"Add it with {', '.join(needed)}" if needed else "Add it"
        return Problem(f"the table [{'.'.join(path)}] is missing", remedy=remedy)
    section = section_at(model, tuple(table))
    spec = section.spec(name) if section else None
    if spec is None:
        return Problem(f"{name} is missing", remedy="Add it")
    example = spec.example or '"..."'
    place = f" to [{'.'.join(table)}]" if table else ""
    why = f"{spec.meaning}: no default exists" if spec.meaning else ""
    return Problem(f"{name} is missing", "", why, f"Add for example {name} = {example}{place}")


def _one(model: type[BaseModel], error: ErrorDetails) -> Problem:
    path = tuple(str(part) for part in error["loc"])
    if error["type"] == "tribodyn":
        told = error["ctx"]
        return Problem(told["what"], "", told["why"], told["remedy"])
    if error["type"] == "missing":
        return _missing(model, path)
    if error["type"] == "extra_forbidden":
        return _unknown(model, path, error["input"])
    shown = f"{path[-1]} = {written(error['input'])}"
    if error["type"] in ("model_type", "dict_type", "model_attributes_type"):
        return Problem(shown, "", f"{path[-1]} is a table", f"Write [{'.'.join(path)}]")
    return Problem(shown, "", error["msg"], "Correct the value")


def translate(model: type[BaseModel], error: ValidationError) -> list[tuple[str, Problem]]:
    """Turn a pydantic error into problems with the key of each."""
    details = error.errors(include_url=False)
    return [(".".join(str(p) for p in one["loc"]), _one(model, one)) for one in details]
