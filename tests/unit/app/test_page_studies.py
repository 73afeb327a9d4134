"""Every study of the page computes with the values that stand in its form at first, and saves."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("dash", reason="the page needs Dash")

from tribodyn.app.studies import STUDIES, compute, first_values
from tribodyn.cases.load import load_case
from tribodyn.errors import InputError
from tribodyn.progress import SILENT

#: Fewer points than at first, to be quick.
_FEW = {
    "sweep": {"values": "800..900 rpm:2"},
    "losses": {"torque": "50, 90 N*m", "speed": "900 rpm"},
    "film": {"torque": "50, 90 N*m", "speed": "900 rpm"},
    "bifurcation": {"values": "800..900 rpm:2", "cycles": "4", "transient": "2"},
    "relief": {"torque": "90 N*m"},
    "lead": {"misalignment": "10 um"},
    "harris": {"torque": "60 N*m, 90 N*m"},
    "continuation": {"ends": "1430..1440 rpm", "longest_step": "1"},
    "basins": {"points": "2"},
    "lyapunov": {"cycles": "4", "transient": "10"},
    "sobol": {
        "second_key": "operation.torque",
        "second_tolerance": "90 N*m +- 5 %",
        "figures": "tangential_force, pitch_line_velocity",
        "size": "2",
    },
    "run-up": {"duration": "0.2"},
    "recording": {"duration": "500 ms", "format": "csv"},
    "friction-from-loss": {"file": "fzg-wheel-driven"},
}


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")  # the page lists them
@pytest.mark.parametrize("kind", STUDIES)
def test_every_study_displays_and_saves_its_result(kind: str, tmp_path: Path) -> None:
    case = load_case("fzg-roughness")
    if kind in ("continuation", "basins", "lyapunov"):  # exponents take a single coefficient
        case = case.replace({"stiffness.model": "analytic", "friction.law": "none"})
    values = first_values(kind, case) | _FEW.get(kind, {})
    study_result = compute(kind, case, values, SILENT, tmp_path / "result")
    assert study_result["sentences"]
    assert all(figure.data for _, figure, _ in study_result["figures"])
    assert study_result["figures"]
    assert all(len(row) == len(head) for _, head, rows in study_result["tables"] for row in rows)
    assert any(path.suffix == ".html" for path in (tmp_path / "result").iterdir())


def test_a_wrong_range_is_explained_with_an_example() -> None:
    with pytest.raises(InputError, match=r'"fast".*Write for example "90 N\*m"'):
        compute("harris", load_case("fzg-roughness"), {"torque": "fast"}, SILENT, Path())


@pytest.mark.parametrize("gears", ["both", "wheel"])
def test_the_relief_that_a_study_offers_is_that_of_its_better_case(
    gears: str, tmp_path: Path
) -> None:
    """Keys of the relieved gears alone: the rest of the case may have changed meanwhile."""
    case = load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    case = case.replace({"gears.pinion.modification.tip_relief": "30 um"})
    study_result = compute(
        "relief", case, {"torque": "90 N*m", "gears": gears}, SILENT, tmp_path / "r"
    )
    best = load_case(tmp_path / "r" / "best.toml")
    assert case.replace(study_result["relief"]).gears == best.gears
    relieved = {key.split(".")[1] for key in study_result["relief"]}
    assert relieved == ({"pinion", "wheel"} if gears == "both" else {"wheel"})
    assert all(key.partition(".")[0] == "gears" for key in study_result["relief"])


def test_a_tolerance_that_is_none_is_refused() -> None:
    values = {"key": "operation.torque", "tolerance": "5 %"}
    with pytest.raises(InputError, match=r'"5 %" is no tolerance of operation.torque'):
        compute("sobol", load_case("fzg-roughness"), values, SILENT, Path())


def test_wrong_numbers_of_a_study_are_refused_with_their_limits() -> None:
    values = {"cycles": "many", "transient": "-3"}
    with pytest.raises(InputError) as refused:
        compute("lyapunov", load_case("fzg-roughness"), values, SILENT, Path())
    cycles, transient = refused.value.problems
    assert (cycles.where, transient.where) == ("cycles", "transient")
    assert '"many"' in cycles.what
    assert "whole number" in cycles.why
    assert "100000" in transient.why
    values = {"key": "operation.speed", "values": "800..900 rpm:2", "sweep": "sideways"}
    with pytest.raises(InputError, match=r"sideways.*up, down, both, independent"):
        compute("bifurcation", load_case("fzg-roughness"), values, SILENT, Path())
