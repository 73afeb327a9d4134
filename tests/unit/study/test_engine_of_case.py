"""The engine of a case: all march steady motions and transients, and agree."""

from __future__ import annotations

import importlib.util
from dataclasses import replace

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


#: A spur pair with a force law that vibrates at twice its natural frequency.
RESONANT = {
    "dynamics.mesh_law": "force-law", "dynamics.backlash": "0.05 mm", "friction.law": "none",
    "dynamics.mesh_damping_ratio": 0.02, "friction.coefficient": None,
}  # fmt: skip
#: A helical pair without films, and one whose teeth part in a resonance.
HELICAL = {"film.model": "none", "friction.law": "none"}
PARTING = {"dynamics.mesh_damping_ratio": 0.01, "dynamics.transmission_error_amplitude": "3 um"}


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_harmonic_balance_of_a_pair_equals_the_march(case: td.Case) -> None:
    fine = case.replace({"solver.steps_per_mesh_cycle": 4096})
    spectra = td.run(case.replace({"solver.engine": "harmonic-balance",
                                   "solver.steps_per_mesh_cycle": None}))  # fmt: skip
    marched = td.run(fine)
    assert spectra.response.engine == "harmonic-balance"
    error = spectra.response.step_error + marched.response.step_error
    assert error < 1e-4
    for name in ("mean_mesh_force", "rms_mesh_force", "rms_dynamic_transmission_error"):
        assert spectra.summary()[name] == pytest.approx(marched.summary()[name], rel=3.0 * error)
    multipliers = [abs(each.response.floquet_multipliers[0]) for each in (spectra, marched)]
    assert multipliers[0] == pytest.approx(multipliers[1], rel=1e-5)


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_an_automatic_engine_takes_the_one_that_fits(case: td.Case, tmp_path) -> None:
    by_choice = {"solver.engine": "auto"}
    spring = td.run(case.replace(by_choice))
    assert spring.response.reason == 'one spring with mesh_law = "stiffness" is marched faster'
    assert spring.summary() == td.run(case).summary()
    over_time = {"solver.method": "transient", "solver.cycles": 4}
    assert td.run(case.replace({**by_choice, **over_time})).response.reason.endswith("is marched")
    # Twice the natural frequency: the motion of one mesh cycle is unstable, that of two is not.
    twice = case.replace({**RESONANT, "operation.speed": 2.0 * spring.summary()["resonance_speed"]})
    resonant = td.run(twice.replace(by_choice))
    assert (resonant.response.engine, resonant.response.period) == ("runge-kutta-4", 2)
    assert "no stable motion repeats after a mesh cycle" in resonant.response.reason
    with pytest.raises(ComputationError, match=r'largest multiplier.*Choose engine = "auto"'):
        td.run(twice.replace({"solver.engine": "harmonic-balance"}))
    resonant.save(tmp_path / "result")
    assert td.load_result(tmp_path / "result").response.reason == resonant.response.reason


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_an_automatic_engine_judges_what_harmonic_balance_finds() -> None:
    helical = td.load_case("helical-pair").replace(HELICAL)
    automatic = helical.replace({"solver.engine": "auto"})
    assert "takes harmonic balance if" in motion.engine_remark(automatic)
    spectra, marched = td.run(automatic), td.run(helical)
    assert spectra.response.engine == "harmonic-balance"
    error = spectra.response.step_error + marched.response.step_error
    assert error < 1e-4
    for name in ("mean_mesh_force", "rms_mesh_force", "rms_dynamic_transmission_error"):
        assert spectra.summary()[name] == pytest.approx(marched.summary()[name], rel=3.0 * error)
    coarse = td.run(automatic.replace({"solver.steps_per_mesh_cycle": 64})).response
    assert coarse.engine == "runge-kutta-4"
    assert "with 64 steps, limit 1e-04" in coarse.reason
    speed = {"operation.speed": marched.summary()["resonance_speed"]}
    parting = td.run(automatic.replace({**PARTING, **speed})).response
    assert parting.engine == "runge-kutta-4"
    assert parting.reason == "the teeth part, so that several motions may exist"


def test_harmonic_balance_needs_a_periodic_motion(case: td.Case) -> None:
    with pytest.raises(InputError, match="Harmonic balance finds periodic motions only"):
        case.replace({"solver.engine": "harmonic-balance", "solver.method": "transient"})


def test_a_machine_is_not_marched_where_its_engine_is_harmonic_balance(case: td.Case) -> None:
    with pytest.warns(td.ModelWarning):
        response = td.run(case).response
    assert motion.by_engine("harmonic-balance", response) is response
    lost = replace(response, converged=False)
    assert motion.by_engine("auto", lost) is lost
    with pytest.raises(ComputationError, match=r"solver\.engine: no periodic motion"):
        motion.by_engine("harmonic-balance", lost)
