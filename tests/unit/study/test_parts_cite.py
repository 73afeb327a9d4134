"""Papers behind machines and stages: those of their pairs, and of shafts, bearings, planets."""

from __future__ import annotations

import pytest

import tribodyn as td
from tribodyn.study.pipeline.citations import cite, papers


@pytest.mark.parametrize(
    ("name", "its_own"),
    [
        ("two-stage-spur", {"cowper", "iso-16281"}),
        ("hypoid-axle", {"cowper"}),
        ("planetary-stage", {"lin-parker", "parker-lin"}),
        ("wind-turbine-gearbox", {"lin-parker"}),
    ],
)
def test_papers_are_those_of_all_pairs_and_of_the_parts(name: str, its_own: set[str]) -> None:
    case = td.load_case(name)
    entries = papers(case)
    assert its_own <= set(entries)
    for _, pair, _ in case.mesh_pairs():
        of_motion = {*pair.dynamics.chosen.papers, *pair.solver.chosen.papers, "anderson"}
        assert set(papers(pair)) - of_motion <= set(entries)
        assert not of_motion & set(entries)  # the machine has its own structure and search
    assert entries["case"]["title"].endswith(case.origin)
    assert cite(case).count("\n") + 1 == len(entries)
    assert cite(case, "bibtex").count("@") >= len(entries)
