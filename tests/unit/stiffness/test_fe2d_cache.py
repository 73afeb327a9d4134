"""Cached compliances: read again, distinguished by their inputs, and validated."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import BasicRack, Material, SpurGear
from tribodyn.stiffness.fe2d import MeshSize, fe2d_influence, provider
from tribodyn.stiffness.fe2d.provider import NODES, UnitCompliances

STEEL = Material()


def gear_of(**changes: object) -> SpurGear:
    values = {
        "teeth": 20,
        "normal_module": 2e-3,
        "normal_pressure_angle": math.radians(20.0),
        "profile_shift_coefficient": 0.1,
        "tip_diameter": 44e-3,
        "face_width": 10e-3,
        "bore_diameter": 12e-3,
    }
    return SpurGear(**{**values, **changes})


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    monkeypatch.setenv("TRIBODYN_CACHE_DIR", str(tmp_path))
    return tmp_path


@pytest.fixture
def counted(folder, monkeypatch) -> list[tuple[object, ...]]:
    """The cache without the elements: what is computed is a stand-in that is counted."""
    calls: list[tuple[object, ...]] = []

    def stand_in(gear: SpurGear, nu: float, neighbours: int, size: MeshSize) -> UnitCompliances:
        calls.append((gear, nu, neighbours, size))
        rho = np.linspace(1.0, 2.0, NODES) * gear.normal_module
        self_values = np.full(NODES, 3.0 + len(calls))
        return UnitCompliances(rho, self_values, np.ones((neighbours, NODES, NODES)))

    monkeypatch.setattr(provider, "unit_compliances", stand_in)
    return calls


def files(folder: Path) -> list[Path]:
    return sorted(path for path in folder.rglob("*") if path.is_file())


def test_second_time_nothing_is_computed(counted, folder):
    first = fe2d_influence(gear_of(), STEEL)
    again = fe2d_influence(gear_of(), STEEL)
    assert len(counted) == 1
    assert np.array_equal(first.self_compliance, again.self_compliance)
    assert np.array_equal(first.cross_compliance, again.cross_compliance)
    assert [path.suffix for path in files(folder)] == [".npz"]


def test_unrelated_changes_compute_nothing_again(counted):
    fe2d_influence(gear_of(), STEEL)
    other = Material(youngs_modulus=100e9, density=1.0)
    soft = fe2d_influence(gear_of(face_width=5e-3, mass=1.0), other, reference="rim")
    assert len(counted) == 1
    assert np.all(soft.self_compliance < 4.0 / 100e9)
    bore = fe2d_influence(gear_of(), other)
    assert bore.self_compliance == pytest.approx(4.0 / 100e9)


@pytest.mark.parametrize(
    "changes",
    [
        {"teeth": 21},
        {"normal_module": 2.01e-3},
        {"normal_pressure_angle": 0.35},
        {"profile_shift_coefficient": 0.11},
        {"tip_diameter": 44.01e-3},
        {"tooth_thinning": 1e-5},
        {"bore_diameter": 12.1e-3},
        {"rack": BasicRack(tip_radius_coefficient=0.3)},
    ],
    ids=lambda changes: next(iter(changes)),
)
def test_every_change_of_the_shape_is_computed(counted, changes):
    fe2d_influence(gear_of(), STEEL)
    fe2d_influence(gear_of(**changes), STEEL)
    assert len(counted) == 2


def test_other_constants_and_meshes_are_computed(counted):
    fe2d_influence(gear_of(), STEEL)
    fe2d_influence(gear_of(), Material(poissons_ratio=0.31))
    fe2d_influence(gear_of(), STEEL, neighbours=2)
    fe2d_influence(gear_of(), STEEL, size=MeshSize(flank=0.1))
    assert len(counted) == 4


def test_other_sources_are_computed(counted, monkeypatch):
    fe2d_influence(gear_of(), STEEL)
    monkeypatch.setattr(provider, "_digest", lambda: "changed")
    fe2d_influence(gear_of(), STEEL)
    assert len(counted) == 2


def test_every_source_that_counts_is_in_the_digest():
    package = Path(provider.__file__).parent
    listed = set(provider._SOURCES[0][1].split())
    kept_out = {"__init__", "picture"}
    assert listed | kept_out == {path.stem for path in package.glob("*.py")}
    for folder, names in provider._SOURCES:
        assert all((package / folder / f"{name}.py").is_file() for name in names.split())


def test_without_cache_nothing_is_stored(counted, folder):
    fe2d_influence(gear_of(), STEEL, cache=False)
    fe2d_influence(gear_of(), STEEL, cache=False)
    assert len(counted) == 2
    assert files(folder) == []


@pytest.mark.parametrize("damage", ["cut", "text", "empty", "shape", "names", "numbers"])
def test_damaged_file_is_ignored_and_written_anew(counted, folder, damage):
    fe2d_influence(gear_of(), STEEL)
    (path,) = files(folder)
    good = path.read_bytes()
    stored = dict(np.load(path))
    if damage == "cut":
        path.write_bytes(good[: len(good) // 2])
    elif damage == "text":
        path.write_text("no arrays")
    elif damage == "empty":
        path.write_bytes(b"")
    elif damage == "shape":
        np.savez(path, **{**stored, "self_compliance": np.ones(3)})
    elif damage == "names":
        np.savez(path, other=np.ones(3))
    else:
        np.savez(path, **{**stored, "self_compliance": np.full(NODES, np.nan)})
    fe2d_influence(gear_of(), STEEL)
    assert len(counted) == 2
    fe2d_influence(gear_of(), STEEL)
    assert len(counted) == 2
    assert files(folder) == [path]


def test_pickled_objects_are_not_loaded(counted, folder):
    fe2d_influence(gear_of(), STEEL)
    (path,) = files(folder)
    np.savez(path, curvature_radius=np.array([{"a": 1}], dtype=object))
    assert provider.load_arrays(path.stem) is None


def test_folder_that_cannot_be_made_does_not_stop_the_work(counted, folder, monkeypatch):
    blocked = folder / "file"
    blocked.write_text("a file where a folder should be")
    monkeypatch.setenv("TRIBODYN_CACHE_DIR", str(blocked))
    assert fe2d_influence(gear_of(), STEEL).neighbours == 3
    assert fe2d_influence(gear_of(), STEEL).neighbours == 3
    assert len(counted) == 2


def test_interrupted_writing_leaves_nothing_behind(folder, monkeypatch):
    def full(*_: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr(provider.os, "replace", full)
    assert not provider.store_arrays("name", {"a": np.ones(2)})
    assert files(folder) == []
    assert provider.load_arrays("name") is None


def test_folder_of_the_platform(monkeypatch, tmp_path):
    for name in ("TRIBODYN_CACHE_DIR", "XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(provider.Path, "home", lambda: tmp_path)
    expected = {"linux": ".cache", "win32": "Local", "darwin": "Caches"}
    for platform, part in expected.items():
        monkeypatch.setattr(sys, "platform", platform)
        assert part in provider.cache_folder().parts
        assert provider.cache_folder().is_relative_to(tmp_path)
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "other"))
    assert provider.cache_folder() == tmp_path / "other" / "tribodyn"
    monkeypatch.setenv("TRIBODYN_CACHE_DIR", str(tmp_path / "mine"))
    assert provider.cache_folder() == tmp_path / "mine"


def test_cached_result_is_the_computed_one(folder):
    coarse = MeshSize(flank=0.15, largest=0.3, growth=2.0, body_growth=0.6, body_ratio=0.4)
    first = fe2d_influence(gear_of(), STEEL, size=coarse)
    cached = fe2d_influence(gear_of(), STEEL, size=coarse)
    fresh = fe2d_influence(gear_of(), STEEL, size=coarse, cache=False)
    for influence in (cached, fresh):
        assert influence.self_compliance == pytest.approx(first.self_compliance, rel=1e-12)
        assert influence.cross_compliance == pytest.approx(first.cross_compliance, rel=1e-12)
    assert len(files(folder)) == 1


@pytest.mark.parametrize(("neighbours", "expected"), [(1, 1), (2, 2), (3, 2), (9, 2)])
def test_no_more_neighbours_than_there_are(counted, neighbours, expected):
    gear = gear_of(teeth=6, profile_shift_coefficient=0.5, tip_diameter=17e-3, bore_diameter=3e-3)
    assert fe2d_influence(gear, STEEL, neighbours=neighbours).neighbours == expected


def test_wrong_requests_are_refused(counted):
    with pytest.raises(InputError, match="neighbours = 0"):
        fe2d_influence(gear_of(), STEEL, neighbours=0)
    with pytest.raises(InputError, match="hub"):
        fe2d_influence(gear_of(), STEEL, reference="hub")
    with pytest.raises(InputError, match=r"bore radius 0 mm.*rim"):
        fe2d_influence(gear_of(bore_diameter=0.0), STEEL)
    assert counted == []


def test_rim_thinner_than_the_local_compression_reaches_is_refused(folder):
    gear = gear_of(
        teeth=80, profile_shift_coefficient=0.0, tip_diameter=164e-3, bore_diameter=154.6e-3
    )
    coarse = MeshSize(flank=0.15, largest=0.3, growth=2.0)
    with pytest.raises(InputError, match=r"rim of 0\.2 mm.*smaller bore"):
        fe2d_influence(gear, STEEL, size=coarse)
