"""The report as text: complete, escaped, self-contained, and written at once."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from plotly.offline import get_plotlyjs

from tribodyn.errors import InputError, ModelWarning
from tribodyn.report import html, render_report, write_report
from tribodyn.report.figure_blocks import SECTIONS, script_json
from tribodyn.report.html import operating_point


class Outline(HTMLParser):
    """Headings, ids, and everything that a browser would fetch."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.headings: list[str] = []
        self.ids: set[str] = set()
        self.fetched: list[str] = []
        self.links: list[str] = []
        self.open: list[str] = []
        self._heading = False
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        attributes = {name: value or "" for name, value in attrs}
        self._heading = tag in {"h1", "h2"}
        self.ids.add(attributes.get("id", ""))
        if tag not in {"meta", "link", "br", "wbr"}:
            self.open.append(tag)
        if tag == "a":
            self.links.append(attributes["href"])
        elif "src" in attributes or "href" in attributes:
            self.fetched.append(attributes.get("src", attributes.get("href", "")))

    def handle_endtag(self, tag: str) -> None:
        self._heading = False
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self._heading:
            self.headings.append(data.strip())


@pytest.fixture(scope="module")
def page(drawable: Any) -> str:
    return render_report(drawable())


@pytest.fixture(scope="module")
def outline(page: str) -> Outline:
    return Outline(page)


def test_page_is_well_formed_and_complete(outline: Outline) -> None:
    assert outline.open == []
    for heading in (
        "The gear pair",
        "Along the path of contact",
        "Flank modifications",
        "Mesh stiffness",
        "Load sharing",
        "Static transmission error",
        "Friction",
        "Mesh force",
        "Transmission error",
        "Accelerations",
        "Spectra",
        "Bearing forces",
        "All numbers",
        "Assumptions",
        "Sources",
        "Provenance",
    ):
        assert heading in outline.headings


def test_links_lead_to_sections(outline: Outline) -> None:
    assert len(outline.links) > len(SECTIONS)
    assert {link.removeprefix("#") for link in outline.links} <= outline.ids


def test_nothing_is_fetched(page: str, outline: Outline) -> None:
    assert outline.fetched == ["data:,"]
    text = page.replace(get_plotlyjs(), "")
    assert len(text) < len(page)
    assert not re.search(r"https?://|url\(|@import", text)


def test_plotly_is_there_once(page: str) -> None:
    assert page.count(get_plotlyjs()) == 1


def test_size(page: str) -> None:
    assert len(page.encode()) < 6e6


def test_every_drawn_figure_has_its_place_and_its_data(page: str, outline: Outline) -> None:
    match = re.search(r"const figures = (\{.*?\n\});", page, re.DOTALL)
    assert match
    figures = json.loads(match.group(1))
    missing = {
        "campbell",
        "film",
        "film_pressure",
        "film_stiffness",
        "flank_modification",
        "lubrication",
    }
    assert set(figures) == set(SECTIONS) - missing
    for name, figure in figures.items():
        assert f"figure-{name}" in outline.ids
        assert figure["data"]
        assert figure["layout"]["height"] > 200


def test_missing_figures_are_explained(drawable: Any) -> None:
    page = render_report(drawable(names=("pinion_theta", "wheel_theta")))
    assert page.count("their centres are fixed") == 1
    assert "dynamics.model = &#34;spur-6dof&#34;" in page
    together = "Accelerations, bearing forces, spectra of the bearing forces"
    assert together in Outline(page).headings
    assert "No film model was chosen" in page
    assert "figure-acceleration" not in Outline(page).ids


def test_modified_flanks_are_drawn(drawable: Any) -> None:
    relieved = drawable(changes={"gears.pinion.modification.tip_relief": "10 um"})
    page = render_report(relieved)
    assert "figure-flank_modification" in Outline(page).ids
    assert "Gap of the unloaded flanks of up to 10.0 µm" in page
    assert "neither gear has a modification" not in page


def test_chips_name_the_method_and_the_models(page: str, drawable: Any) -> None:
    case = drawable(
        changes={
            "gears.composite_roughness": None,
            "friction.law": "none",
            "friction.variant": None,
            "solver.method": "transient",
        }
    ).case
    assert "<span>Method</span> steady" in page
    assert "<span>Composite roughness</span> 0.53 µm" in page
    assert "<span>Friction law</span> benedict-kelly" in page
    assert "<span>Film model</span> dowson-higginson" in page
    assert "<span>Stiffness model</span> potential-energy" in page
    chips = dict(operating_point(case))
    assert (chips["Method"], chips["Friction law"]) == ("transient", "none")
    assert "Composite roughness" not in chips


def test_text_of_the_user_is_escaped(drawable: Any) -> None:
    evil = '</title></script><script>alert("x")</script>'
    result = drawable(changes={"title": evil})
    result.warnings = (ModelWarning("some-code", "5 < 6 & <b>bold</b>"),)
    result.cite = lambda: "A & B (2020): <i>Title</i>."
    page = render_report(result)
    assert "<script>alert" not in page
    assert "&lt;script&gt;alert" in page
    assert "[some-code] 5 &lt; 6 &amp; &lt;b&gt;bold&lt;/b&gt;" in page
    assert "&lt;i&gt;Title" in page
    assert page.count("<script>") == 2
    assert Outline(page).open == []


def test_data_cannot_close_the_script() -> None:
    text = '{"a": "</script><!--\u2028"}'
    safe = script_json(text)
    assert "<" not in safe
    assert "\u2028" not in safe
    assert json.loads(safe) == json.loads(text)


def test_warnings_are_shown_only_if_there_are_any(drawable: Any, page: str) -> None:
    assert "all models were used within their range of validity" in page
    result = drawable()
    result.warnings = (ModelWarning("some-code", "too fast"),)
    assert "all models were used within their range of validity" not in render_report(result)


def test_report_lists_assumptions_and_case(drawable: Any, page: str) -> None:
    result = drawable()
    for assumption in result.assumptions:
        assert assumption.value in page
    assert "normal_module = &#34;4.5 mm&#34;" in page


def test_report_is_written_whole_or_not_at_all(
    drawable: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "report.html"
    assert write_report(drawable(), target) == target
    report = target.read_text(encoding="utf-8")
    assert report.startswith("<!DOCTYPE html>")

    def broken(result: Any) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr(html, "render_report", broken)
    with pytest.raises(KeyboardInterrupt):
        write_report(drawable(), target)
    assert target.read_text(encoding="utf-8") == report
    assert [file.name for file in tmp_path.iterdir()] == ["report.html"]


def test_a_folder_that_cannot_be_written_is_reported(drawable: Any, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="report"):
        write_report(drawable(), tmp_path / "nowhere" / "report.html")
