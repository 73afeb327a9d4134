"""What a run would refuse because of the case alone is told when the case is read."""

import warnings

import pytest

import tribodyn as td
from tribodyn.errors import ComputationError, InputError, ModelWarning
from tribodyn.friction import LAWS
from tribodyn.study.pipeline.tooth_contact import mesh_of


@pytest.mark.parametrize("law", ["benedict-kelly", "xu-2007"])
@pytest.mark.parametrize("roughness", ["0.5 um", "1.1 um", "1.5 um", "3.2 um"])
def test_check_refuses_what_run_refuses(law, roughness):
    """A case that can be read has friction; a law asked directly agrees."""
    changes = {"friction.law": law, "gears.composite_roughness": roughness}
    base = td.load_case("fzg-roughness")
    try:
        case = base.replace(changes)
    except InputError as error:
        assert str(error).startswith(("replace: friction.law: ", "replace: gears.composite_roug"))
        assert "another friction law" in str(error)
        assert roughness in ("1.5 um", "3.2 um")
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        assert mesh_of(case).friction_coefficient.max() > 0.0
    assert roughness in ("0.5 um", "1.1 um") or law == "xu-2007"


def test_a_law_of_a_third_party_is_asked_too():
    """One mechanism for all laws: the law itself says no."""

    @LAWS.define("shy", source="test", meaning="refuses rough flanks", needs_oil=True)
    def shy(contact):
        if contact.composite_roughness > 1e-7:
            raise InputError("too rough for the shy law", "argument roughness", "", "Polish")
        return 0.0 * contact.load_per_width + 0.05

    try:
        with pytest.raises(InputError, match=r"gears.composite_roughness: too rough for the shy law"):
            td.load_case("fzg-roughness").replace({"friction.law": "shy"})
        smooth = {"friction.law": "shy", "gears.composite_roughness": "0.05 um"}
        assert td.load_case("fzg-roughness").replace(smooth).friction.law == "shy"
    finally:
        LAWS._items.pop("shy")


def test_a_run_away_names_the_friction_first(monkeypatch):
    case = td.load_case("fzg-roughness").replace({"gears.composite_roughness": "1.1 um",
                                                  "friction.law": "benedict-kelly"})  # fmt: skip

    def fails(*_):
        raise ComputationError("the motion grew beyond all bounds", why="a parametric resonance")

    monkeypatch.setattr("tribodyn.study.pipeline.run.motion_of", fails)
    with pytest.raises(ComputationError) as caught:
        td.run(case)
    first, second = caught.value.problems
    assert first.what.startswith("the friction coefficient reaches 3.")
    assert second.why == "a parametric resonance"
    with pytest.raises(ComputationError) as caught:
        td.run(td.load_case("fzg-roughness"))
    assert len(caught.value.problems) == 1
