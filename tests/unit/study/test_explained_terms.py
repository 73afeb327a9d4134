"""Every warning and every choice of a model is explained, in the program and in its pages."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

import tribodyn
from tribodyn.cli import call
from tribodyn.contact import hertz_line
from tribodyn.nomenclature import QUANTITIES
from tribodyn.study import SUMMARY
from tribodyn.study.case.reference import (
    case_keys,
    choice_meanings,
    explanations,
    warning_meanings,
)
from tribodyn.study.case.values import find_term, listed_terms

_PAGE = Path(__file__).resolve().parents[3] / "docs" / "command-line.md"


def test_the_page_lists_every_warning_with_its_meaning() -> None:
    page = _PAGE.read_text(encoding="utf-8")
    for code, meaning in warning_meanings().items():
        assert f"| `{code}` | {meaning} |" in page


@pytest.mark.parametrize(
    "key", ["stiffness.model", "friction.law", "film.model", "dynamics.model", "solver.method"]
)
def test_every_choice_is_explained(key: str, capsys: pytest.CaptureFixture[str]) -> None:
    spec = {name: spec for name, spec, _ in case_keys()}[key]
    assert spec.names is not None
    for name in set(spec.names()) - {"none"}:
        assert call(["explain", name]) == 0
        assert choice_meanings()[name] in capsys.readouterr().out


def test_warning_codes_are_explained(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["explain", "thin-rim"]) == 0
    assert warning_meanings()["thin-rim"] in capsys.readouterr().out
    assert call(["explain", ""]) == 2
    assert "nothing to explain" in capsys.readouterr().err
    assert call(["explain", "backlsh"]) == 2
    remedy = capsys.readouterr().err.partition("Did you mean")[2].rstrip("?\n")
    codes = [code.strip() for code in remedy.split(" or ")]
    assert "backlash" in codes
    assert len(set(codes)) == len(codes)


def _explain(capsys: pytest.CaptureFixture[str], *terms: str) -> list[dict[str, Any]]:
    assert call(["explain", *terms, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_explained_terms_exist_and_every_warning_has_a_remedy() -> None:
    explained, keys = explanations(), [key for key, _, _ in case_keys()]
    names = {*keys, *(key.rpartition(".")[2] for key in keys), *QUANTITIES, *SUMMARY}
    assert set(explained["equations"]) <= names | set(choice_meanings())
    assert set(explained["ranges"]) <= set(choice_meanings())
    assert set(explained["remedies"]) == set(warning_meanings())
    assert {entry.key for entry in map(find_term, listed_terms()) if entry and entry.key} <= names


def test_pages_that_are_named_exist() -> None:
    named = {
        *explanations()["pages"].values(),
        *(term.page for w in listed_terms() if (term := find_term(w))),
    }
    for name in named:
        file, _, anchor = name.partition("#")
        text = (_PAGE.parent / file).read_text(encoding="utf-8")
        headings = {h.lower().replace(" ", "-") for h in re.findall(r"^#+ (.*)$", text, re.M)}
        assert not anchor or anchor in headings


@pytest.mark.parametrize(
    ("terms", "first"),
    [
        (("lambda",), {"quantity": "film_ratio", "equation": "Lambda = h_min / S"}),
        (("LAMBDA",), {"quantity": "film_ratio"}),
        (("tip", "relief"), {"quantity": "tip_relief", "unit": "um"}),
        (("Ra",), {"see": "roughness_ra"}),
        (("DTE",), {"see": "dynamic_transmission_error"}),
        (("TE",), {"see": "static_transmission_error"}),
        (("LTCA",), {"page": "docs/stiffness.md"}),
        (("EHL",), {"page": "docs/film.md"}),
        (("hunting", "tooth", "frequency"), {"page": "docs/diagnosis.md#where-to-look"}),
        (("assembly", "phase"), {"page": "docs/diagnosis.md#where-to-look"}),
        (("scuffing",), {"page": "docs/rating.md"}),
        (("c_gamma",), {"page": "docs/stiffness.md"}),
        (("helix",), {"page": "docs/geometry.md"}),
        (("Kv",), {"see": "dynamic_factor_peak"}),
        (("XU-2007",), {"choice": "xu-2007", "page": "docs/friction.md"}),
        (("[mixed-lubrication]",), {"warning": "mixed-lubrication"}),
        (("gears.pinion.modification.tip_relief",), {"page": "docs/modifications.md"}),
        (("hertz",), {"warning": "hertz-pressure"}),
    ],
)
def test_common_search_terms_give_the_right_entry_first(
    terms: tuple[str, ...], first: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    explained = _explain(capsys, *terms)
    assert first.items() <= explained[0].items()


def test_complete_words_precede_partial_matches_and_the_list_is_short(
    capsys: pytest.CaptureFixture[str],
) -> None:
    names = [str(next(iter(entry.values()))) for entry in _explain(capsys, "pitch")]
    contain = ["pitch" in re.split(r"[^a-z]", name.lower()) for name in names]
    assert contain == sorted(contain, reverse=True)
    assert call(["explain", "mesh"]) == 0
    out = capsys.readouterr().out
    assert out.count("page:") == 8
    assert " more match: " in out
    assert call(["explain", "Ra"]) == 0
    assert len(capsys.readouterr().out.splitlines()) < 40


def test_hertz_equations_are_those_of_the_package() -> None:
    names = {"w": 147802.0, "R": 8e-3, "E_": 2.2e11, "pi": math.pi, "sqrt": math.sqrt}
    dry = hertz_line(names["w"], names["R"], names["E_"])
    for name, value in (("hertz_pressure", dry.maximum_pressure), ("half_width", dry.half_width)):
        text = explanations()["equations"][name].partition(" = ")[2].replace("E'", "E_")
        text = re.sub(r"(?<=\w) (?=\w)", "*", text)
        assert eval(text, dict(names)) == pytest.approx(float(value), rel=1e-12)


def test_every_symbol_of_a_frequency_is_explained(capsys: pytest.CaptureFixture[str]) -> None:
    symbols = set()
    for name in ("two-stage-helical", "planetary-stage", "hypoid-axle"):
        symbols.update(tribodyn.kinematic_frequencies(tribodyn.load_case(name)).symbol)
    listed = {symbol for symbol in symbols if symbol.isupper() and symbol.isalpha()} - {"TF"}
    assert listed >= {"GMF", "HTF", "APF", "BPFO", "BPFI", "BSF", "FTF", "PPF"}
    for symbol in listed:
        answer = _explain(capsys, symbol)[0]["answer"]
        assert symbol in answer or symbol == "APF"
        assert "tribodyn frequencies FILE" in answer


@pytest.mark.parametrize("count", [9, 13])
def test_the_explained_formulas_are_those_of_the_program(count: int) -> None:
    """Outer and inner ring share all passes, and the elements roll between them."""
    from tribodyn.faults import BearingImpacts

    ratio, turning = 0.21, 31.0
    frequencies = {
        place: BearingImpacts(
            place=place,
            rolling_elements=count,
            element_diameter=ratio,
            pitch_diameter=1.0,
            contact_angle=0.3,
        ).frequency(turning)
        for place in ("outer", "inner", "element")
    }
    part = ratio * math.cos(0.3)
    assert frequencies["outer"] == pytest.approx(count / 2 * turning * (1 - part))
    assert frequencies["inner"] == pytest.approx(count / 2 * turning * (1 + part))
    assert frequencies["element"] == pytest.approx(2 * (turning / (2 * ratio) * (1 - part**2)))
