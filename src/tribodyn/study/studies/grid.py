"""One loop over the cases of a study: each is built or computed once, several at a time."""

from __future__ import annotations

import hashlib
import json
import os
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from tribodyn.checkpoints import Members
from tribodyn.errors import InputError
from tribodyn.interrupt import in_threads
from tribodyn.mesh import MeshTable
from tribodyn.progress import SILENT, Progress
from tribodyn.study.pipeline.assembly import whole_system
from tribodyn.study.pipeline.tooth_contact import mesh_of

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.study.case.case import Case

Value = TypeVar("Value")


class Member(NamedTuple):
    """One case of a study with its tooth contact and its structure."""

    case: Case
    mesh: MeshTable
    system: System


def contact_without_speed(case: Case) -> bool:
    """Whether nothing in the tooth contact depends on how fast the gears turn."""
    return case.film.model == "none" and case.friction.law in ("none", "constant")


def built(case: Case) -> Member:
    """Tooth contact and structure of a case."""
    mesh = mesh_of(case)
    return Member(case, mesh, whole_system(case, mesh))


def varied(
    case: Case,
    changes: Sequence[Mapping[str, Any]],
    progress: Progress,
    kept: Members | None = None,
) -> list[Member]:
    """Tooth contact and structure of a case under each of some changes, in their order."""
    members: dict[int, Member] = {}
    folder = kept.folder if kept is not None else None

    def member(index: int) -> Member:
        changed = case.replace(changes[index])
        path = folder / f"mesh-{index}.nc" if folder else None
        if path is not None and path.exists():
            with suppress(InputError):
                mesh = MeshTable.load(path)
                return Member(changed, mesh, whole_system(changed, mesh))
            path.unlink()
        found = built(changed)
        if path is not None:
            found.mesh.save(path)
        return found

    progress.start("Tooth contacts", len(changes))
    over_cases(member, range(len(changes)), members, progress)
    progress.finish()
    return [members[index] for index in range(len(changes))]


def identity(study: str, case: Case, over: Any, **options: Any) -> dict[str, Any]:
    """What tells a study from others: only members of the same one are taken for finished."""
    import tribodyn

    text = json.dumps(over, default=str)
    return {
        "study": study,
        "version": tribodyn.__version__,
        "options": options,
        "case": hashlib.sha256(case.to_toml().encode()).hexdigest(),
        "over": hashlib.sha256(text.encode()).hexdigest(),
    }


def over_cases(
    compute: Callable[[Any], Value],
    members: Sequence[Any],
    done: dict[int, Value],
    progress: Progress = SILENT,
) -> None:
    """Compute members in threads; ``done`` holds what is finished by index, interrupted or not."""
    lock = threading.Lock()
    progress.advance(len(done))

    def one(index: int) -> None:
        value = compute(members[index])
        with lock:
            done[index] = value
            progress.advance()

    left = [index for index in range(len(members)) if index not in done]
    in_threads(one, left, os.cpu_count() or 1)


def finished(done: Mapping[int, Value]) -> list[Value]:
    """What is finished before the first member that is not."""
    count = next(index for index in range(len(done) + 1) if index not in done)
    return [done[index] for index in range(count)]
