"""Only regular files of limited size are read, and a stored table that changed is refused."""

from __future__ import annotations

import io
import os
import signal
import socket
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import xarray

from tribodyn import validated_files
from tribodyn.errors import InputError
from tribodyn.record import Parts
from tribodyn.validated_files import read_bytes, read_dataset, write_dataset


def _data() -> xarray.Dataset:
    return xarray.Dataset(
        {
            "force": (("time", "gear"), np.arange(6.0).reshape(3, 2), {"units": "N"}),
            "verdict": (("time",), np.array(["physical", "", "µ"], dtype=object)),
            "touching": (("time",), np.array([True, False, True])),
            "period": (("time",), np.array([1, 2, 0])),
            "single": ((), 4.0),
        },
        {"time": [0.0, 0.5, np.nan]},
        {"teeth": 24, "share": 0.5, "title": "x", "names": ["a", "b"]},
    )


def test_read_as_it_was_written(tmp_path: Path) -> None:
    write_dataset(_data(), tmp_path / "a.nc")
    properties = h5py.File(tmp_path / "a.nc").attrs["_NCProperties"]
    assert b"tribodyn=" in properties
    xarray.testing.assert_equal(read_dataset(tmp_path / "a.nc"), _data())
    write_dataset(_data().force, tmp_path / "b.nc")
    assert read_dataset(tmp_path / "b.nc").force.identical(_data().force)


def _contents(path: Path) -> dict[str, Any]:
    """All that HDF5 holds but references, which follow from the dimensions of the variables."""

    def plain(attributes: Any) -> dict[str, Any]:
        named_attributes = {
            n: v for n, v in attributes.items() if n not in ("_NCProperties", "REFERENCE_LIST")
        }
        lists = named_attributes.pop("DIMENSION_LIST", ())
        return {n: (repr(v), np.asarray(v).dtype) for n, v in named_attributes.items()} | {
            "": len(lists)
        }

    with h5py.File(path) as file:
        scales = {n: [[str(s.name) for s in d.values()] for d in v.dims] for n, v in file.items()}
        values = {n: (v.dtype, repr(v[...].tolist()), plain(v.attrs)) for n, v in file.items()}
        return {"": plain(file.attrs), "scales": scales, **values}


def test_the_file_is_that_of_xarray(tmp_path: Path) -> None:
    """Values, types, fill values, attributes, dimensions and their scales, coordinates."""
    data = _data().assign_coords(
        side=(("gear",), ["left", "right"]),
        mark=(("event",), [0.25, 0.5]),
        at=(("time",), [1, 2, 3]),
    )
    data.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    write_dataset(data, tmp_path / "b.nc")
    assert _contents(tmp_path / "a.nc") == _contents(tmp_path / "b.nc")
    parts = Parts(
        {str(n): (v.dims, v.values.tolist(), v.attrs) for n, v in data.data_vars.items()},
        {str(n): (v.dims, v.values, v.attrs) for n, v in data.coords.items()},
        dict(data.attrs),
    )
    write_dataset(parts, tmp_path / "c.nc")
    assert _contents(tmp_path / "c.nc") == _contents(tmp_path / "b.nc")
    assert read_dataset(tmp_path / "c.nc").identical(read_dataset(tmp_path / "b.nc"))


def test_empty_axes_and_names_of_other_dimensions_are_stored(tmp_path: Path) -> None:
    variables = {
        "phase": (("time",), np.arange(3.0)),
        "speed": (("phase",), np.arange(2)),
        "event": (("none", "time"), np.zeros((0, 3))),
        "at": (("empty",), np.zeros(0, int)),
    }
    data = xarray.Dataset(variables, {"empty": ("empty", [])})
    write_dataset(data, tmp_path / "a.nc")
    xarray.testing.assert_identical(read_dataset(tmp_path / "a.nc"), data)
    data.to_netcdf(tmp_path / "b.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "b.nc", engine="h5netcdf") as opened:
        xarray.testing.assert_identical(read_dataset(tmp_path / "a.nc"), opened.load())


def test_variables_that_do_not_fit_together_are_not_stored(tmp_path: Path) -> None:
    for name, values in (("b", [1.0]), ("a/b", [1.0, 2.0])):
        parts = Parts({"a": ("time", [1.0, 2.0]), name: ("time", values)}, {}, {})
        with pytest.raises(ValueError, match="cannot be stored"):
            write_dataset(parts, tmp_path / "a.nc")


@pytest.mark.parametrize("name", ["force", "period", "touching", "time"])
def test_one_changed_value_is_refused(tmp_path: Path, name: str) -> None:
    write_dataset(_data(), tmp_path / "a.nc")
    with h5py.File(tmp_path / "a.nc", "r+") as file:
        value = file[name][...]
        value.reshape(-1)[1] += 1
        file[name][...] = value
    with pytest.raises(InputError, match="damaged or changed after"):
        read_dataset(tmp_path / "a.nc")


def test_a_changed_attribute_or_name_is_refused(tmp_path: Path) -> None:
    for number, change in enumerate(
        (
            lambda file: file.attrs.__setitem__("teeth", 25),
            lambda file: file["force"].attrs.__setitem__("units", "kN"),
            lambda file: file.move("force", "Force"),
            lambda file: file.__delitem__("period"),
        )
    ):
        path = tmp_path / f"{number}.nc"
        write_dataset(_data(), path)
        with h5py.File(path, "r+") as file:
            change(file)
        with pytest.raises(InputError, match="damaged or changed after"):
            read_dataset(path)


def test_only_regular_files_are_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    opened = socket.socket(socket.AF_UNIX)
    opened.bind(str(tmp_path / "socket"))
    for path in (tmp_path / "pipe", tmp_path / "socket", Path("/dev/zero")):
        with pytest.raises(OSError, match="not a regular file"):
            read_bytes(path, "case")
    opened.close()
    with pytest.raises(OSError, match="directory"):
        read_bytes(tmp_path, "case")
    with pytest.raises(OSError, match="no such file"):
        read_bytes(tmp_path / "none", "case")
    with pytest.raises(OSError, match="long"):
        read_bytes(tmp_path / ("x" * 5000), "case")


def test_the_size_is_limited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(validated_files.LARGEST, "case", 10)
    (tmp_path / "a").write_bytes(b"0123456789")
    assert len(read_bytes(tmp_path / "a", "case")) == 10
    (tmp_path / "a").write_bytes(b"0123456789a")
    with pytest.raises(OSError, match="larger than"):
        read_bytes(tmp_path / "a", "case")


@pytest.mark.parametrize("access", [1, 2, 10, 30])
def test_an_interruption_waits_until_a_netcdf_file_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, access: int
) -> None:
    """Inside HDF5 it would print a traceback, pass for a damaged file, or leave a lock behind."""
    write_dataset(_data(), tmp_path / "a.nc")
    dropped: list[object] = []
    monkeypatch.setattr("sys.unraisablehook", dropped.append)
    accesses: list[str] = []

    class Interrupted(io.BytesIO):
        def readinto(self, buffer: Any) -> int:
            accesses.append("read")
            if len(accesses) == access:
                signal.raise_signal(signal.SIGINT)
            return super().readinto(buffer)

    with monkeypatch.context() as patch:
        patch.setattr(validated_files.io, "BytesIO", Interrupted)
        with pytest.raises(KeyboardInterrupt):
            read_dataset(tmp_path / "a.nc")
    assert len(accesses) > access
    assert not dropped
    handler = signal.getsignal(signal.SIGINT)
    assert handler is signal.default_int_handler
    xarray.testing.assert_equal(read_dataset(tmp_path / "a.nc"), _data())
