"""Every broken case file is refused with file, line, key, value and remedy."""

from __future__ import annotations

import pytest
from broken import BROKEN, SOUND, Broken, line_of

from tribodyn.errors import InputError
from tribodyn.study import read_case


@pytest.mark.parametrize("broken", BROKEN, ids=lambda broken: broken.name)
def test_message_names_place_fault_and_remedy(broken: Broken) -> None:
    assert broken.old in SOUND
    text = SOUND.replace(broken.old, broken.new, 1)
    with pytest.raises(InputError) as caught:
        read_case(text, "pair.toml")
    message = str(caught.value)
    for part in broken.says:
        assert part in message
    if broken.at:
        assert f"pair.toml:{line_of(text, broken.at)}" in message
    else:
        assert "pair.toml" in message
    assert all(problem.why or problem.remedy for problem in caught.value.problems)


def test_the_sound_file_is_sound() -> None:
    assert read_case(SOUND, "pair.toml").gears.wheel.teeth == 24


def test_there_are_at_least_thirty() -> None:
    assert len({broken.name for broken in BROKEN}) == len(BROKEN) >= 30


def test_all_faults_come_at_once_in_the_order_of_the_file() -> None:
    text = SOUND
    for old, new in (
        ('"4.5 mm"', '"4.5 kg"'),
        ("teeth = 16", 'teeth = "x"'),
        ('"900 rpm"', "900"),
        ('"steady"', '"stedy"'),
    ):
        text = text.replace(old, new, 1)
    with pytest.raises(InputError) as caught:
        read_case(text, "pair.toml")
    places = [str(problem.where).split(":")[1] for problem in caught.value.problems]
    assert places == ["3", "9", "18", "29"]


def test_impossible_gears_are_reported_along_with_other_errors() -> None:
    text = SOUND.replace('"91.5 mm"', '"80 mm"').replace('"steady"', '"stedy"')
    with pytest.raises(InputError) as caught:
        read_case(text, "pair.toml")
    message = str(caught.value)
    assert "pair.toml:5: gears.center_distance" in message
    assert "stedy" in message


@pytest.mark.parametrize("text", ["", "# nothing yet\n"])
def test_a_file_without_values_names_where_to_start(text: str) -> None:
    with pytest.raises(InputError, match=r"tribodyn new my\.toml"):
        read_case(text, "pair.toml")


def test_a_missing_unit_has_one_remedy() -> None:
    with pytest.raises(InputError) as caught:
        read_case(SOUND.replace('"4.5 mm"', '"4.5"', 1), "pair.toml")
    assert str(caught.value).count("rite for example") == 1


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("[operation]", "[operations]"),
        ("[gears.pinion]", "[gear.pinion]"),
        ("teeth = 16", "theeth = 16"),
        ('torque = "90 N*m"', 'power = "8 kW"'),
        ("bearing_stiffness =", "bearing_stiffness_pinion ="),
        ('composite_roughness = "0.53 um"', 'composite_roughnes = "0.53 um"'),
    ],
)
def test_a_misspelt_key_is_reported_once_and_not_as_missing(old: str, new: str) -> None:
    with pytest.raises(InputError, match="unknown key") as caught:
        read_case(SOUND.replace(old, new, 1), "pair.toml")
    assert len(caught.value.problems) == 1


def test_faults_within_a_misspelt_table_keep_their_lines() -> None:
    text = SOUND.replace("[gears.pinion]", "[gear.pinion]").replace("teeth = 16", "teeth = 2")
    with pytest.raises(InputError) as caught:
        read_case(text, "pair.toml")
    places = [str(problem.where) for problem in caught.value.problems]
    assert places == ["pair.toml:8: gear", "pair.toml:9: gear.pinion.teeth"]
