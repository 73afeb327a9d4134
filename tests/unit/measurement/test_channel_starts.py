"""Channels that start at different times are on one axis, or refused; speeds as channels."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from tribodyn.cli import call
from tribodyn.errors import InputError, ModelWarning
from tribodyn.measurement import Recording, analyse_signal, read
from tribodyn.types import Array

RATE, SIZE, LATE, EVENT = 1000.0, 1000, 0.25, 0.7


def event(start: float) -> Array:
    """One pulse at 0.7 s, of a channel whose first sample is at ``start``."""
    time = start + np.arange(SIZE) / RATE
    return np.asarray(np.exp(-(((time - EVENT) / 0.01) ** 2)))


def tdms(path: Path, *, offset: bool) -> None:
    nptdms = pytest.importorskip("nptdms")
    day = np.datetime64("2024-05-01T10:00:00.000000")
    channels = []
    for name, start in (("acc", 0.0), ("pulses", LATE)):
        shift = np.timedelta64(0 if offset else round(1e6 * start), "us")
        properties = {"wf_increment": 1.0 / RATE, "wf_start_time": day + shift}
        properties["wf_start_offset"] = start if offset else 0.0
        channels.append(nptdms.ChannelObject("m", name, event(start), properties=properties))
    with nptdms.TdmsWriter(str(path)) as out:
        out.write_segment(channels)


def uff(path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    for name, start in (("acc", 0.0), ("pulses", LATE)):
        data = {
            "type": 58, "binary": 1, "func_type": 1, "rsp_node": 1, "rsp_dir": 1, "ref_node": 1,
            "ref_dir": 1, "data": event(start), "x": start + np.arange(SIZE) / RATE, "id1": name,
            "rsp_ent_name": name, "ref_ent_name": "NONE", "abscissa_spacing": 1,
            "abscissa_min": start, "abscissa_inc": 1.0 / RATE, "abscissa_spec_data_type": 17,
            "ordinate_spec_data_type": 0, "orddenom_spec_data_type": 0, "n_bytes": 0,
            "ordinate_axis_units_lab": "g", "z_axis_spec_data_type": 0,
            **dict.fromkeys(("id2", "id3", "id4", "id5"), "NONE"),
        }  # fmt: skip
        pyuff.UFF(str(path)).write_sets(data, "add")


def csv(path: Path, head: str = "time [s],acc [g],time [s],pulses [V]") -> None:
    time = np.arange(SIZE) / RATE
    columns = np.stack([time, event(0.0), time + LATE, event(LATE)], axis=1)
    np.savetxt(path, columns, "%.9g", ",", header=head, comments="")


def clock(path: Path) -> None:
    """Times of day, of which the second begins on the next day."""
    rows = ["time,acc,time,pulses"]
    for number, values in enumerate(zip(event(-0.5), event(-0.5 + LATE), strict=True)):
        cells = []
        for start, value in zip((-0.5, -0.5 + LATE), values, strict=True):
            second = 86_400.0 + start + number / RATE
            day, hour = ("01", "23:59:") if second < 86_400.0 - 1e-9 else ("02", "00:00:")
            rest = f"{second % 60.0 + 1e-9:09.6f}"
            cells += [f"2024-05-{day} {hour}{rest}", f"{value:.9g}"]
        rows.append(",".join(cells))
    path.write_text("\n".join(rows) + "\n")


def mat(path: Path) -> None:
    group = {"dt": 1.0 / RATE}
    first, second = {"data": event(0.0), "t0": 0.0}, {"data": event(LATE), "t0": LATE}
    savemat(path, {"acc": first | group, "pulses": second | group})


def hdf5(path: Path) -> None:
    with h5py.File(path, "w") as file:
        for name, start in (("acc", 0.0), ("pulses", LATE)):
            group = file.create_group(name)
            group["time"] = start + np.arange(SIZE) / RATE
            group["data"] = event(start)


def hdf5_dates(path: Path) -> None:
    with h5py.File(path, "w") as file:
        for name, text in (("acc", "2024-05-01T10:00:00Z"), ("pulses", "2024-05-01 10:00:00.25")):
            file[name] = event(0.0 if name == "acc" else LATE)
            file[name].attrs["start_time"] = text
        file.attrs["fs"] = RATE


@pytest.mark.parametrize(
    ("name", "write", "options"),
    [
        ("start.tdms", tdms, {"offset": False}),
        ("offset.tdms", tdms, {"offset": True}),
        ("starts.uff", uff, {}),
        ("two_times.csv", csv, {}),
        ("bare.csv", csv, {"head": "time,acc,time,pulses"}),
        ("numbered.csv", csv, {"head": "Time1,acc,Time2,pulses"}),
        ("clock.csv", clock, {}),
        ("starts.mat", mat, {}),
        ("times.h5", hdf5, {}),
        ("dates.h5", hdf5_dates, {}),
    ],
)
def test_an_event_is_at_one_sample_of_all_channels(
    tmp_path: Path, name: str, write: Any, options: dict[str, Any]
) -> None:
    write(tmp_path / name, **options)
    with pytest.warns(ModelWarning, match="channels-aligned.*start at different times"):
        recording = read(tmp_path / name)
    first, second = (int(np.argmax(values)) for values in recording.channels.values())
    assert first == second
    assert recording.duration == pytest.approx(SIZE / RATE - LATE)
    assert recording.sample_rate == pytest.approx(RATE, rel=1e-6)
    only = list(recording.channels)[:1]
    assert read(tmp_path / name, channels=only).duration == pytest.approx(SIZE / RATE)


def test_a_fraction_of_a_sample_that_remains_is_reported(tmp_path: Path) -> None:
    columns = np.arange(100) / RATE
    table = np.stack([columns, columns, columns + 0.0103, columns], axis=1)
    np.savetxt(tmp_path / "a.csv", table, "%.9g", ",", header="t,a,t,b", comments="")
    with pytest.warns(ModelWarning, match=r"90 samples from 0\.01 to 0\.1 s.*0\.3 of a sample"):
        assert read(tmp_path / "a.csv")["a"].size == 90


@pytest.mark.parametrize(
    ("starts", "message"),
    [
        ({"acc": 0.0, "pulses": 2.0}, "no time in common: acc 0 s, pulses 2 s"),
        ({"acc": 0.0, "pulses": 0.5, "other": None}, "that of other is not known"),
    ],
)
def test_channels_without_a_common_axis_are_refused(
    tmp_path: Path, starts: dict[str, float | None], message: str
) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.attrs["fs"] = RATE
        for name, start in starts.items():
            file[name] = event(0.0)
            if start is not None:
                file[name].attrs["t0"] = start
    with pytest.raises(InputError, match=message):
        read(tmp_path / "a.h5")
    assert read(tmp_path / "a.h5", channels=["acc"])["acc"].size == SIZE


@pytest.mark.parametrize("head", ["time [s],acc [g],t_oil [s],b", "time [s],T1 [K],T2 [K],b"])
def test_a_channel_that_only_sounds_like_a_time_remains_one(tmp_path: Path, head: str) -> None:
    time = np.arange(40) / RATE
    columns = np.stack([time, event(0.0)[:40], np.cos(time), time], axis=1)
    np.savetxt(tmp_path / "a.csv", columns, "%.9g", ",", header=head, comments="")
    recording = read(tmp_path / "a.csv")
    assert len(recording.channels) == 3
    assert recording.duration == pytest.approx(0.04)


def text_uff(path: Path, values: Array, count: int) -> None:
    """Dataset 58 as text, with six samples in a line."""
    lines = [
        "    -1", "    58", "test", "NONE", "01-Jan-24 10:00:00", "NONE", "NONE",
        "    1         0    0         0 ACC                1   3 NONE               0   0",
        f"{2:10d}{count:10d}{1:10d}{0.0:13.5e}{1.0 / RATE:13.5e}{0.0:13.5e}",
        f"{17:10d}{0:5d}{0:5d}{0:5d} {'Time':20s} {'s':20s}",
        f"{12:10d}{1:5d}{0:5d}{0:5d} {'Acceleration':20s} {'m/s^2':20s}",
        *[f"{0:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {'NONE':20s}"] * 2,
    ]  # fmt: skip
    rows = ["".join(f"{v:13.5e}" for v in values[k : k + 6]) for k in range(0, values.size, 6)]
    path.write_text("\n".join([*lines, *rows, "    -1"]) + "\n")


def test_zeros_that_fill_the_last_line_of_a_universal_file_are_no_samples(tmp_path: Path) -> None:
    pytest.importorskip("pyuff")
    for count in range(6):
        values = np.append(np.cos(np.arange(101.0)), np.zeros(count))
        text_uff(tmp_path / "a.uff", values, 101)
        np.testing.assert_allclose(read(tmp_path / "a.uff")["test"], values[:101], rtol=1e-5)
    for surplus, message in (([1.0], "Only zeros"), ([0.0] * 7, "has 108 samples")):
        text_uff(tmp_path / "a.uff", np.append(np.ones(101), surplus), 101)
        with pytest.raises(InputError, match=message):
            read(tmp_path / "a.uff")


@pytest.mark.parametrize(
    ("name", "unit", "factor"),
    [("n", "rpm", 1.0), ("n", "rad/s", np.pi / 30.0), ("rpm", "", 1.0), ("n", "1/min", -1.0)],
)
def test_a_channel_in_rpm_is_the_speed(name: str, unit: str, factor: float) -> None:
    """The angle is the integral of a speed that rises evenly from 900 to 1100 rpm."""
    time = np.arange(20_000) / 5000.0
    speed = 900.0 + 50.0 * time
    angle = np.pi / 30.0 * (900.0 * time + 25.0 * time**2)
    run = Recording({"acc": 2.0 * np.cos(16.0 * angle), name: factor * speed}, 5000.0,
                    {"acc": "m/s^2", name: unit})  # fmt: skip
    analysis = analyse_signal(run, "acc", tacho=name, teeth=16)
    assert analysis.speed is not None
    np.testing.assert_allclose(analysis.speed.angle, angle, atol=1e-9)
    numbers = analysis.figures()
    assert numbers["mesh_harmonic_1_amplitude"] == pytest.approx(2.0, rel=2e-3)
    assert numbers["highest_speed"] == pytest.approx(1100.0 * np.pi / 30.0, rel=0.01)
    assert analysis.speed.source == f"speed of channel {name}"


@pytest.mark.parametrize(
    ("speed", "pulses", "message"),
    [
        (np.full(4000, 900.0), 60, "holds the speed in rpm"),
        (np.linspace(-500.0, 900.0, 4000), 1, "goes from -500 to 900 rpm"),
        (np.zeros(4000), 1, "The shaft must turn"),
    ],
)
def test_a_speed_that_is_none_is_refused(speed: Array, pulses: int, message: str) -> None:
    run = Recording({"acc": np.cos(np.arange(4000.0)), "n": speed}, 1000.0, {"n": "rpm"})
    with pytest.raises(InputError, match=message):
        analyse_signal(run, "acc", tacho="n", pulses_per_revolution=pulses)


def test_the_command_takes_a_column_in_rpm(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    time = np.arange(8000) / 4000.0
    table = np.stack([time, np.cos(2 * np.pi * 300.0 * time), 900.0 + 0.0 * time], axis=1)
    file = tmp_path / "rpm.csv"
    np.savetxt(file, table, "%.9g", ",", header="time [s],acc [g],n [rpm]", comments="")
    arguments = ["signal", str(file), "--channel", "acc", "--tacho", "n"]
    assert call([*arguments, "--teeth", "20"]) == 0
    assert "shaft at 900 rpm, by speed of channel n" in capsys.readouterr().out
    assert call([*arguments, "--pulses", "2"]) == 2
    assert "--pulses: pulses_per_revolution = 2" in capsys.readouterr().err
