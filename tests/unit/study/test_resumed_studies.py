"""A study that was killed goes on: what is finished is read, and the whole is what it would be."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import tribodyn.study.studies.runner as runner
import tribodyn.study.studies.sweep as sweeps
from tribodyn import load_case
from tribodyn.checkpoints import Checkpoints
from tribodyn.nonlinear.attractors import Motions
from tribodyn.study import bifurcation, sweep

_SPEEDS = {"operation.speed": ("900 rpm", "1500 rpm", 4)}


class _KilledError(Exception):
    """What ends the process in these tests."""


def _plain_case() -> Any:
    return load_case("fzg-roughness").replace(
        {"stiffness.model": "iso6336", "friction.law": "none", "film.model": "none"}
    )


def _dying(monkeypatch: pytest.MonkeyPatch, after: int) -> list[str]:
    """Let the process die when it keeps one member more."""
    keep, stored = Checkpoints.keep, []

    def then_die(self: Checkpoints, name: str, value: Any) -> None:
        if len(stored) == after:
            raise _KilledError
        stored.append(name)
        keep(self, name, value)

    monkeypatch.setattr(Checkpoints, "keep", then_die)
    return stored


def test_a_sweep_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = _plain_case()
    full = sweep(case, _SPEEDS)
    with monkeypatch.context() as patch, Checkpoints(tmp_path / "s") as members:
        patch.setattr(runner.os, "cpu_count", lambda: 1)
        _dying(patch, 2)
        with pytest.raises(_KilledError):
            sweep(case, _SPEEDS, checkpoints=members)
    prepare_run, requests = sweeps.prepare_run, []
    monkeypatch.setattr(
        sweeps, "prepare_run", lambda *a, **k: requests.append(a) or prepare_run(*a, **k)
    )
    with Checkpoints(tmp_path / "s") as members:
        result = sweep(case, _SPEEDS, checkpoints=members)
    assert len(requests) == 2
    assert result == full
    assert result.to_csv() == full.to_csv()


@pytest.mark.parametrize("direction", ["both", "independent"])
@pytest.mark.parametrize("over", ["operation.speed", "operation.torque"])
@pytest.mark.slow
def test_a_bifurcation_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, over: str, direction: str
) -> None:
    case = _plain_case()
    options: dict[str, Any] = {"sweep": direction, "transient": 40, "cycles": 8, "keep": 4}
    between = {"operation.speed": ("900 rpm", "3000 rpm"), "operation.torque": (60.0, 120.0)}[over]
    full = bifurcation(case, over, between, 6, **options)
    for after in (0, 3, 5):
        with monkeypatch.context() as patch, Checkpoints(tmp_path / "b") as members:
            _dying(patch, after)
            with pytest.raises(_KilledError):
                bifurcation(case, over, between, 6, checkpoints=members, **options)
    computed_parts, queue = [], Motions.queue
    monkeypatch.setattr(
        Motions,
        "queue",
        lambda self, indices: (computed_parts.append(len(list(indices))), queue(self, indices)),
    )
    with Checkpoints(tmp_path / "b") as members:
        result = bifurcation(case, over, between, 6, checkpoints=members, **options)
        assert len(members) >= 8
    motions = 24 if direction == "both" else 12
    if (over, direction) != ("operation.speed", "both"):  # There stretches are joined, too.
        assert sum(computed_parts) == motions - len(members)
    assert result.verdicts() == full.verdicts()
    assert result.period.tolist() == full.period.tolist()
    assert result.rms == pytest.approx(full.rms, rel=1e-5)
    assert result.refined_rms == pytest.approx(full.refined_rms, rel=1e-5)
