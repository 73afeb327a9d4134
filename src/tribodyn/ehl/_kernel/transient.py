"""The contact over time from Python."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.ehl._kernel.elementary import BURIED, JIT
from tribodyn.ehl._kernel.film_sum import film_plan, influence
from tribodyn.ehl._kernel.inlet import flooded_inlet
from tribodyn.ehl._kernel.instant import instant_work, solve_instant
from tribodyn.ehl._kernel.newton import CONVERGED, ROUNDED
from tribodyn.ehl._kernel.reynolds import oil_state
from tribodyn.ehl._kernel.transfer import central
from tribodyn.types import Array


@nb.njit(**BURIED)
def add_profile(
    n: int, start: float, dx: float, shift: float, factor: float, heights: Array, first: float,
    spacing: float, periodic: bool, shape: Array,
) -> None:  # fmt: skip
    """Add the heights of a profile that has moved by ``shift`` to the gap."""
    size = heights.size
    if size < 4:
        return
    for i in range(n + 1):
        place = (start + i * dx - shift - first) / spacing
        if not periodic and (place < 0.0 or place > size - 1.0):
            continue
        j = int(np.floor(place))
        if not periodic:
            j = min(max(j, 1), size - 3)
        f = place - j
        a = heights[(j - 1) % size]
        b = heights[j % size]
        c = heights[(j + 1) % size]
        d = heights[(j + 2) % size]
        shape[i] += factor * (
            b * (f + 1.0) * (f - 1.0) * (f - 2.0) * 0.5
            - c * (f + 1.0) * f * (f - 2.0) * 0.5
            + d * (f + 1.0) * f * (f - 1.0) / 6.0
            - a * f * (f - 1.0) * (f - 2.0) / 6.0
        )


# What calls the solver is inlined: every layer of calls would be optimised anew as a whole.

#: Columns of the table of inputs: load over that of the reference, offset, speed over that of the
#: reference, reference radius over radius, distances travelled by the two surfaces, factor of
#: the heights of both.
LOAD, OFFSET, SPEED, CURVATURE, FIRST_SHIFT, SECOND_SHIFT, HEIGHT = 0, 1, 2, 3, 4, 5, 6
#: Columns of the table.
INPUTS = 7
#: Columns of the record: offset, sum of the pressures, load with that of the inlet, central and
#: minimum film, last free node, Newton steps, flux error, parts of the step, highest pressure,
#: share of the load in the last sixteenth of the grid, nodes of cavities before the outlet.
RECORD = 12
#: Load of the reference, in b p_h.
_FULL = 0.5 * np.pi
#: Flux error that is accepted where rounding keeps it above its tolerance.
_ROUNDED_FLUX = 1e-4


@nb.njit(**BURIED)
def _gap(n: int, start: float, dx: float, row: Array, rough: Any, shape: Array) -> None:
    """Gap of the undeformed bodies at one instant."""
    for i in range(n + 1):
        x = start + i * dx
        shape[i] = 0.5 * row[CURVATURE] * x * x
    ends = rough[2]
    for side in range(2):
        heights = rough[0] if side == 0 else rough[1]
        add_profile(
            n, start, dx, row[FIRST_SHIFT + side], row[HEIGHT], heights, ends[side, 0],
            ends[side, 1], ends[side, 2] > 0.0, shape,
        )  # fmt: skip


@nb.njit(inline="always", **BURIED)
def _inlet(
    start: float, film: float, carried: float, lam: float, flooded: bool, row: Array
) -> tuple[float, float]:
    """Pressure at the first node, and the load before it, at a film and load of the contact."""
    if not flooded or row[SPEED] == 0.0:
        return 0.0, 0.0
    s = np.sqrt(max(carried, 0.0) / row[CURVATURE])
    s = min(s, 0.99 * abs(start))
    pressure, outside, _, _, _, _ = flooded_inlet(
        start, max(film, 0.0), lam * row[SPEED], row[CURVATURE], s
    )
    return pressure, outside


@nb.njit(inline="always", **BURIED)
def _solve(
    n: int, start: float, dx: float, lam: float, oil: Array, K: Array, plan: Array, limits: Array,
    imposed: bool, flooded: bool, row: Array, film: float, load: float, squeeze: float,
    history: Array, shape: Array, work: Any, P: Array, H: Array, cavity: Array, state: Array,
) -> int:  # fmt: skip
    """Solve one instant; ``state[5]`` receives the load with that of the inlet."""
    carried = row[LOAD] if imposed else load / _FULL
    tail, outside = _inlet(start, film, carried, lam, flooded, row)
    given = _FULL * row[LOAD] - outside if imposed else row[OFFSET]
    status = solve_instant(
        n, dx, lam, row[SPEED], squeeze, given, imposed, tail, oil, shape, history, K,
        plan, limits, work, P, H, cavity, state,
    )  # fmt: skip
    state[5] += outside
    if status == ROUNDED and state[4] < _ROUNDED_FLUX:
        status = CONVERGED
    return status


@nb.njit(inline="always", **BURIED)
def _settle(
    n: int, start: float, dx: float, lam: float, oil: Array, K: Array, plan: Array, limits: Array,
    imposed: bool, flooded: bool, row: Array, rough: Any, shape: Array, history: Array, work: Any,
    P: Array, H: Array, cavity: Array, state: Array,
) -> int:  # fmt: skip
    """Steady state under the inputs of one row, from a state nearby."""
    _gap(n, start, dx, row, rough, shape)
    film, status = central(n, start, dx, H), CONVERGED
    for _ in range(40):
        status = _solve(
            n, start, dx, lam, oil, K, plan, limits, imposed, flooded, row, film, state[5], 0.0,
            history, shape, work, P, H, cavity, state,
        )  # fmt: skip
        before, film = film, central(n, start, dx, H)
        if status != CONVERGED or not flooded or abs(film - before) < 1e-13 * abs(film):
            break
    return status


@nb.njit(inline="always", **BURIED)
def carry(
    n: int, start: float, dx: float, lam: float, oil: Array, K: Array, plan: Array, limits: Array,
    imposed: bool, flooded: bool, ratio: float, table: Array, rough: Any, work: Any, P: Array,
    H: Array, state: Array,
) -> int:  # fmt: skip
    """Carry a steady state, in place, from the inputs of the first row to those of the last."""
    first, last, now = table[0], table[table.shape[0] - 1], np.empty(table.shape[1])
    shape, history, cavity = np.empty(n + 1), np.zeros(n + 1), np.zeros(n + 1)
    p, h, trial = np.empty(n + 1), np.empty(n + 1), np.empty(state.size)
    furthest = 0.0
    for c in range(now.size):
        if c in (LOAD, SPEED, CURVATURE) and first[c] > 0.0 and last[c] > 0.0:
            furthest = max(furthest, abs(np.log(last[c] / first[c])))
    largest = 1.0 / max(1.0, np.ceil(furthest / np.log(ratio)))
    done, part = 0.0, largest
    while done < 1.0:
        reached = done + part
        if reached > 1.0 - 1e-9:
            reached = 1.0
        for c in range(now.size):
            now[c] = first[c] + reached * (last[c] - first[c])
            if c in (LOAD, SPEED, CURVATURE) and first[c] > 0.0:
                now[c] = first[c] * (last[c] / first[c]) ** reached
        p[:], h[:], trial[:] = P, H, state
        status = _settle(
            n, start, dx, lam, oil, K, plan, limits, imposed, flooded, now, rough, shape, history,
            work, p, h, cavity, trial,
        )  # fmt: skip
        if status != CONVERGED:
            cavity[:] = 0.0
            part *= 0.5
            if part < 1e-3:
                return status
            continue
        P[:], H[:], state[:] = p, h, trial
        done = reached
        part = min(2.0 * part, largest)
    return CONVERGED


@nb.njit(**BURIED)
def _keep(
    n: int, start: float, dx: float, P: Array, H: Array, cavity: Array, state: Array, parts: int,
    record: Array,
) -> None:  # fmt: skip
    k = int(state[1])
    total, highest, late = 0.0, 0.0, 0.0
    for i in range(k + 1):
        total += P[i]
        highest = max(highest, P[i])
        if i > n - n // 16:
            late += P[i]
    least = H[0]
    for i in range(min(k + 2, n + 1)):
        least = min(least, H[i])
    record[0], record[1], record[2] = state[0], dx * total, state[5]
    record[3], record[4] = central(n, start, dx, H), least
    record[5], record[6], record[7] = state[1], state[2], state[4]
    record[8], record[9] = parts, highest
    record[10] = late / total if total > 0.0 else 0.0
    record[11] = np.sum(cavity)


@nb.njit(inline="always", **BURIED)
def march(
    n: int, start: float, dx: float, lam: float, oil: Array, K: Array, plan: Array, limits: Array,
    imposed: bool, flooded: bool, time: Array, table: Array, rough: Any, halvings: int, every: int,
    work: Any, P: Array, H: Array, state: Array, records: Array, pressures: Array, films: Array,
) -> tuple[int, int]:  # fmt: skip
    """March a contact over time, from the state of the first instant."""
    cavity, broken = np.zeros(n + 1), np.zeros(n + 1)
    shape, history = np.empty(n + 1), np.empty(n + 1)
    lneta, dlneta, rho, drho = np.empty((4, n + 1))
    before, earlier = np.empty(n + 1), np.empty(n + 1)
    p, h, trial = np.empty(n + 1), np.empty(n + 1), np.empty(state.size)
    row = np.empty(table.shape[1])
    oil_state(n, P, oil, lneta, dlneta, rho, drho)
    for i in range(n + 1):
        before[i] = rho[i] * H[i]
    film, film_before = central(n, start, dx, H), 0.0
    load, load_before = state[5], 0.0
    last = 0.0
    _keep(n, start, dx, P, H, cavity, state, 0, records[0])
    if every > 0:
        pressures[0], films[0] = P, H
    for m in range(1, time.size):
        whole = time[m] - time[m - 1]
        done, part, parts, steps = 0.0, 1.0, 0, 0.0
        while done < 1.0:
            width = part * whole
            reached = done + part
            for c in range(row.size):
                row[c] = table[m - 1, c] + reached * (table[m, c] - table[m - 1, c])
            _gap(n, start, dx, row, rough, shape)
            if last == 0.0:
                squeeze, expected, expected_load = dx / width, film, load
                for i in range(n + 1):
                    history[i] = squeeze * before[i]
            else:
                r = width / last
                squeeze = dx / width * (1.0 + 2.0 * r) / (1.0 + r)
                near, far = dx / width * (1.0 + r), dx / width * r * r / (1.0 + r)
                for i in range(n + 1):
                    history[i] = near * before[i] - far * earlier[i]
                expected = film + r * (film - film_before)
                expected_load = load + r * (load - load_before)
            p[:], h[:], broken[:], trial[:] = P, H, cavity, state
            status = _solve(
                n, start, dx, lam, oil, K, plan, limits, imposed, flooded, row, expected,
                expected_load, squeeze, history, shape, work, p, h, broken, trial,
            )  # fmt: skip
            if status != CONVERGED:
                part *= 0.5
                if part < 0.5**halvings:
                    return status, m
                continue
            P[:], H[:], cavity[:], state[:] = p, h, broken, trial
            oil_state(n, P, oil, lneta, dlneta, rho, drho)
            for i in range(n + 1):
                earlier[i] = before[i]
                before[i] = rho[i] * H[i]
            film_before, film = film, central(n, start, dx, H)
            load_before, load = load, state[5]
            last, done = width, reached
            parts += 1
            steps += state[2]
        state[2] = steps
        _keep(n, start, dx, P, H, cavity, state, parts, records[m])
        if every > 0 and m % every == 0:
            pressures[m // every], films[m // every] = P, H
    return CONVERGED, time.size - 1


#: Every file whose code ends up in the compiled kernel.
_SOURCES = (
    "elementary", "reynolds", "film_sum", "factors", "linear_solver", "transfer", "inlet",
    "newton", "instant", "transient",
)  # fmt: skip


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


march_contact = _build_march(source_digest(Path(__file__).parent, _SOURCES))
