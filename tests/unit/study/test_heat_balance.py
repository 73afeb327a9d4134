"""Bulk temperature: what is lost is what the surroundings take up."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import ComputationError, InputError
from tribodyn.lubricant import library, temperature_range
from tribodyn.mesh import MeshTable
from tribodyn.study import coupling
from tribodyn.study.pipeline.run import prepare_run
from tribodyn.study.pipeline.tooth_contact import mesh_of

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")


def _case(transfer: str = "4 W/K", **more: Any) -> Any:
    changes = {
        "lubricant.name": "ISO VG 100", "lubricant.temperature": "60 degC",
        "friction.law": "schlenk", "friction.variant": None, "lubricant.heat_transfer": transfer,
    }  # fmt: skip
    more = {key.replace("__", "."): value for key, value in more.items()}
    return td.load_case("fzg-roughness").replace({**changes, **more})


def _balanced(case: Any, mesh_at: Callable[[Any], MeshTable]) -> Any:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(coupling, "mesh_of", lambda point, progress: mesh_at(point))
        prepared = prepare_run(case)
    return prepared.case, prepared.heat


def _balance(case: Any) -> Any:
    """The balance of the mesh alone, without the motion."""
    calls: list[float] = []

    def mesh_at(point: Any) -> MeshTable:
        calls.append(point.lubricant.temperature)
        return mesh_of(point)

    summary, heat = _balanced(case, mesh_at)
    gears = heat.temperature if heat.gear_temperature is None else heat.gear_temperature
    assert calls == gears.tolist()
    return summary, heat


@pytest.mark.parametrize("around", ["-10 degC", "20 degC"])
def test_lost_power_equals_heat_given_off(around: str) -> None:
    if around == "-10 degC":
        with pytest.raises(ComputationError, match="start at 10 degC"):
            _balance(_case(lubricant__ambient_temperature=around))
        return
    summary, heat = _balance(_case(losses__wheel__seal_diameter="30 mm"))
    lost = td.loss_map(summary, torque=summary.operation.torque, speed=summary.operation.speed)
    rise = summary.lubricant.temperature - 293.15
    assert float(lost.total[0, 0]) == pytest.approx(4.0 * rise, rel=1e-6)
    assert lost.seal[0, 0] > 0.0
    assert float(lost.gear[0, 0]) < 4.0 * rise  # the seal heats too
    assert heat.power_loss[-1] == pytest.approx(heat.dissipated[-1], rel=1e-6)
    # not a thing of chance: a tenth of a degree further it no longer holds
    off = summary.replace({"lubricant.temperature": summary.lubricant.temperature + 0.1})
    lost = td.loss_map(off, torque=summary.operation.torque, speed=summary.operation.speed)
    assert float(lost.total[0, 0]) != pytest.approx(4.0 * (rise + 0.1), rel=1e-4)


def test_more_heat_transfer_is_cooler_down_to_the_surroundings() -> None:
    transfers = ("3 W/K", "10 W/K", "100 W/K", "1e4 W/K", "1e9 W/K")
    above = (
        np.array([_balance(_case(each))[0].lubricant.temperature for each in transfers]) - 293.15
    )
    assert np.all(np.diff(above) < 0.0)
    assert above[-1] < 1e-6
    # far out the loss is that of the surroundings, so that the rise falls as 1/hA
    assert above[-2] / above[-1] == pytest.approx(1e5, rel=1e-3)


def test_where_it_begins_does_not_matter() -> None:
    cold, hot = (_balance(_case(lubricant__temperature=t))[0] for t in ("20 degC", "120 degC"))
    assert cold.lubricant.temperature == pytest.approx(hot.lubricant.temperature, abs=1e-4)


def test_without_losses_it_is_as_warm_as_the_surroundings() -> None:
    summary, heat = _balance(_case(friction__law="none"))
    assert summary.lubricant.temperature == 293.15
    assert heat.power_loss[-1] == 0.0


def test_a_balance_outside_the_range_of_the_oil_is_reported() -> None:
    with pytest.raises(ComputationError) as caught:
        _balance(_case("0.5 W/K"))
    message = str(caught.value)
    for part in ("130 degC", "lubricant.heat_transfer", "the loss is", "Set more than"):
        assert part in message
    # what it says would do does
    enough = float(message.partition("Set more than ")[2].partition(" W/K")[0])
    assert _balance(_case(f"{1.02 * enough} W/K"))[0].lubricant.temperature < 403.15


def test_losses_that_jump_are_reported() -> None:
    case, mesh = _case(), mesh_of(_case())
    lossy, smooth = (_scaled(mesh, factor) for factor in (8.0, 0.01))

    def mesh_at(point: Any) -> MeshTable:
        return lossy if point.lubricant.temperature < 320.0 else smooth

    with pytest.raises(ComputationError, match="do not settle"):
        _balanced(case, mesh_at)


def _scaled(mesh: MeshTable, factor: float) -> MeshTable:
    from dataclasses import replace

    return replace(mesh, friction_coefficient=factor * mesh.friction_coefficient)


@pytest.mark.parametrize(("law", "local"), [("schlenk", False), ("benedict-kelly", True)])
def test_a_run_ends_at_the_balance_with_and_without_coupling(
    law: str, local: bool, tmp_path: Path
) -> None:
    """A mean coefficient does not know how load is shared; one of each contact does."""
    case = _case(
        "10 W/K", operation__torque_balance="load", friction__law=law,
        gears__composite_roughness="0.3 um",
    )  # fmt: skip
    plain, coupled = (
        td.run(case.replace({"solver.coupling": coupling})) for coupling in ("none", "static")
    )
    for result in (plain, coupled):
        heat, summary = result.heat, result.summary()
        assert heat.power_loss[-1] == pytest.approx(heat.dissipated[-1], rel=1e-6)
        assert summary["oil_temperature"] == result.case.lubricant.temperature
        assert heat.power_loss[-1] == pytest.approx(result.mesh.mean_friction_power, rel=1e-12)
    assert coupled.coupling.friction_change[-1] <= coupled.coupling.tolerance
    fall = plain.heat.temperature[-1] - coupled.heat.temperature[-1]
    less = plain.mesh.mean_friction_power - coupled.mesh.mean_friction_power
    assert 10.0 * fall == pytest.approx(less, rel=1e-3, abs=1e-5)
    assert fall > 0.01 if local else abs(fall) < 1e-6
    if local:
        stored = td.load_result(coupled.save(tmp_path / "saved")).heat
        assert stored.to_xarray().identical(coupled.heat.to_xarray())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"lubricant.name": None, "lubricant.dynamic_viscosity": "82 mPa*s",
          "lubricant.density": "880 kg/m^3",
          "lubricant.pressure_viscosity_coefficient": "21.9 1/GPa"}, "at one temperature"),
        ({"lubricant.heat_transfer": None, "lubricant.ambient_temperature": "30 degC"},
         "temperatures are fixed"),
        ({"lubricant.heat_transfer": "5 W"}, "heat_transfer"),
        ({"lubricant.heat_transfer": "0 W/K"}, "heat_transfer"),
        ({"lubricant.gear_temperature": "90 degC"}, "The balance finds"),
        ({"lubricant.heat_transfer": None, "lubricant.gear_heat_transfer": "5 W/K"}, "are fixed"),
    ],
)  # fmt: skip
def test_wrong_keys_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        _case().replace(changes)


@pytest.mark.parametrize(
    "oil",
    [
        {"lubricant.name": "80W"},
        {"lubricant.name": None, "lubricant.kinematic_viscosity_at_40": "100 mm^2/s",
         "lubricant.viscosity_index": 95.0, "lubricant.density_at_15": "892.2 kg/m^3"},
    ],
)  # fmt: skip
def test_any_oil_over_temperature_takes_part_in_the_balance(oil: dict[str, Any]) -> None:
    summary, heat = _balance(_case().replace(oil))
    assert heat.power_loss[-1] == pytest.approx(heat.dissipated[-1], rel=1e-6)
    if "lubricant.density_at_15" in oil:
        same, _ = _balance(_case())
        assert summary.lubricant.temperature == pytest.approx(same.lubricant.temperature, abs=0.01)


def test_range_of_an_oil_is_where_it_can_be_made() -> None:
    for name in library():
        for temperature in temperature_range(name):
            td.lubricant.from_library(name, temperature)
    with pytest.raises(InputError):
        td.lubricant.from_library("ISO VG 100", temperature_range("ISO VG 100")[1] + 0.1)


def test_gears_and_oil_each_dissipate_what_heats_them() -> None:
    """Heat flows of both nodes, with losses computed anew at the temperatures that result."""
    bath = {"losses__wheel__immersion": "20 mm", "losses__oil_volume": "1.2 l"}
    local = {"friction__law": "benedict-kelly", "gears__composite_roughness": "0.3 um"}
    point, heat = _balance(_case("5 W/K", lubricant__gear_heat_transfer="20 W/K", **bath, **local))
    oil, gears = point.lubricant.temperature, point.lubricant.gear_temperature
    lost = td.loss_map(point, torque=point.operation.torque, speed=point.operation.speed)
    assert float(lost.gear[0, 0]) == pytest.approx(20.0 * (gears - oil), rel=1e-6)
    assert float(lost.total[0, 0]) == pytest.approx(5.0 * (oil - 293.15), rel=1e-6)
    assert (heat.temperature[-1], heat.gear_temperature[-1]) == (oil, gears)
    # The film has the temperature of the gears, the bath that of the oil.
    keys = ("heat_transfer", "gear_heat_transfer", "gear_temperature")
    one_temperature = {f"lubricant.{key}": None for key in keys}
    warm = point.replace({**one_temperature, "lubricant.temperature": gears})
    assert mesh_of(warm).mean_friction_power == mesh_of(point).mean_friction_power
    other = td.loss_map(warm, torque=point.operation.torque, speed=point.operation.speed)
    assert other.churning[0, 0] < 0.99 * lost.churning[0, 0]


def test_a_good_transfer_between_gears_and_oil_makes_one_node_of_them() -> None:
    alone, _ = _balance(_case())
    together, heat = _balance(_case(lubricant__gear_heat_transfer="1e9 W/K"))
    assert together.lubricant.temperature == pytest.approx(alone.lubricant.temperature, abs=1e-4)
    assert heat.gear_temperature[-1] == pytest.approx(heat.temperature[-1], abs=1e-5)
    with pytest.raises(ComputationError, match="a greater gear_heat_transfer"):
        _balance(_case(lubricant__gear_heat_transfer="0.5 W/K"))
