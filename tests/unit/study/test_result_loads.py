"""Results of every kind by load: tables, system, motion, signals, figures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_summary_names import QUICK
from tests.unit.study.test_machine_run import GEARED

import tribodyn as td
from tribodyn.study import read_case

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")


def _computed(kind: str) -> Any:
    if kind == "machine":
        loads = [{"name": name, "share": 0.5, "torque": f"{torque} N*m"}
                 for name, torque in (("operation", 40), ("slow 1.5", 60))]  # fmt: skip
        return td.run(read_case(GEARED, "geared.toml").replace({"load_cases": loads}))
    if kind == "stage":
        return td.run(td.load_case("planetary-stage").replace(QUICK, by="test"))
    return td.run("fzg-stiffness")


@pytest.mark.parametrize("kind", ["pair", "machine", pytest.param("stage", marks=pytest.mark.slow)])
def test_loads_have_tables_system_motion_signals(kind: str) -> None:
    result = _computed(kind)
    names = ["operation"] + (["slow 1.5", "load_cases.operation"] if kind == "machine" else [])
    assert list(result.loads) == names
    summary = result.summary()
    for name, load in result.loads.items():
        prefix = "" if name == "operation" else f"load_cases.{name.removeprefix('load_cases.')}."
        assert {prefix + key: value for key, value in load.figures.items()}.items() <= (
            summary.items()
        )
        assert tuple(load.system.names) == load.response.names
        assert all(table.mean_mesh_stiffness > 0.0 for table in load.tables.values())
        assert load.signals.data_vars
    first = result.loads["operation"]
    assert result.response is first.response
    assert result.system is first.system
    assert result.mesh is next(iter(first.tables.values()), None)
    assert result.signals.identical(first.signals)
    plots = [name for name in dir(result) if name.startswith("plot_")]
    assert plots
    with pytest.raises(AttributeError, match=r"the result of a .* has no figure 'plot_nothing'"):
        result.plot_nothing  # noqa: B018


def test_figures_of_a_machine_are_methods() -> None:
    result = _computed("machine")
    assert result.plot_machine_power().to_json() == result.plot("machine_power").to_json()
    with pytest.raises(AttributeError, match="of a machine has no plot_planetary_forces"):
        result.plot_planetary_forces()


def test_a_stored_result_has_the_figures_of_its_load(tmp_path: Path) -> None:
    for kind in ("pair", "machine"):
        result = _computed(kind)
        again = td.load_result(result.save(tmp_path / kind))
        for name, load in result.loads.items():
            assert again.loads[name].figures == load.figures
            np.testing.assert_allclose(again.loads[name].response.position, load.response.position)
