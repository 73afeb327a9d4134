"""The numbered examples run, and print figures that are known from elsewhere."""

import re
import runpy
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from gallery import EXAMPLES, GALLERY, masked

from registries import as_before


def figure(text: str, label: str, column: int = 0) -> float:
    """Return a number of the line that begins with a label."""
    line = next(line for line in text.splitlines() if line.strip().startswith(label))
    return float(re.findall(r"-?\d+\.?\d*(?:e[+-]?\d+)?", line.strip()[len(label) :])[column])


def first_light(text: str) -> None:
    # contact ratio from ISO 21771 by hand; 90 N*m over the base radius of 33.828934 mm is 2660.4 N,
    # from which friction may take or add a few percent
    assert figure(text, "transverse contact ratio") == pytest.approx(1.326952, abs=1e-6)
    assert figure(text, "mesh frequency") == pytest.approx(240.0, abs=1e-3)
    assert figure(text, "mean mesh force") == pytest.approx(2660.4, rel=0.05)
    assert "report.html" in text


def roughness_study(text: str) -> None:
    rows = {size: figure(text, size) for size in ("0.325", "0.53", "0.991")}
    across = [figure(text, size, 2) for size in rows]
    # the law's own factor 1.13/(1.13 - S) between the smoothest and the middle surface
    assert rows["0.53"] / rows["0.325"] == pytest.approx((1.13 - 0.325) / (1.13 - 0.53), rel=1e-3)
    assert rows["0.325"] < rows["0.53"] < rows["0.991"]
    assert across == sorted(across)


def own_structure(text: str) -> None:
    # an exact periodic orbit, found by two independent methods
    assert figure(text, "mean transmission error") == pytest.approx(11.119736, rel=1e-5)
    assert figure(text, "mean mesh force") == pytest.approx(2660.4444, rel=1e-6)
    assert figure(text, "rms mesh force") == pytest.approx(2693.7133, rel=1e-6)
    assert figure(text, "rms pinion acceleration along") == pytest.approx(788.665, rel=1e-5)


def friction_laws(text: str) -> None:
    # by hand from the printed formulas
    assert figure(text, "xu-2007") == pytest.approx(0.067992, abs=2e-6)
    assert figure(text, "benedict-kelly") == pytest.approx(0.105843, abs=2e-6)
    assert figure(text, "constant") == 0.05
    assert figure(text, "none") == 0.0


def single_contact(text: str) -> None:
    # two independent schemes: 1.0248 and 0.896 um, 2.51e10 N/m; Hertz by hand
    assert figure(text, "central film") == pytest.approx(1.0248, rel=1e-3)
    assert figure(text, "minimum film") == pytest.approx(0.896, rel=5e-3)
    assert figure(text, "dry Hertz pressure") == pytest.approx(0.8043, abs=1e-4)
    assert figure(text, "film stiffness") == pytest.approx(2.51e10, rel=0.02)
    assert figure(text, "mass flux constant to") < 1e-3


def film_over_torque_and_speed(text: str) -> None:
    over_torque, over_speed = text.split("rpm", maxsplit=1)
    assert figure(over_torque, "50 ", 0) == pytest.approx(1.1395, rel=1e-3)
    assert figure(over_torque, "50 ", 1) == pytest.approx(0.991, rel=2e-3)
    lost = {load: 1 - figure(over_torque, load, 2) / figure(over_torque, load) for load in
            ("50 ", "150 ", "300 ")}  # fmt: skip
    assert list(lost.values()) == pytest.approx([0.32, 0.14, 0.07], abs=0.01)
    films = [figure(over_speed, rpm) for rpm in ("800 ", "1400 ", "1800 ", "3000 ")]
    assert films == sorted(films)
    # every film formula has a power of the speed of about 0.7
    assert films[3] / films[0] == pytest.approx((3000 / 800) ** 0.7, rel=0.02)
    assert "film-over-speed.html film-over-torque.html" in text


