"""One loop over the cases of a study: each is built or computed once, several at a time."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from tribodyn.interrupt import in_threads
from tribodyn.progress import SILENT, Progress
from tribodyn.study.pipeline.assembly import whole_system
from tribodyn.study.pipeline.tooth_contact import mesh_of

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case

Value = TypeVar("Value")


class Member(NamedTuple):
    """One case of a study with its tooth contact and its structure."""

    case: Case
    mesh: MeshTable
    system: System


def built(case: Case) -> Member:
    """Tooth contact and structure of a case."""
    mesh = mesh_of(case)
    return Member(case, mesh, whole_system(case, mesh))


def varied(case: Case, changes: Sequence[Mapping[str, Any]], progress: Progress) -> list[Member]:
    """Tooth contact and structure of a case under each of some changes, in their order."""
    members: dict[int, Member] = {}
    progress.start("Tooth contacts", len(changes))
    over_cases(lambda change: built(case.replace(change)), changes, members, progress)
    progress.finish()
    return [members[index] for index in range(len(changes))]


def over_cases(
    compute: Callable[[Any], Value],
    members: Sequence[Any],
    done: dict[int, Value],
    progress: Progress = SILENT,
) -> None:
    """Compute members in threads; ``done`` holds what is finished by index, interrupted or not."""
    lock = threading.Lock()

    def one(index: int) -> None:
        value = compute(members[index])
        with lock:
            done[index] = value
            progress.advance()

    in_threads(one, range(len(members)), os.cpu_count() or 1)


def finished(done: Mapping[int, Value]) -> list[Value]:
    """What is finished before the first member that is not."""
    count = next(index for index in range(len(done) + 1) if index not in done)
    return [done[index] for index in range(count)]
