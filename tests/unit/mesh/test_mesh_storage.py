"""A mesh table as a data set and as a file; and as a figure."""

from __future__ import annotations

import json
from dataclasses import fields, replace

import numpy as np
import pytest

from tribodyn.errors import InputError, OutputExistsError
from tribodyn.gear import FlankModification, Material, ProfileMap, flank_ranges
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import MeshTable, build
from tribodyn.nomenclature import QUANTITIES

# The laws say for themselves where they are used beyond their range.
pytestmark = pytest.mark.filterwarnings(r"ignore:\[friction-range\]")


@pytest.fixture(params=["none", "moes"])
def mesh(request, fzg):
    return build(
        fzg(),
        material=Material(),
        lubricant=Lubricant(0.082, 880.0, 21.9e-9),
        friction_law="xu-2007",
        composite_roughness=0.53e-6,
        film_model=request.param,
        pinion_speed=94.0,
        pinion_torque=90.0,
        steps=64,
    )


def test_a_round_trip_is_exact(mesh, tmp_path):
    mesh.save(tmp_path / "mesh.nc")
    again = MeshTable.load(tmp_path / "mesh.nc")
    for field in fields(mesh):
        before, after = getattr(mesh, field.name), getattr(again, field.name)
        if isinstance(before, np.ndarray):
            assert after.dtype == before.dtype
            assert np.array_equal(after, before), field.name
        elif field.name != "grid":
            assert after == before, field.name
    assert again.event_phases == mesh.event_phases
    assert again.segments == mesh.segments
    assert np.array_equal(again.phase, mesh.phase)
    assert repr(again) == repr(mesh)
    assert np.array_equal(again.at("stiffness", 0.123), mesh.at("stiffness", 0.123))


def test_modifications_come_back(mesh, fzg, tmp_path):
    pinion, _ = flank_ranges(fzg())
    rows = ((1e-6, 2e-6), (3e-6, -4e-6))
    pair = fzg(
        pinion_modification=FlankModification(
            tip_relief=10e-6,
            tip_relief_length=3e-3,
            tip_relief_shape="parabolic",
            wear_depth=(1e-6, 2e-6),
            profile_map=ProfileMap(tuple(pinion), (-10e-3, 10e-3), rows),
        ),
        wheel_modification=FlankModification(
            cumulative_pitch_deviation=tuple(tooth * 1e-7 for tooth in range(24)), run_out=9e-6
        ),
        misalignment=-4e-6,
    )
    replace(mesh, gear_pair=pair).save(tmp_path / "mesh.nc")
    again = MeshTable.load(tmp_path / "mesh.nc").gear_pair
    assert again == pair
    assert hash(again) == hash(pair)
    assert again != mesh.gear_pair


def test_a_table_from_before_modifications_has_none(mesh, tmp_path):
    import xarray

    mesh.save(tmp_path / "mesh.nc")
    with xarray.open_dataset(tmp_path / "mesh.nc", engine="h5netcdf") as opened:
        data = opened.load()
    pair = json.loads(data.attrs["gear_pair"])
    del pair["misalignment"], pair["pinion"]["modification"], pair["wheel"]["modification"]
    data.attrs["gear_pair"] = json.dumps(pair)
    data.to_netcdf(tmp_path / "old.nc", engine="h5netcdf")
    assert MeshTable.load(tmp_path / "old.nc").gear_pair == mesh.gear_pair


def test_columns_carry_the_units_of_the_nomenclature(mesh):
    data = mesh.to_xarray()
    assert data["stiffness"].attrs["units"] == QUANTITIES["pair_stiffness"].unit == "N/m"
    assert data["hertz_pressure"].attrs["units"] == "Pa"
    assert data["load_share"].attrs["units"] == "1"
    assert all("units" in data[name].attrs for name in data.data_vars)
    assert data["stiffness"].dims == ("knot", "pair")
    assert data.attrs["pinion_torque"] == 90.0


def test_an_existing_file_is_not_replaced(mesh, tmp_path):
    path = tmp_path / "mesh.nc"
    path.write_text("mine")
    with pytest.raises(OutputExistsError, match="exists already"):
        mesh.save(path)
    assert path.read_text() == "mine"


def test_a_file_that_is_no_table_is_refused(tmp_path):
    import xarray

    missing, text, other = (tmp_path / name for name in ("no.nc", "text.nc", "other.nc"))
    text.write_text("mine")
    xarray.Dataset({"x": ("n", [1.0])}).to_netcdf(other, engine="h5netcdf")
    for path in (missing, text, other):
        with pytest.raises(InputError, match="no mesh table"):
            MeshTable.load(path)


def test_the_table_has_its_plot(mesh):
    stiffness, friction = mesh.plot_stiffness(), mesh.plot_friction()
    highest = max(float(np.max(trace.y)) for trace in stiffness.data)
    assert highest == pytest.approx(mesh.mesh_stiffness.max() / 1e6, rel=1e-12)
    assert len(friction.data) >= 1
