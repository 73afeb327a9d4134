"""Studies over the speed of a machine whose reduced structure has more modes at a higher speed."""

from __future__ import annotations

import numpy as np
import pytest

import tribodyn as td
from tribodyn.study.studies.case_grid import moving, moving_at, of_one_size

BETWEEN = (3000 * np.pi / 30, 4000 * np.pi / 30)


@pytest.fixture(scope="module")
def case() -> td.study.MachineCase:
    """An idler between two gears, on shafts that have modes between 7 and 10 kHz."""
    places = {"in": 23, "idler": 37, "out": 53}
    return td.study.MachineCase(
        shafts={name: {"sections": [["120 mm", "50 mm"]]} for name in places},
        bearings={
            f"{name}{end}": {"shaft": name, "position": f"{end} mm", "radial_stiffness": 4e8,
                             "axial_stiffness": 2e8}
            for name in places for end in (20, 100)
        },
        gears={
            f"z_{name}": {"shaft": name, "position": "60 mm", "teeth": teeth, "face_width": "40 mm"}
            for name, teeth in places.items()
        },
        meshes={
            "one": {"gears": ["z_in", "z_idler"], "normal_module": "3 mm", "stiffness": 6e8,
                    "transmission_error_amplitude": "2 um", "angle": "20 deg"},
            "two": {"gears": ["z_idler", "z_out"], "normal_module": "3 mm", "stiffness": 6e8,
                    "angle": "-30 deg"},
        },
        operation={"input": "in", "output": "out", "speed": "3000 rpm", "torque": "200 N*m"},
    )  # fmt: skip


def test_all_speeds_have_the_coordinates_of_the_greatest(case) -> None:
    sizes = [moving_at(case, "operation.speed", "one", speed).system.size for speed in BETWEEN]
    assert sizes[0] < sizes[1]
    alike = of_one_size(case, "operation.speed", BETWEEN)
    for speed in (BETWEEN[0], 3400 * np.pi / 30, BETWEEN[1]):
        assert moving_at(alike, "operation.speed", "one", speed).system.size == sizes[1]
    own = case.replace({"dynamics.frequency_limit": 9e3})
    assert of_one_size(own, "operation.speed", BETWEEN) is own
    assert of_one_size(case, "operation.torque", BETWEEN) is case
    assert moving(alike.replace({"operation.speed": BETWEEN[1]})).system.size == sizes[1]


@pytest.mark.slow
def test_a_diagram_and_a_branch_pass_the_speed_where_modes_are_added(case) -> None:
    diagram = td.bifurcation(case, between=BETWEEN, points=2, mesh="one", transient=20, cycles=4)
    assert np.isfinite(diagram.rms).all()
    assert diagram.rms.min() > 0.0
    branch = td.continuation(case, between=BETWEEN, mesh="one", points=4, longest_step=1.0)
    assert branch.parameter[0] < branch.parameter[-1]
