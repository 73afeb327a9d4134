"""Entries from Python to the compiled transient contact and to the tangent of the film."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.ehl.kernel.film_sum import film_plan, influence
from tribodyn.ehl.kernel.film_tangent import film_tangent
from tribodyn.ehl.kernel.instant import instant_work
from tribodyn.ehl.kernel.krylov import newton_work
from tribodyn.ehl.kernel.options import JIT
from tribodyn.ehl.kernel.squeeze import carry, march
from tribodyn.types import Array

_COMMON = (
    "options", "elementary", "transform", "film_sum", "oil", "reynolds", "band", "dense",
    "coarse", "krylov", "transfer", "outlet", "march_entry",
)  # fmt: skip
_FOLDER = Path(__file__).parent


def _build_march(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def march_contact(
        n: int, start: float, dx: float, reference: float, lam: float, oil: Array, limits: Array,
        imposed: bool, flooded: bool, ratio: float, time: Array, table: Array, rough: Any,
        halvings: int, every: int, P: Array, H: Array, state: Array, records: Array,
        pressures: Array, films: Array,
    ) -> tuple[int, int]:  # fmt: skip
        """March a contact over time, or carry a steady one to other inputs."""
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        K = influence(n, dx) + dx * np.log(reference) / np.pi
        plan, work = film_plan(n, K), instant_work(n)
        if time.size == 0:
            status = carry(
                n, start, dx, lam, oil, K, plan, limits, imposed, flooded, ratio, table, rough,
                work, P, H, state,
            )  # fmt: skip
            return status, 0
        return march(
            n, start, dx, lam, oil, K, plan, limits, imposed, flooded, time, table, rough,
            halvings, every, work, P, H, state, records, pressures, films,
        )  # fmt: skip

    return march_contact


def _build_tangent(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def tangent_of_film(
        n: int, start: float, dx: float, lam: float, oil: Array, k: int, tail: float,
        load: float, P: Array, H: Array,
    ) -> tuple[float, int]:  # fmt: skip
        """Slope of the film, see :func:`tribodyn.ehl.kernel.film_tangent.film_tangent`."""
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        K = influence(n, dx)
        return film_tangent(
            n, start, dx, lam, oil, k, tail, load, K, film_plan(n, K), newton_work(n), P, H
        )

    return tangent_of_film


march_contact = _build_march(
    source_digest(_FOLDER, (*_COMMON, "newton", "flooded_inlet", "profile", "instant", "squeeze"))
)
tangent_of_film = _build_tangent(source_digest(_FOLDER, (*_COMMON, "film_tangent")))
