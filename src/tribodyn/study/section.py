"""What every section of the case file shares: frozen, closed, each value checked by its Spec."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationInfo, field_validator

from tribodyn.errors import InputError, Problem
from tribodyn.study.fields import Spec
from tribodyn.study.values import read_value


class Section(BaseModel):
    """Base of the sections of a case file."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    @field_validator("*", mode="before")
    @classmethod
    def _read(cls, value: Any, info: ValidationInfo) -> Any:
        spec = cls.spec(info.field_name or "")
        return value if spec is None else read_value(spec, info.field_name or "", value)

    def __setattr__(self, name: str, value: Any) -> None:
        """Refuse a new value: a case stays what it was when it was checked."""
        if name.startswith("_"):
            super().__setattr__(name, value)
            return
        what = f"{name} cannot be set: a case does not change"
        remedy = 'Make a changed one: case = case.replace({"operation.torque": "120 N*m"})'
        raise InputError(Problem(what, name, "", remedy))

    def __dir__(self) -> list[str]:
        """Values and what can be done with them."""
        own = {n for n in dir(type(self)) if not n.startswith("_") and not hasattr(BaseModel, n)}
        return sorted({*own, *type(self).model_fields})

    @classmethod
    def spec(cls, name: str) -> Spec | None:
        """Return the Spec behind a field, or None for a field that is itself a section."""
        extra = cls.model_fields[name].json_schema_extra
        return extra["spec"] if isinstance(extra, dict) else None  # type: ignore[return-value]

    @classmethod
    def specs(cls) -> Iterator[tuple[str, Spec]]:
        """Walk over the plain fields and their Specs, in order."""
        for name in cls.model_fields:
            spec = cls.spec(name)
            if spec is not None:
                yield name, spec
