"""Figures of a result whose mesh carries by a force law: all ramps count, and the first touch."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from broken import SOUND

import tribodyn as td
from tribodyn.dynamics import steady_state
from tribodyn.mesh import MeshTable
from tribodyn.plot import FIGURES
from tribodyn.study import Result, read_case
from tribodyn.study.pipeline.assembly import damping_of, system_of
from tribodyn.study.pipeline.response_series import first_touch
from tribodyn.study.pipeline.tooth_contact import mesh_of

#: Deflection at which the relieved flanks touch, mean and swing over the mesh cycle [m].
_TOUCH, _SWING = 6e-6, 2e-6
_CHANGES = {
    "dynamics.backlash": "0.05 mm", "dynamics.mesh_damping_ratio": 0.02,
    "solver.steps_per_mesh_cycle": 1024, "friction.coefficient": 0.0,
}  # fmt: skip
#: A light, fast drive whose flanks part.
_LOOSE = {
    "operation.torque": 5.0, "operation.speed": "6000 rpm", "dynamics.model": "torsional",
    "dynamics.transmission_error_amplitude": 10e-6,
}  # fmt: skip


def _with_law(mesh: MeshTable, shares: tuple[float, ...]) -> MeshTable:
    """A mesh of 3e8 N/m in ramps 4 um apart, that begins where relieved flanks touch."""
    touch = _TOUCH + _SWING * np.cos(2 * np.pi * mesh.grid.phase)
    places = touch[:, None] + 4e-6 * np.arange(len(shares))
    stiffness = np.tile(3e8 * np.array(shares), (touch.size, 1))
    table = replace(mesh, ramp_deflection=places, ramp_stiffness=stiffness)
    static = table.force_law.deflection(0.0, mesh.total_normal_force) + touch - touch[0]
    tangent = table.force_law.tangent(0.0, static[0])
    return replace(
        table,
        static_transmission_error=static,
        mesh_stiffness_tangent=np.full(touch.size, tangent),
    )


@pytest.fixture
def ran(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Run a case on such a mesh: ``ran(way, shares, changes)``."""

    def make(way: str, shares: tuple[float, ...], changes: dict[str, Any] | None = None) -> Result:
        for place in ("assembly", "motion"):
            monkeypatch.setattr(f"tribodyn.study.pipeline.{place}.mesh_law_of", lambda case: way)
        case = read_case(SOUND, "pair.toml").replace(_CHANGES | (changes or {}))
        mesh = _with_law(mesh_of(case), shares)
        damping = damping_of(case, mesh)
        system = system_of(case, mesh, damping)
        response = steady_state(system, mesh.mesh_frequency, steps=1024)
        return Result(case, mesh, system, response, damping, ())

    return make


def test_all_ramps_carry_the_torque(ran: Any) -> None:
    result = ran("force-law", (0.5, 0.3, 0.2))
    assert result.response.contact_force.shape[1] == 3
    figures = result.summary()
    assert figures["mean_mesh_force"] == pytest.approx(figures["static_mesh_force"], rel=1e-8)
    total = result.response.fine.contact_force.sum(axis=1)
    assert figures["peak_mesh_force"] == pytest.approx(total.max(), rel=1e-6)
    curve = next(trace for trace in FIGURES["mesh_force"](result).data if trace.name == "dynamic")
    assert max(curve.y) == pytest.approx(total.max(), rel=1e-6)
    data = result.to_xarray()
    assert data["mesh_force"].attrs["units"] == "N"
    np.testing.assert_array_equal(data["mesh_force"], data["contact_force"].sum("contact"))


def test_one_ramp_is_its_own_tangent_in_every_figure(ran: Any) -> None:
    # The transmission error of the tangent counts the error that displaces it.
    law, tangent = (ran(way, (1.0,)).summary() for way in ("force-law", "tangent"))
    for name in (
        "mean_mesh_force", "peak_mesh_force", "mean_dynamic_transmission_error",
        "peak_to_peak_dynamic_transmission_error", "rms_bearing_force_loa_pinion",
    ):  # fmt: skip
        assert law[name] == pytest.approx(tangent[name], rel=1e-5), name
    load, first = law["static_mesh_force"], law["mean_dynamic_transmission_error"]
    assert first == pytest.approx(load / 3e8 + _TOUCH, rel=1e-6)


def test_flanks_are_apart_before_the_relieved_ones_touch(ran: Any) -> None:
    result = ran("force-law", (0.7, 0.3), _LOOSE)
    samples = result.response.fine
    # Off the driving flanks: no force at all, or that of the back flanks.
    parted = (samples.contact_force == 0.0).all(axis=1) | (samples.deflection[:, 0] < 0.0)
    share = result.summary()["contact_loss_share"]
    assert 0.01 < share < 0.99
    assert share == pytest.approx(samples.mean(parted.astype(float)), abs=1e-3)
    touch = first_touch(result.system, samples)
    assert touch.max() == pytest.approx(result.half_backlash + _TOUCH + _SWING, rel=1e-9)
    # Half of the play alone would call relieved flanks closed.
    late = samples.mean((samples.deflection[:, 0] <= result.half_backlash).astype(float))
    assert late < share - 0.01


@pytest.mark.parametrize(
    ("way", "message"),
    [("stiffness", "makes the mesh linear"), ("force-law", "lets the back flanks push at once")],
)
def test_without_play_a_pulling_mesh_is_reported(
    monkeypatch: pytest.MonkeyPatch, way: str, message: str
) -> None:
    for place in ("assembly", "motion"):
        monkeypatch.setattr(f"tribodyn.study.pipeline.{place}.mesh_law_of", lambda case: way)
    light = _LOOSE | {"dynamics.backlash": 0.0}
    case = read_case(SOUND, "pair.toml").replace(_CHANGES | light)
    with pytest.warns(td.ModelWarning, match=f"mesh-tension.*backlash 0 {message}"):
        result = td.run(case)
    assert result.summary()["minimum_mesh_force"] < 0.0
