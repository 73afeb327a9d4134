"""The numbered examples run, and print figures that are known from elsewhere."""

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "examples").glob("*.py"))


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


EXPECTED: dict[str, Callable[[str], None]] = {
    "01_first_light.py": first_light,
    "02_roughness_study.py": roughness_study,
    "03_own_structure.py": own_structure,
    "04_friction_laws.py": friction_laws,
}


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_example_prints_known_figures(path: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, path],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONIOENCODING": "utf-8"},
    )
    assert done.returncode == 0, done.stderr
    EXPECTED[path.name](done.stdout)


def test_every_example_is_known_and_numbered() -> None:
    names = [path.name for path in EXAMPLES]
    assert names == sorted(EXPECTED)
    assert [int(name[:2]) for name in names] == list(range(1, len(names) + 1))
