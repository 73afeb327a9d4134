"""Provenance of a report: operating point, software versions and date."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib.metadata import version as installed
from typing import TYPE_CHECKING, Any

from tribodyn.plot.theme.labels import display_unit, displayed, engineering
from tribodyn.study.case.provenance import Assumption, assumptions
from tribodyn.study.machine.housing_files import HOUSING
from tribodyn.study.studies.needs import PAIRS, kind_of

if TYPE_CHECKING:
    from tribodyn.study.planetary.machine_stages import CaseStage

#: Packages whose version may change a figure.
_PACKAGES = ("numpy", "scipy", "numba")


def version() -> str:
    """Version of the package."""
    import tribodyn

    return tribodyn.__version__


def _with_unit(name: str, value: float) -> str:
    return " ".join(engineering(float(displayed(name, value)), display_unit(name))).rstrip()


def operating_point(case: Any) -> list[tuple[str, str]]:
    """Speed, load, surfaces, oil and models of a case as formatted (name, value) pairs."""
    if kind_of(case) not in PAIRS:
        start, end = case.ends
        return [
            ("Speed", _with_unit("speed", case.operating_point.speed)),
            ("Torque", _with_unit("torque", case.operating_point.torque)),
            ("Input", start),
            ("Output", end),
            ("Meshes", ", ".join(case.meshes)),
            *(row for stage in case.stages.values() for row in _of_stage(stage)),
        ]
    gears, operation = case.gears, case.operation
    stiffness, film = case.contact_models
    point = [
        ("Teeth", " : ".join(str(gear.teeth) for gear in gears.by_name.values())),
        ("Speed", f"{_with_unit('speed', operation.speed)} ({operation.speed_of})"),
        ("Torque", f"{_with_unit('torque', operation.torque)} ({operation.speed_of})"),
        ("Driver", gears.driver),
        ("Film model", film),
        ("Friction law", case.friction.law),
        ("Stiffness model", stiffness),
        ("Structure", case.dynamics.model),
        ("Method", case.solver.method),
    ]
    if case.composite_roughness is not None:
        roughness = _with_unit("composite_roughness", case.composite_roughness)
        point.insert(4, ("Composite roughness", roughness))
    if case.lubricant is not None and case.lubricant.name:
        point.insert(4, ("Oil", case.lubricant.name))
    return point


def _of_stage(stage: CaseStage) -> list[tuple[str, str]]:
    teeth = [stage.gears[stage.table.sun], *stage.planets, stage.gears[stage.table.ring]]
    return [
        (f"Planets of {stage.name}", str(stage.table.count)),
        (f"Teeth of {stage.name}", ", ".join(str(abs(gear.teeth)) for gear in teeth)),
    ]


def case_text(case: Any) -> str:
    """The case file, with the files of a housing called as in a directory of results."""
    named = case if kind_of(case) in PAIRS else case.with_files(HOUSING)
    return str(named.to_toml())


def assumptions_of(case: Any) -> Sequence[Assumption]:
    """What a case of any kind assumes; nothing without a case."""
    if case is None:
        return ()
    stated: Sequence[Assumption] = assumptions(case) if kind_of(case) in PAIRS else case.assumptions
    return stated


def provenance(result: Any) -> list[tuple[str, str]]:
    """Software versions and date of a report as (name, value) pairs."""
    from tribodyn.study.pipeline.stored_motion import describe_stored_cycles

    packages = ", ".join(f"{name} {installed(name)}" for name in _PACKAGES)
    return [
        ("Software", f"tribodyn {version()}"),
        ("Built on", f"Python {platform.python_version()}, {packages}"),
        *(
            [("Motion in response.nc", describe_stored_cycles(result.response))]
            if hasattr(result, "response")
            else []
        ),
        ("Report written", f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC"),
    ]
