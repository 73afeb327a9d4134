"""200 random machines, built and broken: they balance, or a message names the part."""

from __future__ import annotations

import dataclasses
import math
import re
from random import Random
from typing import Any

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.machine import Bearing, Gear, Machine, Mesh, Operation, Section, Shaft

Parts = dict[str, Any]
GROUPS = ("shafts", "gears", "meshes", "bearings")
VALUES = (
    math.nan, math.inf, -math.inf, 0.0, -1.0, 1e-30, 1e30, 1e300, -0.05, 0.05, 7, -7, 10**400,
    None, True, "", "s0", "no such part", "12 mm", (), ("g0",), ("g0", "g1"), ("g1", "g0"),
    [[1.0]], np.eye(6), np.full((6, 6), np.inf), complex(1.0, 1.0), object(), {}, Shaft(),
)  # fmt: skip


def random_parts(draw: Random) -> Parts:
    """Parts of a valid machine: a tree of shafts, each with bearings and gears side by side."""
    count = draw.randint(2, 5)
    shafts: dict[str, Shaft] = {}
    gears: dict[str, Gear] = {}
    meshes: dict[str, Mesh] = {}
    places = [0.0] * count
    for number in range(1, count):
        driver = draw.randrange(number)
        ring = draw.random() < 0.2
        first, second = f"g{2 * number - 2}", f"g{2 * number - 1}"
        teeth = draw.randint(18, 40), -draw.randint(60, 90) if ring else draw.randint(18, 60)
        for gear, shaft, z in ((first, driver, teeth[0]), (second, number, teeth[1])):
            places[shaft] += 0.05
            gears[gear] = Gear(f"s{shaft}", places[shaft], z, draw.uniform(0.01, 0.04))
        helix, module = draw.choice([0.0, draw.uniform(0.1, 0.5)]), draw.uniform(1e-3, 4e-3)
        distance = 0.5 * sum(teeth) * module / math.cos(helix)
        distance += draw.choice([0.0, draw.uniform(0.0, 0.6)]) * module
        meshes[f"m{number}"] = Mesh(
            (first, second) if draw.random() < 0.7 else (second, first), module, helix,
            draw.choice(["right", "left"]), draw.choice([None, distance]), draw.uniform(-4.0, 4.0),
            stiffness=draw.choice([None, 3e8, lambda x: 3e8 + 1e7 * np.cos(2 * np.pi * x)]),
        )  # fmt: skip
    bearings = {}
    for number, place in enumerate(places):
        name = f"s{number}"
        shafts[name] = Shaft([Section(0.03, 0.01), Section(place + 0.03, 0.012, 0.004)])
        if draw.random() < 0.2:
            shafts[name] = Shaft()
        bearings[f"b{number}"] = Bearing(name, 0.01, draw.choice([None, 1e8]), 1e8, 1e4)
        bearings[f"c{number}"] = Bearing(name, place + 0.04, (1e8, 2e8))
    ends = draw.sample(sorted(shafts), 2)
    operation = Operation(ends[0], ends[1], draw.uniform(-300, 300), draw.uniform(-500, 500))
    return dict(zip((*GROUPS, "operation"), (shafts, gears, meshes, bearings, operation),
                    strict=True))  # fmt: skip


def check(machine: Machine) -> None:
    """Everything that follows from the graph is finite, and every shaft balances."""
    torque = dict.fromkeys(machine.shafts, 0.0)
    scale = 1e-12
    for name, load in machine.gear_loads.items():
        assert np.all(np.isfinite(load))
        torque[machine.gears[name].shaft] += load[3]
        scale = max(scale, abs(load[3]))
    run, sense = machine.operation, -1.0 if machine.operation.speed < 0.0 else 1.0
    torque[run.input] += sense * run.torque
    exit_load = machine.kinematics.shafts[run.output]
    torque[run.output] -= sense * math.copysign(1.0, exit_load.ratio) * exit_load.torque
    assert max(map(abs, torque.values())) < 1e-9 * max(scale, abs(run.torque))
    powers = {run.input, run.output}
    assert all(
        abs(abs(machine.kinematics.shafts[s].power) - abs(run.torque * run.speed))
        <= 1e-9 * abs(run.torque * run.speed)
        for s in powers
    )
    for name, line in machine.directions.items():
        assert np.all(np.isfinite(line.direction))
        first, second = (machine.gears[gear].shaft for gear in machine.meshes[name].gears)
        speeds = [machine.kinematics.shafts[shaft].speed for shaft in (first, second)]
        slip = line.direction[3] * speeds[0] + line.direction[9] * speeds[1]
        assert abs(slip) <= 1e-9 * abs(line.direction[3] * speeds[0]) + 1e-300
    numbers = [*machine.placement.shafts.values(), *machine.placement.bearings.values()]
    assert np.all(np.isfinite(numbers))
    for body in machine.gear_bodies.values():
        assert np.all(np.isfinite(dataclasses.astuple(body)))
        assert min(dataclasses.astuple(body)) >= 0.0
    assert all(count >= 1 for count in machine.clock.cycles.values())
    assert math.isfinite(machine.clock.frequency)


def damaged(draw: Random, parts: Parts) -> Parts:
    """Parts with one to three faults: fields of wrong values, parts removed or twice."""
    parts = {k: dict(v) if isinstance(v, dict) else v for k, v in parts.items()}
    for _ in range(draw.randint(1, 3)):
        group = draw.choice((*GROUPS, "operation"))
        if group == "operation":
            parts[group] = _changed(draw, parts[group])
            continue
        name = draw.choice(sorted(parts[group]) or ["new"])
        way = draw.random()
        if way < 0.15:
            parts[group].pop(name, None)
        elif way < 0.25:
            parts[group][f"{name}'"] = parts[group].get(name)
        elif way < 0.30:
            parts[draw.choice(GROUPS)][name] = draw.choice(VALUES)
        elif way < 0.32:
            parts[group] = draw.choice(VALUES) if draw.random() < 0.5 else {}
        elif dataclasses.is_dataclass(part := parts[group].get(name)):
            parts[group][name] = _changed(draw, part)
        if not isinstance(parts[group], dict):
            break
    return parts


def _changed(draw: Random, part: Any) -> Any:
    names = [field.name for field in dataclasses.fields(part)]
    name = draw.choice(names)
    value = draw.choice(VALUES)
    number = getattr(part, name)
    if draw.random() < 0.5 and isinstance(number, int | float) and not isinstance(number, bool):
        value = number * draw.choice([-1, 2, 0.5, 1.01, 1e3])
    return dataclasses.replace(part, **{name: value})


#: A message begins with the part and its field, or the argument.
_LOCATION = re.compile(
    r"(argument )?((Machine|Shaft|Section|Gear|Mesh|Bearing|Operation)\.\w+"
    r"|(shafts|gears|meshes|bearings|operation)(\..+?)?): "
)


@pytest.mark.parametrize("seed", range(4))
def test_random_machines_balance_or_name_the_part(seed: int) -> None:
    draw, refused = Random(seed), 0
    for _ in range(50):
        parts = random_parts(draw)
        check(Machine(**parts))
        for _ in range(6):
            try:
                machine = Machine(**damaged(draw, parts))
                check(machine)
            except InputError as error:
                refused += 1
                for line in str(error).splitlines():
                    assert _LOCATION.match(line), line
                    assert not re.search(r"(?<!= )\bnan\b", line), line
    assert refused > 150
