"""Recordings come back as the libraries that define their formats wrote them."""

from __future__ import annotations

import gzip
from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy.io import savemat, wavfile
from scipy.io.matlab import MatlabOpaque

from tribodyn.errors import InputError, ModelWarning
from tribodyn.measurement import Recording, read

RATE = 5000.0
TIME = np.arange(1000) / RATE
ACC, SOUND = np.sin(2 * np.pi * 50 * TIME), 3.0 * np.cos(2 * np.pi * 70 * TIME)


def rows(separator: str, point: str = ".") -> str:
    lines = (f"{a:.4f}{separator}{b:.7f}" for a, b in zip(TIME, ACC, strict=True))
    return "\n".join(line.replace(".", point) for line in lines)


@pytest.mark.parametrize(
    ("head", "separator", "point"),
    [
        ("time [s],acc [m/s^2]\n", ",", "."),
        ("Rig 3; Mr. Smith\nZeit [s];acc [m/s^2]\n", ";", ","),
        ("time\tacc\ns\tm/s^2\n", "\t", "."),
        ("# comment\n# t acc\n", " ", "."),
    ],
)
def test_columns_of_text_in_any_dialect(tmp_path: Path, head, separator, point) -> None:
    file = tmp_path / "run.csv"
    file.write_text("\ufeff" + head + rows(separator, point), "utf-8")
    recording = read(file)
    assert recording.sample_rate == pytest.approx(RATE)
    np.testing.assert_allclose(recording["acc"], ACC, atol=1e-7)
    assert recording.units["acc"] == ("" if "#" in head else "m/s^2")


@pytest.mark.parametrize(
    "text",
    [
        "5000,2\ntime,acc\n0,1\n.001,2\n.002,3\n",
        "Rig 3,Mr. Smith\nacc,Time\nm/s^2,ms\n1,0\n2,1\n3,2\n",
        'Time/s,"acc, m/s^2"\n0,1\n.001,2\n.002,3\n',
        'time,acc\n"0,000","1,0"\n"0,001","2,0"\n"0,002","3,0"\n',
        "TIME [MS];acc;\n0;1;\n1;2;\n2;3;\n",
        "time,acc\n2024-02-28 23:59:59.999,1\n2024-02-29 00:00:00.000,2\n"
        "2024-02-29 00:00:00.001,3\n",
    ],
)
def test_columns_as_loggers_write_them(tmp_path: Path, text: str) -> None:
    file = tmp_path / "run.csv"
    file.write_text(text, "utf-16")
    recording = read(file)
    assert recording.sample_rate == pytest.approx(1000.0, rel=1e-7)
    np.testing.assert_array_equal(recording["acc"], [1.0, 2.0, 3.0])
    assert recording.units["acc"] == ("m/s^2" if "m/s" in text else "")


def test_rounded_times_need_the_rate(tmp_path: Path) -> None:
    file = tmp_path / "run.csv"
    file.write_text("time,acc\n" + "\n".join(f"{n / 25600:.4f},{n}" for n in range(999)) + "\n")
    with pytest.raises(InputError, match=r"rounded to 0\.0001 s"):
        read(file)
    assert read(file, sample_rate=25600.0).sample_rate == 25600.0
    with pytest.raises(InputError, match="rounded"):
        read(file, sample_rate=25000.0)


def test_compressed_text_and_milliseconds(tmp_path: Path) -> None:
    file = tmp_path / "run.csv.gz"
    text = "\n".join(f"{1e3 * a:.3f},{b:.7f}" for a, b in zip(TIME, ACC, strict=True))
    with gzip.open(file, "wt") as out:
        out.write("time [ms],acc\n" + text)
    assert read(file).sample_rate == pytest.approx(RATE)


def test_wav_of_floats_and_of_whole_numbers(tmp_path: Path) -> None:
    wavfile.write(tmp_path / "f.wav", 5000, np.stack([ACC, SOUND], 1).astype("f4"))
    wavfile.write(tmp_path / "i.wav", 5000, np.round(ACC * 32767).astype("i2"))
    wavfile.write(tmp_path / "u.wav", 5000, np.round(128 + ACC * 127).astype("u1"))
    np.testing.assert_allclose(read(tmp_path / "f.wav")["channel 2"], SOUND, atol=1e-6)
    np.testing.assert_allclose(read(tmp_path / "i.wav")["channel 1"], ACC, atol=1e-4)
    np.testing.assert_allclose(read(tmp_path / "u.wav")["channel 1"], ACC, atol=1e-2)


