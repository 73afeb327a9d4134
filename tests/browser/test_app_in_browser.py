"""The page in a real browser: the whole job, without a mouse, narrow, and when things go wrong."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("dash", reason="the page needs Dash")

from tests.unit.study.test_machine_run import GEARED

import tribodyn
from tribodyn.app.server import Page

pytestmark = [pytest.mark.browser, pytest.mark.slow]

#: A case with long cycles, for a run that is still going on when it is stopped.
LONG = {"solver.method": "transient", "solver.cycles": 100000}
WAIT = 120_000
#: A machine without load cases.
MACHINE = GEARED.partition("[[load_cases]]")[0]


#: What the browser says of the speed with which any figure in space is drawn.
DRAWING = "willReadFrequently", "GPU stall due to ReadPixels"


class Visit:
    """A tab of the browser, and what it had to say."""

    def __init__(self, context: Any, page: Page) -> None:
        self.tab = context.new_page()
        self.tab.set_default_timeout(WAIT)
        self.messages: list[str] = []
        self.requests: list[str] = []
        self.tab.on("console", lambda message: self.note(message.text))
        self.tab.on("pageerror", lambda error: self.messages.append(str(error)))
        self.tab.on("request", lambda request: self.requests.append(request.url))
        self.tab.goto(page.address)
        self.wait_for_drawing()

    def note(self, text: str) -> None:
        """Keep a message of the page; advice of the browser on drawing in space is none."""
        if not any(advice in text for advice in DRAWING):
            self.messages.append(text)

    def wait_for_drawing(self) -> None:
        self.tab.wait_for_selector("#bench .main-svg")
        self.tab.wait_for_selector("#case-form .field:visible")

    def fill(self, key: str, text: str) -> None:
        self.tab.fill(f"#case-{key.replace('.', '-')}", text)

    def wait(self, selector: str, text: str = "") -> Any:
        element = self.tab.locator(selector, has_text=text).first
        element.wait_for(state="visible")
        return element

    def run(self, number: int) -> None:
        self.tab.click("#run")
        self.wait(f"[role=tab]:has-text('Run {number}') .state", "done")
        self.wait("#bench .topics")
        self.tab.wait_for_selector("#bench .main-svg")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("desk")


@pytest.fixture(scope="module")
def served(folder: Path) -> Iterator[Page]:
    (folder / "long.toml").write_text(tribodyn.load_case("fzg-roughness").replace(LONG).to_toml())
    page = Page(folder, "fzg-roughness")
    thread = threading.Thread(target=page.serve, daemon=True)
    thread.start()
    yield page
    page.close()
    thread.join(10)
    assert not thread.is_alive()


@pytest.fixture(scope="module")
def context(browser: Any) -> Iterator[Any]:
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    yield context
    context.close()


@pytest.fixture(scope="module")
def visit(context: Any, served: Page) -> Visit:
    return Visit(context, served)


def test_a_case_is_changed_run_laid_over_and_saved(visit: Visit, folder: Path) -> None:
    tab = visit.tab
    visit.run(1)
    for topic, heading in (("Gears", "The gear pair"), ("All numbers", "All numbers")):
        tab.click(f".topics >> text={topic}")
        visit.wait("[role=tabpanel] h3", heading)
    visit.fill("operation.torque", "120")
    tab.click("#tab-pair")
    visit.wait(".card:has-text('Line load')", "177.4")
    visit.run(2)
    visit.wait(".runs li", "Torque 120 N*m")
    visit.wait("#tools button", "Save files")
    tab.click("[aria-label='Overlay Run 1']")
    tab.click("[aria-label='Overlay Run 2']")
    visit.wait("[aria-label='Overlay Run 2'][aria-pressed=true]")
    tab.click("text=Overlay runs")
    visit.wait("#bench h3", "Comparison of results")
    tab.wait_for_selector("#bench .main-svg")
    tab.click("text=What differs")
    visit.wait("#bench td", "operation.torque")
    tab.click("#tab-files")
    tab.fill("#case-name", "mine")
    tab.click("#save")
    visit.wait("#notice", "saved as mine.toml")
    assert tribodyn.load_case(folder / "mine.toml").operation.torque == 120.0
    tab.click("[role=tab]:has-text('Run 2')")
    tab.fill("#result-name", "mine-run")
    tab.click("text=Save files")
    visit.wait("#notice", "Saved in mine-run")
    assert tribodyn.load_result(folder / "mine-run").case.operation.torque == 120.0


def test_a_reload_preserves_the_session(visit: Visit) -> None:
    visit.tab.reload()
    visit.wait("[role=tab]", "Run 2")
    assert visit.tab.input_value("#case-operation-torque") == "120"


def test_a_wrong_value_is_reported_next_to_its_field(visit: Visit) -> None:
    tab = visit.tab
    tab.click("#tab-pair")
    visit.fill("operation.speed", "15 Hz")
    message = visit.wait("#case-operation-speed-fault", "rotational speed").inner_text()
    with pytest.raises(tribodyn.errors.InputError) as refused:
        tribodyn.load_case("fzg-roughness").replace({"operation.speed": "15 Hz"}, by="form")
    assert refused.value.problems[0].what in message
    assert tab.get_attribute("#case-operation-speed", "aria-invalid") == "true"
    tab.click("#run")
    visit.wait("#notice", "Correct the marked fields")
    visit.fill("operation.speed", "900")
    tab.wait_for_selector("#case-operation-speed[aria-invalid=false]")


def test_a_wrong_value_dims_the_figures_and_marks_its_closed_box(visit: Visit) -> None:
    tab = visit.tab
    opacity = "getComputedStyle(document.querySelector('#bench .main-svg').closest('{}')).opacity"
    visit.fill("operation.torque", "-5")
    visit.wait("#bench h3", "out of date")
    tab.wait_for_selector("#bench .outdated .main-svg")
    assert float(tab.evaluate(opacity.format(".outdated"))) < 0.6
    mark = "getComputedStyle(document.querySelector('#case-table-operation .title'), '::after')"
    assert tab.evaluate(f"{mark}.content") == "none"
    tab.click("#case-table-operation")
    tab.wait_for_function(f"{mark}.content.includes('invalid')")
    badge = tab.locator("#case-values-operation")
    assert (badge.inner_text(), badge.is_visible()) == ("4 values", True)
    tab.click("#case-table-operation")
    badge.wait_for(state="hidden")
    visit.fill("operation.torque", "120")
    tab.wait_for_selector("#case-operation-torque[aria-invalid=false]")
    visit.wait_for_drawing()
    assert tab.locator("#bench .outdated").count() == 0


def test_a_message_disappears_unless_it_is_an_error(visit: Visit) -> None:
    tab = visit.tab
    tab.click("#tab-files")
    tab.fill("#case-name", "again")
    tab.click("#save")
    visit.wait("#notice p.good", "saved as again.toml")
    tab.locator("#notice").wait_for(state="hidden")
    tab.click("#save")
    visit.wait("#notice p.bad", "again.toml")
    tab.wait_for_timeout(7500)  # longer than a message stays
    assert tab.is_visible("#notice")
    tab.keyboard.press("Escape")
    tab.locator("#notice").wait_for(state="hidden")
    tab.click("[data-do=replace]")
    visit.wait("#notice p.good", "saved as again.toml")
    tab.click("#tab-pair")


def test_another_unit_leaves_the_value(visit: Visit) -> None:
    visit.tab.select_option("[aria-label='Unit of Torque']", "kN*m")
    visit.tab.wait_for_function("document.getElementById('case-operation-torque').value === '0.12'")
    visit.tab.select_option("[aria-label='Unit of Torque']", "N*m")
    visit.tab.wait_for_function("document.getElementById('case-operation-torque').value === '120'")
    assert visit.tab.get_attribute("#case-operation-torque", "aria-invalid") == "false"


def test_another_model_brings_its_options(visit: Visit) -> None:
    tab = visit.tab
    tab.click("summary:has-text('Friction')")
    assert tab.locator("#case-friction-coefficient").count() == 0
    tab.focus("#case-friction-law")
    tab.select_option("#case-friction-law", "constant")
    visit.wait("#case-friction-coefficient")
    assert tab.evaluate("document.activeElement.id") == "case-friction-law"


def test_a_long_run_outlives_a_reload_and_is_stopped(visit: Visit) -> None:
    tab = visit.tab
    tab.click("#tab-files")
    tab.click("text=long.toml")
    visit.wait("#notice", "long.toml is open")
    tab.click("#run")
    visit.wait("#stop")
    tab.reload()
    visit.wait(".progress progress")
    tab.click("#stop")
    visit.wait("#bench", "It was stopped")
    tab.click("text=Remove Run 3")
    visit.wait_for_drawing()
    assert tab.locator("[role=tab]", has_text="Run 3").count() == 0


def test_a_study_is_started(visit: Visit) -> None:
    tab = visit.tab
    tab.click("#tab-studies")
    tab.click("[data-of=modes]")
    visit.wait("#study-form .field")
    tab.click("#start")
    visit.wait("[role=tab]:has-text('Natural modes') .state", "done")
    visit.wait("#bench h3", "Natural modes")
    tab.wait_for_selector("#bench .main-svg")
    assert "Hz" in tab.inner_text("#bench")


def test_a_machine_is_opened_changed_and_run(context: Any, served: Page, folder: Path) -> None:
    (folder / "shafts.toml").write_text(MACHINE, encoding="utf-8")
    visit = Visit(context, served)
    tab = visit.tab
    tab.click("#tab-files")
    tab.click("text=two-stage-spur")
    visit.wait("#bench h3", "The machine")
    visit.wait("#tab-pair", "Machine")
    tab.click("#tab-files")
    tab.click("text=shafts.toml")
    visit.wait("#title", "Two geared shafts")
    visit.fill("operation.torque", "500")
    visit.wait("#bench p.answer", "500 N")
    visit.run(1)
    tab.click("[role=tab]:has-text('All numbers')")
    visit.wait("#bench h3", "Bearings")
    visit.wait("text=Report")
    assert not visit.messages
    tab.close()


def test_a_script_in_a_title_stays_text(visit: Visit) -> None:
    text = "<img src=x onerror='window.owned=1'><script>window.owned=1</script>"
    tab = visit.tab
    tab.click("#tab-files")
    tab.click("[data-of='case:fzg-roughness']")
    visit.wait_for_drawing()
    tab.evaluate("document.querySelector('summary').click()")
    visit.fill("title", text)
    visit.wait("#title", "<script>")
    visit.run(tab.locator(".runs li").count() + 1)
    tab.click("text=All numbers")
    assert tab.evaluate("window.owned") is None
    assert tab.inner_text("#title").startswith("<img")
    visit.wait("#tools a", "Report")
    with tab.context.expect_page() as opened:
        tab.click("#tools a")
    report = opened.value
    report.wait_for_selector(".main-svg")
    assert report.evaluate("window.owned") is None
    report.close()


def test_two_tabs_have_a_case_each(visit: Visit, context: Any, served: Page) -> None:
    second = Visit(context, served)
    second.fill("operation.torque", "33")
    second.tab.click("#tab-pair")
    second.wait(".card:has-text('Line load')", "48.7")
    assert visit.tab.input_value("#case-operation-torque") != "33"
    assert second.tab.locator("[role=tab]", has_text="Run").count() == 0
    second.tab.close()


def test_everything_has_a_label(visit: Visit) -> None:
    nameless = visit.tab.evaluate(
        """[...document.querySelectorAll('input, select, button, progress')].filter(node => {
             const label = node.getAttribute('aria-label') || node.textContent.trim();
             return !(node.labels?.length || label || node.title);
           }).map(node => node.outerHTML.slice(0, 80))"""
    )
    assert nameless == []
    assert visit.tab.locator("#case-form label").count() > 30


def test_the_keyboard_is_enough(context: Any, served: Page) -> None:
    visit = Visit(context, served)
    tab = visit.tab

    def to(target: str) -> None:
        for _ in range(80):
            tab.keyboard.press("Tab")
            if tab.evaluate(f"document.activeElement.matches({target!r})"):
                return
        raise AssertionError(f"Tab does not reach {target}")

    to("#case-gears-pinion-teeth")
    tab.keyboard.press("Control+A")
    tab.keyboard.type("16")
    to("#case-operation-torque")
    tab.keyboard.press("Control+A")
    tab.keyboard.type("80")
    to("#tab-pair")
    tab.keyboard.press("ArrowRight")
    visit.wait("#case-name")
    tab.keyboard.press("Control+Enter")
    visit.wait("[role=tab] .state", "done")
    visit.wait("#bench .topics")
    assert tab.input_value("#case-operation-torque") == "80"
    tab.close()


@pytest.mark.parametrize("width", [1280, 480])
def test_nothing_hangs_over_the_side(visit: Visit, width: int) -> None:
    tab = visit.tab
    tab.set_viewport_size({"width": width, "height": 900})
    for view in ("pair", "files", "studies"):
        tab.click(f"#tab-{view}")
        visit.wait(f"#tab-{view}[aria-selected=true]")
        assert tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


def test_the_console_is_silent_and_nothing_is_requested_from_outside(
    visit: Visit, served: Page
) -> None:
    assert visit.messages == []
    allowed = (f"http://127.0.0.1:{served.port}/", "data:", "blob:")
    assert [url for url in visit.requests if not url.startswith(allowed)] == []
