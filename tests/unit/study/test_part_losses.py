"""Losses of bearings, seals and oil in machines: as of a pair, and of each part by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.losses import BEARINGS, bearing_moments, churning_loss, seal_loss
from tribodyn.study import Case, MachineCase
from tribodyn.study.case.to_models import lubricant
from tribodyn.study.part_losses import FIGURES, part_losses

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

GEAR = {"face_width": "30 mm", "roughness_ra": "0.3 um"}
MODELS = {"friction": {"law": "benedict-kelly"}, "stiffness": {"model": "iso6336"}}
POINT = {"speed": "1500 rpm", "torque": "90 N*m"}
OIL = {"name": "ISO VG 100", "temperature": "60 degC"}
INPUT = {"bearing": "NJ 406", "seal_diameter": "30 mm", "immersion": "10 mm"}
OUTPUT = {
    "bearing": "6306", "seal_diameter": "40 mm", "seals": 2, "immersion": "20 mm",
    "bearing_drag_factor": 0.001, "bearing_oil_level": "10 mm",
}  # fmt: skip


def gear(teeth: int) -> dict[str, Any]:
    """Teeth of a gear; those of a ring end where the mate can follow."""
    return {"teeth": teeth, **GEAR, **({"tip_diameter": "178 mm"} if teeth < 0 else {})}


def pair(oil: dict[str, str], wheel: int, **losses: Any) -> Any:
    gears = {"pinion": gear(20), "wheel": gear(wheel)}
    gears |= {"driver": "pinion", "normal_module": "3 mm", "normal_pressure_angle": "20 deg"}
    tables = {"oil_volume": "1 l", "pinion": INPUT, "wheel": OUTPUT, **losses}
    return Case(
        gears=gears, lubricant=oil, **MODELS, operation=POINT, losses=tables,
        dynamics={"model": "torsional", "backlash": "0.1 mm"},
    )  # fmt: skip


def machine(oil: dict[str, str], wheel: int, supports: str = "", **losses: Any) -> Any:
    gears = {
        name: {"shaft": shaft, "position": "40 mm", **gear(teeth)}
        for name, shaft, teeth in (("a", "in", 20), ("b", "out", wheel))
    }
    held = {
        f"{shaft} {place}": {"shaft": shaft, "position": place, "radial_stiffness": supports}
        for shaft in ("in", "out")
        for place in ("10 mm", "70 mm")
    }
    mesh = {"gears": ["a", "b"], "normal_module": "3 mm", "backlash": "0.1 mm"}
    tables = {"oil_volume": "1 l", "shafts": {"in": INPUT, "out": OUTPUT}, **losses}
    return MachineCase(
        gears=gears, meshes={"m": mesh}, bearings=held if supports else {}, lubricant=oil,
        operation={"input": "in", "output": "out", **POINT}, losses=tables, **MODELS,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("wheel", "supports", "heat"),
    [(41, "", {"heat_transfer": "9 W/K"}), (41, "4e8 N/m", {}), (-61, "", {})],
)
def test_a_machine_of_two_gears_loses_what_its_pair_loses(
    wheel: int, supports: str, heat: dict[str, str]
) -> None:
    """Two bearings on both sides of a gear share its force, as those of a pair do."""
    alone, joined = (td.run(make({**OIL, **heat}, wheel)) for make in (pair, machine))
    if supports:
        joined = td.run(machine(OIL, wheel, supports))
    one, other = alone.summary(), joined.summary()
    for name in FIGURES:
        assert one[name] > 0.0
        assert other[f"machine.{name}"] == pytest.approx(one[name], rel=1e-9), name
    total, power = other["machine.total_power_loss"], other["machine.input_power"]
    parts = [other[f"machine.{name}"] for name in (*FIGURES, "friction_power")]
    assert total == pytest.approx(sum(parts), rel=1e-12)
    assert other["machine.total_efficiency"] == pytest.approx(1.0 - total / power, rel=1e-12)
    if heat:  # with these losses the oil is warmer than with teeth alone
        cold = td.run(machine({**OIL, **heat}, wheel).replace({"losses": None}))
        assert joined.heat.temperature[-1] == pytest.approx(alone.heat.temperature[-1], abs=1e-6)
        assert joined.heat.temperature[-1] > cold.heat.temperature[-1] + 5.0


@pytest.mark.slow
def test_a_shaft_dips_all_its_gears_into_one_bath_and_each_bearing_has_its_own_load() -> None:
    case = td.load_case("two-stage-spur").replace({
        "losses.oil_volume": "2 l", "losses.windage": False,
        "losses.shafts.middle.immersion": "60 mm", "losses.shafts.middle.seal_diameter": "40 mm",
        "losses.bearings.C.bearing": "6308", "losses.bearings.D.bearing": "NJ 406",
    })  # fmt: skip
    result = td.run(
        case.replace(
            {
                "load_cases": None,
                "film.model": "none",
                "friction.law": "constant",
                "friction.coefficient": 0.05,
            }
        )
    )
    figures, speed = result.summary(), abs(result.machine.kinematics.shafts["middle"].speed)
    oil = lubricant(case.oil)
    wheel, pinion = (
        result.tables[mesh].gear_pair.center_distance * share
        for mesh, share in (("first", 57 / 80), ("second", 21 / 82))
    )
    bath = (speed, 2e-3, oil.density, oil.kinematic_viscosity)
    churned = churning_loss(wheel, 30e-3, 3e-3, 60e-3, *bath)
    depth = max(60e-3 - (wheel - pinion), 0.0)
    churned += churning_loss(pinion, 47e-3, 4e-3, depth, *bath)
    assert figures["machine.churning_power_loss"] == pytest.approx(churned, rel=1e-9)
    assert figures["machine.seal_power_loss"] == pytest.approx(float(seal_loss(40e-3, speed)))
    moments = [
        bearing_moments(
            BEARINGS[kind], speed, oil.kinematic_viscosity,
            float(np.hypot(*result.operation.static.bearings[name].load[1:3])),
            float(result.operation.static.bearings[name].load[0]),
        ).total
        for name, kind in (("C", "6308"), ("D", "NJ 406"))
    ]  # fmt: skip
    assert figures["machine.bearing_power_loss"] == pytest.approx(speed * sum(moments), rel=1e-9)


@pytest.mark.parametrize("heat", [{}, {"heat_transfer": "3 W/K"}])
def test_meshes_of_constant_stiffness_leave_the_losses_of_bearings_and_bath(
    heat: dict[str, str],
) -> None:
    """Oil is that of bearings and bath: 90 N m on a base radius of 28.19 mm, half to each side."""
    stiff = machine({**OIL, **heat}, 41, "4e8 N/m").data
    meshes = {"m": {"gears": ["a", "b"], "normal_module": "3 mm", "stiffness": "4e8 N/m"}}
    gears = {name: {k: v for k, v in each.items() if k != "roughness_ra"}
             for name, each in stiff["gears"].items()}  # fmt: skip
    data = {k: v for k, v in stiff.items() if k not in MODELS} | {"meshes": meshes, "gears": gears}
    result = td.run(MachineCase(**data))
    figures = result.summary()
    warm = figures.get("machine.oil_temperature", 333.15)
    oil = lubricant(result.case.oil, warm)
    force, speeds = 0.5 * 90.0 / (0.03 * np.cos(np.radians(20.0))), (157.0796, 157.0796 * 20 / 41)
    extra = {"drag_factor": 0.001, "oil_level": 10e-3}
    lost = sum(
        2.0 * speed * bearing_moments(
            BEARINGS[kind], speed, oil.kinematic_viscosity, force, **options
        ).total
        for speed, kind, options in zip(speeds, ("NJ 406", "6306"), ({}, extra), strict=True)
    )  # fmt: skip
    assert figures["machine.bearing_power_loss"] == pytest.approx(lost, rel=1e-6)
    if heat:
        assert 3.0 * (warm - 293.15) == pytest.approx(figures["machine.total_power_loss"], rel=1e-6)


def test_bearings_of_helical_gears_lose_by_their_thrust_as_well() -> None:
    case = td.load_case("two-stage-helical").replace({"losses.shafts.input.bearing": "6308"})
    load = case.operating_point
    thrust = [each.load[0] for each in _static(case).bearings.values()]
    assert max(map(abs, thrust)) > 10.0
    assert part_losses(case, load, _static(case))["bearing_power_loss"] > 0.0
    assert (
        part_losses(case, load)["bearing_power_loss"]
        < 0.5 * (part_losses(case, load, _static(case))["bearing_power_loss"])
    )


def _static(case: Any) -> Any:
    from tribodyn.machine import static_balance

    stiff = {name: {"stiffness": 4e8} for name in case.meshes}
    return static_balance(case.machine(**stiff))


def test_gears_of_a_hypoid_axle_churn_as_their_pair() -> None:
    depth = {"losses.oil_volume": "2 l", "losses.pinion.immersion": "5 mm",
             "losses.wheel.immersion": "40 mm"}  # fmt: skip
    case = td.load_case("hypoid-axle")
    (mesh,) = case.meshes
    oil = {f"lubricant.{k}": v for k, v in OIL.items() if "lubricant" not in case.data}
    pinion, wheel = (case.gears[name].shaft for name in case.data["meshes"][mesh]["gears"])
    axle = case.replace({**oil, "losses.oil_volume": "2 l",
                         f"losses.shafts.{pinion}.immersion": "5 mm",
                         f"losses.shafts.{wheel}.immersion": "40 mm"})  # fmt: skip
    of_pair = case.replace(oil).pair(mesh, case.operating_point).replace(depth)
    losses = td.loss_map(of_pair, torque=of_pair.operation.torque, speed=of_pair.operation.speed)
    of_axle = part_losses(axle, axle.operating_point)
    for name in ("churning", "windage"):
        value = float(getattr(losses, name)[0, 0])
        assert value > 0.0
        assert of_axle[f"{name}_power_loss"] == pytest.approx(value, rel=1e-9)


@pytest.mark.slow
def test_a_stage_loses_by_the_seal_of_its_carrier(tmp_path: Path) -> None:
    case = td.load_case("planetary-stage")
    stage = case.data["planets"][case.lone_stage]
    shaft = f"losses.shafts.{stage['carrier']}"
    sealed = case.replace({f"{shaft}.seal_diameter": "60 mm", "load_cases": None})
    result = td.run(sealed)
    speed = abs(result.machine.kinematics.shafts[stage["carrier"]].speed)
    lost = result.summary()["machine.seal_power_loss"]
    assert lost == pytest.approx(float(seal_loss(60e-3, speed)), rel=1e-12)
    again = td.load_result(result.save(tmp_path / "saved"))
    assert again.operation.losses == result.operation.losses
    assert again.case.to_toml() == sealed.to_toml()
    with pytest.raises(InputError, match="axes stand still"):
        sealed.replace({f"{shaft}.immersion": "10 mm"})


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"losses.shafts.int.seals": 2}, ("losses.shafts.int", 'no shaft "int"', "in")),
        ({"losses.bearings.Z.bearing": "6306"}, ("losses.bearings.Z", 'no bearing "Z"')),
        ({"losses.bearings.in 10 mm.bearing_oil_level": "1 mm"}, ("bearing is missing",)),
        ({"losses.shafts.in.bearings": 4}, ("losses.shafts.in.bearings", "in 10 mm, in 70 mm")),
        ({"losses.shafts.in.immersion": "35 mm"}, ("losses.shafts.in.immersion", "30 mm")),
        ({"losses.oil_volume": None}, ("losses.oil_volume", "oil_volume is missing")),
        ({"lubricant": None, "friction.law": "constant", "friction.coefficient": 0.05},
         ("losses.shafts.in.bearing", "there is no oil")),
    ],
)  # fmt: skip
def test_what_has_no_part_or_no_effect_is_refused(
    changes: dict[str, Any], words: tuple[str, ...]
) -> None:
    case = machine(OIL, 41, "4e8 N/m")
    with pytest.raises(InputError) as caught:
        case.replace(changes)
    for word in words:
        assert word in str(caught.value)


def test_papers_behind_the_losses_are_cited() -> None:
    case = machine(OIL, 41)
    from tribodyn.study.pipeline.citations import papers

    assert {"skf", "iso-14179", "changenet-velex", "anderson-loewenthal"} <= set(papers(case))
    assert "skf" not in papers(case.replace({"losses": None}))
