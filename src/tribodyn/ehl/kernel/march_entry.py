"""Entry from Python to the compiled transient contact."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numba as nb
import numpy as np
from numpy.typing import NDArray

from tribodyn.compiled import source_digest
from tribodyn.ehl.kernel.coarse import no_coarse
from tribodyn.ehl.kernel.film_sum import film_plan, influence
from tribodyn.ehl.kernel.film_tangent import film_tangent
from tribodyn.ehl.kernel.instant import instant_work
from tribodyn.ehl.kernel.krylov import newton_work
from tribodyn.ehl.kernel.newton import CONVERGED, newton_level
from tribodyn.ehl.kernel.options import JIT
from tribodyn.ehl.kernel.squeeze import CURVATURE, LOAD, SPEED, march, settle

__all__ = ["level_contact", "march_contact", "settle_contact", "tangent_of_film"]

Array = NDArray[np.float64]

_COMMON = (
    "options", "elementary", "transform", "film_sum", "oil", "reynolds", "band", "dense",
    "coarse", "krylov", "transfer", "outlet", "flooded_inlet", "march_entry",
)  # fmt: skip
_FOLDER = Path(__file__).parent


def _build_march(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def march_contact(
        n: int, start: float, dx: float, reference: float, lam: float, oil: Array, limits: Array,
        imposed: bool, flooded: bool, time: Array, table: Array, rough: Any, halvings: int,
        every: int, P: Array, H: Array, state: Array, records: Array, pressures: Array,
        films: Array,
    ) -> tuple[int, int]:  # fmt: skip
        """March a contact, see :func:`tribodyn.ehl.kernel.squeeze.march`.

        ``reference`` is the distance, in b, at which the deflection is taken as zero.
        """
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        K = influence(n, dx) + dx * np.log(reference) / np.pi
        return march(
            n, start, dx, lam, oil, K, film_plan(n, K), limits, imposed, flooded, time, table,
            rough, halvings, every, P, H, state, records, pressures, films,
        )  # fmt: skip

    return march_contact


def _build_settle(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def settle_contact(
        n: int, start: float, dx: float, reference: float, lam: float, oil: Array, limits: Array,
        imposed: bool, flooded: bool, first: Array, row: Array, ratio: float, rough: Any,
        P: Array, H: Array, state: Array,
    ) -> int:  # fmt: skip
        """Carry a steady state from the inputs ``first`` to those of ``row``.

        Load, speed and curvature go by factors of at most ``ratio``, all others linearly in as
        many steps; a step that fails is halved.
        """
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        K = influence(n, dx) + dx * np.log(reference) / np.pi
        plan, work = film_plan(n, K), instant_work(n)
        p, h, trial, now = P.copy(), H.copy(), state.copy(), row.copy()
        furthest = 0.0
        for c in (LOAD, SPEED, CURVATURE):
            if first[c] > 0.0 and row[c] > 0.0:
                furthest = max(furthest, abs(np.log(row[c] / first[c])))
        largest = 1.0 / max(1.0, np.ceil(furthest / np.log(ratio)))
        done, part = 0.0, largest
        while done < 1.0:
            reached = min(1.0, done + part)
            if reached > 1.0 - 1e-9:
                reached = 1.0
            for c in range(row.size):
                if c in (LOAD, SPEED, CURVATURE) and first[c] > 0.0:
                    now[c] = first[c] * (row[c] / first[c]) ** reached
                else:
                    now[c] = first[c] + reached * (row[c] - first[c])
            p[:], h[:], trial[:] = P, H, state
            status = settle(
                n, start, dx, lam, oil, K, plan, limits, imposed, flooded, now, rough, work, p, h,
                trial,
            )  # fmt: skip
            if status != CONVERGED:
                part *= 0.5
                if part < 1e-3:
                    return status
                continue
            P[:], H[:], state[:] = p, h, trial
            done = reached
            part = min(2.0 * part, largest)
        return CONVERGED

    return settle_contact


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


def _build_level(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def level_contact(
        n: int, dx: float, lam: float, u: float, load: float, tail: float, oil: Array,
        shape: Array, limits: Array, P: Array, H: Array, state: Array,
    ) -> int:  # fmt: skip
        """Solve a steady contact from a state nearby.

        The arguments are those of :func:`tribodyn.ehl.kernel.newton.newton_level`.
        """
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        K = influence(n, dx)
        return newton_level(
            n, dx, lam, u, 0.0, load, True, tail, oil, shape, np.zeros(n + 1), K,
            film_plan(n, K), limits, no_coarse(), newton_work(n), P, H, state,
        )  # fmt: skip

    return level_contact


_MARCH = source_digest(_FOLDER, (*_COMMON, "newton", "profile", "instant", "squeeze"))
march_contact = _build_march(_MARCH)
settle_contact = _build_settle(_MARCH)
level_contact = _build_level(source_digest(_FOLDER, (*_COMMON, "newton")))
tangent_of_film = _build_tangent(source_digest(_FOLDER, (*_COMMON, "film_tangent")))
