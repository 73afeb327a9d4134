"""Captions say what the data of their figures show: jumps of the stiffness, pairs under load."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import ModelWarning
from tribodyn.plot import FIGURES
from tribodyn.study.pipeline.cautions import mesh_cautions
from tribodyn.study.pipeline.tooth_contact import mesh_of


def table(**changes):
    case = td.load_case("fzg-roughness").replace(
        {"stiffness.model": "analytic", "friction.law": "none", "film.model": "none", **changes}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return mesh_of(case)


def relief(amount, length=None):
    return {
        f"gears.{gear}.modification.{key}": value
        for gear in ("pinion", "wheel")
        for key, value in (("tip_relief", amount), ("tip_relief_length", length))
        if value is not None
    }


def caption(mesh, name):
    return FIGURES[name].caption_of(mesh)


def test_the_stiffness_jumps_where_pairs_carry_at_once():
    mesh = table(**{"stiffness.model": "rectangular", "stiffness.pair_stiffness": "300 N/um"})
    assert "jumps by up to 300 N/µm" in caption(mesh, "mesh_stiffness")


@pytest.mark.parametrize("changes", [{}, relief("15 um", "4 mm")], ids=["plain", "relief"])
def test_the_stiffness_does_not_jump_where_pairs_come_in_gradually(changes):
    text = caption(table(**changes), "mesh_stiffness")
    assert "has no jump" in text
    assert "jumps" not in text.replace("has no jump", "")


def test_an_even_stiffness_is_called_even():
    """A mesh of which two or one pair have one stiffness together."""
    even = {"stiffness.model": "rectangular"}
    totals = {
        "stiffness.single_pair_stiffness": "3e8 N/m",
        "stiffness.double_pair_stiffness": "3e8 N/m",
    }
    text = caption(table(**even, **totals), "mesh_stiffness")
    assert "is constant over the mesh cycle" in text


@pytest.mark.parametrize(
    "changes", [{}, relief("10 um"), relief("30 um", "4 mm"), relief("6 um", "1 mm")]
)
def test_parts_of_the_cycle_add_up_to_the_contact_ratio_under_load(changes):
    mesh = table(**changes)
    text = caption(mesh, "load_sharing")
    parts = re.findall(r"(one|two|three) pairs? carr(?:ies|y) during ([\d.]+) %", text)
    number = {"one": 1, "two": 2, "three": 3}
    assert sum(float(part) for _, part in parts) == pytest.approx(100.0, abs=0.2)
    mean = sum(number[pairs] * float(part) for pairs, part in parts) / 100.0
    assert mean == pytest.approx(mesh.contact_ratio_under_load, abs=2e-3)


def test_the_ends_of_contact_are_named_by_where_they_lie():
    plain, relieved = table(), table(**relief("15 um", "4 mm"))
    rigid = table(**{"stiffness.extended_contact": False})
    assert re.search(r"begins to carry before A .* ceases after E", caption(plain, "load_sharing"))
    text = caption(relieved, "load_sharing")
    assert re.search(r"begins to carry after A .* ceases before E", text)
    assert "begins to carry at A and ceases at E" in caption(rigid, "load_sharing")
    first = float(re.search(r"after A \(([\d.]+) rad\)", text)[1])
    share = relieved.load_share[:, 0]
    curve_ = FIGURES["load_sharing"](relieved).data[0]
    loaded = np.asarray(curve_.x)[np.asarray(curve_.y) > 0.0]
    assert first == pytest.approx(loaded.min(), abs=1e-3)
    assert share[0] == 0.0


@pytest.mark.parametrize("name", ["mesh_stiffness", "load_sharing", "path_of_contact"])
def test_captions_of_relieved_teeth_separate_geometry_and_load(name):
    text = caption(table(**relief("30 um", "4 mm")), name)
    assert "Before B and after D" not in text
    assert "whenever" not in text


def test_the_drawing_of_the_pair_names_geometry_alone():
    mesh = table()
    title = FIGURES["gear_pair"](mesh.gear_pair).layout.title.text
    assert "1.33 tooth pairs are between A and E" in title
    assert "load" not in title + caption(mesh.gear_pair, "gear_pair")


def reduced_ratio_warnings(mesh):
    return [w for w in mesh_cautions(mesh) if w.code == "contact-ratio-reduced"]


@pytest.mark.parametrize("amount", ["0 um", "2 um", "4 um", "8 um", "12 um", "15 um", "30 um"])
@pytest.mark.parametrize("torque", ["45 N*m", "90 N*m"])
def test_a_relief_is_reported_where_it_takes_more_than_a_tenth(amount, torque):
    mesh = table(**relief(amount), **{"operation.torque": torque})
    lost = 1.0 - mesh.contact_ratio_under_load / mesh.transverse_contact_ratio
    messages = reduced_ratio_warnings(mesh)
    assert bool(messages) == (lost > 0.1)
    if messages:
        assert f"take off {100.0 * lost:.2g} %" in messages[0].message


def test_both_sides_of_the_limit_are_met():
    assert not reduced_ratio_warnings(table())
    assert not reduced_ratio_warnings(table(**relief("2 um")))
    assert reduced_ratio_warnings(table(**relief("30 um", "4 mm")))


def test_check_gives_the_warnings_of_the_run():
    """The quick rehearsal of a case has the contact ratio of the run."""
    from tribodyn.study.pipeline.run import rehearse

    case = td.load_case("fzg-roughness").replace(
        {"stiffness.model": "analytic", **relief("30 um", "4 mm")}
    )
    before = [w.message for w in rehearse(case) if w.code == "contact-ratio-reduced"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        after = [w.message for w in reduced_ratio_warnings(mesh_of(case))]
    assert before == after != []
