"""Lanes of a graphics processor: the same motions as on the CPU, and what is said without one."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path
from subprocess import PIPE

import numpy as np
import pytest

from known_systems import reference_system
from tribodyn.analysis import parameter_map
from tribodyn.dynamics import (
    Contact,
    LaneParameters,
    LoadFriction,
    System,
    simulate,
    simulate_ensemble,
)
from tribodyn.dynamics._engine.generated import cuda as gpu
from tribodyn.errors import ComputationError, InputError

_SIGNALS = ("deflection", "contact_force", "acceleration", "output")


def _rubbing(stiffness: float, load: float = 5.0) -> System:
    """Two masses, one contact with a dead zone and damping in it, friction that follows loads."""
    first = Contact(
        [1.0, -1.0], lambda phase: stiffness + np.where(phase < 0.4, 20.0, 0.0), 0.4,
        error=lambda phase: 0.02 * np.sin(4 * np.pi * phase), gap=0.05, damping_in_gap=True,
        events=(0.4,),
    )  # fmt: skip
    second = Contact(
        lambda phase: np.stack([0 * phase, 1 + 0.1 * np.sin(2 * np.pi * phase)], 1), 9.0
    )
    drag = LoadFriction([0.2, 0.1], [0.02, -0.01, 0.005], load, contacts=(0, 1))
    push = lambda phase: np.stack([6.0 * np.cos(2 * np.pi * phase), 1.0 + 0 * phase], 1)  # noqa: E731
    mass, damping = [[1.0, 0.1], [0.1, 2.0]], np.diag([0.1, 0.2])
    return System(mass, damping, [[1.0, 0.0], [0.0, 3.0]], push, [first, second], frictions=[drag])


def _motions(backend: str) -> dict[str, np.ndarray]:
    """What every way to march lanes gives, by name."""
    pair, start = reference_system(0.1, gap=1e-5), np.zeros(6)
    start[0] = 4e-5
    factors = LaneParameters(
        stiffness_scale=np.array([1.0, 1.1]), damping_scale=0.9, friction_scale=1.2,
        error_scale=np.array([1.0, 1.5]), gap_scale=np.array([1.0, 0.8]), force_scale=0.3,
    )  # fmt: skip
    ensemble = simulate_ensemble(
        pair, [2500.0, 2300.0], 2, (start, 0.0 * start), steps=32,
        parameters=factors, harmonics=1, outputs=np.eye(12)[:2], backend=backend,
    )  # fmt: skip
    separate_systems = simulate_ensemble(
        [_rubbing(40.0), _rubbing(60.0, 4.0)], 0.3, 1, ([0.3, 0.0], [1.0, 0.0]), steps=48,
        averaged=0, backend=backend,
    )  # fmt: skip
    alone = simulate(
        _rubbing(50.0),
        0.3,
        2,
        ([0.3, 0.0], [1.0, 0.0]),
        steps=48,
        recorded_cycles=1,
        backend=backend,
    )
    motions = {
        "position": ensemble.position,
        "velocity": ensemble.velocity,
        "loss": ensemble.contact_loss_share,
    }
    motions |= {
        "own": np.hstack([separate_systems.position, separate_systems.velocity]),
        "alone": alone.position,
    }
    for name in _SIGNALS:
        each = getattr(ensemble, name)
        motions |= {f"{name} {key}": getattr(each, key) for key in vars(each)}
    push = lambda phase: 0.3 + np.sin(2 * np.pi * phase)[:, None]  # noqa: E731
    swinging = System([[1.0]], [[0.9]], [[2.0]], push, [Contact([1.0], 3.0, gap=0.1)])
    over = (("mesh_frequency", [0.2]), ("gap_scale", [1.0, 2.0]))
    chart = parameter_map(
        swinging, over=over, transient=16, cycles=2, steps=32, verdict=False, backend=backend
    )
    motions |= {"rms": chart.rms, "share": chart.contact_loss_share, "period": chart.period}
    growing = System([[1.0]], [[-170.0]], [[40.0]], [1.0])
    with pytest.raises(ComputationError, match="beyond all bounds") as lost:
        simulate_ensemble(growing, [1.0, 1.0], 5, ([1.0], [0.0]), steps=64, backend=backend)
    return motions | {"lost": np.array(str(lost.value))}


@pytest.fixture(scope="module", params=["simulator", "processor"])
def marched(request, tmp_path_factory) -> dict[str, np.ndarray]:
    """The motions on a graphics processor, in a process of its own: Numba decides at import."""
    if request.param == "processor":
        from numba import cuda

        if importlib.util.find_spec("numba_cuda") is None or not cuda.is_available():
            pytest.skip("no graphics processor")
    path = tmp_path_factory.mktemp("cuda") / "motions.npz"
    tests = Path(__file__).parents[2]
    simulated = {"NUMBA_ENABLE_CUDASIM": str(int(request.param == "simulator"))}
    roads = os.pathsep.join([str(tests), *filter(None, sys.path)])
    environment = os.environ | simulated | {"PYTHONPATH": roads}
    subprocess.run([sys.executable, __file__, str(path)], check=True, env=environment, stderr=PIPE)
    return dict(np.load(path))


def test_gpu_lanes_equal_cpu_lanes(marched) -> None:
    expected = _motions("cpu")
    assert expected["loss"].max() > 0.05  # contacts opened and closed
    assert str(marched.pop("lost")) == str(expected.pop("lost"))
    for name, values in expected.items():
        size = max(np.abs(values).max(initial=0.0), 1e-300)
        assert np.abs(marched[name] - values).max(initial=0.0) <= 1e-12 * size, name


def test_missing_package_or_gpu_is_reported_with_its_remedy(monkeypatch) -> None:
    free = System([[1.0]], [[0.0]], [[4.0]], [0.0])
    find_spec = importlib.util.find_spec

    def ask(**options: str) -> str:
        with pytest.raises(InputError) as refused:
            simulate_ensemble(free, [1.0, 2.0], 1, ([1.0], [0.0]), backend="cuda", **options)
        # What a machine lacks is no fault of a member of a study, which is tried again elsewhere.
        assert isinstance(refused.value, OSError) is not bool(options)
        return str(refused.value)

    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "numba_cuda" else find_spec(name)
    )
    assert "argument backend: numba-cuda is not installed" in (text := ask())
    assert 'pip install "tribodyn[cuda]"' in text
    from numba import cuda

    monkeypatch.setattr(importlib.util, "find_spec", lambda name: True)
    monkeypatch.setattr(cuda, "is_available", lambda: False)
    reason = "\nCUDA driver library cannot be found.\nIf you are sure ..."
    monkeypatch.setattr(cuda, "cuda_error", lambda: f"Error at driver init: {reason}")
    assert "no NVIDIA graphics processor available. CUDA driver library" in (text := ask())
    assert "nvidia-smi" in text
    assert 'It belongs to "rk4"' in ask(method="newmark")
    with pytest.raises(InputError, match='"cpu", or "cuda"'):
        simulate(free, 1.0, 1, ([1.0], [0.0]), backend="gpu")


def test_incompatible_package_versions_are_reported(monkeypatch) -> None:
    from numba import cuda

    # What numba-cuda 0.30 meets with NumPy 2.5, before it compiles anything.
    code = compile("def to_device(array): raise AttributeError('no row_stack')", "numba", "exec")
    exec(code, broken := {"__name__": "numba.cuda.np.arrayobj"})
    monkeypatch.setattr(cuda, "to_device", broken["to_device"])
    monkeypatch.setattr(gpu, "require_gpu", lambda: None)
    monkeypatch.setattr(gpu, "version", lambda name: "0.1")
    monkeypatch.setattr(gpu, "_kernel", lambda *sizes: None)
    free = System([[1.0]], [[0.0]], [[4.0]], [0.0])
    with pytest.raises(ComputationError) as caught:
        simulate_ensemble(free, [1.0, 2.0], 1, ([1.0], [0.0]), backend="cuda")
    assert "no row_stack. These versions are incompatible: numba-cuda 0.1" in str(caught.value)


if __name__ == "__main__":
    np.savez(sys.argv[1], **_motions("cuda"))