def film_along_path(text: str) -> None:
    rows = [[float(each) for each in line.split()] for line in text.splitlines() if "." in line
            and line.strip()[0].isdigit()]  # fmt: skip
    assert len(rows) > 30
    # Dowson (1968) for the minimum film, which is good to 5 % for gears: 80W oil, steel
    for _, load, radius, speed, _, thinnest in rows:
        U = 0.082 * speed / (2.2637e11 * radius * 1e-3)
        W = load * 1e3 / (2.2637e11 * radius * 1e-3)
        dowson = 2.65 * U**0.7 * (2.19e-8 * 2.2637e11) ** 0.54 * W**-0.13 * radius * 1e3
        assert thinnest == pytest.approx(dowson, rel=0.06)
    # 90 N*m on a base radius of 33.829 mm, 20 mm wide: one pair alone
    assert max(row[1] for row in rows) == pytest.approx(133.0, abs=0.05)
    assert figure(text, "thinnest of all") == min(row[5] for row in rows)
    assert "film-along-path.html" in text


def film_over_a_mesh_cycle(text: str) -> None:
    # while one pair carries a constant load, radius and speed change slowly: nearly steady
    steady = figure(text, "steady film, one pair alone")
    assert figure(text, "moving film, one pair alone") == pytest.approx(steady, rel=0.02)
    # thick films of the light load are carried through after the load has come, and reversely
    assert figure(text, "largest excess over steady") > 10.0
    assert figure(text, "largest lack against steady") < -5.0
    assert "film-moving.html film-over-time.html" in text


def rough_flank(text: str) -> None:
    before = figure(text, "amplitude of the waves, before")
    # a standing wave is flattened by the pressure, a moving one less
    standing, moving = (
        figure(text, f"amplitude of the waves, {x}") for x in ("standing", "moving")
    )
    assert 0.3 * before < standing < moving < before
    smooth, thinnest = (figure(text, f"thinnest film, {x}") for x in ("smooth", "moving"))
    assert smooth == pytest.approx(0.896, rel=5e-3)
    assert smooth - 2.0 * before < thinnest < smooth
    assert "rough-moving.html rough-standing.html" in text


def transmission_error(text: str) -> None:
    # an independent model of the same gears without backlash: 11.78 um mean, 5.19 um peak to peak,
    # harmonics 2.37, 1.02 and 0.40 um at 90 N*m
    for column, expected in enumerate((11.78, 5.19, 2.37, 1.02, 0.40)):
        assert figure(text, "90", column) == pytest.approx(expected, rel=0.025)
    assert figure(text, "300", 5) == pytest.approx(243.5, rel=0.01)
    # pairs that are added up overstate what excites the mesh
    assert figure(text, "90", 6) > 1.29 * figure(text, "90", 1)
    assert "harris-map.html loaded-contact.html" in text


def tip_relief(text: str) -> None:
    before = figure(text, "largest peak to peak before")
    assert before == figure(text, "120", 0)
    assert figure(text, "largest peak to peak after") < 0.45 * before
    # both ends of the range are equally loud: nothing more is to be gained
    assert figure(text, "60", 1) == pytest.approx(figure(text, "120", 1), rel=0.01)
    # at a sixth of the torque nothing closes the gap of the relief
    assert figure(text, "15", 1) > 3.0 * figure(text, "15", 0)
    assert "tip-relief-harris.html tip-relief-map.html" in text


def comprehensive_stiffness(text: str) -> None:
    for kind, softer in (("tangent", 0.012), ("secant", 0.12)):
        films, teeth, combined = (figure(text, f"{kind}  1400 rpm", k) for k in range(3))
        assert combined < teeth < films
        assert combined == pytest.approx(teeth, rel=softer)
        slow, fast = (figure(text, f"{kind}  {n} rpm", 2) for n in (" 400", "3000"))
        assert slow > combined > fast
        light, heavy = (figure(text, f"{kind}   {torque} N*m", 2) for torque in (" 50", "300"))
        assert light < combined < heavy
    # two independent schemes give 2.51e10 N/m at the pitch point at 150 N*m and 1400 rpm
    assert figure(text, "tangent   150 N*m  films") == pytest.approx(2.51e4, rel=0.03)
    assert "comprehensive-secant-speed.html" in text


