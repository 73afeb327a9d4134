"""All keys of the case file with their Specs: what documentation and ``explain`` are made of."""

from __future__ import annotations

from collections.abc import Iterator

from tribodyn.study.case import Case
from tribodyn.study.derived import BASIS
from tribodyn.study.faults import section_at
from tribodyn.study.fields import Spec
from tribodyn.study.section import Section


def case_keys() -> Iterator[tuple[str, Spec, str]]:
    """Walk over all keys of the case file."""
    yield from _walk(Case, ())


def _walk(section: type[Section], path: tuple[str, ...]) -> Iterator[tuple[str, Spec, str]]:
    for name, field in section.model_fields.items():
        spec = section.spec(name)
        inner = section_at(Case, (*path, name))
        if spec is not None:
            yield (
                ".".join((*path, name)),
                spec,
                _default(spec, name, field.is_required(), field.default),
            )
        elif inner is not None:
            yield from _walk(inner, (*path, name))


def _default(spec: Spec, name: str, required: bool, value: object) -> str:
    if required:
        return "required"
    if value is None:
        return f"from {BASIS[name]}" if name in BASIS else "none"
    return spec.show(value)


def reference_tables() -> str:
    """Write all keys as Markdown tables, one for each table of the case file."""
    lines: list[str] = []
    table = ""
    for key, spec, default in case_keys():
        place, _, name = key.rpartition(".")
        if place != table or not lines:
            table = place
            lines += ["", f"### `[{place}]`" if place else "### Top of the file", ""]
            lines += ["| key | symbol | meaning | allowed | default |", "|---|---|---|---|---|"]
        symbol = f"`{spec.symbol}`" if spec.symbol else ""
        row = (f"`{name}`", symbol, spec.meaning, _limits(spec), default)
        lines.append("| " + " | ".join(row) + " |")
    return "\n".join(lines).strip() + "\n"


def _limits(spec: Spec) -> str:
    if spec.names is not None:
        return ", ".join(f"`{name}`" for name in spec.names())
    return f"{spec.allowed()} ({spec.origin})" if spec.origin else spec.allowed()
