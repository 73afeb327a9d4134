"""Every command on every kind of case, reduced in size: a result, or a refusal with a remedy."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn
from tribodyn.cases.papers.printed import papers
from tribodyn.cli import call
from tribodyn.cli.app import COMMANDS
from tribodyn.study import MachineCase
from tribodyn.study.studies.needs import KINDS, PARTS, STUDIES, kind_of, mesh_names, takes

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_CASES = tuple(tribodyn.cases(machines=True))
#: Cases that have the structure of another one, and nothing else once their teeth are reduced.
_LIKE_ANOTHER = {
    "fzg-12dof-light": "fzg-12dof",
    "fzg-ehl-vibration": "fzg-roughness",
    "fzg-film": "fzg-roughness",
    "fzg-stiffness": "fzg-roughness",
    "time-varying-friction": "fzg-roughness",
    "two-stage-helical": "two-stage-spur",
}
#: Commands that are tried apart: a server, and processes that compile.
_APART = {"app", "warm-up"}
#: Commands that compute no motion, or one that another test has computed.
_LIGHT = {"check", "export", "friction-from-loss", "new", "rate", "signal"}
#: Commands that are tried on every built-in case, the others on one of each structure.
_ON_ALL = {"check", "export", "friction-from-loss", "new", "rate", "run"}
#: Reasons for which a command for all kinds may refuse a reduced case: a gear whose mate turns with
#: a carrier, and machines whose constant teeth excite nothing.
_EXCUSES = {
    "continuation": "derivatives over each period",
    "lyapunov": "derivatives over each period",
    "paper": "there are no printed tables",
    "rate": "the case has no table [rating]",
    "surrogate": "no level of the parts varies",
    "signal": "turns with a carrier",
    "sobol": "the output does not vary",
}
#: Values that make the tooth contact of a case cheap, as far as the case has the keys.
_CHEAP = {"film.model": "none", "friction.law": "none", "friction.shear_model": None}


_case = cache(tribodyn.load_case)


def _reduced(name: str) -> Any:
    """Case with teeth that cost little."""
    case = _case(name)
    if isinstance(case, MachineCase):
        teeth = {f"meshes.{mesh}.stiffness": 5e8 for mesh in case.data.get("meshes", {})}
        films = _CHEAP if "planets" in case.data else {}  # others have no computed teeth left
        return case.replace({**teeth, **films})
    if case.lumped and case.gears.kind == "hypoid":
        return case.replace(_CHEAP)
    return case.replace({**_CHEAP, "stiffness.model": "iso6336", "dynamics.mesh_law": "stiffness"})


class _Place:
    """Folder with the reduced files of all cases, and their results once they are computed."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._results: dict[str, str] = {}

    def file(self, name: str) -> str:
        path = self.folder / f"{name}.toml"
        if not path.exists():
            path.write_text(_reduced(name).to_toml(), encoding="utf-8")
        return str(path)

    def result(self, name: str) -> str:
        if name not in self._results:
            target = self.folder / f"{name}-result"
            assert call(["run", self.file(name), "--out", str(target), "--quiet"]) == 0
            self._results[name] = str(target)
        return self._results[name]

    def study(self, name: str) -> str:
        path = self.folder / f"{name}-study.toml"
        speeds = f'axes.operation.speed = "{_speed(name, 0.9)},{_speed(name)} rpm"'
        path.write_text(f'case = "{name}.toml"\n{speeds}\n', encoding="utf-8")
        return str(path)

    def recording(self) -> str:
        path = self.folder / "recording.csv"
        time = np.arange(0.0, 0.4, 1e-4)
        table = np.column_stack([time, np.sin(2.0 * np.pi * 400.0 * time)])
        np.savetxt(path, table, delimiter=",", header="time [s],acc [m/s^2]", comments="")
        return str(path)


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> _Place:
    return _Place(tmp_path_factory.mktemp("cases"))


def _speed(name: str, factor: float = 1.0) -> str:
    case = _case(name)
    load = case.operation if case.lumped else case.operating_point
    return f"{factor * load.speed * 30.0 / np.pi:.6g}"


def _torque(name: str) -> str:
    case = _case(name)
    load = case.operation if case.lumped else case.operating_point
    return f"{load.torque:.6g} N*m"


def _range(name: str) -> str:
    return f"{_speed(name, 0.97)}..{_speed(name)} rpm"


def _spread(name: str) -> list[str]:
    return ["--set", f"operation.torque={_torque(name)} +- 2 %"]


def _gear(name: str) -> list[str]:
    case = _case(name)
    return [] if case.lumped else ["--gear", next(iter(case.gears))]


def _mesh(name: str) -> list[str]:
    return ["--mesh", mesh_names(_case(name))[0]]


def _followed(name: str) -> list[str]:
    case = _case(name)
    return [] if case.lumped else ["--mesh", next(iter(case.meshes))]


def _sensor(name: str) -> str:
    case = _case(name)
    if isinstance(case, MachineCase):
        return f"meshes.{next(iter(case.meshes))}.mesh_force"
    return "mesh_force" if case.lumped else "planet_1.sun_mesh_force"


