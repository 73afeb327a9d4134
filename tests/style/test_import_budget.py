"""`import tribodyn` is light: no heavy package, little CPU, and names are found on demand."""

import os
import subprocess
import sys

import pytest

HEAVY = ("scipy", "numba", "pint", "xarray", "plotly", "pydantic", "h5py", "rich", "pandas")
BUDGET = 0.35  # seconds of CPU of the child process: the figure that the design promises


def loaded(code: str) -> set[str]:
    code = f"import sys\n{code}\nprint(*(m for m in {HEAVY!r} if m in sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_import_loads_nothing_heavy() -> None:
    assert loaded("import tribodyn") == set()
    assert loaded("import plotly, scipy") == {"plotly", "scipy"}  # the probe itself can see


@pytest.mark.skipif(not hasattr(os, "wait4"), reason="the CPU use of a child is read by wait4")
def test_import_takes_little_processor_time() -> None:
    spent = []
    for _ in range(3):
        child = subprocess.Popen([sys.executable, "-c", "import tribodyn"])
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        assert child.returncode == 0
        spent.append(usage.ru_utime + usage.ru_stime)
    assert min(spent) < BUDGET


def test_physics_packages_load_neither_screen_nor_files() -> None:
    code = "import tribodyn.gear, tribodyn.contact, tribodyn.lubricant, tribodyn.friction"
    assert not loaded(code) & {"plotly", "pydantic", "rich", "xarray", "h5py", "pandas", "scipy"}


def test_a_case_is_checked_without_compiler_and_scipy() -> None:
    code = "import io, contextlib\nfrom tribodyn.cli import call\n"
    code += "with contextlib.redirect_stdout(io.StringIO()):\n    call(['check', 'fzg-roughness'])"
    assert not loaded(code) & {"scipy", "numba", "pint", "plotly", "xarray", "h5py"}


def test_unknown_public_name_is_an_attribute_error() -> None:
    import tribodyn

    with pytest.raises(AttributeError, match="no_such_name"):
        _ = tribodyn.no_such_name
    assert set(tribodyn.__all__) <= set(dir(tribodyn))


def test_classes_come_with_their_subclasses() -> None:
    modules = ["tribodyn.study.machine.case", "tribodyn.study.pipeline.result"]
    code = "import sys\nfrom tribodyn.study import Case, Result\n"
    code += f"print(*(m for m in {modules!r} if m in sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == modules
