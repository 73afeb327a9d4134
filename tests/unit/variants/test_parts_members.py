"""Studies of machines and stages: members are the runs of their cases."""

from __future__ import annotations

from pathlib import Path

import pytest

import tribodyn as td
from tribodyn.errors import InputError, quiet
from tribodyn.variants import open_study, read_study, run_study

_MACHINE = """
case = "two-stage-spur"
set.meshes.first.stiffness = "5e8 N/m"
set.meshes.second.stiffness = "6e8 N/m"
"""


def test_members_of_a_machine_are_its_runs(tmp_path: Path) -> None:
    study = read_study(f'{_MACHINE}axes.operation.speed = "2800,3000 rpm"')
    run_study(study, tmp_path / "store")
    data = open_study(tmp_path / "store").load()
    with quiet():
        wanted = td.run(
            study.case.replace({"operation.speed": "3000 rpm", "load_cases": None})
        ).summary()
    for name, value in wanted.items():
        assert float(data[name][1]) == pytest.approx(value, rel=1e-6), name
    assert data["meshes.first.mesh_frequency"].attrs["units"] == "Hz"


def test_stages_are_sampled_by_their_keys() -> None:
    text = 'case = "planetary-stage"\n[samples]\nsize = 4\nseed = 1\n'
    study = read_study(f'{text}over.planets.low.pin_stiffness = "1e8 N/m +- 3 %"')
    assert study.layout.count == 4


def test_batched_motions_of_machines_are_refused() -> None:
    text = f'compute = "motions"\n{_MACHINE}axes.operation.speed = "2800,3000 rpm"'
    with pytest.raises(InputError, match="of gear pairs in batches"):
        read_study(text)
    with pytest.raises(InputError, match='Did you mean "two-stage-spur"'):
        read_study('case = "two-stage-spu"\naxes.operation.speed = "2800,3000 rpm"')