@pytest.mark.parametrize("ending", ["mat", "h5", "csv"])
def test_names_of_channels_come_back_as_they_were(tmp_path: Path, ending: str) -> None:
    values = np.sin(np.arange(200.0))
    saved = Recording({"meshes.first.mesh_force": values, "2nd acc": values}, 1e3,
                      {"meshes.first.mesh_force": "N", "2nd acc": "m/s^2"})  # fmt: skip
    recording = read(saved.save(tmp_path / f"r.{ending}"))
    assert set(recording.channels) == set(saved.channels)
    assert dict(recording.units) == dict(saved.units)


def test_mat_and_hdf5(tmp_path: Path) -> None:
    savemat(tmp_path / "a.mat", {"acc": ACC, "fs": RATE, "more": {"sound": SOUND}})
    recording = read(tmp_path / "a.mat")
    np.testing.assert_array_equal(recording["acc"], ACC)
    np.testing.assert_array_equal(recording["more.sound"], SOUND)
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["rig/acc"] = 0.1 * ACC
        file["rig/acc"].attrs["units"] = "V"
        file.attrs["sample_rate"] = RATE
    scaled = read(tmp_path / "a.h5", sensitivity={"rig/acc": "100 mV/g"})
    np.testing.assert_allclose(scaled["rig/acc"], 9.80665 * ACC)
    assert scaled.units["rig/acc"] == "m/s^2"


def test_rates_and_units_apply_to_their_enclosing_scope(tmp_path: Path) -> None:
    two = {"a": {"data": ACC, "fs": RATE, "unit": "g"}, "b": {"data": SOUND[:500], "dt": 4e-4}}
    savemat(tmp_path / "two.mat", two)
    with h5py.File(tmp_path / "two.h5", "w") as file:
        for name, values in two.items():
            file[f"{name}/data"] = values["data"]
        file["a"].attrs["sample_rate"] = str(RATE)
        file["a/data"].attrs["unit"] = "g"
        file["b/time"] = 0.4 * np.arange(500)
        file["b/time"].attrs["units"] = "ms"
    for path, mark in ((tmp_path / "two.mat", "."), (tmp_path / "two.h5", "/")):
        with pytest.raises(InputError, match="rates differ"):
            read(path)
        assert read(path, channels=f"a{mark}data") == Recording(
            {f"a{mark}data": ACC}, RATE, {f"a{mark}data": "g"}
        )
        slow = read(path, channels=f"b{mark}data")
        assert slow.sample_rate == pytest.approx(2500.0)
        np.testing.assert_array_equal(slow[f"b{mark}data"], SOUND[:500])
    savemat(tmp_path / "both.mat", {"acc": ACC, "fs": RATE, "dt": 1.0 / RATE, "Fs": 2.0 * RATE})
    with pytest.raises(InputError, match="different sampling rates"):
        read(tmp_path / "both.mat")


