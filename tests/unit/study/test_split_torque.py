"""Machines whose torque takes two ways: what each mesh, shaft and tooth carries of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import tribodyn as td
from tribodyn.machine.graph.kinematics import base_radius
from tribodyn.study.machine.pair_cases import teeth_under
from tribodyn.study.machine.result import power_with_friction
from tribodyn.study.machine.run import balanced_machine

K_IN, K_OUT, SOFT, HARD = 4e8, 6e8, 2e8, 1e12
TEETH = {"z1": ("in", 23), "za": ("la", 71), "zb": ("lb", 71), "pa": ("la", 19), "pb": ("lb", 19),
         "bull": ("out", 83)}  # fmt: skip
PAIRS = {"ia": ("z1", "za", 3, 60.0), "ib": ("z1", "zb", 3, -60.0),
         "oa": ("pa", "bull", 4, -36.77), "ob": ("pb", "bull", 4, 36.77)}  # fmt: skip


def split_torque(**changes: Any) -> td.study.MachineCase:
    """Two lay shafts side by side, of which one has soft bearings."""
    return td.study.MachineCase(
        gears={
            name: {"shaft": shaft, "teeth": teeth, "face_width": "40 mm"}
            for name, (shaft, teeth) in TEETH.items()
        },
        meshes={
            name: {"gears": [first, second], "normal_module": f"{module} mm",
                   "angle": f"{angle} deg",
                   **({} if changes else {"stiffness": K_IN if module == 3 else K_OUT})}
            for name, (first, second, module, angle) in PAIRS.items()
        },
        bearings={
            shaft: {"shaft": shaft, "position": 0.0,
                    "radial_stiffness": SOFT if shaft == "la" else HARD}
            for shaft in ("in", "la", "lb", "out")
        },
        operation={"input": "in", "output": "out", "speed": "3000 rpm", "torque": "200 N*m"},
        **changes,
    )  # fmt: skip


def way_of_the_soft_shaft(machine: td.machine.Machine) -> float:
    """Share that makes the energy of springs and bearings least (Castigliano)."""
    forces = {name: mesh.force for name, mesh in machine.kinematics.meshes.items()}
    directions = {name: each.direction for name, each in machine.directions.items()}
    compliance = []
    for enters, leaves, support in (("ia", "oa", SOFT), ("ib", "ob", HARD)):
        on_shaft = forces[enters] * directions[enters][7:9]
        on_shaft = on_shaft + forces[leaves] * directions[leaves][1:3]
        springs = forces[enters] ** 2 / K_IN + forces[leaves] ** 2 / K_OUT
        compliance.append(springs + on_shaft @ on_shaft / support)
    return float(compliance[1] / sum(compliance))


def test_the_torque_of_a_loop_is_shared_by_meshes_and_bearings() -> None:
    case = split_torque()
    share = way_of_the_soft_shaft(case.machine())
    assert share < 0.4  # half of the torque by rigid shafts
    result = td.run(case)
    figures, torque = result.summary(), 200.0 * 71 / 23
    assert figures["shafts.la.torque"] == pytest.approx(share * torque, rel=1e-3)
    assert figures["shafts.lb.torque"] == pytest.approx((1.0 - share) * torque, rel=1e-3)
    assert figures["shafts.out.torque"] == pytest.approx(torque * 83 / 19, rel=1e-12)
    assert figures["shafts.la.power"] + figures["shafts.lb.power"] == pytest.approx(
        figures["machine.input_power"], rel=1e-12
    )
    for name in PAIRS:
        static = figures[f"meshes.{name}.static_mesh_force"]
        assert static == pytest.approx(result.static.meshes[name].force, rel=1e-9)
        assert figures[f"meshes.{name}.mean_mesh_force"] == pytest.approx(static, rel=1e-6)


@pytest.mark.slow
def test_a_stored_loop_has_the_same_power_flow(tmp_path: Path) -> None:
    result = td.run(split_torque())
    result.save(tmp_path / "result")
    again = td.load_result(tmp_path / "result")
    assert again.power_flow.shafts == result.power_flow.shafts


def test_teeth_of_a_loop_carry_what_the_loop_gives_them() -> None:
    case = split_torque(
        stiffness={"model": "iso6336"},
        film={"model": "none"},
        friction={"law": "constant", "coefficient": 0.05},
    )
    state = balanced_machine(case, case.operating_point)
    force = {name: mesh.force for name, mesh in state.static.meshes.items()}
    assert force["ia"] < 0.75 * force["ib"]
    flow, lost = power_with_friction(state.machine, state.tables)
    for name, nominal in state.machine.kinematics.meshes.items():
        assert nominal.force == pytest.approx(force[name], rel=0.01)
        share = state.tables[name].mean_friction_power / nominal.power
        assert lost[name] == pytest.approx(share * flow.meshes[name].power, rel=1e-12)
        pinion = state.machine.gears[nominal.driver]
        lever = base_radius(state.machine.meshes[name], pinion)
        _, torque = teeth_under(case, name, state.load).operation
        assert torque == pytest.approx(force[name] * lever, rel=0.01)
    left = case.operating_point.torque * case.operating_point.speed - sum(lost.values())
    assert flow.shafts["out"].power == pytest.approx(left, rel=1e-9)
