"""The contact over time from Python: the squeeze term by a backward formula of second order.

Inputs are rows of a table over time, linear in between. The steps are those of the table; one that
fails is halved. The first step is of first order, which keeps the second order of the whole.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.ehl._kernel.elementary import INNER, JIT, SOURCES
from tribodyn.ehl._kernel.film_sum import Grid, film_plan, influence
from tribodyn.ehl._kernel.grid_transfer import central
from tribodyn.ehl._kernel.inlet import flooded_inlet
from tribodyn.ehl._kernel.linear_solver import no_coarse
from tribodyn.ehl._kernel.newton import (
    CONVERGED,
    ROUNDED,
    Equation,
    Limits,
    NewtonWork,
    newton_level,
    newton_work,
)
from tribodyn.ehl._kernel.reynolds import oil_state
from tribodyn.types import Array, Index

_DIGEST = source_digest(Path(__file__).parent, (*SOURCES, "transient"))

# What calls the solver is inlined: every layer of calls would be optimised again as a whole.

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


class Profiles(NamedTuple):
    """Heights of both surfaces; none where fewer than four."""

    first: Array
    second: Array
    ends: Array  #: of each surface: first position, spacing, whether periodic


class TransientContact(NamedTuple):
    """A contact over time in the scales of its widest dry contact."""

    n: int  #: intervals
    start: float  #: first position, in half widths
    dx: float
    depth: float  #: distance at which the deflection is zero
    lam: float  #: factor of the viscous flux
    oil: Array
    imposed: bool  #: whether the load is imposed, or the offset
    flooded: bool  #: whether the inlet before the first node is full of oil
    profiles: Profiles
    limits: Limits


class Instant(NamedTuple):
    """State of an instant, besides pressure and film, that the next one starts from."""

    offset: float
    free: int  #: last node with pressure
    load: float  #: with that of the inlet
    steps: int  #: of Newton's method
    flux_error: float


class _Setting(NamedTuple):
    """What stays over all instants: the grid, and arrays that each of them fills."""

    contact: TransientContact
    grid: Grid
    shape: Array  #: gap of the undeformed bodies
    history: Array  #: what the squeeze term takes over
    work: NewtonWork


@nb.njit(**INNER)
def _setting(contact: TransientContact, flag: Index) -> _Setting:
    n = contact.n
    kernel = influence(n, contact.dx) + contact.dx * np.log(contact.depth) / np.pi
    grid = Grid(n, contact.dx, kernel, film_plan(n, kernel))
    return _Setting(contact, grid, np.empty(n + 1), np.zeros(n + 1), newton_work(n, flag))


@nb.njit(**INNER)
def _add_profile(
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


@nb.njit(**INNER)
def _fill_gap(contact: TransientContact, row: Array, shape: Array) -> None:
    """Gap of the undeformed bodies at one instant."""
    n, start, dx, profiles = contact.n, contact.start, contact.dx, contact.profiles
    for i in range(n + 1):
        x = start + i * dx
        shape[i] = 0.5 * row[CURVATURE] * x * x
    ends = profiles.ends
    for side in range(2):
        heights = profiles.first if side == 0 else profiles.second
        _add_profile(
            n, start, dx, row[FIRST_SHIFT + side], row[HEIGHT], heights, ends[side, 0],
            ends[side, 1], ends[side, 2] > 0.0, shape,
        )  # fmt: skip


@nb.njit(inline="always", **INNER)
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


@nb.njit(inline="always", **INNER)
def _solve(
    setting: _Setting, row: Array, film: float, squeeze: float, state: Instant, load: float,
    P: Array, H: Array, cavity: Array,
) -> tuple[int, Instant]:  # fmt: skip
    """Solve one instant from a state nearby: its status and what it hands on."""
    contact = setting.contact
    lam, speed, imposed = contact.lam, row[SPEED], contact.imposed
    carried = row[LOAD] if imposed else load / _FULL
    tail, outside = _inlet(contact.start, film, carried, lam, contact.flooded, row)
    target = _FULL * row[LOAD] - outside if imposed else row[OFFSET]
    equation = Equation(
        lam, contact.oil, speed, squeeze, setting.history, setting.shape, tail, imposed, target
    )
    solved = newton_level(
        setting.grid, equation, contact.limits, state.offset, state.free, P, H, cavity,
        no_coarse(), setting.work,
    )  # fmt: skip
    status = solved.status
    if status == ROUNDED and solved.flux_error < _ROUNDED_FLUX:
        status = nb.int64(CONVERGED)
    return status, Instant(
        solved.offset, solved.free, solved.load + outside, solved.steps, solved.flux_error
    )


@nb.njit(inline="always", **INNER)
def _carry(
    setting: _Setting, ratio: float, table: Array, P: Array, H: Array, state: Instant
) -> tuple[int, Instant]:
    """Carry a steady state, in place, from the inputs of the first row to those of the last."""
    contact = setting.contact
    n, start, dx = contact.n, contact.start, contact.dx
    first, last, row = table[0], table[table.shape[0] - 1], np.empty(table.shape[1])
    p, h, cavity = np.empty(n + 1), np.empty(n + 1), np.zeros(n + 1)
    furthest = 0.0
    for c in range(row.size):
        if c in (LOAD, SPEED, CURVATURE) and first[c] > 0.0 and last[c] > 0.0:
            furthest = max(furthest, abs(np.log(last[c] / first[c])))
    largest = 1.0 / max(1.0, np.ceil(furthest / np.log(ratio)))
    done, part = 0.0, largest
    while done < 1.0:
        progress = done + part
        if progress > 1.0 - 1e-9:
            progress = 1.0
        for c in range(row.size):
            row[c] = first[c] + progress * (last[c] - first[c])
            if c in (LOAD, SPEED, CURVATURE) and first[c] > 0.0:
                row[c] = first[c] * (last[c] / first[c]) ** progress
        p[:], h[:] = P, H
        _fill_gap(contact, row, setting.shape)
        trial, film = state, central(n, start, dx, h)
        status = nb.int64(CONVERGED)
        # The inlet follows the film that it feeds.
        for _ in range(40):
            status, trial = _solve(setting, row, film, 0.0, trial, trial.load, p, h, cavity)
            before, film = film, central(n, start, dx, h)
            if status != CONVERGED or not contact.flooded or abs(film - before) < 1e-13 * abs(film):
                break
        if status != CONVERGED:
            cavity[:] = 0.0
            part *= 0.5
            if part < 1e-3:
                return status, state
            continue
        P[:], H[:] = p, h
        state, done, part = trial, progress, min(2.0 * part, largest)
    return nb.int64(CONVERGED), state


@nb.njit(**INNER)
def _keep(
    contact: TransientContact, P: Array, H: Array, cavity: Array, state: Instant,
    counts: tuple[int, int], record: Array,
) -> None:  # fmt: skip
    """Fill a line of the record; ``counts`` are Newton steps and parts of the step."""
    n, dx, k = contact.n, contact.dx, state.free
    total, highest, late = 0.0, 0.0, 0.0
    for i in range(k + 1):
        total += P[i]
        highest = max(highest, P[i])
        if i > n - n // 16:
            late += P[i]
    least = H[0]
    for i in range(min(k + 2, n + 1)):
        least = min(least, H[i])
    record[0], record[1], record[2] = state.offset, dx * total, state.load
    record[3], record[4] = central(n, contact.start, dx, H), least
    record[5], record[6], record[7] = k, counts[0], state.flux_error
    record[8], record[9] = counts[1], highest
    record[10] = late / total if total > 0.0 else 0.0
    record[11] = np.sum(cavity)


@nb.njit(inline="always", **INNER)
def _follow(
    setting: _Setting, time: Array, table: Array, halvings: int, every: int, past: Array,
    P: Array, H: Array, state: Instant, records: Array, pressures: Array, films: Array,
) -> tuple[int, int, Instant]:  # fmt: skip
    """Follow a contact over time, from the state of the first instant."""
    contact, history = setting.contact, setting.history
    n, start, dx, oil = contact.n, contact.start, contact.dx, contact.oil
    cavity, broken = np.zeros(n + 1), np.zeros(n + 1)
    lneta, dlneta, rho, drho = np.empty((4, n + 1))
    before, earlier = np.empty(n + 1), np.empty(n + 1)
    p, h = np.empty(n + 1), np.empty(n + 1)
    row = np.empty(table.shape[1])
    oil_state(n, P, oil, lneta, dlneta, rho, drho)
    for i in range(n + 1):
        before[i] = rho[i] * H[i]
    film, film_before = central(n, start, dx, H), 0.0
    load, load_before = state.load, 0.0
    last = 0.0
    _keep(contact, P, H, cavity, state, (state.steps, nb.int64(0)), records[0])
    if every > 0:
        pressures[0], films[0] = P, H
    for m in range(1, time.size):
        interval = time[m] - time[m - 1]
        done, part, parts, steps = 0.0, 1.0, nb.int64(0), nb.int64(0)
        while done < 1.0:
            width = part * interval
            progress = done + part
            for c in range(row.size):
                row[c] = table[m - 1, c] + progress * (table[m, c] - table[m - 1, c])
            _fill_gap(contact, row, setting.shape)
            if last == 0.0:
                squeeze, expected, expected_load = dx / width, film, load
                for i in range(n + 1):
                    history[i] = squeeze * before[i]
                if past.size > 0:
                    squeeze, history[:] = past[0], past[1:]
            else:
                r = width / last
                squeeze = dx / width * (1.0 + 2.0 * r) / (1.0 + r)
                weight_before = dx / width * (1.0 + r)
                weight_earlier = dx / width * r * r / (1.0 + r)
                for i in range(n + 1):
                    history[i] = weight_before * before[i] - weight_earlier * earlier[i]
                expected = film + r * (film - film_before)
                expected_load = load + r * (load - load_before)
            p[:], h[:], broken[:] = P, H, cavity
            status, trial = _solve(
                setting, row, expected, squeeze, state, expected_load, p, h, broken
            )
            if status != CONVERGED:
                part *= 0.5
                if part < 0.5**halvings:
                    return status, m, state
                continue
            P[:], H[:], cavity[:] = p, h, broken
            state = trial
            oil_state(n, P, oil, lneta, dlneta, rho, drho)
            for i in range(n + 1):
                earlier[i] = before[i]
                before[i] = rho[i] * H[i]
            film_before, film = film, central(n, start, dx, H)
            load_before, load = load, state.load
            last, done = width, progress
            parts += 1
            steps += state.steps
        _keep(contact, P, H, cavity, state, (steps, parts), records[m])
        if every > 0 and m % every == 0:
            pressures[m // every], films[m // every] = P, H
    return nb.int64(CONVERGED), time.size - 1, state


@cached_njit(_DIGEST, "the transient film solver", "one to two minutes", **JIT)
def follow_contact(
    contact: TransientContact, ratio: float, time: Array, table: Array, halvings: int,
    every: int, past: Array, P: Array, H: Array, state: Instant, records: Array,
    pressures: Array, films: Array, flag: Index,
) -> tuple[int, int, Instant]:  # fmt: skip
    """Follow a contact over time or, without any, carry a steady one to other inputs."""
    # A single step may have its squeeze term imposed: `past` is its factor and its history.
    setting = _setting(contact, flag)
    if time.size == 0:
        status, final_state = _carry(setting, ratio, table, P, H, state)
        return status, nb.int64(0), final_state
    return _follow(
        setting, time, table, halvings, every, past, P, H, state, records, pressures, films
    )
