"""A part of a machine in one file: a coupling with data of its own, of a motor."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.machine import machine_modes
from tribodyn.study.machine.run import structure_at_rest

Load = Callable[[str], dict[str, object]]

BEARING = """
[bearings.{shaft}-{end}]
shaft = "{shaft}"
position = "{end} mm"
radial_stiffness = "4e8 N/m"
axial_stiffness = "4e8 N/m"
"""
DRIVE = """
title = "Motor, coupling, gears"
[shafts]
motor = { sections = [["100 mm", "40 mm"]], moment_of_inertia = "0.02 kg*m^2" }
input = { sections = [["100 mm", "40 mm"]] }
output = { sections = [["100 mm", "40 mm"]] }
[gears]
z1 = { shaft = "input", position = "50 mm", teeth = 27, face_width = "30 mm" }
z2 = { shaft = "output", position = "50 mm", teeth = 51, face_width = "30 mm" }
[meshes.only]
gears = ["z1", "z2"]
normal_module = "3 mm"
stiffness = "4e8 N/m"
[operation]
input = "motor"
output = "output"
speed = "1500 rpm"
torque = "100 N*m"
[couplings.motor]
shafts = ["motor", "input"]
"""
ENDS = [(shaft, end) for shaft in ("motor", "input", "output") for end in (5, 95)]
DRIVE = "".join(BEARING.format(shaft=shaft, end=end) for shaft, end in ENDS).join(
    (DRIVE.partition("[operation]")[0], "[operation]" + DRIVE.partition("[operation]")[2])
)
SPIDER = DRIVE + 'model = "spider"\nnominal_torque = "160 N*m"\nfrequency = "220 Hz"\n'
STIFFNESS = 25.0 * 160.0
DAMPING = 0.8 * STIFFNESS / (2.0 * math.pi) / (2.0 * math.pi * 220.0)


def case_of(text: str, tmp_path: Path) -> td.MachineCase:
    path = tmp_path / "drive.toml"
    path.write_text(text, encoding="utf-8")
    return td.load_case(path)


def test_a_coupling_of_its_own_moves_like_the_linear_one_of_its_data(
    load: Load, tmp_path: Path
) -> None:
    load("coupling")
    case = case_of(SPIDER, tmp_path)
    assert case.couplings["motor"].torsional_stiffness == pytest.approx(STIFFNESS, rel=1e-15)
    assert case.couplings["motor"].torsional_damping == pytest.approx(DAMPING, rel=1e-15)
    linear = f'torsional_stiffness = "{STIFFNESS!r} N*m/rad"\n'
    linear += f'torsional_damping = "{DAMPING!r} N*m*s/rad"\n'
    same = case_of(DRIVE + linear, tmp_path)
    frequencies = [machine_modes(structure_at_rest(each)).frequency for each in (case, same)]
    np.testing.assert_allclose(*frequencies, rtol=1e-12)
    summaries = [td.run(each).summary() for each in (case, same)]
    assert summaries[0] == pytest.approx(summaries[1], rel=1e-9)


def test_its_data_are_keys_of_the_case(load: Load, tmp_path: Path) -> None:
    """They are read back, varied, and offered by the form of the page."""
    from tribodyn.study.studies.study_axes import read_axes

    load("coupling")
    case = case_of(SPIDER, tmp_path)
    written = case.to_toml()
    assert 'nominal_torque = "160 N*m"' in written
    assert case_of(written, tmp_path).couplings == case.couplings
    stiffer = case.replace({"couplings.motor.stiffness_factor": 50.0})
    assert stiffer.couplings["motor"].torsional_stiffness == pytest.approx(2.0 * STIFFNESS)
    (axis,) = read_axes(case, {"couplings.motor.nominal_torque": ["150 N*m", "170 N*m"]}, by="test")
    assert axis.values == (150.0, 170.0)
    option = case.option_of("couplings.motor.relative_damping")
    assert option is not None
    assert option.default == 0.8


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('"160 N*m"', '"2e6 N*m"', ("nominal_torque", "spiders of the data sheet")),
        ('frequency = "220 Hz"\n', "", ("frequency is missing",)),
        ('"spider"', '"spyder"', ("spyder", "linear, spider")),
        ("frequency =", 'torsional_stiffness = "4e3 N*m/rad"\nfrequency =', ("unknown key",)),
    ],
)
def test_mistakes_name_their_line(
    load: Load, tmp_path: Path, old: str, new: str, says: tuple[str, ...]
) -> None:
    load("coupling")
    with pytest.raises(InputError) as refused:
        case_of(SPIDER.replace(old, new), tmp_path)
    text = str(refused.value)
    assert all(part in text for part in says), text
    assert "drive.toml:" in text


def test_it_is_forgotten_without_its_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="spider"):
        case_of(SPIDER, tmp_path)