def test_mat_of_every_version_cells_and_lists_of_structures(tmp_path: Path) -> None:
    items = np.zeros(2, dtype=[("data", "O")])
    items["data"] = [ACC, SOUND]
    cells = np.empty(2, dtype=object)
    cells[:] = [ACC, SOUND]
    savemat(tmp_path / "unit.mat", {"acc": ACC, "acc_unit": "m/s^2", "note": "rig", "fs": RATE})
    assert dict(read(tmp_path / "unit.mat").units) == {"acc": "m/s^2"}
    savemat(tmp_path / "four.mat", {"acc": ACC, "fs": RATE}, format="4")
    savemat(tmp_path / "five.mat", {"s": items, "c": cells, "fs": RATE})
    np.testing.assert_array_equal(read(tmp_path / "four.mat")["acc"], ACC)
    five = read(tmp_path / "five.mat")
    for name in ("s(2).data", "c{2}"):
        np.testing.assert_array_equal(five[name], SOUND)
    with h5py.File(tmp_path / "new.mat", "w", userblock_size=512) as file:
        file["#refs#/a"] = SOUND
        file["c"] = np.array([file["#refs#/a"].ref], dtype=h5py.ref_dtype)
        file["count"] = np.arange(1000, dtype="i2")[:, None]
        file["count"].attrs["MATLAB_class"] = np.bytes_(b"int16")
        file["fs"] = [[RATE]]
    with open(tmp_path / "new.mat", "r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file".ljust(128))
    new = read(tmp_path / "new.mat")
    np.testing.assert_array_equal(new["c{1}"], SOUND)
    np.testing.assert_array_equal(new["count"], np.arange(1000))
    with h5py.File(tmp_path / "new.mat", "r+") as file:
        file["T"] = np.zeros(6, "u4")
        file["T"].attrs["MATLAB_object_decode"] = 3
        file["T"].attrs["MATLAB_class"] = np.bytes_(b"timetable")
    with pytest.raises(InputError, match="table2struct"):
        read(tmp_path / "new.mat")


def test_whatever_a_recorder_adds_to_a_wav_file(tmp_path: Path) -> None:
    wavfile.write(tmp_path / "a.wav", 5000, ACC)
    raw = (tmp_path / "a.wav").read_bytes()
    more = b"bext" + (602).to_bytes(4, "little") + bytes(602)
    size = (len(raw) + len(more) - 8).to_bytes(4, "little")
    (tmp_path / "a.wav").write_bytes(b"RIFF" + size + b"WAVE" + more + raw[12:])
    np.testing.assert_array_equal(read(tmp_path / "a.wav")["channel 1"], ACC)


