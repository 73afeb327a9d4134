"""What a motion with faults on one clock takes, stated before it is computed."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import pytest

import tribodyn as td
from tribodyn.dynamics.harmonic import newton, residual
from tribodyn.dynamics.harmonic.harmonic_balance import _cache
from tribodyn.study.faults.clock import check_motion, fault_cost
from tribodyn.study.faults.machine_motion import machine_turning_motion, rehearse_faults
from tribodyn.study.machine.first_look import ClockCost, clock_cost
from tribodyn.study.machine.run import rehearse_machine

AXIS = {"kind": "eccentricity", "gear": "z2", "amplitude": "10 um"}


def idler(fault: dict[str, Any] = AXIS, **more: Any) -> Any:
    """Three gears in a row, which mesh at one frequency."""
    shafts, teeth = ("in", "middle", "out"), (23, 37, 53)
    gears = {
        f"z{n}": {"shaft": shaft, "teeth": count, "face_width": 0.04}
        for n, (shaft, count) in enumerate(zip(shafts, teeth, strict=True), start=1)
    }
    meshes = {
        "one": {"gears": ["z1", "z2"], "normal_module": 3e-3, "angle": 0.3},
        "two": {"gears": ["z2", "z3"], "normal_module": 3e-3, "angle": -0.5},
    }
    bearings = {
        f"of_{name}": {"shaft": name, "position": 0.0, "radial_stiffness": 4e8} for name in shafts
    }
    run = {"input": "in", "output": "out", "speed": "3000 rpm", "torque": 200.0}
    return td.study.MachineCase(
        gears=gears, meshes=meshes, bearings=bearings, operation=run,
        stiffness={"model": "iso6336"}, faults={"axis": fault}, **more,
    )  # fmt: skip


def test_period_steps_and_work_are_those_of_the_run(monkeypatch: Any) -> None:
    """From the sound motion the search took 40 steps of Newton's method and added damping."""
    case, products = idler(), []

    def counted(*given: Any) -> Any:
        found = newton.solve_linear(*given)
        products.append(found[1])
        return found

    cost = fault_cost(case, case.machine())
    assert isinstance(cost, ClockCost)
    sound = td.run(case.replace({"faults": None})).operation
    monkeypatch.setattr(residual, "solve_linear", counted)
    motion = machine_turning_motion(case, sound)
    assert motion.response.converged
    assert cost.cycles == motion.cycles == 37
    assert cost.period == pytest.approx(motion.period)
    assert cost.period == pytest.approx(37 / 1150)
    samples = min(_cache[0][1].samples)
    assert cost.steps <= samples < 1.1 * cost.steps
    assert cost.contacts == len(motion.structure.machine.meshes)
    assert sum(products) < 60


def test_check_states_the_period_and_its_cost() -> None:
    case = idler()
    (text,) = rehearse_faults(case, rehearse_machine(case))
    assert "The motion repeats after 37 mesh cycles (0.03217 s): about 4736 steps" in text
    assert "teeth" not in text  # an eccentricity turns: no teeth differ
    sound = case.replace({"faults": None})
    assert check_motion(sound) == []
    none = idler({**AXIS, "amplitude": 0.0})
    assert check_motion(none) == []
    crack = idler({"kind": "crack", "gear": "z2", "tooth": 4, "depth": "1 mm"})
    (text,) = rehearse_faults(crack, rehearse_machine(crack))
    assert float(re.findall(r"its teeth take about (\S+) s", text)[0]) > 3.0


def test_check_states_it_of_rolling_bearings_at_their_loads() -> None:
    fault = {f"faults.axis.{key}": value for key, value in {**AXIS, "gear": "z1"}.items()}
    case = td.load_case("hypoid-axle").replace(fault)
    (text,) = rehearse_faults(case, rehearse_machine(case))
    assert "The motion repeats after 10 mesh cycles (0.02 s)" in text


def test_what_exceeds_the_memory_is_refused_before_the_run(monkeypatch: Any) -> None:
    case = idler()
    cost = fault_cost(case, case.machine())
    assert isinstance(cost, ClockCost)
    assert cost.cycles == 37
    monkeypatch.setattr("tribodyn.study.machine.run.run_load", lambda *_: pytest.fail("computed"))
    with pytest.raises(td.ComputationError, match=r"solver\.memory allows .* after 37 cycles of"):
        td.run(case.replace({"solver.memory": 0.99 * cost.memory}))


def test_a_period_that_no_run_takes_is_refused_with_its_cycles() -> None:
    case = idler(solver={"phases": "off"}).replace(
        {
            "faults.other": {"kind": "eccentricity", "gear": "z1", "amplitude": "5 um"},
            "faults.last": {"kind": "eccentricity", "gear": "z3", "amplitude": "5 um"},
            "solver.memory": 1e13,
        }
    )
    with pytest.raises(td.errors.TribodynError, match="45103"):
        fault_cost(case, case.machine())


def test_the_cost_of_a_clock_grows_with_steps_contacts_and_coordinates() -> None:
    small = ClockCost(10, 1.0, 2, 20)
    assert small._replace(cycles=20).memory == 2.0 * small.memory
    for larger in (small._replace(contacts=3), small._replace(coordinates=21)):
        assert larger.memory > small.memory
        assert larger.time > small.time
    machine = idler().machine()  # meshes of one stiffness move linearly
    rigid = {name: replace(mesh, stiffness=4e8) for name, mesh in machine.meshes.items()}
    costs = [clock_cost(each, 1e12) for each in (machine, machine._with(meshes=rigid))]
    assert [cost.contacts for cost in costs] == [2, 0]
