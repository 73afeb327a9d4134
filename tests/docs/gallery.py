"""Record what the examples print and draw: ``python tests/docs/gallery.py [NUMBER ...]``."""

import contextlib
import functools
import io
import os
import re
import runpy
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from pages import ROOT

GALLERY = ROOT / "docs" / "gallery"
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def _laws(names: dict[str, Any]) -> Any:
    """Friction over sliding speed, a curve for each law."""
    import plotly.graph_objects as go

    rows = [line.split() for line in names["printed"].splitlines()[1:]]
    figure = go.Figure()
    for number, (name, *values) in enumerate(rows):  # colours come again after ten laws
        line, y = {"dash": "dash" if number > 9 else "solid"}, [float(x) for x in values]
        figure.add_scatter(x=names["sliding"], y=y, name=name, line=line)
    return figure.update_layout(
        template="plotly_white",
        margin={"t": 30},
        xaxis_title="sliding speed [m/s]",
        yaxis_title="friction coefficient",
    )


def _printed(names: dict[str, Any]) -> Any:
    """Printed and computed changes by friction in one chart."""
    import plotly.graph_objects as go

    rows = [r for r in names["found"].rows if r["table"] == "Table 3, change by friction"]
    where = [row["row"] for row in rows]
    bars = [
        go.Bar(x=where, y=[row[key] for row in rows], name=key) for key in ("printed", "computed")
    ]
    return go.Figure(bars).update_layout(template="plotly_white", yaxis_title="change [%]")


def _orbit(names: dict[str, Any]) -> Any:
    import plotly.graph_objects as go

    figure = go.Figure(go.Scatter(x=names["samples"].time * 1e3, y=names["force"]))
    return figure.update_layout(
        template="plotly_white", xaxis_title="time [ms]", yaxis_title="mesh force [N]"
    )


#: Pictures of the examples that write none: from the names that they leave.
DRAWN: dict[str, Callable[[dict[str, Any]], Any]] = {
    "01": lambda names: names["result"].plot_mesh_force(),
    "02": lambda names: names["result"].plot_bearing_force(),
    "03": _orbit,
    "04": _laws,
    "05": lambda names: names["contact"].plot(),
    "17": lambda names: names["result"].plot_transmission_error(),
    "19": _printed,
    "21": lambda names: names["result"].plot_hypoid_pressure(),
}
#: Figure that represents an example that writes several, instead of the first.
CHOSEN = {"15": "run-up-map", "16": "jump-basins", "18": "power-flow", "20": "learned"}


def masked(text: str) -> str:
    """What is printed without its numbers and its places, which differ between machines."""
    text = re.sub(r"( in )[^ :]+:", r"\1FOLDER:", text)
    return " ".join(_NUMBER.sub("#", text).split())


def record(example: Path, shoot: Callable[[Path, Path], None]) -> None:
    """Run one example and keep its text and a picture."""
    number, output = example.name[:2], io.StringIO()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        with contextlib.redirect_stdout(output):
            argv, sys.argv = sys.argv, [str(example)]
            names = runpy.run_path(str(example), run_name="__main__")
            sys.argv = argv
        text = output.getvalue()
        places = {**names, "printed": text}
        page = Path("picture.html")
        if number in DRAWN:
            DRAWN[number](places).write_html(page)
        else:
            pages_written = re.findall(r"([\w-]+)\.html", text)
            page = Path("figures") / f"{CHOSEN.get(number, pages_written[0])}.html"
        shoot(page.resolve(), GALLERY / f"{example.stem}.png")
        text = text.replace(os.path.realpath(folder), "here")
    (GALLERY / f"{example.stem}.txt").write_text(text, "utf-8")


@contextlib.contextmanager
def open_browser() -> Iterator[Any]:
    """Open a page of headless Chromium."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"]
        )
        yield browser.new_page(viewport={"width": 960, "height": 640})


def save_screenshot(page: Any, source: Path, target: Path) -> None:
    """Store a picture of a figure that was written as HTML."""
    from PIL import Image

    page.goto(source.as_uri())
    page.wait_for_selector(".main-svg")
    page.wait_for_timeout(500)
    page.screenshot(path=target, full_page=True)
    with Image.open(target) as image:
        image.convert("P", palette=Image.Palette.ADAPTIVE, colors=64).save(target, optimize=True)


def main(numbers: list[str]) -> None:
    """Record all examples, or those of some numbers."""
    with open_browser() as page:
        for example in EXAMPLES:
            if not numbers or example.name[:2] in numbers:
                record(example, functools.partial(save_screenshot, page))
                print(example.name)


if __name__ == "__main__":
    main(sys.argv[1:])