def test_numbers_that_are_scaled_in_the_file(tmp_path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    raw = np.round(1000.0 * ACC).astype("i2")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["acc"] = raw
        file["acc"].attrs.update({"scale_factor": 1e-3, "add_offset": 2.0, "fs": RATE})
    linear = {"Scale_Type": "Linear", "Linear_Slope": 1e-3, "Linear_Y_Intercept": 2.0,
              "Linear_Input_Source": np.uint32(0xFFFFFFFF)}  # fmt: skip
    scaling = {f"NI_Scale[0]_{name}": value for name, value in linear.items()}
    scaling |= {"NI_Number_Of_Scales": np.int32(1), "NI_Scaling_Status": "unscaled"}
    with nptdms.TdmsWriter(str(tmp_path / "a.tdms")) as out:
        group = nptdms.GroupObject("rig", properties={"wf_increment": 1.0 / RATE})
        out.write_segment([group, nptdms.ChannelObject("rig", "acc", raw, properties=scaling)])
    for name in ("a.h5", "a.tdms"):
        np.testing.assert_allclose(read(tmp_path / name)["acc"], 2.0 + 1e-3 * raw)


def uff_set(samples: np.ndarray, name: str, binary: int, unit: str) -> dict:
    """A time history as pyuff writes it."""
    return {
        "type": 58, "binary": binary, "func_type": 1, "rsp_node": 1, "rsp_dir": 1, "ref_node": 1,
        "ref_dir": 1, "data": samples, "x": TIME, "id1": name, "rsp_ent_name": name,
        "ref_ent_name": "NONE", "abscissa_spacing": 1, "abscissa_inc": 1.0 / RATE,
        "abscissa_spec_data_type": 17, "ordinate_spec_data_type": 0, "orddenom_spec_data_type": 0,
        "ordinate_axis_units_lab": unit, "z_axis_spec_data_type": 0, "n_bytes": 0,
        "id2": "NONE", "id3": "NONE", "id4": "NONE", "id5": "NONE",
    }  # fmt: skip


def test_uff_and_tdms_by_their_own_libraries(tmp_path: Path) -> None:
    pyuff, nptdms = pytest.importorskip("pyuff"), pytest.importorskip("nptdms")
    for name, binary in (("text.uff", 0), ("binary.uff", 1)):
        data = uff_set(SOUND, "microphone", binary, "Pa")
        pyuff.UFF(str(tmp_path / name)).write_sets(data, "add")
        recording = read(tmp_path / name)
        np.testing.assert_allclose(recording["microphone"], SOUND, rtol=1e-4)
        assert recording.units["microphone"] == "Pa"
        assert recording.sample_rate == pytest.approx(RATE, rel=1e-4)
    with nptdms.TdmsWriter(str(tmp_path / "a.tdms")) as out:
        properties = {"wf_increment": 1.0 / RATE, "unit_string": "g"}
        out.write_segment([nptdms.ChannelObject("rig", "acc", ACC, properties=properties)])
    assert read(tmp_path / "a.tdms") == Recording({"acc": ACC}, RATE, {"acc": "g"})


def test_a_saved_recording_comes_back_equal(tmp_path: Path) -> None:
    recording = Recording({"acc": ACC, "sound": SOUND}, RATE, {"acc": "m/s^2", "sound": "Pa"})
    recording.save(tmp_path / "made.nc")
    assert read(tmp_path / "made.nc") == recording
    assert recording.to_xarray()["sound"].units == "Pa"
    assert read(tmp_path / "made.nc", channels=["sound"]).units == {"sound": "Pa"}
    with h5py.File(tmp_path / "made.nc", "r+") as file:
        file["acc"][7] = 5.0
    with pytest.raises(InputError, match="damaged or changed after"):
        read(tmp_path / "made.nc")


def written(folder: Path) -> dict[str, Path]:
    """One file of every kind that is written here."""
    wavfile.write(folder / "a.wav", 5000, ACC.astype("f4"))
    savemat(folder / "a.mat", {"acc": ACC, "fs": RATE})
    with h5py.File(folder / "a.h5", "w") as file:
        file["acc"] = ACC
        file.attrs["fs"] = RATE
    pyuff, nptdms = pytest.importorskip("pyuff"), pytest.importorskip("nptdms")
    data = uff_set(ACC, "a", 1, "g")
    pyuff.UFF(str(folder / "a.uff")).write_sets(data, "add")
    with nptdms.TdmsWriter(str(folder / "a.tdms")) as out:
        out.write_segment([nptdms.ChannelObject("r", "a", ACC, properties={"wf_increment": 2e-4})])
    return {path.suffix: path for path in folder.iterdir()}


def test_files_that_are_cut_short_are_refused(tmp_path: Path) -> None:
    for suffix, path in written(tmp_path).items():
        cut = tmp_path / f"cut{suffix}"
        cut.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])
        with pytest.raises(InputError) as error:
            read(cut)
        assert "cut" in str(error.value), suffix


