"""The report in a real browser: no error, no request, everything drawn, nothing cut off."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

import tribodyn
from tribodyn.errors import ModelWarning
from tribodyn.report import write_report
from tribodyn.report.figure_blocks import SECTIONS

pytestmark = [pytest.mark.browser, pytest.mark.slow]


@dataclass
class Visit:
    """An open page and what the browser had to say about it."""

    page: Any
    messages: list[str] = field(default_factory=list)
    requested: list[str] = field(default_factory=list)


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        result = tribodyn.run(tribodyn.load_case("fzg-roughness"))
    return write_report(result, tmp_path_factory.mktemp("report") / "report.html")


@pytest.fixture(scope="module", params=[1280, 800, 420])
def visit(request: pytest.FixtureRequest, browser: Any, report: Path) -> Iterator[Visit]:
    page = browser.new_page(viewport={"width": request.param, "height": 900})
    opened = Visit(page)
    page.on("console", lambda message: opened.messages.append(f"{message.type}: {message.text}"))
    page.on("pageerror", lambda error: opened.messages.append(f"error: {error}"))
    page.on("request", lambda sent: opened.requested.append(sent.url))
    page.goto(report.as_uri())
    page.wait_for_function(
        "Object.keys(figures).every(name =>"
        " document.querySelector('#figure-' + name + ' .main-svg'))"
    )
    yield opened
    page.close()


def test_console_is_silent(visit: Visit) -> None:
    assert visit.messages == []


def test_nothing_is_requested_from_outside(visit: Visit) -> None:
    assert visit.requested[0].startswith("file://")
    outside = [url for url in visit.requested if not url.startswith(("file:", "data:", "blob:"))]
    assert outside == []
    assert len([url for url in visit.requested if url.startswith("file:")]) == 1


def test_every_figure_is_drawn(visit: Visit) -> None:
    figures = visit.page.locator(".figure")
    assert (
        figures.count() == len(SECTIONS) - 2
    )  # a film formula knows no pressure, the flanks are perfect
    for number in range(figures.count()):
        figure = figures.nth(number)
        assert figure.locator(".main-svg").count() > 0
        assert figure.locator(".trace, .bars").count() > 0
    answer_texts = visit.page.locator(".answer").all_inner_texts()
    assert len(answer_texts) == figures.count()
    assert all(answer.strip() for answer in answer_texts)


def test_no_text_is_broken(visit: Visit) -> None:
    text = visit.page.inner_text("body") + " ".join(
        visit.page.locator("svg text").all_text_contents()
    )
    for mark in ("NaN", "nan", "undefined", "None", "Infinity", "[object"):
        assert mark not in text.split()


def test_no_button_sends_data_away(visit: Visit) -> None:
    buttons = visit.page.evaluate(
        "[...document.querySelectorAll('.modebar-btn')].map(button => button.dataset.title)"
    )
    assert len(set(buttons)) == 6
    assert not [title for title in buttons if any(w in title for w in ("Share", "cloud", "Plotly"))]


def test_headings_are_there(visit: Visit) -> None:
    headings = visit.page.locator("h2").all_inner_texts()
    assert len(headings) >= len(SECTIONS) + 4
    assert {"Mesh force", "Bearing forces", "Assumptions", "Provenance"} <= set(headings)
    assert "FZG" in visit.page.inner_text("h1")


def test_nothing_hangs_over_the_side(visit: Visit) -> None:
    assert visit.page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


def test_labels_stay_within_their_figures(visit: Visit) -> None:
    overhang = visit.page.evaluate(
        """[...document.querySelectorAll('.figure')].flatMap(figure => {
             const frame = figure.getBoundingClientRect();
             return [...figure.querySelectorAll('.annotation-text, .legendtext, .ytitle, .xtitle')]
               .filter(label => {
                 const box = label.getBoundingClientRect();
                 return box.left < frame.left || box.right > frame.right
                   || box.top < frame.top || box.bottom > frame.bottom;
               }).map(label => figure.id + ': ' + label.textContent);
           })"""
    )
    assert overhang == []


def test_nothing_runs_out_of_its_card(visit: Visit) -> None:
    outside = visit.page.evaluate(
        """[...document.querySelectorAll('.block, .card, .notice, header')].flatMap(card => {
             const frame = card.getBoundingClientRect();
             return [...card.querySelectorAll('p, h1, h2, li, dd, .figure, .main-svg, .scroll')]
               .filter(part => {
                 const box = part.getBoundingClientRect();
                 return box.left < frame.left || box.right > frame.right + 0.5;
               }).map(part => card.id + ': ' + part.textContent.slice(0, 40));
           })"""
    )
    assert outside == []


def test_buttons_do_not_lie_under_the_menu(visit: Visit) -> None:
    overlaps = visit.page.evaluate(
        """[...document.querySelectorAll('.figure')].filter(figure => {
             const menu = figure.querySelector('.modebar').getBoundingClientRect();
             return [...figure.querySelectorAll('.updatemenu-button')].some(button => {
               const box = button.getBoundingClientRect();
               return box.right > menu.left && box.bottom > menu.top && box.top < menu.bottom;
             });
           }).map(figure => figure.id)"""
    )
    assert overlaps == []


def test_names_of_lines_cover_no_bar_no_button_and_no_other_name(visit: Visit) -> None:
    covered = visit.page.evaluate(
        """[...document.querySelectorAll('#figure-spectrum, #figure-bearing_spectrum')].flatMap(
             figure => {
               const notes = [...figure.querySelectorAll('.annotation-text')];
               const others = [...notes,
                 ...figure.querySelectorAll('.bars path, .updatemenu-button')];
               return notes.flatMap(note => {
                 const a = note.getBoundingClientRect();
                 return others.filter(other => {
                   const b = other.getBoundingClientRect();
                   return other !== note && a.left < b.right && b.left < a.right
                     && a.top < b.bottom && b.top < a.bottom;
                 }).map(other => figure.id + ': ' + note.textContent + ' ' + other.textContent);
               });
             })"""
    )
    assert covered == []
    assert visit.page.locator("#figure-spectrum .annotation-text").count() > 1
    legend = visit.page.locator("#figure-spectrum .legendtext").all_text_contents()
    assert any(name.endswith(" Hz") for name in legend)


def test_legends_stand_below_on_a_narrow_screen(visit: Visit) -> None:
    if visit.page.viewport_size["width"] >= 720:
        return
    legends_aside = visit.page.evaluate(
        """[...document.querySelectorAll('.figure')].filter(figure => {
             const plots = [...figure.querySelectorAll('.nsewdrag')]
               .map(part => part.getBoundingClientRect());
             return [...figure.querySelectorAll('.legend')].some(legend =>
               plots.some(plot => legend.getBoundingClientRect().top < plot.bottom));
           }).map(figure => figure.id)"""
    )
    assert legends_aside == []


def test_meanings_can_be_read(visit: Visit) -> None:
    widths = visit.page.evaluate(
        """[...document.querySelectorAll('#numbers tbody tr:not(.topic) td:last-child')]
             .map(cell => cell.getBoundingClientRect().width)"""
    )
    assert min(widths) > 200


def test_spectra_switch_to_a_logarithmic_scale(visit: Visit) -> None:
    figure = visit.page.locator("#figure-spectrum")
    kind = "document.getElementById('figure-spectrum')._fullLayout.yaxis2.type"
    figure.locator(".updatemenu-button", has_text="logarithmic").click()
    visit.page.wait_for_function(f"{kind} === 'log'")
    figure.locator(".updatemenu-button", has_text="linear").click()
    visit.page.wait_for_function(f"{kind} === 'linear'")
    assert visit.messages == []


def test_bodies_in_space_have_no_legend_on_a_narrow_screen(browser: Any, tmp_path: Path) -> None:
    machine = tribodyn.Case(
        gears={
            "z1": {"shaft": "in", "teeth": 20, "face_width": "50 mm"},
            "z2": {"shaft": "out", "teeth": 41, "face_width": "50 mm"},
        },
        meshes={"first": {"gears": ["z1", "z2"], "normal_module": "4 mm", "stiffness": 5e8}},
        operation={"input": "in", "output": "out", "speed": "1200 rpm", "torque": "100 N*m"},
    )
    page = browser.new_page(viewport={"width": 420, "height": 900})
    page.goto(write_report(tribodyn.run(machine), tmp_path / "report.html").as_uri())
    page.wait_for_function("document.querySelector('#figure-machine_space .main-svg')")
    assert page.evaluate("document.querySelectorAll('#figure-machine_space .legend').length") == 0
    assert "trace 0" not in page.content()
    page.close()
