"""Every doctest of every module runs, each module on its own."""

import doctest
import importlib
import pkgutil
from pathlib import Path

import pytest

import tribodyn

_ROOT = Path(tribodyn.__path__[0]).parent
FOUND = ["tribodyn", *(i.name for i in pkgutil.walk_packages(tribodyn.__path__, "tribodyn."))]


def _has_examples(name: str) -> bool:
    path = _ROOT.joinpath(*name.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return ">>>" in path.read_text("utf-8")


NAMES = [name for name in FOUND if not name.endswith("__main__") and _has_examples(name)]
# Their examples compile kernels of their own.
SLOW = {
    "tribodyn.ehl.transient.transient",
    "tribodyn.dynamics.time.adaptive_solution",
    "tribodyn.dynamics.running_up.speed_sweep",
    "tribodyn.dynamics.running_up.run_up",
}
EACH = [pytest.param(name, marks=pytest.mark.slow if name in SLOW else ()) for name in NAMES]


def examples(name: str) -> list[doctest.DocTest]:
    module = importlib.import_module(name)
    tests = doctest.DocTestFinder().find(module, name)
    return [test for test in tests if test.examples and _is_home(test.name, name)]


def _is_home(example: str, name: str) -> bool:
    """Whether what is documented was written in this module, and is not only found there."""
    short = example.removeprefix(f"{name}.").partition(".")[0]
    home = getattr(importlib.import_module(name), short, None)
    return getattr(getattr(home, "__wrapped__", home), "__module__", name) == name


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("name", EACH)
def test_doctests(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    complaints: list[str] = []
    runner = doctest.DocTestRunner(verbose=False)
    for test in examples(name):
        runner.run(test, out=complaints.append)
    assert runner.failures == 0, "".join(complaints)


def test_doctests_are_collected() -> None:
    assert set(NAMES) > SLOW
    assert len(examples("tribodyn.units")) >= 4
    assert sum(len(examples(name)) for name in NAMES) >= 60


def test_a_wrong_doctest_is_noticed() -> None:
    test = doctest.DocTestParser().get_doctest(">>> 1 + 1\n3\n", {}, "wrong", None, 0)
    assert doctest.DocTestRunner(verbose=False).run(test, out=lambda text: None).failed == 1
