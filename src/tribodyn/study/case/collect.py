"""Collect model warnings, so that none is lost and none is told twice."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from tribodyn.errors import ModelWarning


@contextmanager
def collected() -> Iterator[list[ModelWarning]]:
    """Collect the model warnings issued inside the block, each once; others pass as usual."""
    found: list[ModelWarning] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ModelWarning)
        try:
            yield found
        finally:
            seen = set()
            others = []
            for record in caught:
                if not isinstance(record.message, ModelWarning):
                    others.append(record)
                elif str(record.message) not in seen:
                    seen.add(str(record.message))
                    found.append(record.message)
    for record in others:
        warnings.warn_explicit(record.message, record.category, record.filename, record.lineno)
