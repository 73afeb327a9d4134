"""Harris maps of hypoid pairs: the loaded contact at every torque."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from known_hypoids import eased, random_blanks
from tribodyn.errors import InputError, collected
from tribodyn.mesh import hypoid_loaded_contact, hypoid_transmission_error_over_torque
from tribodyn.study.mesh_inputs import mesh_inputs
from tribodyn.study.pipeline.tooth_contact import hypoid_loaded_contact_of, mesh_of


def test_it_is_the_loaded_contact_at_every_torque() -> None:
    for blank, side in zip(random_blanks(2, seed=3), ("drive", "coast"), strict=True):
        loaded = hypoid_loaded_contact(eased(blank, side), 100.0, steps=16, cells=16)
        study = hypoid_transmission_error_over_torque(loaded, [400.0, 50.0, 1600.0])
        assert study.torque.tolist() == [50.0, 400.0, 1600.0]
        for torque, error, mean in zip(
            study.torque, study.transmission_error, study.mean_mesh_stiffness_secant, strict=True
        ):
            contact = loaded.under(torque)
            lag = contact.wheel_lever * contact.loaded_rotation
            assert error == pytest.approx(lag[:-1], rel=1e-12)
            assert mean == pytest.approx(contact.mean_mesh_stiffness, rel=1e-12)
        assert np.all(np.diff(study.transmission_error, axis=0) > 0.0)
        assert np.all(study.unloaded_transmission_error < study.transmission_error[0])
        # A sum of harmonics holds the whole variation.
        rms = study.transmission_error.std(axis=1)
        assert np.sqrt(0.5 * (study.harmonics**2).sum(axis=1)) == pytest.approx(rms, rel=0.05)


def test_of_a_case_it_meets_the_summary_and_the_contact_without_load() -> None:
    case = td.load_case("hypoid-mixed-ehl")
    study = td.harris_map(case, ["1e-3 N*m", "500 N*m"], phases=100)
    with collected():
        table = mesh_of(case)
    swing = study.peak_to_peak_transmission_error
    assert swing[1] == pytest.approx(np.ptp(table.transmission_error_at_rest), rel=1e-9)
    assert swing[0] == pytest.approx(np.ptp(study.unloaded_transmission_error), rel=0.01)
    assert swing[0] > 3.0 * swing[1]
    wheel = case.replace({"operation.speed_of": "wheel", "operation.torque": "2150 N*m"})
    other = td.harris_map(wheel, ["2150 N*m"])
    assert other.torque == pytest.approx([500.0])
    assert other.peak_to_peak_transmission_error[0] == pytest.approx(swing[1], rel=1e-9)


def test_plot_and_default_range_up_to_twice_the_torque() -> None:
    study = td.harris_map(td.load_case("hypoid-mixed-ehl"), phases=16)
    assert study.torque[[0, -1]] == pytest.approx([50.0, 1000.0])
    figure = study.plot()
    assert "Least variation of the transmission error" in figure.layout.title.text
    assert {note.text for note in figure.layout.annotations} >= {"pair enters"}
    assert "plot_flank_modification" not in dir(study)


def test_wrong_arguments_name_themselves() -> None:
    case = td.load_case("hypoid-mixed-ehl")
    with pytest.raises(InputError, match=r"phases = 8.*16"):
        td.harris_map(case, phases=8)
    loaded = hypoid_loaded_contact_of(mesh_inputs(case), steps=16, cells=16)
    for torque in (-5.0, 0.0, np.nan, []):
        with pytest.raises(InputError, match="torque"):
            hypoid_transmission_error_over_torque(loaded, torque)


def test_the_command_writes_a_report_and_figures(
    tmp_path: Any, capsys: Any, monkeypatch: Any
) -> None:
    from tribodyn.cli import main

    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as end:
        main(["harris", "hypoid-mixed-ehl", "100 N*m", "500 N*m", "--out", "h", "--json"])
    assert end.value.code in (0, None)
    figures = json.loads(capsys.readouterr().out)
    assert figures["torque"] == pytest.approx([100.0, 500.0])
    assert figures["peak_to_peak_transmission_error"][1] == pytest.approx(0.66e-6, rel=0.01)
    assert "Transmission error over torque" in (tmp_path / "h" / "report.html").read_text("utf-8")
