"""What tests register is forgotten afterwards, so that no other test sees it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import tribodyn.plot
import tribodyn.report  # noqa: F401  # Figures and reports register before anything is forgotten.
from tribodyn.drawing import FIGURES
from tribodyn.dynamics import STRUCTURES
from tribodyn.ehl import FILM_MODELS
from tribodyn.friction import LAWS
from tribodyn.friction.benedict_kelly import VARIANTS
from tribodyn.machine import COUPLINGS
from tribodyn.stiffness import MODELS
from tribodyn.study import SUMMARY
from tribodyn.study.pipeline.summary_figures import MEASURES, PARTS

__all__ = ["as_before"]


@contextmanager
def as_before() -> Iterator[None]:
    """Bring the registries back to what they held."""
    registries: list[Any] = [
        COUPLINGS,
        FIGURES,
        STRUCTURES,
        FILM_MODELS,
        LAWS,
        VARIANTS,
        MODELS,
        MEASURES,
    ]
    before = [dict(registry.all()) for registry in registries]
    figures, parts = dict(SUMMARY), {kind: dict(PARTS[kind]["figures"]) for kind in PARTS}
    try:
        yield
    finally:
        for registry, items in zip(registries, before, strict=True):
            registry._items.clear()
            registry._items.update(items)
            registry.version += 1
        SUMMARY.clear()
        SUMMARY.update(figures)
        for kind, each in parts.items():
            PARTS[kind]["figures"] = each
