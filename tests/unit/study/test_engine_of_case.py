"""The engine of a case: all march steady motions and transients, and agree."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from broken import SOUND

import tribodyn as td
from tribodyn.errors import ComputationError, InputError
from tribodyn.study import read_case
from tribodyn.study.pipeline import motion

TEXT = SOUND.replace('bearing_stiffness = "3.5e9 N/m"', 'model = "torsional"\nbacklash = "0 mm"')


@pytest.fixture(scope="module")
def case() -> td.Case:
    return read_case(TEXT).replace({"solver.steps_per_mesh_cycle": 512})


def motion_with(case: td.Case, engine: str, **options: float) -> dict[str, float]:
    changes = {f"solver.{name}": value for name, value in options.items()}
    return td.run(case.replace({"solver.engine": engine, **changes})).summary()


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_steady_motions_of_all_engines_agree_within_their_order(case: td.Case) -> None:
    name = "rms_mesh_force"
    coarse, fine = (case.replace({"solver.steps_per_mesh_cycle": steps}) for steps in (1024, 2048))
    reference = motion_with(fine, "runge-kutta-4")
    adaptive = motion_with(fine, "dormand-prince", relative_tolerance=1e-10)
    assert adaptive[name] == pytest.approx(reference[name], rel=1e-7)
    # Second order: half the step leaves about a quarter of the error.
    errors = [abs(motion_with(c, "newmark")[name] / adaptive[name] - 1.0) for c in (coarse, fine)]
    assert errors[0] < 1e-4
    assert 3.0 < errors[0] / errors[1] < 5.0
    assert adaptive["steady_state_error"] < 1e-8


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_transients_of_all_engines_start_from_the_same_state(case: td.Case) -> None:
    over_time = case.replace(
        {"solver.method": "transient", "solver.cycles": 4, "solver.steps_per_mesh_cycle": 1024}
    )
    motions = [
        td.run(over_time.replace({"solver.engine": name, **options})).response
        for name, options in (
            ("runge-kutta-4", {}),
            ("dormand-prince", {"solver.relative_tolerance": 1e-10}),
            ("newmark", {}),
            ("modal", {}),
        )
    ]
    assert [motion.engine for motion in motions][-1] == "modal"
    size = np.abs(motions[0].deflection).max()
    for other, allowed in zip(motions[1:], (1e-3, 1e-2, 1e-3), strict=True):
        assert np.abs(other.deflection - motions[0].deflection).max() < allowed * size


def test_options_of_another_engine_are_refused(case: td.Case) -> None:
    with pytest.raises(InputError, match=r"gamma = 0.6 does not belong to engine"):
        case.replace({"solver.gamma": 0.6})
    with pytest.raises(InputError, match="Did you mean"):
        case.replace({"solver.engine": "newmrk"})


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_a_motion_that_does_not_repeat_is_refused(
    case: td.Case, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(motion, "_REPEATS", -1.0)
    monkeypatch.setattr(motion, "_MOST_CYCLES", 64)
    with pytest.raises(ComputationError, match=r"solver\.engine.*still changes"):
        motion_with(case, "newmark")


def test_a_missing_graphics_processor_is_reported_at_its_key(monkeypatch) -> None:
    find_spec = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "numba_cuda" else find_spec(name)
    )
    asking = read_case(TEXT).replace({"solver.backend": "cuda"})
    with pytest.raises(InputError, match=r"solver\.backend: numba-cuda is not installed"):
        td.run(asking)
    with pytest.raises(InputError, match='does not belong to engine = "newmark"'):
        asking.replace({"solver.engine": "newmark", "solver.backend": "cuda"})
