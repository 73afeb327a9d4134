"""What IPython shows of the package: progress, errors and warnings."""

import io
import sys
import traceback
import warnings

import pytest

import tribodyn as td
from tribodyn import notebook, progress
from tribodyn.errors import InputError, ModelWarning, warn


class Shell:
    """The part of IPython's shell that is set up."""

    custom_exceptions: tuple = ()

    def set_custom_exc(self, kinds, handler) -> None:
        self.custom_exceptions, self.handler = kinds, handler

    def showtraceback(self, shown, tb_offset=None) -> None:
        self.shown = shown


@pytest.fixture
def shell(monkeypatch: pytest.MonkeyPatch) -> Shell:
    monkeypatch.setattr(progress, "automatic", progress.automatic)
    monkeypatch.setattr(warnings, "formatwarning", warnings.formatwarning)
    ready = Shell()
    notebook.prepare(ready)
    return ready


def call_of_a_user(script: str) -> None:
    exec(compile(script, "cell-1.py", "exec"), {"td": td})


@pytest.mark.parametrize(
    "script",
    ["td.load_case('fzg-rough')", "td.load_case('two-stage-spur').replace({'meshes.x.y': 1})"],
)
def test_tracebacks_end_at_the_line_of_the_user(shell: Shell, script: str) -> None:
    with pytest.raises(InputError) as caught:
        call_of_a_user(f"\n{script}")
    assert caught.tb.tb_next.tb_next is not None  # the frames inside the package
    shell.handler(shell, InputError, caught.value, caught.tb.tb_next)
    kind, error, traceback = shell.shown
    while traceback.tb_next is not None:
        traceback = traceback.tb_next
    assert traceback.tb_frame.f_code.co_filename == "cell-1.py"
    assert traceback.tb_lineno == 2
    assert error.__cause__ is None
    assert error.__suppress_context__
    assert kind is InputError


@pytest.mark.parametrize(
    ("script", "shortened"),
    [("case.plot_mesh_forse", True), ("''.joined", False), ("td.gear.spurpair", False)],
)
def test_unknown_attributes_of_objects_end_there_too(
    shell: Shell, script: str, shortened: bool
) -> None:
    case = f"case = td.load_case('fzg-roughness')\n{script}"
    with pytest.raises(AttributeError) as caught:
        call_of_a_user(case)
    assert AttributeError in shell.custom_exceptions
    whole = len(caught.traceback) - 1  # without this test
    shell.handler(shell, AttributeError, caught.value, caught.tb.tb_next)
    length = sum(1 for _ in traceback.walk_tb(shell.shown[2]))
    assert (length < whole) is shortened


def test_handlers_of_the_user_stay() -> None:
    class Busy(Shell):
        custom_exceptions = (KeyError,)

    assert Busy().custom_exceptions == (KeyError,)
    busy = Busy()
    usual = progress.automatic, warnings.formatwarning
    try:
        notebook.prepare(busy)
        assert busy.custom_exceptions == (KeyError,)
    finally:
        progress.automatic, warnings.formatwarning = usual
    notebook.prepare(None)
    assert progress.automatic is usual[0]


@pytest.mark.usefixtures("shell")
def test_warnings_are_shown_without_a_line_of_source() -> None:
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always")
        warn("friction-range", "too fast")
        warnings.warn("of another package", UserWarning, stacklevel=1)
    texts = [
        warnings.formatwarning(each.message, each.category, each.filename, each.lineno)
        for each in issued
    ]
    assert texts[0] == "ModelWarning: [friction-range] too fast\n"
    assert issued[0].category is ModelWarning
    assert __file__ in texts[1]


def test_progress_is_text_in_a_notebook_and_silent_in_scripts(
    shell: Shell, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(notebook, "_INTERVAL", 0.0)
    case = td.load_case("time-varying-friction")

    def written(**options) -> str:
        screen = io.StringIO()
        with monkeypatch.context() as patched, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            patched.setattr(sys, "stdout", screen)
            call = {"td": td, "case": case, "options": options}
            exec("td.sweep(case, {'operation.torque': [50.0, 60.0]}, **options)", call)
        return screen.getvalue()

    lines = written().split("\r")
    assert any(line.startswith("Values: 1 of 2") for line in lines)
    assert lines[-1] == ""
    assert not lines[-2].strip()
    assert written(progress=progress.SILENT) == ""
    monkeypatch.setattr(progress, "automatic", lambda: progress.SILENT)
    assert written() == ""
