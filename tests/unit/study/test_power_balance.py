"""Power in the summary of machines and stages: what enters leaves or is listed as lost."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import pytest

import tribodyn as td

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
QUICK = {
    "film.model": "dowson-higginson",
    "friction.law": "constant",
    "friction.coefficient": 0.05,
    "load_cases": None,
}
SPUR = "two-stage-spur"


def run(name: str, **changes: Any) -> Any:
    """Result of a built-in case with a constant friction coefficient."""
    named = {key.replace("__", "."): value for key, value in changes.items()}
    return td.run(td.load_case(name).replace({**QUICK, **named}, by="test"))


@pytest.fixture(scope="module")
def results() -> dict[str, Any]:
    return {
        "forward": run(SPUR),
        "coast": run(SPUR, operation__torque="-120 N*m"),
        "backward": run(SPUR, operation__speed="-3000 rpm"),
        "stage": run("planetary-stage"),
        "multiplier": run(
            "planetary-stage", operation__input="carrier", operation__output="sun",
            operation__speed="300 rpm", operation__torque="2000 N*m",
        ),
    }  # fmt: skip


@pytest.mark.slow
def test_input_power_is_output_power_and_listed_losses(results: dict[str, Any]) -> None:
    for name, result in results.items():
        figures, case = result.operation.figures, result.case
        ends = [case.data["operation"][end] for end in ("input", "output")]
        start, end = ends[::-1] if name == "coast" else ends
        entering, leaving = (abs(figures[f"shafts.{end}.power"]) for end in (start, end))
        torque, speed = figures["machine.output_torque"], figures[f"shafts.{ends[1]}.speed"]
        listed = sum(figures[f"meshes.{mesh}.friction_power"] for mesh in case.meshes)
        power, lost = figures["machine.input_power"], figures["machine.friction_power"]
        assert power == pytest.approx(entering, rel=1e-9), name
        assert power - leaving == pytest.approx(lost, rel=1e-7), name
        assert listed == pytest.approx(lost, rel=1e-9), name
        assert figures["machine.efficiency"] == pytest.approx(leaving / power, rel=1e-12), name
        output = entering if name == "coast" else leaving
        assert torque * abs(speed) == pytest.approx(output, rel=1e-9), name


@pytest.mark.slow
def test_flow_of_power_is_drawn_without_a_gap(results: dict[str, Any]) -> None:
    for name in ("forward", "coast", "backward"):
        result = results[name]
        sankey, net = result.plot("machine_power").data[0], defaultdict[str, float](float)
        link, label = sankey.link, sankey.node.label
        for source, target, value in zip(link.source, link.target, link.value, strict=True):
            assert value > 0.0
            net[label[source]] -= value
            net[label[target]] += value
        figures = result.operation.figures
        power, lost = figures["machine.input_power"], figures["machine.friction_power"]
        assert net.pop("input") == pytest.approx(-power)
        assert net.pop("friction") == pytest.approx(lost)
        assert net.pop("output") == pytest.approx(power - lost)
        assert max(map(abs, net.values())) < 1e-9 * power


@pytest.mark.slow
def test_motion_loses_what_the_summary_lists(results: dict[str, Any]) -> None:
    """The force of the second mesh is less than that of the first one by the losses between."""
    result = results["forward"]
    figures, machine = result.operation.figures, result.machine
    loads = machine.kinematics.meshes
    losses = [figures[f"meshes.{n}.friction_power"] / loads[n].power for n in ("first", "second")]
    # Friction of half a mesh acts before, of the other half behind its line of action.
    ratio = [figures[f"meshes.{n}.mean_mesh_force"] / loads[n].force for n in ("first", "second")]
    between = 0.5 * (losses[0] + losses[1])
    assert 1.0 - ratio[1] / ratio[0] == pytest.approx(between, rel=0.25)
