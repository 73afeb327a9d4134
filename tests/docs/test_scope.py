"""One table says what is modelled: the program has it, and no page says otherwise."""

import json
import re
from pathlib import Path

import pytest
from pages import PAGES, ROOT, anchors
from written_tables import program_table

import tribodyn as td
from tribodyn.cli import call
from tribodyn.cli.app import COMMANDS
from tribodyn.cookbook import write_skill
from tribodyn.scope import PROGRAMS, features, not_modelled, statement
from tribodyn.study.case.reference import case_keys
from tribodyn.study.case.values import find_term, listed_terms
from tribodyn.study.machine_tables import machine_keys

MODELLED = [each for each in features() if each.modelled]
MISSING = [each for each in features() if not each.modelled]
KEYS = {key: spec for key, spec, *_ in [*case_keys(), *machine_keys()]}
#: What pages say of things that are not there.
DENIED = re.compile(
    r"not (available|modelled|in this version|supported)|only (external )?spur|spur gears? only"
    r"|does not (model|have|compute|rate)|\\bno (safety|rating|helical|hypoid|planetary|housing)",
    re.IGNORECASE,
)


def exists(evidence: str) -> bool:
    if evidence.startswith("tribodyn "):
        return evidence.removeprefix("tribodyn ") in {each.name for each in COMMANDS}
    if evidence.startswith("td."):
        member: object = td
        for name in evidence.split(".")[1:]:
            member = getattr(member, name, None)
        return callable(member)
    key, _, choice = evidence.partition("=")
    if choice:
        return choice in KEYS[key].names()
    return key in td.cases(machines=True) or any(f"{each}.".startswith(f"{key}.") for each in KEYS)


@pytest.mark.parametrize("feature", MODELLED, ids=lambda feature: feature.text[:30])
def test_what_is_modelled_is_there(feature) -> None:
    assert feature.evidence
    assert not feature.absent
    assert [each for each in feature.evidence if not exists(each)] == []
    page, _, anchor = feature.page.partition("#")
    text = (ROOT / "docs" / page).read_text("utf-8")
    assert not anchor or anchor in anchors(text)


@pytest.mark.parametrize("feature", MISSING, ids=lambda feature: feature.text[:30])
def test_what_is_not_modelled_is_not_there(feature, capsys) -> None:
    assert feature.absent
    assert not feature.evidence
    options = {f"{key}={name}" for key, spec in KEYS.items() if spec.names for name in spec.names()}
    for word in feature.absent:
        assert [name for name in {*KEYS, *options} if word in name] == []
    for word in feature.terms:
        assert feature.text in find_term(word).meaning
        assert call(["explain", *word.split(), "--json"]) == 0
        (first, *_) = json.loads(capsys.readouterr().out)
        assert first["page"] == "docs/scope.md"


def test_the_check_sees_what_is_wrong() -> None:
    assert not exists("gears.kind=worm")
    assert not exists("tribodyn weld")
    assert not exists("td.study.no_such")
    assert denials("| duty cycle, gear rating | not available |\nSpur gears only, no helical ones.")
    assert not denials("Worm gears are not in this version.")


def denials(text: str) -> list[str]:
    """Lines that deny what is modelled."""
    words = "|".join(word for each in MODELLED for word in each.terms)
    hand_written = re.sub(r"<!-- scope \w+ -->.*?<!-- end -->", "", text, flags=re.DOTALL)
    known = [each.text for each in MISSING]
    for each in known:
        hand_written = hand_written.replace(each, "")
    sentences = re.split(r"\n|(?<=[.;]) ", hand_written)
    return [each for each in sentences if DENIED.search(each) and re.search(words, each, re.I)]


@pytest.mark.parametrize(
    "path",
    [
        path
        for path in PAGES
        if re.match(r"README|scope|coming-from|index|exchange|install|rating", path.name)
    ],
    ids=lambda path: path.name,
)
def test_no_page_denies_what_is_modelled(path: Path) -> None:
    assert denials(path.read_text("utf-8")) == []


def test_terms_skill_help_and_package_say_the_same(tmp_path: Path, capsys) -> None:
    for term in listed_terms():
        if term not in not_modelled():
            assert denials(find_term(term).meaning) == []
    skill = (write_skill(tmp_path) / "SKILL.md").read_text("utf-8")
    assert denials(skill) == []
    assert call(["--help"]) == 0
    shown = " ".join(re.sub(r"[^\w ,:-]", " ", capsys.readouterr().out).split())
    for text in (skill, shown):
        assert statement("gears") in text
        assert statement("summary") in text
    assert all(each.text in skill for each in MISSING)


@pytest.mark.parametrize("program", PROGRAMS)
def test_users_of_other_programs_see_where_things_are(program: str) -> None:
    table = program_table(program).splitlines()
    assert len(table) > 8
    assert table[0] == f"| in {program} | here |"
    page = (ROOT / "docs" / f"coming-from-{PROGRAMS[program]}.md").read_text("utf-8")
    assert all(line in page for line in table)


def test_citation_has_the_version_of_the_package() -> None:
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    assert f"\nversion: {td.__version__}\n" in citation