def test_a_file_that_ends_between_its_datasets_is_refused(tmp_path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    for name in ("a", "b", "c"):
        pyuff.UFF(str(tmp_path / "a.uff")).write_sets(uff_set(ACC, name, 1, "g"), "add")
    raw = (tmp_path / "a.uff").read_bytes()
    text = ("time,acc\n" + "\n".join(f"{a},{b}" for a, b in zip(TIME, SOUND, strict=True))).encode()
    fixed = ("time,acc\n" + rows(",")).encode()
    readable = 0
    for tenth in range(1, 10):
        (tmp_path / "a.uff").write_bytes(raw[: len(raw) * tenth // 10])
        with pytest.raises(InputError):
            read(tmp_path / "a.uff")
        for content in (text, fixed):
            (tmp_path / "a.csv").write_bytes(content[: len(content) * tenth // 10])
            try:
                samples = read(tmp_path / "a.csv")["acc"]
            except InputError:
                continue
            readable += 1
            np.testing.assert_allclose(
                samples, (SOUND if content is text else ACC)[: samples.size], atol=1e-6
            )
    assert readable < 9


def test_files_with_a_wrong_extension_are_recognised(tmp_path: Path) -> None:
    files = written(tmp_path)
    for suffix, path in files.items():
        for other in {*files, ".csv"} - {suffix}:
            wrong = tmp_path / f"wrong{other}"
            wrong.write_bytes(path.read_bytes())
            with pytest.raises(InputError, match=r"is no .* file"):
                read(wrong)


def test_damaged_files_raise_nothing_but_input_errors(tmp_path: Path, draws) -> None:
    files = written(tmp_path)
    files[".csv"] = tmp_path / "a.csv"
    files[".csv"].write_text("time,acc\n" + rows(","))
    for random in draws(15):
        for suffix, path in files.items():
            raw = bytearray(path.read_bytes())
            for _ in range(random.randint(1, 9)):
                raw[random.randrange(len(raw) if random.random() < 0.5 else 600)] = (
                    random.getrandbits(8)
                )
            damaged = tmp_path / f"damaged{suffix}"
            damaged.write_bytes(raw)
            try:
                recording = read(damaged)
            except InputError:
                continue
            assert all(np.all(np.isfinite(recording[name])) for name in recording.channels)


def test_a_table_of_matlab_names_the_way_out(tmp_path: Path, monkeypatch) -> None:
    variables = {"None": np.zeros(1).view(MatlabOpaque)}
    monkeypatch.setattr("scipy.io.loadmat", lambda *_, **__: variables)
    savemat(tmp_path / "t.mat", {"a": ACC})
    with pytest.raises(InputError, match="table2struct"):
        read(tmp_path / "t.mat")


def test_rates_in_headers(tmp_path: Path) -> None:
    """A header structure describes the channels next to it, that of one channel only this one."""
    savemat(tmp_path / "a.mat", {"acc": ACC, "File_Header": {"SampFreq": "5000", "rate": 3.0}})
    assert read(tmp_path / "a.mat").sample_rate == RATE
    channels = {f"Channel_{n}_Data": ACC for n in (1, 10)} | {"sound": SOUND}
    headers = {"Channel_1_Header": {"XInc": 1e-3}, "Channel_10_Header": {"XInc": 1.0 / RATE}}
    savemat(tmp_path / "b.mat", channels | headers | {"Info": {"Acq": {"SampFreq": 2e4}}})
    for name, rate in (("Channel_1_Data", 1000.0), ("Channel_10_Data", RATE), ("sound", 2e4)):
        assert read(tmp_path / "b.mat", channels=[name]).sample_rate == pytest.approx(rate)
    savemat(tmp_path / "c.mat", {"Channel_1": {"Data": ACC, "XInc": 1.0 / RATE}, "ramp": {"dt": 9}})
    assert read(tmp_path / "c.mat").sample_rate == pytest.approx(RATE)
    with h5py.File(tmp_path / "d.h5", "w") as file:
        file["rig/acc"] = ACC
        file.create_group("rig/header").attrs["SampFreq"] = RATE
    assert read(tmp_path / "d.h5").sample_rate == RATE
    savemat(tmp_path / "e.mat", {"acc": ACC, "A": {"fs": 1e3}, "B": {"fs": 2e3}})
    with pytest.raises(InputError, match="different sampling rates"):
        read(tmp_path / "e.mat")


@pytest.mark.parametrize(
    "head",
    [
        "XInc,2e-4\nXOrg,0\nacc,sound\n",
        "Sample Rate [kHz];5\nacc;sound\n",
        "# SampFreq = 5000 Hz\n# acc sound\n",
        "Sample interval: 200 us\n",
    ],
)
def test_rates_above_the_columns_of_text(tmp_path: Path, head: str) -> None:
    separator = ";" if ";" in head else "," if "," in head else " "
    table = "\n".join(f"{a:.6f}{separator}{b:.6f}" for a, b in zip(ACC, SOUND, strict=True))
    (tmp_path / "run.csv").write_text(head + table + "\n")
    recording = read(tmp_path / "run.csv")
    assert recording.sample_rate == pytest.approx(RATE)
    first, second = recording.channels
    assert first == ("acc" if "acc" in head else "column 1")
    np.testing.assert_allclose(recording[second], SOUND, atol=1e-6)


def test_the_second_of_duplicate_variables_counts(tmp_path: Path) -> None:
    parts = []
    for name, values in {"first": 0.0 * ACC, "second": ACC}.items():
        savemat(tmp_path / f"{name}.mat", {"acc": values, "fs": RATE})
        parts.append((tmp_path / f"{name}.mat").read_bytes())
    (tmp_path / "run.mat").write_bytes(parts[0] + parts[1][128:])
    with pytest.warns(ModelWarning) as raised:
        recording = read(tmp_path / "run.mat")
    assert [each.message.code for each in raised] == ["duplicate-variables"]
    assert "holds acc, fs twice: the second of each is read" in str(raised[0].message)
    np.testing.assert_allclose(recording["acc"], ACC)


BAD = [
    ("a,b\n1,2\n3,x\n", {}, '"x" is not a number in row 2'),
    ("a,b\n1,2\n3\n", {}, "1 columns"),
    ("a,b\n1,2\n3,nan\n", {}, '"nan" is not a number'),
    ("a,b\n1,2\n3,4\n", {}, "Pass sample_rate"),
    ("time,b\n0,2\n1,4\n2,4\n4,4\n", {}, "a step of 2 s at sample 3"),
    ("time,b\n0,2\n0,4\n", {}, "do not rise"),
    ("time\n0\n1\n", {}, "has a time column but no channels"),
    ("nothing here", {}, "no line of numbers"),
    ("time,b\n0,2\n1,4\n", {"sample_rate": 2.0}, "sampling rates differ"),
    ("time,acc\n0,2\n1,4\n", {"channels": ["ac"]}, 'Did you mean "acc"'),
    ("time,acc\n0,2\n1,4\n", {"sensitivity": {"acc": "100 mV"}}, "100 mV/g"),
    ("time,acc\n0,2\n1,4\n", {"sensitivity": {"acc": "1 kg/g"}}, "100 mV/g"),
]


@pytest.mark.parametrize(("text", "options", "message"), BAD)
def test_messages(tmp_path: Path, text: str, options: dict, message: str) -> None:
    file = tmp_path / "a.csv"
    file.write_text(text)
    with pytest.raises(InputError) as error:
        read(file, **options)
    assert message in str(error.value)


@pytest.mark.parametrize("path", ["", "missing.csv", "/dev/zero", 3, None])
def test_places_that_are_no_recording(path: object) -> None:
    with pytest.raises(InputError):
        read(path)


def test_recordings_are_whole(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="different numbers"):
        Recording({"a": ACC, "b": ACC[1:]}, RATE, {})
    with pytest.raises(InputError, match="nan at sample 2"):
        Recording({"a": [1.0, 2.0, np.nan]}, RATE, {})
    with pytest.raises(InputError):
        Recording({}, RATE, {})
    recording = Recording({"a": ACC}, RATE, {})
    assert recording.cut(0.05, 0.1)["a"].size == 250
    with pytest.raises(InputError, match=r"lasts 0\.2 s"):
        recording.cut(0.1, 0.3)
    assert len(recording.plot().data) == 1


@pytest.mark.parametrize(
    ("text", "width"),
    [
        ("1," * 100_000, 100_000),
        ("a," * 50_000 + "\n" + "1," * 50_000 + "\n", 50_000),
        ("# " * 100_000 + "\n1;2\n3;4\n", 2),
        ("a" + " " * 100_000 + "b;c\n1;2\n3;4\n", 2),
        ("x:" + "," * 100_000 + "!\n1;2\n3;4\n", 2),
    ],
)
def test_long_lines_take_time_in_proportion_to_their_length(
    tmp_path: Path, text: str, width: int
) -> None:
    """In proportion to the square of it, each of them takes minutes."""
    (tmp_path / "a.csv").write_text(text)
    assert len(read(tmp_path / "a.csv", sample_rate=RATE).channels) == width


def test_a_list_above_the_columns_is_no_rate(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("offsets: 1,2,3.5,4\nSampFreq: 2000 Hz;;;\na;b\n1;2\n3;4\n")
    assert read(tmp_path / "a.csv").sample_rate == 2000.0


def test_names_that_repeat_stay_apart(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("a;column 3;;a\n1;2;3;4\n5;6;7;8\n")
    names = list(read(tmp_path / "a.csv", sample_rate=RATE).channels)
    assert names == ["a", "column 3", "column 3 (3)", "a (4)"]
