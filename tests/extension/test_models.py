"""Models of third parties, one file each, chosen in a case file with options of their own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from own_case import CASE, DYNAMICS, STIFFNESS

import tribodyn as td
from tribodyn.cli import call
from tribodyn.errors import InputError
from tribodyn.study.case.write import case_text

Load = Callable[[str], dict[str, object]]


def case_of(text: str, tmp_path: Path) -> td.Case:
    path = tmp_path / "my.toml"
    path.write_text(text, encoding="utf-8")
    return td.load_case(path)


FRICTION = CASE + '[friction]\nlaw = "falling"\nstart = 0.08\nslope = "0.5 s/m"\n'


def test_friction_law_with_options_runs_from_a_case_file(load: Load, tmp_path: Path) -> None:
    load("friction_law")
    case = case_of(FRICTION, tmp_path)
    assert (case.friction.start, case.friction.slope) == (0.08, 0.5)
    mesh = td.run(case).mesh
    speed = np.abs(mesh.sliding_direction * 0.0 + mesh.sliding_speed)
    expected = 0.08 * np.exp(-0.5 * speed)
    np.testing.assert_allclose(
        mesh.friction_coefficient[mesh.in_contact], expected[mesh.in_contact], rtol=1e-12
    )


def test_default_and_source_of_an_option_are_reported(load: Load, tmp_path: Path) -> None:
    load("friction_law")
    text = FRICTION.replace('slope = "0.5 s/m"\n', "")
    case = case_of(text, tmp_path)
    written = case_text(case, comments=True)
    assert 'slope = "0.3 s/m"  # fall with the sliding speed' in written
    again = tmp_path / "again.toml"
    again.write_text(written, encoding="utf-8")
    assert td.load_case(again) == case
    from tribodyn.study.pipeline.citations import cite

    assert "Own tests of 2026, unpublished" in cite(case)


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("start = 0.08", "start = 5", 27, ("start = 5", "0 to 0.5", "dry steel")),
        ('"0.5 s/m"', '"0.5 m/s"', 28, ("wrong kind of quantity",)),
        ('"0.5 s/m"', "0.5", 28, ("needs a unit",)),
        ("start = 0.08\n", "", 25, ("start is missing", "start = 0.08")),
        ("slope", "slop", 28, ("unknown key", 'Did you mean "slope"?')),
        ('law = "falling"', 'law = "fallen"', 26, ('Did you mean "falling"?',)),
        ('law = "falling"', 'law = "none"', 27, ("does not belong to law",)),
    ],
)
def test_faults_name_file_line_and_key(
    load: Load, tmp_path: Path, old: str, new: str, line: int, says: tuple[str, ...]
) -> None:
    load("friction_law")
    with pytest.raises(InputError) as caught:
        case_of(FRICTION.replace(old, new), tmp_path)
    message = str(caught.value)
    assert f"my.toml:{line}: friction" in message
    for part in says:
        assert part in message


def test_replace_drops_the_options_of_the_law_left_behind(load: Load, tmp_path: Path) -> None:
    load("friction_law")
    case = case_of(FRICTION, tmp_path).replace(
        {"friction.law": "constant", "friction.coefficient": 0.05}
    )
    assert "friction.slope" not in case.user_input
    assert case.friction.slope is None


def test_the_command_line_knows_the_law(
    load: Load, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    load("friction_law")
    case_of(FRICTION, tmp_path)
    for arguments, parts in (
        (["explain", "falling"], ("falls exponentially", "unpublished", "friction.law")),
        (["explain", "slope"], ("friction.slope", "0 s/m to 10 s/m")),
        (["check", str(tmp_path / "my.toml")], ("transverse_contact_ratio",)),
        (["new", str(tmp_path / "n.toml"), "--from", str(tmp_path / "my.toml")], ("n.toml",)),
    ):
        assert call(arguments) == 0
        output = capsys.readouterr().out
        for part in parts:
            assert part in output


def test_stiffness_model_with_options(load: Load, tmp_path: Path) -> None:
    load("stiffness_model")
    keys = 'model = "parabola"\nfall = 0.4\n'
    case = case_of(CASE.replace(STIFFNESS, keys), tmp_path)
    mesh = td.run(case).mesh
    stiffness = mesh.tooth_stiffness[mesh.in_contact]
    assert stiffness.max() == pytest.approx(4e8, rel=1e-3)
    assert stiffness.min() == pytest.approx(0.6 * 4e8, rel=1e-9)
    with pytest.raises(InputError, match=r"my.toml:\d+: stiffness.fall: fall = 2"):
        case_of(CASE.replace(STIFFNESS, keys.replace("0.4", "2.0")), tmp_path)


def test_film_formula_with_options(load: Load, tmp_path: Path) -> None:
    load("film_formula")
    text = CASE + '[film]\nmodel = "martin"\nfactor = 2.45\nstiffness = "tangent"\n'
    text += '[lubricant]\nname = "80W"\n'
    case = case_of(text, tmp_path)
    film = td.run(case).mesh
    full_mesh = td.run(case.replace({"film.factor": 4.9, "film.stiffness": "none"})).mesh
    assert film.central_film is not None
    assert full_mesh.central_film is not None
    touching = film.in_contact & full_mesh.in_contact
    ratio = film.central_film[touching] * film.load_per_width[touching]
    full = full_mesh.central_film[touching] * full_mesh.load_per_width[touching]
    np.testing.assert_allclose(full, 2.0 * ratio, rtol=1e-6)


def test_structure_with_options(load: Load, tmp_path: Path) -> None:
    load("structure")
    keys = 'model = "held-wheel"\nholding_stiffness = "1e5 N*m/rad"'
    case = case_of(CASE.replace(DYNAMICS, keys), tmp_path)
    result = td.run(case)
    assert np.asarray(result.system.stiffness)[1, 1] == 1e5
    assert result.summary()["mean_mesh_force"] > 0.0
    with pytest.raises(InputError, match="holding_stiffness is missing"):
        case_of(CASE.replace(DYNAMICS, 'model = "held-wheel"'), tmp_path)
