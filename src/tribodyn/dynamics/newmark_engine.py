"""Newmark's scheme for all lanes: tables, blocks, threads, and what is said of a failure."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np

from tribodyn.dynamics.divergence import probable_cause
from tribodyn.dynamics.lane_parameters import LaneParameters
from tribodyn.dynamics.march import Compiled, Member, is_brief
from tribodyn.dynamics.newmark_tables import NewmarkTables, newmark_tables
from tribodyn.dynamics.unparted import unparted_step
from tribodyn.errors import ComputationError, Problem
from tribodyn.interrupt import in_threads, refuse_stopped, stop_flag
from tribodyn.types import Array, Index

#: Lanes of one block.
_WIDTHS = (1, 16)
#: A state above this has grown beyond all bounds; contact forces are then not to blame.
_HUGE = 1e100


@dataclass(frozen=True)
class NewmarkEngine:
    """Systems laid out for Newmark's scheme."""

    compiled: Compiled
    members: tuple[Member, ...]  #: systems with their lanes
    tables: tuple[NewmarkTables, ...]  #: one for each member
    law: Array  #: gamma, beta, tolerance [-]

    def blocks(self, lanes: int, member: int = -1) -> list[tuple[int, Index]]:
        """Lanes that march side by side."""
        found = []
        for number, one in enumerate(self.members):
            if member not in (-1, number):
                continue
            own = one.lanes if self.compiled.members and member < 0 else np.arange(lanes)
            width = _WIDTHS[0] if own.size < 4 else _WIDTHS[1]
            found += [(number, own[at : at + width]) for at in range(0, own.size, width)]
        return found

    def march(
        self,
        period: Array,
        state: Array,
        cycles: int,
        *,
        extra_force: Array | None = None,
        scales: Array | None = None,
        record: Array | None = None,
        member: int = -1,
        numbers: Index | None = None,
        threads: int | None = None,
        elapsed: int = 0,
    ) -> Array:
        """March lanes by whole mesh cycles."""
        lanes, double = state.shape
        extra = np.zeros((lanes, double // 2)) if extra_force is None else extra_force
        factors = np.ones((lanes, 6)) if scales is None else scales
        load = np.hstack((np.asarray(extra, dtype=float), factors))
        new = np.empty_like(state)
        blocks = self.blocks(lanes, member)
        called = (np.arange(lanes) if lanes > 1 else np.array([-1])) if numbers is None else numbers

        def block(place: int) -> int:
            number, index = blocks[place]
            width = _WIDTHS[0] if index.size == 1 else _WIDTHS[1]
            # A lane past the end repeats the last one, so that a block is always full.
            full = index[np.minimum(np.arange(width), index.size - 1)]
            part = np.ascontiguousarray(state[full])
            kept = None
            if record is not None:
                kept = np.empty((*record.shape[:2], index.size))
            failed = self._block(number, period[full], load[full], part, cycles, kept, index.size)
            new[index] = part[: index.size]
            if record is not None and kept is not None:
                record[:, :, index] = kept
            return failed

        threads = threads or os.cpu_count() or 1
        brief = is_brief(self.compiled, lanes, cycles)
        failures = in_threads(block, range(len(blocks)), threads, brief=brief)
        for (number, index), failed in zip(blocks, failures, strict=True):
            if failed >= 0:
                self._refuse_unparted(number, index, called, period, failed, elapsed)
                self._report(number, index, called, period, load, state, cycles, elapsed)
        return new

    def _block(
        self,
        number: int,
        period: Array,
        load: Array,
        state: Array,
        cycles: int,
        record: Array | None,
        count: int,
    ) -> int:
        from tribodyn.dynamics.crossing_search import WIDTH
        from tribodyn.dynamics.newmark_force import SINGLE
        from tribodyn.dynamics.newmark_marching import newmark_block

        tables, law, grid = self.tables[number], self.law, self.compiled.grid
        (n, m, f, c), width, kinds = tables.shape, state.shape[0], tables.widths.size
        sources = m + f
        inner = 8 * n + 5 * m + 2 * f + sources * n + 2 * m * sources + m * m + SINGLE
        length = m * (5 + 3 * n) + f * (n + c) + n
        mass, damping, stiffness = (
            part.reshape(n, n) for part in tables.matrices[: 3 * n * n].reshape(3, n * n)
        )
        h = (tables.widths[:, None] * period)[:, :, None, None]
        effective = np.linalg.inv(mass + law[0] * h * damping + law[1] * h * h * stiffness)
        search = WIDTH * (m + 1)
        rest = inner + 2 * n * n + 2 * length + search + n * n
        work = np.zeros((inner + kinds * n * n) * width + rest)
        shared = work[inner * width : (inner + kinds * n * n) * width]
        shared[:] = np.moveaxis(effective, 1, -1).reshape(-1)
        keep = np.zeros((0, 2 * n, 1)) if record is None else record
        code = newmark_block(
            (0.0,) * width, tables.shape, law, *tables.structure, tables.matrices, tables.rows,
            grid.width, tables.kind, grid.after_event, tables.dead, tables.facts, work,
            np.ascontiguousarray(period), np.ascontiguousarray(load), state, cycles, keep, 0,
            count, stop_flag(),
        )  # fmt: skip
        return refuse_stopped(int(code))

    def _refuse_unparted(
        self,
        number: int,
        index: Index,
        called: Index,
        period: Array,
        code: int,
        elapsed: int,
    ) -> None:
        """Tell of a step that comes to no end, if that is what ended a block."""
        from tribodyn.dynamics.newmark_marching import UNPARTED

        if code < UNPARTED:
            return
        grid, contacts = self.compiled.grid, len(self.members[number].system.contacts)
        width = _WIDTHS[0] if index.size == 1 else _WIDTHS[1]
        place, item = divmod(code - UNPARTED, width)
        cycle, step = divmod(place // contacts, grid.steps)
        lane = int(index[min(item, index.size - 1)])
        phase = elapsed + cycle + float(grid.left[step])
        raise unparted_step(
            place % contacts, contacts, phase, phase * float(period[lane]),
            int(called[lane]) if called[lane] >= 0 else None,
        )  # fmt: skip

    def _report(
        self,
        number: int,
        index: Index,
        called: Index,
        period: Array,
        load: Array,
        state: Array,
        cycles: int,
        elapsed: int,
    ) -> None:
        """Find the lane that failed, when, and which coordinate moved most; raise."""
        grid, system = self.compiled.grid, self.members[number].system
        steps, n = grid.steps, system.size
        for lane in index:
            own = slice(lane, lane + 1)
            part = state[own].copy()
            failed = self._block(number, period[own], load[own], part, cycles, None, 1)
            if failed < 0:
                continue
            before, part = max((failed // 2 - 1) // steps, 0), state[own].copy()
            self._block(number, period[own], load[own], part, before, None, 1)
            record = np.zeros((steps + 1, 2 * n, 1))
            self._block(number, period[own], load[own], part, 1, record, 1)
            done = failed // 2 - before * steps
            finite = np.isfinite(record[:done, :, 0]).all(axis=1)
            step = done if finite.all() else int(np.argmin(finite))
            with np.errstate(over="ignore", invalid="ignore"):
                energy = np.diag(system.mass) * record[max(step - 1, 0), n:, 0] ** 2
            name = system.names[int(np.argmax(energy))]
            time = (elapsed + before + float(np.append(grid.left, 1.0)[step])) * float(period[lane])
            small = bool(finite.all()) and float(np.abs(record[:done]).max()) < _HUGE
            who = f" in lane {called[lane]}" if called[lane] >= 0 else ""
            cause = probable_cause(system, self.members[number].nodes, 0.0, load[lane, n:])
            raise ComputationError(self._failure(failed % 2 == 1 and small, time, name, who, cause))

    def _failure(
        self, unfound: bool, time: float, name: str, who: str, cause: tuple[str, str]
    ) -> Problem:
        law, reached = self.law, self.compiled.step_number
        number = f" at omega_max*dt = {reached:.3g}" if np.isfinite(reached) else ""
        if unfound:
            return Problem(
                what=f"the contact forces of the step that ends at {time:.6g} s were not "
                f"found{who}",
                why=f"Newton's method did not come below the tolerance of {law[2]:.0e} within 25 "
                f"passes{number}",
                remedy="Take more steps per mesh cycle or a larger tolerance, and look for a "
                "contact stiffness or damping below zero, which can make the equations of a step "
                "singular",
            )
        return Problem(
            what=f"the motion grew beyond all bounds at about {time:.6g} s{who}, most of all "
            f"{name}",
            why=f"{cause[0]}. gamma = {law[0]:g}, beta = {law[1]:g} are stable{number}, so the "
            "step is not to blame",
            remedy=cause[1],
        )


def newmark_engine(
    compiled: Compiled, law: Array, parameters: LaneParameters | None = None
) -> NewmarkEngine:
    """Lay out all systems of the lanes."""
    whole = Member(compiled.system, compiled.nodes, np.zeros(0, dtype=np.int64))
    members = compiled.members or (whole,)
    split = parameters is not None and parameters.scales_friction
    tables = tuple(
        newmark_tables(one.system, one.nodes, compiled.grid, split=split) for one in members
    )
    return NewmarkEngine(compiled, members, tables, law)
