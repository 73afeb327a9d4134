"""Run the items of a study: in threads or worker processes, resumed, with partial results."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from tribodyn.interrupt import in_threads
from tribodyn.mesh.film.film_lookup import shared_films
from tribodyn.model import known_elsewhere
from tribodyn.progress import SILENT, Progress
from tribodyn.study.processes import helpers
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase

Item = TypeVar("Item")
Value = TypeVar("Value")

#: Number of groups for each processor, and the multiple of items that a large group has.
_GROUPS_PER_CPU, _BATCH = 4, 8
#: Number of items that justifies a worker process.
_ITEMS_PER_PROCESS = 50
_NO_VALUES: Mapping[int, Any] = MappingProxyType({})


def identity(study: str, case: AnyCase, over: object, **options: object) -> Tree:
    """Identity of a study; checkpoints are reused only if it is the same."""
    import tribodyn

    text = json.dumps(over, default=str)
    return {
        "study": study,
        "version": tribodyn.__version__,
        "options": options,
        "case": hashlib.sha256(case._text(comments=True).encode()).hexdigest(),
        "over": hashlib.sha256(text.encode()).hexdigest(),
    }


class Groups(NamedTuple):
    """How the items of a study are grouped, and where the groups are computed."""

    largest: int = 1  #: most items of a group
    #: What worker processes compute, if they may; it takes a group, as the local function does.
    remote: Callable[[Sequence[Any]], Sequence[Any]] | None = None
    warm_up: int | None = None  #: items with which a worker process loads what it needs
    #: Context that yields whether the first group is computed alone, to compile its kernels.
    compiling: Callable[[Sequence[Any]], AbstractContextManager[bool]] = lambda group: nullcontext(
        False
    )

    def size(self, count: int) -> int:
        """Items of a group, for a number of items."""
        size = min(self.largest, max(1, count // (_GROUPS_PER_CPU * (os.cpu_count() or 1))))
        return size - (size % _BATCH if size > _BATCH else 0)

    def pickled(self) -> bytes:
        """Pickle what worker processes compute; empty if they cannot compute it."""
        if self.remote is not None and known_elsewhere():
            with suppress(pickle.PicklingError, AttributeError, TypeError):
                return pickle.dumps(partial(_with_shared_films, self.remote))
        return b""


def run_groups(
    compute: Callable[[Sequence[Item]], Sequence[Value]],
    items: Sequence[Item],
    *,
    groups: Groups = Groups(),  # noqa: B008
    task: str = "",
    progress: Progress = SILENT,
    earlier: Mapping[int, Value] = _NO_VALUES,
    store: Callable[[int, Value], None] = lambda index, value: None,
    partly: bool = False,
) -> list[Value]:
    """Compute the values of all items in groups, up to the first that is missing."""
    # task: name in the progress; empty if the caller has started it. earlier: values by index that
    # another process has finished. store: receives index and value of each finished item. partly:
    # return what is finished when interrupted with Ctrl-C, if the first item is among it.
    done, lock = dict(earlier), threading.Lock()
    missing = [index for index in range(len(items)) if index not in done]
    size = groups.size(len(missing))
    indices = [missing[first : first + size] for first in range(0, len(missing), size)]
    inputs = [[items[index] for index in group] for group in indices]

    def keep(number: int, values: Sequence[Value]) -> None:
        for index, value in zip(indices[number], values, strict=True):
            store(index, value)
            with lock:
                done[index] = value
                progress.advance()

    if task:
        progress.start(task, len(items))
    progress.advance(len(earlier))
    try:
        # Groups in parallel threads or processes would all wait for the same kernels.
        with groups.compiling(inputs[0]) if inputs else nullcontext(False) as alone:
            if alone:
                keep(0, compute(inputs[0]))
        numbers = range(int(alone), len(inputs))
        pickled = groups.pickled()
        with helpers(len(missing) // _ITEMS_PER_PROCESS if pickled else 0) as workers:
            if pickled and workers.count:
                remaining = [inputs[number] for number in numbers]
                first_call = remaining[0][: groups.warm_up] if remaining else None
                workers.each(
                    compute, pickled, remaining, lambda n, v: keep(numbers[n], v), first_call
                )
            else:
                in_threads(lambda n: keep(n, compute(inputs[n])), numbers, os.cpu_count() or 1)
    except KeyboardInterrupt:
        if not (partly and 0 in done):
            raise
    if task:
        progress.finish()
    end = next(index for index in range(len(done) + 1) if index not in done)
    return [done[index] for index in range(end)]


def run_each(
    compute: Callable[[Item], Value], items: Sequence[Item], **options: Any
) -> list[Value]:
    """Compute each item in threads; options are those of :func:`run_groups`."""
    return run_groups(lambda group: [compute(item) for item in group], items, **options)


def _with_shared_films(
    compute: Callable[[Sequence[Item]], Sequence[Value]], group: Sequence[Item]
) -> Sequence[Value]:
    with shared_films(persistent=True):
        return compute(group)