def stiffness_bifurcation(text: str) -> None:
    long, short = text.split("800 steps:", maxsplit=1)
    assert "step-limited" in long.splitlines()[0]
    # the printed diagram has one period up to 1.731e7 N/mm and another motion from 1.741e7 on
    assert figure(long, "not period 1 from") == pytest.approx(1.73e7, rel=0.02)
    assert figure(long, "not period 1 from", 1) == pytest.approx(2.83, abs=0.1)
    assert "period 1 with 800 steps" in long
    assert figure(short, "motions not period 1") == 0.0
    rows = [line.split() for line in short.splitlines() if line.endswith("stable")]
    assert len(rows) == 8
    assert all(row[2] == "stable" and float(row[1]) < 0.36 for row in rows)
    assert "stiffness-bifurcation.html" in text


def fifth_harmonic(text: str) -> None:
    usual, light = text.split("fzg-12dof-light:", maxsplit=1)
    # printed: +1.6, -26.9, +16.2, +27.4 and +61.6 %
    changes = [figure(light, "0.035, change [%]", k) for k in range(5)]
    assert [change > 0.0 for change in changes] == [True, False, True, True, True]
    assert changes[4] == pytest.approx(61.6, abs=2.0)
    assert abs(figure(usual, "0.035, change [%]", 4)) < 1.5
    assert figure(usual, "fzg-12dof: first mode") == pytest.approx(492.0, abs=0.1)
    assert "fifth-fzg-12dof-none.html" in text


def run_up(text: str) -> None:
    # 16 teeth at 400 and 3000 rpm
    assert "mesh frequency 106.667 to 800 and back to 106.667 Hz" in text
    order, speed, frequency, mode = (figure(text, "7 ", column - 1) if column else 7.0
                                     for column in range(4))  # fmt: skip
    # the strongest peak lies where order 7 meets the mesh mode
    assert frequency == pytest.approx(order * speed * 16 / 60, rel=1e-3)
    assert frequency == pytest.approx(mode, rel=0.02)
    for rpm in (1000, 2000, 2800):
        up, down = (figure(text, f"{way} {rpm} rpm  rms acceleration of the pinion")
                    for way in ("up  ", "down"))  # fmt: skip
        assert up == pytest.approx(down, rel=0.05)
    assert figure(text, "order 1.5 of the shaft at 2017 rpm is") == pytest.approx(50.4, abs=0.05)
    assert figure(text, "its largest amplitude here") < 1.0
    assert "run-up-map.html run-up.html" in text


def jump(text: str) -> None:
    folds = [figure(text, "two motions between", k) for k in range(2)]
    swept = [figure(text, "the sweeps differ between", k) for k in range(2)]
    # the sweeps, which step 20 Hz, jump at the folds
    assert folds[0] <= swept[0] <= folds[0] + 40.0
    assert folds[1] - 20.0 <= swept[1] <= folds[1]
    # sqrt(3.8e8 / 1.15) / (2 pi)
    assert figure(text, "resonance of small vibrations") == pytest.approx(2893.1, abs=0.1)
    assert figure(text, "backbone") == pytest.approx(figure(text, "loudest motion"), rel=2e-3)
    rows = [line.split() for line in text.splitlines() if line.strip().startswith("rms")]
    assert sum(float(row[4]) for row in rows) == pytest.approx(100.0, abs=0.2)
    assert [row[6] for row in rows] == ["physical", "physical"]
    assert "jump-basins.html jump-branch.html" in text


def mesh_table(text: str) -> None:
    # 29 teeth at 50 Hz; 150 N*m over 42.5 mm, which an orbit without friction has as its mean
    assert figure(text, "mesh frequency") == pytest.approx(1450.0, abs=1e-6)
    assert figure(text, "static mesh force") == pytest.approx(150.0 / 0.0425, abs=0.06)
    assert figure(text, "mean mesh force") == pytest.approx(150.0 / 0.0425, abs=0.06)
    assert figure(text, "peak mesh force") > figure(text, "mean mesh force")


def losses(text: str) -> None:
    # the motor brings up all losses; seals lose 7.69e-6 d^2 n; the teeth are equal on both sides
    parts = ("gear", "bearing_rolling", "bearing_sliding", "seal", "churning", "windage")
    rows = [[figure(text, part, box) for box in (0, 1)] for part in parts]
    assert figure(text, "motor") == pytest.approx(sum(map(sum, rows)), abs=0.1)
    assert rows[3][0] == pytest.approx(7.69e-6 * 900.0 * 1400.0 * (1.0 + 1.0 / 1.5), abs=0.005)
    assert rows[0][0] == rows[0][1]
    # 0.05 less what the run without load rubs at 5 N*m, within the band of 95 %
    for torque in (50, 150, 300):
        low, high = (figure(text, f"{torque} ", column) for column in (1, 2))
        assert low <= 0.05 * (1.0 - 5.0 / torque) <= high


