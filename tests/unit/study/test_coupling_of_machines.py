"""Film, friction and load agree in machines and stages, with their shafts and their oil."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.study import Case, MachineCase

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

GEAR = {"face_width": "30 mm", "roughness_ra": "0.3 um"}
OIL = {"name": "ISO VG 100", "temperature": "60 degC"}
POINT = {"speed": "1500 rpm", "torque": "90 N*m"}
SOLVER = {"coupling": "static", "coupling_tolerance": 1e-10}
MODELS = {
    "film": {"model": "dowson-higginson", "stiffness": "tangent"},
    "friction": {"law": "benedict-kelly"},
    "stiffness": {"model": "iso6336"},
}
COLUMNS = ("friction_coefficient", "load_per_width", "central_film", "stiffness", "load_share")


def two_gears(**tables: Any) -> MachineCase:
    gears = {"a": {"shaft": "in", "teeth": 20, **GEAR}, "b": {"shaft": "out", "teeth": 41, **GEAR}}
    meshes = {"m": {"gears": ["a", "b"], "normal_module": "3 mm", "backlash": "0.1 mm"}}
    ends = {"input": "in", "output": "out"}
    tables = {"lubricant": OIL, "solver": SOLVER, **MODELS, **tables}
    return MachineCase(gears=gears, meshes=meshes, operation={**ends, **POINT}, **tables)


def as_pair(**tables: Any) -> Case:
    gears = {"pinion": {"teeth": 20, **GEAR}, "wheel": {"teeth": 41, **GEAR}, "driver": "pinion"}
    gears |= {"normal_module": "3 mm", "normal_pressure_angle": "20 deg"}
    tables = {"lubricant": OIL, "solver": SOLVER, **MODELS, **tables}
    dynamics = {"model": "torsional", "backlash": "0.1 mm"}
    return Case(gears=gears, dynamics=dynamics, operation=POINT, **tables)


@pytest.mark.parametrize("warm", [{}, {"heat_transfer": "6 W/K"}])
@pytest.mark.parametrize("law", ["stiffness", "tangent"])
def test_a_pair_and_a_machine_of_two_gears_settle_alike(warm: dict[str, str], law: str) -> None:
    oil = {"lubricant": {**OIL, **warm}}
    machine = two_gears(**oil, dynamics={"mesh_law": law})
    pair = as_pair(**oil).replace({"dynamics.mesh_law": law})
    joined, alone = td.run(machine), td.run(pair)
    apart = td.run(two_gears(**oil, dynamics={"mesh_law": law}, solver={}))
    table, nominal = joined.operation.tables["m"], apart.operation.tables["m"]
    for name in COLUMNS:
        of_machine, of_pair = getattr(table, name), getattr(alone.mesh, name)
        np.testing.assert_allclose(of_machine, of_pair, rtol=1e-9, atol=1e-9 * of_pair.max())
    touch = table.in_contact
    change = table.load_per_width[touch] / nominal.load_per_width[touch] - 1.0
    assert np.abs(change).max() > 0.01
    if warm:
        assert joined.heat.temperature[-1] == pytest.approx(alone.heat.temperature[-1], abs=1e-6)


def two_stages(order: int) -> MachineCase:
    """A reducer on elastic shafts, whose parts are listed in one order or in the other."""
    gears = {
        "z1": {"shaft": "in", "position": "70 mm", "teeth": 20, **GEAR},
        "z2": {"shaft": "middle", "position": "70 mm", "teeth": 40, **GEAR},
        "z3": {"shaft": "middle", "position": "130 mm", "teeth": 20, **GEAR},
        "z4": {"shaft": "out", "position": "130 mm", "teeth": 44, **GEAR},
    }
    meshes = {
        "first": {"gears": ["z1", "z2"], "normal_module": "3 mm"},
        "second": {"gears": ["z3", "z4"], "normal_module": "4 mm", "angle": "40 deg"},
    }
    shafts, bearings = {}, {}
    for shaft, thick in (("in", 30), ("middle", 35), ("out", 50)):
        shafts[shaft] = {"sections": [["200 mm", f"{thick} mm"]]}
        for end, place in (("left", 10), ("right", 190)):
            bearings[f"{shaft}_{end}"] = {
                "shaft": shaft, "position": f"{place} mm", "radial_stiffness": "3e8 N/m",
                "axial_stiffness": "1e8 N/m",
            }  # fmt: skip
    groups = {"shafts": shafts, "bearings": bearings, "gears": gears, "meshes": meshes}
    listed = {group: dict(list(parts.items())[::order]) for group, parts in groups.items()}
    return MachineCase(
        **listed, **MODELS | {"film": {"model": "dowson-higginson"}}, solver=SOLVER,
        lubricant={**OIL, "heat_transfer": "12 W/K"},
        dynamics={"backlash": "0.1 mm"}, operation={"input": "in", "output": "out", **POINT},
    )  # fmt: skip


@pytest.mark.slow
def test_shafts_film_and_temperature_settle_together_in_any_order_of_the_parts() -> None:
    first, second = (td.run(two_stages(order)) for order in (1, -1))
    figures, others = first.summary(), second.summary()
    for name in ("machine.oil_temperature", "machine.friction_power", "machine.efficiency"):
        assert others[name] == pytest.approx(figures[name], rel=1e-8)
    for mesh, table in first.operation.tables.items():
        for name in COLUMNS:
            column = getattr(table, name)
            other = getattr(second.operation.tables[mesh], name)
            np.testing.assert_allclose(other, column, rtol=1e-8, atol=1e-8 * np.nanmax(column))
        # The balance at rest with these teeth misaligns the flanks as they were computed.
        bent = first.operation.static.meshes[mesh]
        moved = bent.misalignment - first.operation.misalignment[mesh]
        assert abs(moved) < 1e-6 * bent.compression
    # The second mesh carries what the first one leaves: its force holds that torque.
    lost = first.operation.friction_power["first"]
    reached = first.operation.power_flow.meshes["second"].power
    entering = first.operation.power_flow.meshes["first"].power
    assert reached == pytest.approx(entering - lost, rel=1e-9)
    table = first.operation.tables["second"]
    moment = (table.sliding_direction * table.friction_coefficient * table.load_share
              * table.pinion_curvature_radius).sum(axis=1)  # fmt: skip
    carried = table.load_per_width.sum(axis=1) * table.common_face_width
    torque = carried * (table.base_radius_pinion + moment)
    speed = first.machine.power_flow({}).shafts["middle"].speed
    np.testing.assert_allclose(torque * abs(speed), reached, rtol=1e-8)


def test_planets_settle_with_their_films() -> None:
    rough = {f"gears.{name}.roughness_ra": "0.3 um" for name in ("sun", "planet", "ring")}
    oil = {f"lubricant.{name}": value for name, value in OIL.items()}
    case = td.load_case("planetary-stage").replace({
        "friction.law": "benedict-kelly", "film.model": "dowson-higginson",
        "load_cases": None, **rough, **oil,
    })  # fmt: skip
    settled = td.run(case.replace({"solver.coupling": "static"}))
    plain = td.run(case)
    for name, table in settled.operation.tables.items():
        nominal = plain.operation.tables[name]
        loading = table.load_per_width.sum(axis=1) / nominal.load_per_width.sum(axis=1)
        assert 1e-3 < np.abs(loading - 1.0).max() < 0.1
        role = name.rstrip("0123456789")
        assert table == settled.operation.tables[f"{role}1"]


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"solver": {"coupling": "dynamic"}}, "no function of its own phase"),
        ({"dynamics": {"friction_load": "dynamic"}}, "friction follow the load"),
        ({"solver": {"engine": "newmark"}}, "auto, harmonic-balance"),
        ({"solver": {"cycles": 9}}, "has no effect here"),
        ({"solver": {"coupling": "both"}}, "static"),
    ],
)
def test_what_machines_do_not_have_is_refused(tables: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        two_gears(**tables)
    assert "solver." in str(caught.value)
