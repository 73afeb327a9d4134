"""Heat balance of machines and stages: one temperature for what all meshes lose."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import ComputationError, InputError
from tribodyn.study import Case, MachineCase

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

GEAR = {"face_width": "30 mm", "roughness_ra": "0.3 um"}
MODELS = {"friction": {"law": "benedict-kelly"}, "stiffness": {"model": "iso6336"}}
POINT = {"speed": "1500 rpm", "torque": "90 N*m"}
#: Heat transfer of the housing, and of the gears to the oil.
NODES = ({"heat_transfer": "6 W/K"}, {"heat_transfer": "6 W/K", "gear_heat_transfer": "20 W/K"})


def oil(**keys: str) -> dict[str, str]:
    return {"name": "ISO VG 100", "temperature": "60 degC", **keys}


def machine(
    lubricant: dict[str, str], /, pairs: int = 1, torque: str = "90 N*m", **mesh: Any
) -> Any:
    """Pairs of equal gears beside each other on two shafts."""
    gears, meshes = {}, {}
    for number in range(pairs):
        place = f"{40 * number} mm"
        for name, shaft, teeth in (("a", "in", 20), ("b", "out", 41)):
            gears[f"{name}{number}"] = {"shaft": shaft, "position": place, "teeth": teeth, **GEAR}
        names = {"gears": [f"a{number}", f"b{number}"], "normal_module": "3 mm"}
        meshes[f"m{number}"] = {**names, "backlash": "0.1 mm", **mesh}
    return MachineCase(
        gears=gears, meshes=meshes, lubricant=lubricant, **MODELS,
        operation={"input": "in", "output": "out", **POINT, "torque": torque},
    )  # fmt: skip


def stage(**keys: Any) -> Any:
    rough = {f"gears.{name}.roughness_ra": "0.3 um" for name in ("sun", "planet", "ring")}
    lubricant = {f"lubricant.{name}": value for name, value in oil(**keys).items()}
    return td.load_case("planetary-stage").replace(
        {"friction.law": "benedict-kelly", "load_cases": None, **rough, **lubricant}
    )


@pytest.mark.parametrize("transfer", NODES)
def test_a_pair_and_a_machine_of_two_gears_are_equally_warm(transfer: dict[str, str]) -> None:
    gears = {"pinion": {"teeth": 20, **GEAR}, "wheel": {"teeth": 41, **GEAR}, "driver": "pinion"}
    gears |= {"normal_module": "3 mm", "normal_pressure_angle": "20 deg"}
    pair = td.run(Case(
        gears=gears, lubricant=oil(**transfer), **MODELS, operation=POINT,
        dynamics={"model": "torsional", "backlash": "0.1 mm"},
    ))  # fmt: skip
    joined = td.run(machine(oil(**transfer)))
    for name in ("temperature", "gear_temperature"):
        one, other = (getattr(result.heat, name) for result in (pair, joined))
        assert (one is None) == (other is None)
        assert one is None or other[-1] == pytest.approx(one[-1], abs=1e-6)
    for name in ("friction_coefficient", "stiffness", "load_share"):
        of_machine = getattr(joined.operation.tables["m0"], name)
        np.testing.assert_allclose(of_machine, getattr(pair.mesh, name), rtol=1e-9, atol=1e-12)
    assert joined.summary()["machine.oil_temperature"] == pair.summary()["oil_temperature"]


@pytest.mark.parametrize("transfer", NODES)
def test_two_equal_meshes_with_twice_the_transfer_are_as_warm_as_one(
    transfer: dict[str, str],
) -> None:
    alone = td.run(machine(oil(**transfer)))
    twice = {name: f"{2 * float(value.split()[0])} W/K" for name, value in transfer.items()}
    both = td.run(machine(oil(**twice), pairs=2, torque="180 N*m"))
    assert both.heat.temperature[-1] == pytest.approx(alone.heat.temperature[-1], abs=1e-6)
    assert both.heat.power_loss[-1] == pytest.approx(2.0 * alone.heat.power_loss[-1], rel=1e-6)
    figures = both.summary()
    assert figures["machine.friction_power"] == pytest.approx(
        figures["meshes.m0.friction_power"] + figures["meshes.m1.friction_power"], rel=1e-12
    )


def test_heat_that_is_led_away_leaves_the_temperature_of_the_surroundings() -> None:
    around = {"ambient_temperature": "60 degC"}
    cooled = td.run(machine(oil(heat_transfer="1e9 W/K", **around)))
    stated = td.run(machine(oil()))
    assert cooled.heat.temperature[-1] == pytest.approx(333.15, abs=1e-5)
    assert "machine.oil_temperature" not in stated.summary()
    for name, value in stated.summary().items():
        assert cooled.summary()[name] == pytest.approx(value, rel=1e-6, abs=1e-9), name


def test_a_stage_loses_by_the_speeds_against_its_carrier() -> None:
    """What heats the housing is the friction of the meshes, the loss of power by Willis."""
    result = td.run(stage(heat_transfer="30 W/K"))
    figures, heat = result.summary(), result.heat
    lost = sum(figures[f"meshes.{name}.friction_power"] for name in result.case.meshes)
    assert heat.power_loss[-1] == pytest.approx(lost, rel=1e-9)
    assert heat.power_loss[-1] == pytest.approx(30.0 * (heat.temperature[-1] - 293.15), rel=1e-6)
    assert lost == pytest.approx(
        (1.0 - figures["machine.efficiency"]) * figures["machine.input_power"], rel=1e-9
    )
    # The same oil at that temperature, stated, gives the same teeth.
    warm = stage(temperature=float(heat.temperature[-1]))
    again = td.run(warm)
    for name, table in again.operation.tables.items():
        np.testing.assert_allclose(
            table.friction_coefficient,
            result.operation.tables[name].friction_coefficient,
            rtol=1e-12,
        )


@pytest.mark.slow
def test_bent_shafts_and_every_load_settle_at_their_own_temperature(tmp_path: Path) -> None:
    case = td.load_case("two-stage-spur").replace({
        "lubricant.heat_transfer": "100 W/K", "stiffness.model": "iso6336",
    })  # fmt: skip
    result = td.run(case)
    warm = [load.heat.temperature[-1] for load in result.loads.values()]
    assert len(set(warm)) == len(warm)
    for load in result.loads.values():
        lost = sum(load.friction_power.values())
        assert lost == pytest.approx(100.0 * (load.load.temperature - 293.15), rel=1e-6)
    stored = td.load_result(result.save(tmp_path / "saved"))
    for name, load in result.loads.items():
        assert stored.loads[name].heat == load.heat
        assert stored.loads[name].load == load.load


def test_a_balance_that_is_not_to_be_had_says_what_does() -> None:
    with pytest.raises(ComputationError, match="Set more than") as caught:
        td.run(machine(oil(heat_transfer="0.5 W/K")))
    assert "lubricant.heat_transfer" in str(caught.value)


@pytest.mark.parametrize(
    ("lubricant", "mesh", "message"),
    [
        ({"ambient_temperature": "30 degC"}, {}, "temperatures are fixed"),
        ({"heat_transfer": "6 W/K", "gear_temperature": "90 degC"}, {}, "The balance finds"),
        ({}, {"heat_transfer": "6 W/K"}, "The housing has one heat balance"),
        ({"heat_transfer": "6 W/K"}, {"temperature": "70 degC"}, "finds the temperature of all"),
    ],
)
def test_wrong_keys_are_refused(
    lubricant: dict[str, str], mesh: dict[str, str], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        machine(oil(**lubricant), lubricant=mesh)