def learning(text: str) -> None:
    rows = {line.split(",")[0] + line.split(":")[0].split()[-1]: line for line in text.splitlines()}
    for name in ("acceleration", "mesh_force"):
        share, _, off = re.findall(
            r"R2 ([\d.]+)|0([.]\d+)\)|, ([\d.e-]+) %", rows[f"published{name}"]
        )
        assert float(share[0]) >= 0.996
        assert float(off[2]) < 2.3
        assert "(table over the phase 0.99" in rows[f"honest{name}"]
    assert float(re.findall(r"R2 ([\d.]+)", rows["honestmesh_force"])[0]) > 0.99
    assert figure(text, "steady, 128 points: R2 ") > 0.99


def printed_tables(text: str) -> None:
    # a mode near the fifth harmonic and hardly any damping give its printed growth, 4 % do not
    assert figure(text, "fifth harmonic, constant ", 1) == pytest.approx(61.6, rel=0.05)
    assert abs(figure(text, "fifth harmonic, constant, usual damping", 1)) < 1.0
    assert "Table 1: 8 value" in text


def hypoid(text: str) -> None:
    # figures of another program for this pair: friction, force along the pinion's axis, efficiency
    assert figure(text, "friction coefficient, mean") == pytest.approx(0.0110, rel=5e-3)
    assert figure(text, "mean force of the teeth, y") == pytest.approx(14070.0, rel=2e-3)
    assert figure(text, "efficiency") == pytest.approx(0.9945, abs=6e-4)


EXPECTED: dict[str, Callable[[str], None]] = {
    "01_first_light.py": first_light,
    "02_roughness_study.py": roughness_study,
    "03_own_structure.py": own_structure,
    "04_friction_laws.py": friction_laws,
    "05_single_contact.py": single_contact,
    "06_film_over_torque_and_speed.py": film_over_torque_and_speed,
    "07_film_along_path.py": film_along_path,
    "08_film_over_a_mesh_cycle.py": film_over_a_mesh_cycle,
    "09_rough_flank.py": rough_flank,
    "10_transmission_error.py": transmission_error,
    "11_tip_relief.py": tip_relief,
    "12_comprehensive_stiffness.py": comprehensive_stiffness,
    "13_stiffness_bifurcation.py": stiffness_bifurcation,
    "14_fifth_harmonic.py": fifth_harmonic,
    "15_run_up.py": run_up,
    "16_jump.py": jump,
    "17_mesh_table.py": mesh_table,
    "18_losses.py": losses,
    "19_printed_tables.py": printed_tables,
    "20_learning.py": learning,
    "21_hypoid.py": hypoid,
}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_example_prints_known_figures(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [str(path)])
    with as_before():
        runpy.run_path(str(path), run_name="__main__")
    output = capsys.readouterr().out
    stored = (GALLERY / f"{path.stem}.txt").read_text("utf-8")
    assert masked(output) == masked(stored), f"run: python tests/docs/gallery.py {path.name[:2]}"
    EXPECTED[path.name](output)
    for folder in re.findall(r"^(?:figures|files) in (.*?):", output, re.M):
        assert Path(folder).parent == tmp_path.resolve()
        files = re.findall(r"[\w-]+\.html", output)
        assert files
        assert all((Path(folder) / name).is_file() for name in files)


def test_example_is_a_script_with_an_optional_folder(tmp_path: Path) -> None:
    command = [sys.executable, EXAMPLES[0], "my-report"]
    process = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert process.returncode == 0, process.stderr
    assert (tmp_path / "my-report" / "report.html").is_file()


def test_every_example_is_numbered_and_has_expected_output() -> None:
    names = [path.name for path in EXAMPLES]
    assert names == sorted(EXPECTED)
    assert [int(name[:2]) for name in names] == list(range(1, len(names) + 1))