#: Arguments of each command behind its name, for the place of the files and the name of a case.
_ARGUMENTS: dict[str, Callable[[_Place, str], list[str]]] = {
    "run": lambda p, n: [p.file(n)],
    "check": lambda p, n: [p.file(n)],
    "sweep": lambda p, n: [p.file(n), f"operation.speed={_speed(n, 0.97)},{_speed(n)} rpm"],
    "ensemble": lambda p, n: [p.file(n), "--size", "3", *_spread(n)],
    "sobol": lambda p, n: [
        p.file(n), "--size", "2", *_spread(n), "--set", f"operation.speed={_speed(n)} rpm +- 1 %"
    ],
    "study": lambda p, n: [p.study(n)],
    "rate": lambda p, n: [p.file(n)],
    "frequencies": lambda p, n: [p.file(n)],
    "modes": lambda p, n: [p.file(n)],
    "run-up": lambda p, n: [p.file(n), _range(n), "--duration", "0.3"],
    "compare": lambda p, n: [p.result(n), p.result(n)],
    "recording": lambda p, n: [p.file(n), "--duration", "0.05 s", "--sensor", _sensor(n)],
    "signal": lambda p, n: [p.recording(), "--channel", "acc", "--case", p.file(n), *_gear(n)],
    "new": lambda p, n: ["my.toml", "--from", n],
    "cite": lambda p, n: [p.result(n)],
    "export": lambda p, n: [p.file(n), "--rexs", "my.rexs"],
    "harris": lambda p, n: [p.file(n), _torque(n), *_mesh(n)],
    "relief": lambda p, n: [p.file(n), _torque(n), *_mesh(n)],
    "lead": lambda p, n: [p.file(n), *_mesh(n)],
    "losses": lambda p, n: [
        p.file(n), "--torque", _torque(n), "--speed", f"{_speed(n)} rpm", *_mesh(n)
    ],
    "friction-from-loss": lambda p, n: ["fzg-wheel-driven", "--case", p.file(n), *_mesh(n)],
    "bifurcation": lambda p, n: [
        p.file(n), f"operation.speed={_range(n)}:2", "--cycles", "4", "--transient", "2",
        *_followed(n),
    ],
    "continuation": lambda p, n: [p.file(n), f"operation.speed={_range(n)}", *_followed(n)],
    "basins": lambda p, n: [p.file(n), "--points", "3", *_followed(n)],
    "lyapunov": lambda p, n: [p.file(n), "--cycles", "2", "--transient", "1"],
    "experiment": lambda p, n: [
        "friction", p.file(n), "--roughness", "0.3,0.5 um", "--laws", "xu-2007"
    ],
    "surrogate": lambda p, n: ["train", p.file(n), "--size", "16"],
    "paper": lambda p, n: [n],
}  # fmt: skip


def test_every_command_with_a_case_is_tried() -> None:
    without_case = {"cases", "cookbook", "explain", "import", "units"}
    taking = {each.name for each in COMMANDS} - without_case
    assert set(_ARGUMENTS) | _APART == taking


#: Studies of motions that take minutes: those of a stage are in test_motions_of_machines.py. The
#: printed tables of sources are compared in tests/paper_cases. Studies of many runs are tried on
#: machines with shorter ones.
_LONG = {
    *(("paper", name) for name in papers() if name != "fzg-12dof"),
    *(("continuation", name) for name in ("planetary-stage", "two-stage-spur")),
    *(("basins", name) for name in ("two-stage-spur", "wind-turbine-gearbox")),
    *((study, "wind-turbine-gearbox") for study in ("bifurcation", "sobol", "surrogate")),
}


def test_cases_left_out_have_the_structure_of_another_one() -> None:
    for name, other in _LIKE_ANOTHER.items():
        case, like = _case(name), _case(other)
        assert kind_of(case) == kind_of(like)
        if case.lumped:
            assert case.dynamics.model == like.dynamics.model


@pytest.mark.parametrize(
    ("command", "name"),
    [
        pytest.param(command, name, marks=() if command in _LIGHT else pytest.mark.slow)
        for command in sorted(_ARGUMENTS)
        for name in _CASES
        if (command, name) not in _LONG and (command in _ON_ALL or name not in _LIKE_ANOTHER)
    ],
)
def test_it_computes_or_refuses(
    command: str,
    name: str,
    place: _Place,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    arguments = [command, *_ARGUMENTS[command](place, name), "--json"]
    capsys.readouterr()
    code = call(arguments)
    output = capsys.readouterr()
    assert "fault of tribodyn" not in output.err + output.out, output.err
    if code:
        problems = json.loads(output.out)["error"]["problems"]
        assert code in (1, 2)
        assert all(each["what"] and each["remedy"] for each in problems), problems
    case = _case(name)
    if command in STUDIES and kind_of(case) in PARTS and not takes(command, case):
        assert code == 2
        assert f"{command} does not take one" in output.out
    elif STUDIES.get(command, STUDIES["run"]).kinds == KINDS:
        assert code == 0 or _EXCUSES.get(command, "\0") in output.err, output.err
