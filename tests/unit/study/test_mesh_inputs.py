"""Inputs of a mesh: those of a machine are those of its pair, and a run reads no text."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError, ModelWarning
from tribodyn.gear import Misalignment
from tribodyn.machine import Machine
from tribodyn.progress import SILENT
from tribodyn.study.case.pair import PairCase
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.pair_cases import inputs_under
from tribodyn.study.machine.run import run_load
from tribodyn.study.mesh_inputs import HypoidTeeth, MeshInputs, mesh_inputs
from tribodyn.study.pipeline.tooth_contact import mesh_table


@pytest.fixture(autouse=True)
def _quiet() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        yield


@pytest.mark.parametrize("name", ["two-stage-spur", "two-stage-helical"])
def test_misaligned_teeth_are_those_of_a_pair_read_with_them(name: str) -> None:
    case, shift = td.load_case(name), 2e-6
    load = replace(case.operating_point, torque=0.7 * case.operating_point.torque)
    for mesh in case.meshes_with_teeth:
        inputs = inputs_under(case, mesh, load, shift)
        read = mesh_inputs(case.pair(mesh, load, shift))
        assert inputs.teeth == read.teeth
        assert inputs.settings.teeth == read.settings.teeth
        assert inputs.settings.film == read.settings.film
        assert (inputs.speed, inputs.torque) == (read.speed, read.torque)
        assert (inputs.law, inputs.backlash) == (read.law, read.backlash)
        assert inputs.inertias == read.inertias


def test_mounting_errors_of_hypoid_teeth_add_up() -> None:
    case = td.load_case("hypoid-axle")
    mesh, load = case.meshes_with_teeth[0], case.operating_point
    errors = Misalignment(offset=1e-5, wheel_axial=-2e-5)
    moved = inputs_under(case, mesh, load, errors).teeth
    read = mesh_inputs(case.pair(mesh, load, errors)).teeth
    assert isinstance(moved, HypoidTeeth)
    assert isinstance(read, HypoidTeeth)
    assert moved.mounting == read.mounting
    np.testing.assert_array_equal(moved.flanks.gap, read.flanks.gap)


@pytest.mark.parametrize("name", ["two-stage-spur", "two-stage-helical"])
def test_a_run_reads_no_case_and_checks_no_machine(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = td.load_case(name)
    assert isinstance(case, MachineCase)
    constructed = []

    def counted(kind: type) -> None:
        plain = kind.__dict__["__init__" if kind is PairCase else "__post_init__"]

        def wrapper(self: object, *args: object, **values: object) -> None:
            constructed.append(kind)
            plain(self, *args, **values)

        monkeypatch.setattr(kind, "__init__" if kind is PairCase else "__post_init__", wrapper)

    counted(PairCase)
    counted(Machine)
    run_load(case, case.operating_point, SILENT, [])
    assert not constructed


def test_a_load_beyond_the_range_of_a_pinion_is_refused_at_its_key() -> None:
    case = td.load_case("two-stage-spur")
    load = replace(case.operating_point, torque=1e11)
    with pytest.raises(InputError, match="torque = ") as no:
        inputs_under(case, case.meshes_with_teeth[0], load)
    assert "operation.torque" in str(no.value)


def test_the_table_of_inputs_is_that_of_the_pair() -> None:
    case = td.load_case("fzg-roughness").replace({"film.model": "none", "friction.law": "none"})
    inputs = mesh_inputs(case)
    assert isinstance(inputs, MeshInputs)
    stronger = mesh_table(inputs.under(case.pinion_speed, 1.5 * case.pinion_torque))
    same = mesh_table(mesh_inputs(case.replace({"operation.torque": 1.5 * case.operation.torque})))
    np.testing.assert_array_equal(stronger.mesh_stiffness, same.mesh_stiffness)
