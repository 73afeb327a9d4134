"""One class reads a case of any kind: what a pair, a machine and a stage share, and what not."""

from __future__ import annotations

import pickle
from copy import deepcopy

import pytest

import tribodyn as td
from tribodyn.study import MachineCase, PairCase

KINDS = {
    "fzg-roughness": PairCase,
    "helical-pair": PairCase,
    "hypoid-mixed-ehl": PairCase,
    "two-stage-spur": MachineCase,
    "hypoid-axle": MachineCase,
    "planetary-stage": MachineCase,
}


@pytest.mark.parametrize("name", KINDS)
def test_a_case_of_any_kind_is_read_from_its_tables_by_the_one_class(name: str) -> None:
    case = td.load_case(name)
    assert type(case) is KINDS[name]
    assert isinstance(case, td.Case)
    again = td.Case(case.source, **deepcopy(case.user_input.data))
    assert type(again) is type(case)
    assert again == case
    assert pickle.loads(pickle.dumps(case)) == case
    assert repr(case).startswith("Case(")


@pytest.mark.parametrize("name", KINDS)
def test_a_case_of_any_kind_is_immutable(name: str) -> None:
    case = td.load_case(name)
    for attribute in ("title", "gears", "operating_point"):
        with pytest.raises((td.InputError, AttributeError)):
            setattr(case, attribute, None)
    assert case == td.load_case(name)


@pytest.mark.parametrize(
    ("name", "attribute", "owner"),
    [
        ("two-stage-spur", "gear_pair", "a machine has no gear_pair: that is of a pair of gears"),
        ("planetary-stage", "backlash", "a planetary stage has no backlash: that is of a pair"),
        ("fzg-film", "shafts", "a pair of gears has no shafts: that is of a machine"),
        ("helical-pair", "mesh_pairs", "a pair of gears has no mesh_pairs: that is of a machine"),
        ("hypoid-axle", "nonsense", "a machine has no nonsense$"),
    ],
)
def test_an_attribute_of_another_kind_is_named(name: str, attribute: str, owner: str) -> None:
    case = td.load_case(name)
    assert not hasattr(case, attribute)
    with pytest.raises(AttributeError, match=owner):
        getattr(case, attribute)


def test_the_class_shows_the_members_of_every_kind() -> None:
    for member in ("gear_pair", "material_properties", "meshes", "mesh_pairs", "tooth_group"):
        assert member in td.Case.__annotations__
