"""Worker process of :mod:`tribodyn.app.jobs`: carries out one order from its standard input."""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any
from warnings import catch_warnings, simplefilter

from tribodyn.types import ByName, Tree

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase

#: Shortest time between two messages about progress [s].
_PAUSE = 0.15
#: Case that is computed while the process waits, so that all modules are loaded.
_FIRST = "fzg-roughness"

Tell = Callable[..., None]


class Teller:
    """Progress reporter that writes messages."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._next = tell, 0.0
        self._done = 0

    def start(self, task: str, total: int | None = None) -> None:
        """Begin a task."""
        self._done = 0
        self._tell(task=task, done=0, total=total)

    def advance(self, steps: int = 1) -> None:
        """Report the progress, at most once per pause."""
        self._done += steps
        now = time.monotonic()
        if now >= self._next:
            self._next = now + _PAUSE
            self._tell(done=self._done)

    def finish(self) -> None:
        """End a task."""


def main() -> None:
    """Get ready, wait for one order, and carry it out."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    channel = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # What a library prints is no message.
    orders: SimpleQueue[str] = SimpleQueue()
    threading.Thread(target=_listen, args=(orders,), daemon=True).start()

    def tell(**message: object) -> None:
        channel.write(json.dumps(message, allow_nan=False) + "\n")
        channel.flush()

    _get_ready(lambda: not orders.empty())
    _carry_out(json.loads(orders.get()), tell)


def _listen(orders: SimpleQueue[str]) -> None:
    """Pass on the order; exit when the page closes the stream."""
    for line in sys.stdin:
        orders.put(line)
    os._exit(1)


def _get_ready(wanted: Callable[[], bool]) -> None:
    from tribodyn.cases.load import load_case
    from tribodyn.errors import collected
    from tribodyn.report.figure_blocks import figure_blocks
    from tribodyn.study.pipeline.run import computed, rehearse

    with collected():
        case = load_case(_FIRST)
        for step in (lambda: rehearse(case), lambda: figure_blocks(computed(case))):
            if wanted():
                return
            step()
        import_module("h5py")  # to store what is found


def _carry_out(order: ByName, tell: Tell) -> None:
    from tribodyn.compiled import announcing_to
    from tribodyn.errors import TribodynError

    folder = Path(order["folder"])
    try:
        with announcing_to(lambda text: tell(task=text[:1].upper() + text[1:], done=0, total=None)):
            _KINDS[order["kind"]](order, folder, tell)
    except TribodynError as error:
        tell(state="failed", problems=[str(problem) for problem in error.problems])
    except Exception as error:
        what = f"unexpected {type(error).__name__}: {error}"[:500]
        tell(state="failed", problems=[f"{what}. This is a fault of tribodyn, not of the input."])


def _case(order: ByName) -> AnyCase:
    from tribodyn.study.machine.read import read_case

    case: AnyCase = read_case(order["case"], "case.toml")
    return case


def _run(order: Mapping[str, object], folder: Path, tell: Tell) -> None:
    """Compute a case, send its contents, and write the directory of ``tribodyn run``."""
    from tribodyn.cases.load import run
    from tribodyn.errors import collected
    from tribodyn.report.html import result_content

    with collected(), catch_warnings():  # the result has them
        simplefilter("ignore")
        result = run(_case(order), Teller(tell))  # type: ignore[arg-type]
    tell(task="Figures", done=0, total=None)
    content = result_content(result)
    tell(state="done", content={**content, "blocks": _written(content["blocks"], folder)}, task="")
    result.save(folder / "result")
    tell(saved=True)


def _written(blocks: Any, folder: Path) -> list[Tree]:
    """Write figures as files of a folder and return their descriptions."""
    for block in blocks:
        if block.json:
            (folder / f"{block.name}.json").write_text(block.json, encoding="utf-8")
    return [{k: v for k, v in vars(block).items() if k != "json"} for block in blocks]


def _overlay(order: ByName, folder: Path, tell: Tell) -> None:
    """Overlay stored results."""
    from tribodyn.cases.load import load_result
    from tribodyn.drawing import FIGURES
    from tribodyn.report.figure_blocks import block_of_figure
    from tribodyn.study.result_comparison import compare_results, difference_rows

    results = [load_result(place) for place in order["results"]]
    comparison = compare_results(*results, names=order["names"])
    chart = comparison.plot()
    figure: Any = FIGURES[comparison.results[0]._COMPARISON]
    block = block_of_figure(figure.name, figure.heading, chart, figure.caption_of(comparison))
    rows = list(difference_rows(comparison.values, comparison.figures))
    content = {
        "sentences": [] if rows else ["The results are equal."],
        "tables": [["What differs", ["", *comparison.names, "change"], rows]] if rows else [],
        "blocks": _written([block], folder),
    }
    tell(state="done", content=content, task="")


def _study(order: ByName, folder: Path, tell: Tell) -> None:
    """Compute a study, send its contents, and write the directory of its command."""
    from tribodyn.app.studies import compute
    from tribodyn.errors import ModelWarning, collected
    from tribodyn.report.figure_blocks import block_of_figure

    with collected() as warnings, catch_warnings(record=True) as of_runs:
        simplefilter("always")
        order_of_study = order["study"], _case(order), order["values"]
        content = compute(*order_of_study, Teller(tell), folder / "result")
    blocks = [
        block_of_figure(f"figure-{number}", heading, figure, caption)
        for number, (heading, figure, caption) in enumerate(content.pop("figures"), 1)
    ]
    model_warnings = [each.message for each in of_runs if isinstance(each.message, ModelWarning)]
    content["warnings"] = list(dict.fromkeys(map(str, [*warnings, *model_warnings])))
    tell(state="done", content={**content, "blocks": _written(blocks, folder)}, task="", saved=True)


_KINDS: dict[str, Callable[[ByName, Path, Tell], None]] = {
    "run": _run,
    "overlay": _overlay,
    "study": _study,
}


if __name__ == "__main__":
    main()
