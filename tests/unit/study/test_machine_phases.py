"""Machines whose teeth have no short common period: motion over independent phases."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.dynamics import PhaseResponse
from tribodyn.dynamics.harmonic.phase_balance import _ALONG
from tribodyn.dynamics.harmonic.phase_grid import Work
from tribodyn.dynamics.harmonic.phase_response import along_line, recorded
from tribodyn.study.machine.first_look import over_phases, phase_cost_of, warn_of_motion
from tribodyn.study.machine.motion import line_cause, machine_motion

TEETH = {"z1": 29, "z2": 71, "z3": 23, "z4": 67, "z5": 19, "z6": 61}


def case(teeth: dict[str, int] = TEETH, **solver: Any) -> Any:
    """Stages in a row with a wave of the transmission error each."""
    rows = list(teeth)
    shafts = ["in", *(f"shaft{n}" for n in range(1, len(rows) // 2) for _ in range(2)), "out"]
    gears = {
        name: {"shaft": shaft, "position": 0.1 * (n % 2), "teeth": teeth[name], "face_width": 0.03}
        for n, (name, shaft) in enumerate(zip(rows, shafts, strict=True))
    }
    meshes = {
        f"mesh{n + 1}": {
            "gears": rows[2 * n : 2 * n + 2], "normal_module": 3e-3, "stiffness": 4e8,
            "transmission_error_amplitude": 2e-6,
        }
        for n in range(len(rows) // 2)
    }  # fmt: skip
    run = {"input": "in", "output": "out", "speed": "1000 rpm", "torque": 100.0}
    return td.study.MachineCase(gears=gears, meshes=meshes, operation=run, solver=solver)


@cache
def three() -> Any:
    return td.run(case())


def two(**solver: Any) -> Any:
    return td.run(case({"z1": 19, "z2": 23, "z3": 17, "z4": 31}, **solver))


def test_hunting_teeth_run_over_phases_by_themselves() -> None:
    result = three()
    response, motion = result.operation.response, result.motion
    assert isinstance(response, PhaseResponse)
    assert response.converged
    assert response.step_error < 1e-6
    shaft = 1000.0 / 60.0
    exact = shaft * np.array([29, 29 / 71 * 23, 29 / 71 * 23 / 67 * 19])
    assert motion.mesh_frequency == pytest.approx(exact, rel=1e-14)
    figures = result.summary()
    # Each shaft is in equilibrium on average.
    base = 0.5 * 3e-3 * np.cos(np.radians(20.0)) * np.array(list(TEETH.values()))
    first = 100.0 / base[0]
    forces = first * np.array([1.0, base[1] / base[2], base[1] / base[2] * base[3] / base[4]])
    for name, force in zip(motion.mesh, forces, strict=True):
        assert figures[f"meshes.{name}.mean_mesh_force"] == pytest.approx(force, rel=1e-6)


def test_lines_have_exact_frequencies_and_causes() -> None:
    motion = three().motion
    lines = motion.lines(motion.mesh_force[:, 1], 6)
    causes = {line.cause: line for line in lines}
    for number, name in enumerate(motion.mesh):
        line = causes[f"1 x {name}"]
        assert line.frequency == pytest.approx(motion.mesh_frequency[number], rel=1e-14)
        assert line.numbers == tuple(int(axis == number) for axis in range(3))
    spectra = motion.mesh_spectra("mesh2", 3)
    assert spectra.attrs["mesh_frequency"] == pytest.approx(motion.mesh_frequency[1])


def test_phases_have_the_motion_of_the_common_period() -> None:
    clock, phases = two(phases="off").operation, two(phases="on").operation
    assert isinstance(phases.response, PhaseResponse)
    at = phases.response.at(clock.response.time)
    for name in ("position", "contact_force"):
        expected = getattr(clock.response, name)
        assert np.abs(getattr(at, name) - expected).max() < 1e-6 * np.ptp(expected)
    for key, value in clock.figures.items():
        assert phases.figures[key] == pytest.approx(value, rel=2e-3, abs=1e-12), key


def test_the_period_decides_and_the_case_overrides() -> None:
    short = {"z1": 19, "z2": 23, "z3": 17, "z4": 31}
    for solver, expected in (({}, False), ({"phases": "on"}, True), ({"phases": "off"}, False)):
        chosen = case(short, **solver)
        assert over_phases(chosen.solver, chosen.machine()) is expected
    assert over_phases(case().solver, case().machine())
    with pytest.raises(td.InputError, match=r"solver.phases|phases = 'maybe'"):
        case(phases="maybe")
    with pytest.raises(td.InputError, match="unknown key"):
        case(phase="on")


@pytest.mark.parametrize(("teeth", "over"), [((31, 53), True), ((24, 36), False)])
def test_a_stage_with_computed_teeth_moves_over_phases_earlier(
    teeth: tuple[int, int], over: bool
) -> None:
    """Seven meshes on one clock of 80 cycles take longer than two phases, not of 12 cycles."""
    shafts = {"first": "in", "second": "rotor", "sun": "out", "ring": "held"}
    numbers = dict(zip(shafts, (*teeth, 22, -80), strict=True))
    gears = {n: {"shaft": s, "teeth": numbers[n], "face_width": 0.06} for n, s in shafts.items()}
    gears |= {"planet": {"teeth": 29, "face_width": 0.06}}
    stage = {"sun": "sun", "ring": "ring", "planet": "planet", "carrier": "rotor", "count": 3}
    train = td.study.MachineCase(
        gears=gears, meshes={"pair": {"gears": ["first", "second"], "normal_module": 4e-3}},
        planets={"stage": {**stage, "normal_module": 4e-3}}, stiffness={"model": "iso6336"},
        operation={"input": "in", "output": "out", "speed": "100 rpm", "torque": 2000.0},
    )  # fmt: skip
    machine = train.machine()
    assert over_phases(train.solver, machine) is over
    given = {name: replace(mesh, stiffness=4e8) for name, mesh in machine.meshes.items()}
    assert not over_phases(train.solver, machine._with(meshes=given))


def test_cost_is_stated_before_the_run_and_does_not_depend_on_the_teeth() -> None:
    """But for the samples of the record, whose weight they share, and of the closed line."""
    primes = {"z1": 101, "z2": 211, "z3": 103, "z4": 199, "z5": 107, "z6": 193}
    # The teeth of the first gear turn all meshes alike, those of the last one none.
    alike, others = {**TEETH, "z1": 101, "z6": 193}, {**TEETH, "z2": 97}
    machines = [case(teeth).machine() for teeth in (TEETH, alike, primes, others)]
    few, same, *costs = (warn_of_motion(case().solver, each) for each in machines)
    assert same[1:3] == few[1:3]
    assert same.time == pytest.approx(few.time, rel=1e-9)
    frequencies = [np.array(each.phases.frequency) for each in (machines[0], *machines[2:])]
    samples = [recorded(each) - recorded(frequencies[0]) for each in frequencies[1:]]
    assert len({0, *samples}) == 3
    per_sample = _ALONG * (3 * Work().size + 2 * 3)
    later = [
        cost.time - few.time - per_sample * (along_line(each) - along_line(frequencies[0]))
        for cost, each in zip(costs, frequencies[1:], strict=True)
    ]
    assert later[0] * samples[1] == pytest.approx(later[1] * samples[0], rel=1e-9)
    assert later[0] * samples[0] > 0.0
    assert all(cost[1:3] == few[1:3] and "3 phases" in str(cost) for cost in costs)
    small = case(memory="100 MB")
    with pytest.raises(td.ComputationError, match=r"GB are allowed by solver.memory"):
        phase_cost_of(small.solver.memory, small.machine())
    with pytest.raises(td.ComputationError, match=r"solver.memory allows 0\.1 GB"):
        warn_of_motion(*(lambda c: (c.solver, c.machine()))(case(phases="off", memory="100 MB")))


def test_a_stored_result_keeps_its_phases(tmp_path: Any) -> None:
    result = three()
    result.save(tmp_path / "result")
    stored = td.load_result(tmp_path / "result")
    assert np.array_equal(stored.motion.mesh_force, result.motion.mesh_force)
    assert stored.motion.mesh_frequency == pytest.approx(result.motion.mesh_frequency)
    assert stored.operation.system.phases == 3


def test_a_line_near_a_combination_of_phases_keeps_its_frequency_and_cause() -> None:
    """Harmonic 28 of the last mesh falls on the order of first plus two second of the record."""
    machine = case({"z1": 23, "z2": 71, "z3": 19, "z4": 83, "z5": 17, "z6": 77}).machine()
    wavy = replace(machine.meshes["mesh3"], error=lambda p: 1e-6 * np.cos(56.0 * np.pi * p))
    structure = td.machine.machine_structure(machine._with(meshes={"mesh3": wavy}))
    rates = machine.phases.frequency
    system = td.machine.system(structure, phases=True)
    motion = machine_motion(structure, td.dynamics.harmonic_balance(system, rates))
    assert np.dot(motion.phase_turns, [1, 2, -28]) == 0.0
    lines = motion.lines(motion.mesh_force[:, 2], 3)
    line = max(lines, key=lambda line: abs(line.amplitude))
    assert (line.cause, line.numbers) == ("28 x mesh3", (0, 0, 28))
    assert line.frequency == pytest.approx(28 * 1000 / 60 * 23 / 71 * 19 / 83 * 17, rel=1e-12)
    assert rates[0] + 2.0 * rates[1] > line.frequency + 0.1


def test_causes_of_lines_in_words() -> None:
    meshes = {"a": (1, 0), "b": (0, 2), "c": (0, 3)}
    assert line_cause((2, 0), meshes) == "2 x a"
    assert line_cause((0, 6), meshes) == "3 x b"
    assert line_cause((2, -1), meshes) == "2 x a - 1 x b / 2"


def test_the_spectrum_names_the_largest_combination_lines() -> None:
    """Sums and differences of two meshes of computed teeth stand at their exact frequencies."""
    from tribodyn import plot

    base = case({"z1": 29, "z2": 71, "z3": 23, "z4": 67}, phases="on")
    keys = ("stiffness", "transmission_error_amplitude")
    computed = {f"meshes.mesh{n}.{key}": None for n in (1, 2) for key in keys}
    motion = td.run(base.replace({**computed, "stiffness.model": "iso6336"})).motion
    named = [trace for trace in plot.machine_orders(motion).data if trace.name == "several phases"]
    first, second = 1000 / 60 * 29, 1000 / 60 * 29 / 71 * 23
    assert list(motion.mesh_frequency) == pytest.approx([first, second])
    texts = dict(zip(named[0].text, named[0].x, strict=True))
    assert len(texts) == 5
    rates = {"mesh1": first, "mesh2": second}
    for text, hertz in texts.items():
        words = text.replace(" - ", " + -").split(" + ")
        parts = [word.split(" x ") for word in words]
        assert {name for _, name in parts} == {"mesh1", "mesh2"}
        expected = sum(float(count) * rates[name] for count, name in parts)
        assert abs(expected) == pytest.approx(hertz, rel=1e-9)
    constant = td.run(base).motion  # of constant stiffness: linear, no combinations
    assert all(trace.name != "several phases" for trace in plot.machine_orders(constant).data)
    fault = {"kind": "eccentricity", "gear": "z1", "amplitude": "20 um"}
    turning = td.run(base.replace({"faults": {"e": fault}})).turning_motion.motion
    named = [t for t in plot.machine_orders(turning).data if t.name == "several phases"]
    assert [(t.text, list(t.x)) for t in named[:1]] == [(("1 x in",), [pytest.approx(1000 / 60)])]


def held(base: Any, clearance: float = 20e-6) -> Any:
    """The same in two bearings a shaft, those of the first two shafts with a clearance."""
    changes: dict[str, Any] = {}
    for shaft in ("in", "shaft1", "shaft2", "out"):
        for end, position in (("a", -0.05), ("b", 0.15)):
            bearing = {"shaft": shaft, "position": position, "radial_stiffness": 2e8}
            if shaft in ("in", "shaft1"):
                bearing["clearance"] = clearance
            changes |= {f"bearings.{shaft}_{end}.{key}": each for key, each in bearing.items()}
    return base.replace(changes)


def test_hunting_teeth_in_bearings_with_clearance_run_over_phases() -> None:
    """One clock would take 4,757 cycles of the fastest mesh."""
    base = held(case())
    assert "3 phases" in str(warn_of_motion(base.solver, base.machine()))
    result = td.run(base)
    response, motion, figures = result.operation.response, result.motion, result.summary()
    assert isinstance(response, PhaseResponse)
    assert response.converged
    base_radius = 0.5 * 3e-3 * np.cos(np.radians(20.0)) * np.array(list(TEETH.values()))
    ratios = base_radius[1::2] / np.append(base_radius[2::2], 1.0)
    forces = 100.0 / base_radius[0] * np.cumprod([1.0, *ratios[:-1]])
    for number, force in enumerate(forces, start=1):
        assert figures[f"meshes.mesh{number}.mean_mesh_force"] == pytest.approx(force, rel=1e-9)
    # The bearings of the first shaft hold the first mesh alone, in spite of their clearance.
    on_shaft = [motion.bearing.index(name) for name in ("in_a", "in_b")]
    pushed = np.tensordot(motion.weight, motion.bearing_force[:, on_shaft, 1:3].sum(axis=1), 1)
    assert np.hypot(*pushed) == pytest.approx(forces[0], rel=1e-9)
    for name in ("in_a", "shaft1_b"):
        rows = result.operation.structure.bearing(name)[1:3]
        moved = np.hypot(*(response.fine.position @ rows.T).T)
        assert moved.min() > 20e-6


@pytest.mark.slow
def test_planets_on_loose_pins_beside_hunting_teeth_are_one_clock() -> None:
    """A planetary stage whose pins have a clearance, and a spur stage of 23 and 37 teeth."""
    shafts = {"sun": "mid", "planet": None, "ring": "held", "wheel": "mid", "pinion": "high"}
    teeth = {"sun": 24, "planet": 24, "ring": -72, "wheel": 23, "pinion": 37}
    gears = {
        name: {"teeth": teeth[name], "face_width": 0.03} | ({"shaft": shaft} if shaft else {})
        for name, shaft in shafts.items()
    }
    gears["wheel"]["position"] = 0.1
    stage = {
        "sun": "sun", "ring": "ring", "planet": "planet", "carrier": "rotor", "count": 3,
        "normal_module": 3e-3, "pin_stiffness": 2e8, "pin_clearance": 20e-6,
    }  # fmt: skip
    mesh = {"gears": ["wheel", "pinion"], "normal_module": 3e-3, "stiffness": 4e8}
    mesh["transmission_error_amplitude"] = 2e-6
    base = td.study.MachineCase(
        gears=gears, planets={"low": stage}, meshes={"last": mesh},
        operation={"input": "rotor", "output": "high", "speed": "100 rpm", "torque": 600.0},
        stiffness={"model": "fourier", "mean_stiffness": 3e8, "cosine": [3e7, 8e6]},
    )  # fmt: skip
    results = {way: td.run(base.replace({"solver.phases": way})) for way in ("on", "off")}
    response = results["on"].operation.response
    assert isinstance(response, PhaseResponse)
    assert response.converged
    apart, clock = (result.summary() for result in results.values())
    cosine, torque = np.cos(np.radians(20.0)), 600.0 * 24 / 96
    forces = [apart[f"meshes.low_sun{n}.mean_mesh_force"] for n in (1, 2, 3)]
    assert sum(forces) == pytest.approx(torque / (0.036 * cosine), rel=1e-9)
    assert apart["meshes.last.mean_mesh_force"] == pytest.approx(torque / (0.0345 * cosine))
    for number, force in enumerate(forces, start=1):
        load = apart[f"bearings.low_pin{number}.mean_radial_force"]
        assert load == pytest.approx(2.0 * force * cosine, rel=1e-5)
        rows = results["on"].operation.structure.bearing(f"low_pin{number}")[1:3]
        moved = np.hypot(*(response.fine.position @ rows.T).T).mean()
        assert moved == pytest.approx(20e-6 + load / 2e8, rel=1e-4)
    compared = [name for name in apart if name.endswith("alternating_rms_mesh_force")]
    assert len(compared) == 7
    for name in compared:
        assert apart[name] == pytest.approx(clock[name], rel=1e-6)


def test_a_run_refuses_faults_whose_motion_takes_too_much_before_it_computes(monkeypatch) -> None:
    base = case({"z1": 29, "z2": 71, "z3": 23, "z4": 67})
    faults = {
        f"e{n}": {"kind": "eccentricity", "gear": gear, "amplitude": "20 um"}
        for n, gear in enumerate(("z1", "z2", "z3", "z4"))
    }
    monkeypatch.setattr("tribodyn.study.machine.run.run_load", lambda *_: pytest.fail("computed"))
    with pytest.raises(td.ComputationError, match="memory"):
        td.run(base.replace({"faults": faults, "solver.memory": 0.5e9}))


def test_the_stated_time_follows_from_what_the_forces_do() -> None:
    from tribodyn.study.faults.machine_motion import _work, rehearse_faults
    from tribodyn.study.machine.run import rehearse_machine

    smooth = case()
    waves = {f"meshes.mesh{n}.transmission_error_amplitude": None for n in (1, 2, 3)}
    steady = smooth.replace(waves)
    jumps = steady.replace({
        **{f"meshes.mesh{n}.stiffness": None for n in (1, 2, 3)}, "stiffness.model": "iso6336"
    })  # fmt: skip
    large = {**dict.fromkeys(waves, "60 um"), "dynamics.backlash": "0.1 mm"}
    large["operation.speed"] = "3000 rpm"
    kinds, times = [], []
    for each in (steady, smooth, jumps, smooth.replace(large)):
        state = rehearse_machine(each)
        kinds.append(_work(state.structure(each)).kind)
        (text,) = rehearse_faults(each, state)
        times.append(float(text.partition(" GB and ")[2].partition(" s ")[0]))
    assert kinds == ["steady", "smooth", "ringing", "open"]
    assert times[0] < times[1]
    assert 4.0 * max(times[:2]) < min(times[2:])
