"""State of one browser tab: its case, typed text that is not valid yet, and its jobs."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from tribodyn.app.case_form import CaseForm, key_label
from tribodyn.app.jobs import Job, Jobs
from tribodyn.app.studies import (
    STUDIES,
    first_names,
    first_values,
    form_of,
    numeric_keys,
    offered,
    with_paths,
)
from tribodyn.app.workspace import Workspace
from tribodyn.cases.catalogue import cases
from tribodyn.cases.load import load_case
from tribodyn.errors import InputError, TribodynError, collected
from tribodyn.model import Option
from tribodyn.study.result_comparison import differing
from tribodyn.types import ByName, Tree
from tribodyn.units import UnitProblemError, format_quantity, parse, split
from tribodyn.validated_files import plain_number

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase


#: Greatest number of runs, and of studies, of a tab.
RUNS = 6
#: Characters that a value may have.
_LONGEST = 10_000
#: Origin of a change, in messages.
_BY = "form"


class Edited(NamedTuple):
    """A case that was opened, and the changes since, each a call of ``replace``."""

    opened: Any
    file: str  #: name in the folder; empty for a built-in or a new case
    changes: tuple[ByName, ...] = ()

    def follows(self, other: Edited | None) -> bool:
        """Whether it is another state with further changes."""
        if other is None or other.opened is not self.opened:
            return False
        return self.changes[: len(other.changes)] == other.changes


class TabSession:
    """State of one tab; every request holds the lock while it reads or changes the state."""

    def __init__(self, folder: Workspace, jobs: Jobs, case: AnyCase, name: str = "") -> None:
        self.lock = threading.RLock()
        self.folder, self.jobs = folder, jobs
        self.runs: list[Job] = []
        self.studies: list[Job] = []
        self.overlay: Job | None = None
        self.picked: list[int] = []  #: runs that are selected for the overlay
        self.view, self.topic, self.study = "pair", "", ""  #: the view "pair" is that of the case
        self.values: dict[str, dict[str, str]] = {}  #: of studies, by kind
        self._acted = 0
        self.notice, self.bad = "", False  #: of the last request
        self.notice_count = 0  #: notices so far
        self.edits = 0  #: changes of the form so far
        self._numbers: dict[str, int] = {}
        self.edited: dict[int, Edited] = {}  #: cases of the jobs, as the script makes them
        self.take(case, name)

    def take(self, case: AnyCase, name: str) -> None:
        """Replace the case and clear the form."""
        self.case: AnyCase = case
        self.name = name
        self._made, self._open_change, self._before = Edited(case, name), False, case
        if self.study and not offered(self.study, case):
            self.study = ""
        self.values = {  # with the meshes and sensors of this case
            kind: {**values, **first_names(kind, case)}
            for kind, values in self.values.items()
            if offered(kind, case)
        }
        self.typed: dict[str, str] = {}
        self.units: dict[str, str] = {}
        self.faults: list[dict[str, str]] = []
        self.edits += 1

    def edits_of_case(self) -> Edited:
        """The case in the form, as the script makes it."""
        return self._made

    def _change(self, changes: ByName) -> None:
        """Change the case; one step of the script takes edits as long as it gives the same case."""
        with collected():
            case = self.case.replace(changes, by=_BY)
            steps = list(self._made.changes)
            if self._open_change and steps:
                try:
                    merged = {**steps[-1], **changes}
                    if self._before.replace(merged, by=_BY) == case:
                        changes = merged
                        steps.pop()
                except InputError:
                    pass
        self._before = self._before if len(steps) < len(self._made.changes) else self.case
        self._made = self._made._replace(changes=(*steps, dict(changes)))
        self.case, self._open_change = case, True

    @property
    def form(self) -> CaseForm:
        """The form of the case."""
        return CaseForm(self.case, self.typed, self.units)

    @property
    def job_in_view(self) -> Job | None:
        """Job in the current view."""
        return next((j for j in self.all_jobs() if self.view == f"job-{j.number}"), None)

    def edit(self, event: Mapping[str, object]) -> None:
        """Apply an edit of a form field and check the case with it."""
        key, number = str(event.get("key", "")), number_of(event.get("number"))
        if event.get("form") == "study":
            if self.study and key in STUDIES[self.study].options and "value" in event:
                self.values[self.study][key] = str(event["value"])[:_LONGEST].strip()
            return
        option = self.form.options().get(key)
        if option is None or number <= self._numbers.get(key, -1):
            return  # The field belongs to another model, or a later edit came first.
        self._numbers[key] = number
        self.edits += 1
        unit = str(event.get("unit") or option.display_unit)
        if "value" in event:
            self.typed[key] = _with_unit(option, str(event["value"])[:_LONGEST].strip(), unit)
            if unit:
                self.units[key] = unit
        elif option.unit:
            self._switch(key, option, unit)
        form_options = self.form.options()
        self.typed = {each: text for each, text in self.typed.items() if each in form_options}
        self._check_typed(form_options)

    def fresh(self, number: int) -> bool:
        """Whether an action is new; mark it as done."""
        newer = number > self._acted
        self._acted = max(number, self._acted)
        return newer

    def forms(self) -> Tree:
        """The forms of the page as data."""
        form = self.form
        form_data: Tree = {"case": {"groups": form.groups(), "faults": self.faults}}
        if self.study:
            keys = numeric_keys(form.options())
            form_data["study"] = form_of(self.study, self.values[self.study], self.case, keys)
        return form_data

    def choose_study(self, kind: str) -> None:
        """Select a kind of study."""
        if kind in STUDIES and offered(kind, self.case):
            self.study = kind
            self.values.setdefault(kind, first_values(kind, self.case))

    def start_study(self) -> None:
        """Start the selected study."""
        self._refuse_faults()
        if not self.study:
            raise InputError("no study is chosen", "", "", "Choose one from the list")
        if len(self.studies) >= RUNS:
            what = f"the limit of {RUNS} studies is reached"
            remedy = "Remove one that you no longer need"
            raise InputError(what, "", "", remedy)
        order = {
            "case": self.case.to_toml(),
            "study": self.study,
            "values": with_paths(self.study, self.values[self.study], self.folder),
        }
        job = self._start("study", STUDIES[self.study].title, order)
        self.studies.append(job)
        self.view = f"job-{job.number}"

    def case_of(self, number: int) -> None:
        """Edit the case of a run."""
        job = self.job(number)
        if job is not None:
            self.take(job.case, self.name)
            self._made = self.edited[number]
            self.view = "pair"
            self.tell(f"This is the case of {job.title}.")

    def take_relief(self, number: int) -> None:
        """Apply the flanks that a study found to the case; its other values stay the same."""
        job = self.job(number)
        relief = job.content.get("relief") if job is not None else None
        if not relief:
            return
        self._refuse_faults()
        self._change(relief)
        self.edits += 1
        self.view = "pair"
        gears = list(dict.fromkeys(key.split(".")[1] for key in relief))
        of = {key.rpartition(".")[2]: value for key, value in relief.items()}
        if "tip_relief" in of:
            what = f"a tip relief of {of['tip_relief']} over {of['tip_relief_length']}"
        else:
            what = f"a crowning of {of['crowning']} and a lead slope of {of['lead_slope']}"
        self.tell(f"The case has {what} now: {' and '.join(gears)}. It is not saved yet.")

    def _switch(self, key: str, option: Option, unit: str) -> None:
        """Display a value in another unit without changing it."""
        self.units[key] = unit
        text = self.typed.get(key)
        if text:
            try:
                self.typed[key] = format_quantity(parse(text, option.unit), option.unit, unit)
            except UnitProblemError:
                number = text.partition(" ")[0]
                self.typed[key] = f"{number} {unit}"

    def _check_typed(self, options: Mapping[str, Option]) -> None:
        """Check the case with all typed values; if valid, it replaces the current case."""
        changes: Tree = {}
        self.faults = []
        for key, text in self.typed.items():
            try:
                changes[key] = self._case_value(options[key], text)
            except InputError as error:
                self.faults.append(_fault(key, error))
        if self.faults:
            return
        try:
            self._change(changes)
            self.typed = {}
        except InputError as error:
            for problem in error.problems:
                key = str(problem.where).rpartition(" ")[2]
                key = key if key in options else ""
                self.faults.append(_fault(key, InputError(problem)))

    def _case_value(self, option: Option, text: str) -> Any:
        """Convert typed text to the value of a case file."""
        if not text:
            return None
        if option.kind == "file":
            return str(self.folder.inside(text))
        if option.kind == "flag":
            return text == "true"
        if option.kind == "numbers" or (option.pair and "," in text):
            return [_plain(option, item.strip()) for item in text.split(",")]
        return _plain(option, text) if option.kind in ("number", "integer") else text

    def tell(self, text: str, bad: bool = False) -> None:
        """Display a message about the last request."""
        self.notice, self.bad = text, bad
        self.notice_count += 1

    def open(self, name: str) -> None:
        """Open a built-in case or one of the folder."""
        kind, _, place = name.partition(":")
        if kind == "file":
            self.take(self.folder.load(place), place)
        elif place in cases(machines=True) or not place:
            self.take(initial_case(self.folder, place)[0], "")
        else:
            raise InputError(f'no built-in case is called "{place}"')
        self.view = "pair"
        self.tell(f"{place or 'A new case'} is open.")

    def save(self, name: str, force: bool) -> None:
        """Write the case into the folder."""
        self._refuse_faults()
        place = self.folder.save_case(self.case, name, force)
        self.name = self.folder.relative_name(place)
        self.tell(f"The case is saved as {self.name}.")

    def save_job(self, number: int, name: str) -> None:
        """Write the directory of results of a job into the folder."""
        job = self.job(number)
        if job is None or not job.saved:
            why = "Its files are still being written" if job and job.state == "done" else ""
            raise InputError("the job has no files yet", "", why, "Try again in a moment")
        place = self.folder.save_result(job.result, name)
        self.tell(f"Saved in {self.folder.relative_name(place)}.")

    def run(self) -> None:
        """Compute the case."""
        self._refuse_faults()
        if len(self.runs) >= RUNS:
            remedy = "Remove one that you no longer need"
            raise InputError(f"the limit of {RUNS} runs is reached", "", "", remedy)
        order = {"case": self.case.to_toml()}
        job = self._start("run", f"Run {self._unused_number()}", order)
        self.runs.append(job)
        self.view = f"job-{job.number}"

    def _unused_number(self) -> int:
        used_titles = {job.title for job in self.runs}
        return next(n for n in range(1, RUNS + 2) if f"Run {n}" not in used_titles)

    def _start(self, kind: str, title: str, order: Mapping[str, object]) -> Job:
        job = self.jobs.start(kind, title, order, self.case)
        if job is None:
            why = "Too many computations wait already"
            raise InputError("this cannot be computed now", "", why, "Stop one of them, or wait")
        self.edited[job.number], self._open_change = self._made, False
        return job

    def overlay_runs(self) -> None:
        """Overlay the selected runs."""
        runs = [job for job in self.runs if job.number in self.picked]
        if len(runs) < 2 or not all(job.saved for job in runs):
            why = "" if len(runs) < 2 else "The files of one of them are still being written"
            remedy = "Try again in a moment" if why else "Pick them in the list of runs"
            raise InputError("two finished runs are needed", "", why, remedy)
        if self.overlay is not None:
            self.jobs.forget(self.overlay)
        order = {"results": [str(j.result) for j in runs], "names": [j.title for j in runs],
                 "numbers": [j.number for j in runs]}  # fmt: skip
        self.overlay = self._start("overlay", "Overlay", order)
        self.view = f"job-{self.overlay.number}"

    def pick(self, number: int) -> None:
        """Select a run for the overlay, or deselect it."""
        if number in self.picked:
            self.picked.remove(number)
        elif any(job.number == number for job in self.runs):
            self.picked.append(number)

    def stop(self, number: int) -> None:
        """Stop a job."""
        job = self.job(number)
        if job is not None:
            self.jobs.stop(job)

    def remove(self, number: int) -> None:
        """Stop a job and delete it."""
        job = self.job(number)
        if job is None:
            return
        self.jobs.forget(job)
        self.runs = [each for each in self.runs if each is not job]
        self.studies = [each for each in self.studies if each is not job]
        self.picked = [each for each in self.picked if each != number]
        self.overlay = None if self.overlay is job else self.overlay
        self.view = "pair"

    def job(self, number: int) -> Job | None:
        """Return the job with a number, or None."""
        return next((job for job in self.all_jobs() if job.number == number), None)

    def all_jobs(self) -> list[Job]:
        """All its jobs."""
        return [*self.runs, *self.studies, *([self.overlay] if self.overlay else [])]

    @property
    def busy(self) -> bool:
        """Whether a job is still running or writing files."""
        return any(not job.settled for job in self.all_jobs())

    def changes(self, job: Job) -> list[str]:
        """Differences of the case of a run from that of the first run."""
        if job not in self.runs[1:]:
            return []
        differences = differing([dict(each.case.values()) for each in (self.runs[0], job)])
        texts = []
        for key, (_, value) in differences.items():
            option = self.case.option_of(key)
            value_text = (
                "default" if value is None else option.show(value) if option else str(value)
            )
            texts.append(f"{key_label(key)} {value_text}")
        return texts

    def close(self) -> None:
        """Stop and delete all its jobs."""
        for job in self.all_jobs():
            self.jobs.forget(job)

    def _refuse_faults(self) -> None:
        if self.faults:
            count = len(self.faults)
            what = f"{count} value{'s are' if count > 1 else ' is'} invalid"
            raise InputError(what, "", "", "Correct the marked fields first")


def _fault(key: str, error: TribodynError) -> dict[str, str]:
    """Data of an error message at its form field."""
    problem = error.problems[0]
    parts = (p.rstrip(".") for p in (problem.what, problem.why, problem.remedy) if p)
    text = " ".join(p if p.endswith("?") else f"{p}." for p in parts)
    return {"key": key, "label": key_label(key) if key else "", "text": text}


def number_of(value: object) -> int:
    """Whole number that a request counts with; 0 for anything else."""
    return value if isinstance(value, int) else 0


def _with_unit(option: Option, text: str, unit: str) -> str:
    """Append the unit of the field to a number without unit."""
    if option.kind != "number" or not option.unit or not text:
        return text
    try:
        return text if split(text)[1] else f"{text} {unit}"
    except UnitProblemError:
        return text


def _plain(option: Option, text: str) -> Any:
    """Convert a number without dimension; return anything else as text for the check."""
    if option.unit:
        return text
    number = plain_number(text)
    is_integer = number is not None and option.kind == "integer" and float(number).is_integer()
    return int(number) if is_integer and number is not None else text if number is None else number


def initial_case(folder: Workspace, requested: str) -> tuple[AnyCase, str]:
    """Load the case of ``tribodyn app``: built-in, a file of the folder, or a new one."""
    from tribodyn.study.case.reference import start_toml
    from tribodyn.study.machine.read import read_case

    if not requested:
        return read_case(start_toml(), "case.toml"), ""
    if requested in cases(machines=True) or not Path(requested).exists():
        return load_case(requested), ""  # raises with a list of cases if the name is unknown
    place = Path(requested).resolve()
    if not place.is_relative_to(folder.root):
        why = f"The page reads and writes only in {folder.root}"
        remedy = f'Start it with --folder "{place.parent}"'
        raise InputError(f"{requested} lies outside of the folder", "CASE", why, remedy)
    name = folder.relative_name(place)
    return folder.load(name), name
