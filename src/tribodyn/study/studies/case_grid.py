"""Loop over the cases of a study, which are built or computed in parallel threads."""

from __future__ import annotations

import hashlib
import json
import os
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from tribodyn.checkpoints import Checkpoints
from tribodyn.errors import InputError
from tribodyn.interrupt import in_threads
from tribodyn.mesh import MeshTable
from tribodyn.progress import SILENT, Progress
from tribodyn.study.pipeline.assembly import whole_system
from tribodyn.study.pipeline.tooth_contact import mesh_of

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.user_tables import PartsCase

Value = TypeVar("Value")


class Member(NamedTuple):
    """Case of a study with its tooth contact and its structure."""

    case: Case
    mesh: MeshTable
    system: System


def contact_without_speed(case: Case) -> bool:
    """Whether the tooth contact is independent of the speed."""
    return case.film.model == "none" and case.friction.law in ("none", "constant")


def built(case: Case) -> Member:
    """Build tooth contact and structure of a case."""
    mesh = mesh_of(case)
    return Member(case, mesh, whole_system(case, mesh))


def varied(
    case: Case,
    changes: Sequence[Mapping[str, Any]],
    progress: Progress,
    checkpoints: Checkpoints | None = None,
) -> list[Member]:
    """Build tooth contact and structure of a case for each change, in their order."""
    members: dict[int, Member] = {}
    folder = checkpoints.folder if checkpoints is not None else None

    def member(index: int) -> Member:
        changed = case.replace(changes[index])
        path = folder / f"mesh-{index}.nc" if folder else None
        if path is not None and path.exists():
            with suppress(InputError):
                mesh = MeshTable.load(path)
                return Member(changed, mesh, whole_system(changed, mesh))
            path.unlink()
        built_member = built(changed)
        if path is not None:
            built_member.mesh.save(path)
        return built_member

    progress.start("Tooth contacts", len(changes))
    over_cases(member, range(len(changes)), members, progress)
    progress.finish()
    return [members[index] for index in range(len(changes))]


def identity(study: str, case: Case | PartsCase, over: Any, **options: Any) -> dict[str, Any]:
    """Identity of a study; checkpoints are reused only if it is the same."""
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
    """Compute members in threads; ``done`` receives values by index, even if interrupted."""
    lock = threading.Lock()
    progress.advance(len(done))

    def compute_one(index: int) -> None:
        value = compute(members[index])
        with lock:
            done[index] = value
            progress.advance()

    remaining = [index for index in range(len(members)) if index not in done]
    in_threads(compute_one, remaining, os.cpu_count() or 1)


def finished(done: Mapping[int, Value]) -> list[Value]:
    """Return the finished values up to the first one that is missing."""
    count = next(index for index in range(len(done) + 1) if index not in done)
    return [done[index] for index in range(count)]
