"""``tribodyn recording``: one recording, a labelled set, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path
from shlex import split

import numpy as np
import pytest

from tribodyn.cli import call
from tribodyn.measurement import read

WAVE = (
    "fzg-roughness", "--sensor", "transmission_error", "--set", "stiffness.model=analytic",
    "--set", "film.model=none", "--set", "friction.law=none",
    "--set", "faults.axis.kind=eccentricity", "--set", "faults.axis.gear=pinion",
    "--set", "faults.axis.amplitude=10 um",
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_a_recording_and_a_set_have_their_truth(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The recording has the line of the eccentricity, the set its amplitudes."""
    file, folder = tmp_path / "axis.mat", tmp_path / "set"
    options = ("--duration", "0.5 s", "--sample-rate", "5000 Hz")
    assert call(["recording", *WAVE, *options, "--out", str(file), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["samples"] == 2500
    assert facts["faults"]["axis"]["amplitude"] == pytest.approx(1e-5)
    truth = json.loads(file.with_suffix(".json").read_text("utf-8"))
    assert truth["faults"] == facts["faults"]
    over = "faults.axis.amplitude=0,10 um"
    out = ("--repeats", "2", "--out", str(folder))
    assert call(["recording", WAVE[0], over, "--sensor", "pinion_z", *WAVE[3:], *out]) == 2
    assert not folder.exists()
    assert call(["recording", WAVE[0], over, *WAVE[1:], *options, *out]) == 0
    assert "4 recordings" in capsys.readouterr().out
    rows = (folder / "labels.csv").read_text("utf-8").splitlines()
    assert [float(row.split(",")[-1]) for row in rows[1:]] == [0.0, 0.0, 1e-5, 1e-5]
    signal = read(file)["transmission_error"]
    signal = signal[: round(6 * 5000.0 / 15.0)]  # six turns
    line = np.fft.rfft(signal)[6] / signal.size
    assert abs(2.0 * line) == pytest.approx(1e-5, rel=0.02)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("--duration", "2"), '--duration: "2"'),
        (("--repeats", "3"), "--repeats: repeats = 3"),
        (("--out", "axis.xyz"), "Recordings are written as .wav"),
        (("faults.axis.amplitude=0,1 um", "--force"), "--force"),
        (("faults.axis.amplitude=0,1 um", "--tacho", "wheel"), "--tacho: tacho = wheel"),
        (("--tacho", "whel"), 'Did you mean "wheel"'),
    ],
)
def test_what_cannot_be_recorded_names_its_option(
    arguments: tuple[str, ...], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["recording", *WAVE, *arguments]) == 2
    assert expected in capsys.readouterr().err


MACHINE = """
[gears]
z1 = { shaft = "in", teeth = 20, face_width = "50 mm" }
z2 = { shaft = "out", teeth = 41, face_width = "50 mm" }
[meshes.first]
gears = ["z1", "z2"]
normal_module = "4 mm"
stiffness = "5e8 N/m"
transmission_error_amplitude = "2 um"
[operation]
input = "in"
output = "out"
speed = "1200 rpm"
torque = "100 N*m"
"""


def test_the_tacho_of_a_machine_and_the_command_that_reads_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("m.toml").write_text(MACHINE, "utf-8")
    sensor = ("--sensor", "meshes.first.mesh_force", "--sample-rate", "5000 Hz")
    assert call(["recording", "m.toml", *sensor, "--tacho", "out"]) == 0
    command = capsys.readouterr().err.strip().splitlines()[-1]
    assert command.endswith(
        '--channel "meshes.first.mesh_force" --tacho "tacho" --case m.toml --gear z2'
    )
    tacho = read("m-recording.mat")["tacho"]
    pulses = np.count_nonzero(np.diff((tacho > 0.5 * tacho.max()).astype(int)) == 1)
    assert abs(pulses - 20 * 20 / 41) <= 1  # in a second
    assert call([*split(command.partition("tribodyn ")[2]), "--json"]) == 0
    assert call(["recording", "m.toml", *sensor, "--out", "m.wav"]) == 0  # without names
    command = capsys.readouterr().err.strip().splitlines()[-1]
    assert call([*split(command.partition("tribodyn ")[2]), "--json"]) == 0
