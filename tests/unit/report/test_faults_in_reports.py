"""Reports of machines with faults show the motion with them, and why there is none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.report import render_report
from tribodyn.report.figure_blocks import figure_blocks

DEFECT = {"kind": "bearing-defect", "bearing": "A", "place": "outer", "impact_force": "10 N",
          "rolling_elements": 8, "element_diameter": "8 mm", "pitch_diameter": "40 mm"}  # fmt: skip
AXIS = {"kind": "eccentricity", "gear": "z1", "amplitude": "20 um"}


def result_of(**faults: Any) -> Any:
    gears = {
        name: {"shaft": shaft, "teeth": teeth, "face_width": "30 mm"}
        for name, shaft, teeth in (("z1", "in", 17), ("z2", "out", 23))
    }
    mesh = {"gears": ["z1", "z2"], "normal_module": "3 mm", "stiffness": "4e8 N/m"}
    support = {"shaft": "in", "position": "0 mm", "radial_stiffness": "1e9 N/m",
               "axial_stiffness": "1e9 N/m", "tilting_stiffness": "1e6 N*m/rad"}  # fmt: skip
    run = {"input": "in", "output": "out", "speed": "1000 rpm", "torque": "100 N*m"}
    case = td.study.MachineCase(
        gears=gears, meshes={"pair": mesh}, bearings={"A": support}, operation=run, faults=faults
    )
    return td.run(case)


def test_the_report_of_a_machine_shows_its_motion_with_faults() -> None:
    result = result_of(axis=AXIS, ring=DEFECT)
    blocks = {block.name: block for block in figure_blocks(result)}
    force = blocks["machine_forces-with-faults"]
    assert force.heading == "With faults: forces over a period"
    swing = np.ptp(result.turning_motion.motion.mesh_force)
    assert swing > 10.0 * np.ptp(result.motion.mesh_force)
    assert float(force.title.split(":")[1].split()[0]) == pytest.approx(swing, rel=5e-3)
    assert "machine_orders-with-faults" in blocks
    assert "machine_forces" in blocks


def test_defects_of_bearings_alone_leave_the_motion_as_it_is() -> None:
    for result in (result_of(ring=DEFECT), result_of()):
        assert not [block for block in figure_blocks(result) if "faults" in block.heading]


def test_a_motion_with_faults_that_is_not_found_loses_no_report(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    result = result_of(axis=AXIS)

    def fails(_: Any) -> None:
        raise td.ComputationError("mesh pair finds no motion")

    monkeypatch.setattr(type(result), "turning_motion", property(fails))
    page = render_report(result)
    assert "With faults" in page
    assert "mesh pair finds no motion" in page
