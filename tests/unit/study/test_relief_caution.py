"""Relief far beyond the deflection of the teeth gives a warning that names the pairs left."""

import warnings

import pytest

import tribodyn as td
from tribodyn.cli import main
from tribodyn.study.pipeline.cautions import mesh_cautions
from tribodyn.study.pipeline.tooth_contact import mesh_of


def _relief_warning(**relief):
    changes = {f"gears.{key.replace('__', '.')}.tip_relief": value for key, value in relief.items()}
    case = td.load_case("fzg-roughness").replace(
        {"stiffness.model": "weber", "friction.law": "none", "stiffness.reference": "rim"} | changes
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", td.ModelWarning)
        mesh = mesh_of(case)
    messages = [each.message for each in mesh_cautions(mesh) if each.code == "relief-large"]
    return messages[0] if messages else "", mesh


@pytest.mark.parametrize("modified", [{}, {"pinion__modification": "20 um"}])
def test_usual_relief_gives_no_warning(modified):
    assert not _relief_warning(**modified)[0]


def test_far_too_large_relief_leaves_one_pair():
    """With tips taken off on both gears one pair carries at any phase."""
    text, mesh = _relief_warning(pinion__modification="300 um", wheel__modification="300 um")
    assert "tip_relief = 300 um" in text
    pairs = float(mesh.grid.mean((mesh.load_share > 0.0).sum(axis=1).astype(float)))
    assert float(text.split(": ")[1].split(" tooth pairs")[0]) == pytest.approx(pairs, rel=0.01)
    assert 1.0 <= pairs < 1.05 < 1.3 < mesh.transverse_contact_ratio


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ("gears.pinion.modification.tip_relief=300 um", "relief-large"),
        ("operation.torque=9 kN*m", "hertz-pressure"),
        ("operation.torque=91 N*m", ""),
    ],
)
def test_check_reports_excessive_relief_and_load(change, code, capsys):
    with pytest.raises(SystemExit, match="0"):
        main(["check", "fzg-roughness", "--set", change])
    error = capsys.readouterr().err
    assert [each for each in ("relief-large", "hertz-pressure") if f"[{each}]" in error] == (
        [code] if code else []
    )
