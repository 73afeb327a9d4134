"""What a study stores of a member is what the functions for one case give, whoever computes it."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray

from tribodyn.analysis import parameter_map
from tribodyn.errors import quiet
from tribodyn.interrupt import alone
from tribodyn.study.pipeline.run import computed
from tribodyn.study.studies.case_grid import built
from tribodyn.variants import open_study, read_study, run_study
from tribodyn.variants.compute import VERDICTS, Job, Part

QUICK = """
[set]
stiffness.model = "iso6336"
film.model = "none"
friction.law = "constant"
friction.coefficient = 0.05
"""


@pytest.mark.processor
def test_summaries_are_those_of_a_run(tmp_path: Path) -> None:
    text = f"""
case = "fzg-roughness"
chunk = 3
{QUICK}
[axes]
operation.speed = "900,1500 rpm"
friction.law = ["none", "xu-2007"]
"""
    study = read_study(text)
    run_study(study, tmp_path / "s")
    data = open_study(tmp_path / "s").load()
    member = {"operation.speed": 1, "friction.law": 1}
    changes = {"operation.speed": "1500 rpm", "friction.law": "xu-2007"}
    with quiet():
        wanted = computed(study.case.replace(changes)).summary()
    for name, value in wanted.items():
        # Errors that were estimated are known to the rounding of what they are errors of.
        least = 1e-11 if name.endswith("_error") else 1e-12
        stored = float(data[name].isel(member))
        assert stored == pytest.approx(value, rel=1e-9, abs=least), name


@pytest.mark.processor
def test_motions_are_those_of_a_map_and_of_one_thread(tmp_path: Path) -> None:
    text = f"""
case = "fzg-roughness"
compute = "motions"
chunk = CHUNK
{QUICK}
dynamics.mesh_damping_ratio = 0.02
dynamics.backlash = "60 um"
[axes]
operation.speed = "3000..9000 rpm:4"
force_scale = "0.1,0.3,1"
"""
    study = read_study(text.replace("CHUNK", "7"))
    run_study(study, tmp_path / "s")
    data = open_study(tmp_path / "s").load()
    member = built(study.case)
    speed = data["operation.speed"].values / study.case.operation.speed
    frequency = speed * member.mesh.mesh_frequency
    over = (("mesh_frequency", frequency), ("force_scale", data["force_scale"].values))
    map_result = parameter_map(member.system, over=over)
    for name in ("period", "rms", "contact_loss_share"):
        np.testing.assert_array_equal(data[name], getattr(map_result, name))
    verdicts = np.array(VERDICTS)[data["verdict"].values.astype(int)]
    np.testing.assert_array_equal(verdicts, map_result.verdict)
    assert float(data["contact_loss_share"].max()) > 0.0
    with alone():
        run_study(study, tmp_path / "alone")
    for path in (tmp_path / "s").rglob("*.nc"):
        other = tmp_path / "alone" / path.relative_to(tmp_path / "s")
        assert path.read_bytes() == other.read_bytes()
    run_study(read_study(text.replace("CHUNK", "2")), tmp_path / "small")
    xarray.testing.assert_equal(data, open_study(tmp_path / "small").load())


def test_a_chunk_does_not_depend_on_who_looks_at_its_making() -> None:
    """A profiler holds frames, and with them files and data sets that would be gone."""
    text = 'case = "fzg-roughness"\n[axes]\noperation.speed = "400..900 rpm:3"\n'
    job = Job("summary", read_study(text).case, (), {"operation.speed": [40.0, 60.0, 90.0]})
    part = Part({"rms_mesh_force": np.arange(3.0)}, ["", "failed", ""], [""] * 3)
    alone, encoded = job._encoded(part), []
    sys.setprofile(lambda frame, *_: encoded.append(frame))
    try:
        watched = job._encoded(part)
    finally:
        sys.setprofile(None)
    assert encoded
    assert watched == alone
    with xarray.open_dataset(io.BytesIO(alone), engine="h5netcdf") as data:
        assert data["value"].dims == ("member", "figure")
        assert list(data["figure"].values) == ["rms_mesh_force"]
        assert list(data["failed"].values) == part.failed
