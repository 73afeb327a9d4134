"""The runner of studies: values are those of a plain loop, whoever computes them."""

from __future__ import annotations

from contextlib import contextmanager

import pytest

from tribodyn.study.studies.runner import Groups, run_each, run_groups

ITEMS = list(range(-7, 30))
SQUARES = [item * item for item in ITEMS]


class _Steps:
    """Progress that counts."""

    def __init__(self) -> None:
        self.started, self.count, self.ended = [], 0, False

    def start(self, task: str, total: int | None = None) -> None:
        self.started.append((task, total))

    def advance(self, steps: int = 1) -> None:
        self.count += steps

    def finish(self) -> None:
        self.ended = True


@pytest.mark.parametrize("largest", [1, 5, 16, 100])
@pytest.mark.parametrize("earlier", [{}, {0: 49, 3: 16}, dict(enumerate(SQUARES))])
def test_values_are_those_of_a_loop(largest: int, earlier: dict[int, int]) -> None:
    groups, stored, steps = [], dict[int, int](), _Steps()

    def compute(group: list[int]) -> list[int]:
        groups.append(list(group))
        return [item * item for item in group]

    values = run_groups(
        compute, ITEMS, groups=Groups(largest), task="Squares", progress=steps, earlier=earlier,
        store=stored.__setitem__,
    )  # fmt: skip
    assert values == SQUARES
    assert stored | earlier == dict(enumerate(SQUARES))
    assert not stored.keys() & earlier.keys()
    computed = sorted(item for group in groups for item in group)
    assert computed == [ITEMS[index] for index in sorted(stored)]
    assert all(len(group) <= largest for group in groups)
    assert (steps.started, steps.count, steps.ended) == ([("Squares", 37)], 37, True)


def test_the_first_group_is_computed_alone_where_it_compiles() -> None:
    order, inside = [], []

    @contextmanager
    def compiling(group: list[int]):
        order.append(("compiles", group))
        yield True
        inside.append(len(order))

    def compute(group: list[int]) -> list[int]:
        order.append(("computes", group))
        return group

    assert run_groups(compute, [3, 4, 5], groups=Groups(compiling=compiling)) == [3, 4, 5]
    assert order[:2] == [("compiles", [3]), ("computes", [3])]
    assert inside == [2]
    assert run_groups(compute, [], groups=Groups(compiling=compiling)) == []


@pytest.mark.parametrize(("stop", "finished"), [(5, 5), (0, 0)])
def test_an_interrupted_study_returns_what_is_finished_before_the_first_gap(
    stop: int, finished: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tribodyn.study.studies.runner.os.cpu_count", lambda: 1)

    def compute(item: int) -> int:
        if item == ITEMS[stop]:
            raise KeyboardInterrupt
        return item * item

    with pytest.raises(KeyboardInterrupt):
        run_each(compute, ITEMS)
    if finished:
        assert run_each(compute, ITEMS, partly=True) == SQUARES[:finished]
        # A value beyond the gap that an earlier process has finished is none of the result.
        earlier = {stop + 2: SQUARES[stop + 2]}
        assert run_each(compute, ITEMS, partly=True, earlier=earlier) == SQUARES[:finished]
    else:
        with pytest.raises(KeyboardInterrupt):
            run_each(compute, ITEMS, partly=True)


def test_an_error_ends_the_study() -> None:
    with pytest.raises(ZeroDivisionError):
        run_each(lambda item: 1 / item, ITEMS, partly=True)
