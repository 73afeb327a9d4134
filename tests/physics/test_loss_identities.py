"""Power lost in the mesh: force times sliding, part by part, and what a map and a run agree on."""

from __future__ import annotations

import numpy as np
import pytest

import tribodyn as td
from tribodyn.mesh.functions import PhaseFunction
from tribodyn.study.pipeline.response_series import measured, mesh_force, one_sided_phase

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

BOX = {
    "losses.pinion.bearing": "NJ 406", "losses.wheel.bearing": "NJ 406",
    "losses.pinion.seal_diameter": "30 mm", "losses.wheel.seal_diameter": "30 mm",
    "losses.wheel.immersion": "30 mm", "losses.oil_volume": "1.2 l",
}  # fmt: skip


def case_of(**changes):
    case = td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    return case.replace({key.replace("__", "."): value for key, value in changes.items()})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("driver", "law"), [("pinion", "benedict-kelly"), ("wheel", "xu-2007"), ("wheel", "schlenk")]
)
def test_loss_of_a_run_is_friction_force_times_sliding_of_every_pair(driver, law):
    result = td.run(case_of(gears__driver=driver, friction__law=law))
    mesh, samples = result.mesh, measured(result.response)
    # Of each pair, and of the corners that touch early and late; not by way of the moments.
    each = mesh.by_share(np.abs(mesh.friction_coefficient * mesh.sliding_speed))
    per_force = PhaseFunction(mesh.grid, each)
    power = per_force(one_sided_phase(samples)) * mesh_force(samples)
    lost = float(np.sum(samples.weight * power))
    figures = result.summary()
    assert figures["gear_power_loss"] == pytest.approx(lost, rel=1e-10)
    assert figures["efficiency"] == pytest.approx(1.0 - lost / figures["input_power"], rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("balance", ["drive", "load"])
def test_total_of_a_run_with_a_gearbox(balance):
    case = case_of(operation__torque_balance=balance).replace(BOX)
    figures = td.run(case).summary()
    losses = td.loss_map(case, torque=90.0, speed=case.operation.speed)
    names = ("gear", "bearing", "seal", "churning", "windage")
    parts = {name: figures[f"{name}_power_loss"] for name in names}
    assert figures["total_power_loss"] == pytest.approx(sum(parts.values()), rel=1e-14)
    # Bearings, seals and oil do not ask how the teeth vibrate.
    other_losses = (losses.total - losses.gear).item()
    assert sum(parts.values()) - parts["gear"] == pytest.approx(other_losses, rel=1e-12)
    power_in = 90.0 * case.pinion_speed
    drive_power = power_in + (figures["total_power_loss"] if balance == "load" else 0.0)
    assert figures["total_efficiency"] == pytest.approx(
        1.0 - figures["total_power_loss"] / drive_power, rel=1e-12
    )
    assert figures["total_efficiency"] < figures["efficiency"]


def test_map_of_constant_friction_is_the_gear_loss_factor():
    case = td.load_case("fzg-roughness").replace(
        {
            "stiffness.model": "rectangular",
            "stiffness.pair_stiffness": 2e8,
            "friction.law": "constant",
            "friction.coefficient": 0.06,
        }
    )
    losses = td.loss_map(case, torque=[20.0, 200.0], speed=[50.0, 100.0, 400.0])
    factor = td.losses.gear_loss_factor(case.gear_pair)
    assert losses.gear_efficiency == pytest.approx(np.full((2, 3), 1.0 - 0.06 * factor), rel=1e-12)
    assert np.array_equal(losses.efficiency, losses.gear_efficiency)


def test_map_of_a_wheel_is_that_of_its_pinion():
    case = td.load_case("fzg-roughness").replace({"friction.law": "schlenk"})
    ratio = case.gear_ratio
    turned = case.replace(
        {
            "operation.speed_of": "wheel",
            "operation.torque": 90.0 * ratio,
            "operation.speed": case.operation.speed / ratio,
        }
    )
    assert turned.pinion_torque == pytest.approx(90.0)
    losses = td.loss_map(case, torque=[45.0, 90.0], speed=[50.0, 100.0])
    other = td.loss_map(
        turned, torque=[45.0 * ratio, 90.0 * ratio], speed=[50.0 / ratio, 100.0 / ratio]
    )
    assert other.pinion_torque == pytest.approx(losses.pinion_torque)
    assert other.total == pytest.approx(losses.total, rel=1e-12)
    standing = td.loss_map(turned)
    assert standing.pinion_torque[3] == pytest.approx(90.0)
    assert standing.pinion_speed[3] == pytest.approx(case.pinion_speed)
    assert standing.total.shape == (8, 8)


def test_warnings_of_a_map_are_reported_once_with_their_points():
    case = td.load_case("fzg-roughness")
    with pytest.warns(td.ModelWarning, match=r"friction-range.*holds at \d+ of 4 points") as heard:
        td.loss_map(case, torque=[90.0, 180.0], speed=["100 rpm", "900 rpm"])
    assert len([each for each in heard if "friction-range" in str(each.message)]) == 1


def test_rig_of_a_case_has_its_gears_on_both_sides():
    case = case_of(friction__law="schlenk").replace(BOX)
    slave = case.replace({"losses.pinion.bearing": "QJ 308", "losses.wheel.bearing": "QJ 308"})
    equal, flow = td.rig_power_flow(case), td.rig_power_flow(case, slave)
    point = td.loss_map(case, torque=90.0, speed=case.operation.speed)
    assert equal.motor_power == pytest.approx(2.0 * point.total.item(), rel=1e-12)
    assert flow.loss[0] == pytest.approx(equal.loss[0])
    moved = [name for name, a, b in zip(flow.part, *flow.loss, strict=True) if a != b]
    assert moved == ["bearing_rolling", "bearing_sliding"]
    other = case.replace({"operation.torque": "95 N*m"})
    with pytest.raises(td.InputError, match="the same in both"):
        td.rig_power_flow(case, other)


@pytest.mark.parametrize(
    ("changes", "place"),
    [
        ({"losses.wheel.immersion": "30 mm"}, "losses.oil_volume: oil_volume is missing"),
        ({"losses.wheel.immersion": "90 mm", "losses.oil_volume": "1 l"}, "losses.wheel.immersion"),
        ({"losses.pinion.bearing": "NJ 407"}, 'losses.pinion.bearing.*Did you mean "NJ 406"'),
        ({"losses.pinion.bearings": 0}, "losses.pinion.bearings"),
    ],
)
def test_faults_of_the_gearbox_name_the_key(changes, place):
    with pytest.raises(td.InputError, match=place):
        case_of().replace(changes)


def test_a_case_with_losses_reads_back(tmp_path):
    case = case_of().replace(BOX)
    file = tmp_path / "box.toml"
    file.write_text(case.to_toml(), encoding="utf-8")
    assert td.load_case(file) == case
    assert td.load_case(file).gearbox == case.gearbox
    assert case_of().gearbox is None
