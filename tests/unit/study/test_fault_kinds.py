"""Kinds of faults in each kind of case: they are read, or refused with a reason of the table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from tests.unit.study.test_machine_run import GEARED

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.study import read_case
from tribodyn.study.faults.kinds import KINDS, LACKS, keys_in

PARTS = {
    "pair": {"gear": "wheel"},
    "machine": {"gear": "gears.z1", "shaft": "shafts.output", "bearing": "bearings.A"},
    "stage": {"gear": "gears.sun", "shaft": "carrier", "bearing": "A"},
}
SIZES: dict[str, Any] = {
    "amplitude": "2 um", "order": 3, "accuracy_class": 6, "tooth": 2, "depth": "0.5 mm",
    "start": 0.2, "end": 0.4, "place": "inner", "rolling_elements": 9,
    "element_diameter": "8 mm", "pitch_diameter": "39 mm", "acceleration": "50 m/s^2",
    "resonance": "3 kHz", "impact_force": "200 N", "orders": [1], "torques": ["0.1 N*m"],
    "fluctuations": [1e-3], "frequencies": ["10 Hz", "50 Hz"], "torque": "0.1 N*m",
    "stiffness_share": 0.5,
}  # fmt: skip


@pytest.fixture(scope="module")
def cases() -> dict[str, Any]:
    spur = {"meshes.first.helix_angle": "0 deg", "meshes.first.center_distance": None}
    teeth = {"meshes.first.stiffness": None, "meshes.first.transmission_error_amplitude": None}
    models = {"stiffness.model": "analytic", "film.model": "none", "friction.law": "none"}
    size = {"dynamics.backlash": "60 um"}
    changes = {**spur, **teeth, **models, **size, "load_cases": None}
    return {
        "pair": td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"}),
        "machine": read_case(GEARED).replace(changes, by="test"),
        "stage": td.load_case("planetary-stage"),
    }


@pytest.mark.parametrize("case", LACKS)
@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_is_read_and_written_or_refused(
    cases: dict[str, Any], case: str, kind: str, tmp_path: Path
) -> None:
    absent = kind in LACKS[case]
    required = () if absent else keys_in(case, kind)[0]
    stated = {key: SIZES[key] for key in required[1:] if key != "file"}
    stated |= {key: PARTS[case][key] for key in required[:1]} or {"gear": PARTS[case]["gear"]}
    stated |= {"accuracy_class": 6} if kind == "flank-deviations" else {}
    geometry = ("rolling_elements", "element_diameter", "pitch_diameter")
    stated |= {key: SIZES[key] for key in geometry} if kind == "bearing-defect" else {}
    stated |= {"torque": "0.1 N*m"} if kind == "random-load" else {}
    if kind == "flank-topographies":
        file = tmp_path / "teeth.csv"
        rows = "tooth,roll_length,deviation\n1,mm,um\n1,5,0\n1,35,1\n"
        file.write_text(rows, encoding="utf-8")
        stated |= {"file": str(file)}
    changes = {f"faults.f.{key}": value for key, value in {"kind": kind, **stated}.items()}
    if absent:
        with pytest.raises(InputError, match=r"faults\.f\.kind") as refused:
            cases[case].replace(changes)
        assert LACKS[case][kind] in str(refused.value)
        return
    changed = cases[case].replace(changes)
    assert "[faults.f]" in changed.to_toml()
    missing = changes | {f"faults.f.{required[-1]}": None}
    with pytest.raises(InputError, match=rf"faults\.f\.{required[-1]}.*missing"):
        cases[case].replace(missing)
    other = "start" if kind == "broken-tooth" else "remaining"
    with pytest.raises(InputError, match=rf"faults\.f\.{other}"):
        cases[case].replace(changes | {f"faults.f.{other}": 0.5})
