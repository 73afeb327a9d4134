"""One tab of the browser: its case, what was typed and is not in it yet, and its computations."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.app.case_form import CaseForm, words
from tribodyn.app.jobs import Job, Jobs
from tribodyn.app.studies import STUDIES, first_values, form_of, numeric_keys
from tribodyn.app.workspace import Folder
from tribodyn.cases.catalogue import case_files
from tribodyn.cases.load import load_case
from tribodyn.errors import InputError, TribodynError, collected
from tribodyn.model import Option
from tribodyn.study.case.provenance import spec_of
from tribodyn.study.result_comparison import differing
from tribodyn.units import UnitProblemError, format_quantity, parse, split
from tribodyn.validated_files import plain_number

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case

#: Runs, and studies, that a desk keeps.
RUNS = 6
#: Characters that a value may have.
_LONGEST = 10_000
#: Amount and length of a tip relief.
_GEARS = ("pinion", "wheel")
_RELIEF = ("tip_relief", "tip_relief_length")
#: Who asks for a change, in messages.
_BY = "form"


class Desk:
    """What one tab works on. Every request holds the lock while it reads or changes it."""

    def __init__(self, folder: Folder, jobs: Jobs, case: Case, name: str = "") -> None:
        self.lock = threading.RLock()
        self.folder, self.jobs = folder, jobs
        self.runs: list[Job] = []
        self.studies: list[Job] = []
        self.overlay: Job | None = None
        self.picked: list[int] = []  #: runs that are laid over each other
        self.view, self.topic, self.study = "pair", "", ""
        self.values: dict[str, dict[str, str]] = {}  #: of studies, by kind
        self._acted = 0
        self.notice, self.bad = "", False  #: what the last request came to
        self.told = 0  #: notices so far
        self.edits = 0  #: changes of the form so far
        self._numbers: dict[str, int] = {}
        self.take(case, name)

    def take(self, case: Case, name: str) -> None:
        """Put another case on the desk."""
        self.case, self.name = case, name
        self.typed: dict[str, str] = {}
        self.units: dict[str, str] = {}
        self.faults: list[dict[str, str]] = []
        self.edits += 1

    @property
    def form(self) -> CaseForm:
        """The form of the case."""
        return CaseForm(self.case, self.typed, self.units)

    @property
    def job_in_view(self) -> Job | None:
        """The job that is looked at."""
        return next((j for j in self.jobs_here() if self.view == f"job-{j.number}"), None)

    def edit(self, told: Mapping[str, Any]) -> None:
        """Take down what was typed into a field, and check the case with it."""
        key, number = str(told.get("key", "")), int(told.get("number", 0))
        if told.get("form") == "study":
            if self.study and key in STUDIES[self.study].options and "value" in told:
                self.values[self.study][key] = str(told["value"])[:_LONGEST].strip()
            return
        option = self.form.options().get(key)
        if option is None or number <= self._numbers.get(key, -1):
            return  # It belongs to another model, or a later one has overtaken it.
        self._numbers[key] = number
        self.edits += 1
        unit = str(told.get("unit") or option.display_unit)
        if "value" in told:
            self.typed[key] = _with_unit(option, str(told["value"])[:_LONGEST].strip(), unit)
            if unit:
                self.units[key] = unit
        elif option.unit:
            self._switch(key, option, unit)
        shown = self.form.options()
        self.typed = {each: text for each, text in self.typed.items() if each in shown}
        self._judge(shown)

    def fresh(self, number: int) -> bool:
        """Whether an act has not been done yet; from now on it has."""
        newer = number > self._acted
        self._acted = max(number, self._acted)
        return newer

    def forms(self) -> dict[str, Any]:
        """The forms of the page as data."""
        form = self.form
        shown: dict[str, Any] = {"case": {"groups": form.groups(), "faults": self.faults}}
        if self.study:
            keys = numeric_keys(form.options())
            shown["study"] = form_of(self.study, self.values[self.study], keys)
        return shown

    def choose_study(self, kind: str) -> None:
        """Choose what kind of study to start."""
        if kind in STUDIES:
            self.study = kind
            self.values.setdefault(kind, first_values(kind, self.case))

    def start_study(self) -> None:
        """Start the study that is chosen."""
        self._refuse_faults()
        if not self.study:
            raise InputError("no study is chosen", "", "", "Choose one from the list")
        if len(self.studies) >= RUNS:
            what, remedy = f"{RUNS} studies are kept already", "Remove one that you no longer need"
            raise InputError(what, "", "", remedy)
        order = {
            "case": self.case.to_toml(),
            "study": self.study,
            "values": self.values[self.study],
        }
        job = self._start("study", STUDIES[self.study].title, order)
        self.studies.append(job)
        self.view = f"job-{job.number}"

    def case_of(self, number: int) -> None:
        """Go on with the case of a run."""
        job = self.job(number)
        if job is not None:
            self.take(job.case, self.name)
            self.view = "pair"
            self.tell(f"This is the case of {job.title}.")

    def take_relief(self, number: int) -> None:
        """Put the tip relief of a study into the case; its other values stay as they are."""
        job = self.job(number)
        relief = job.shown.get("relief") if job is not None else None
        if not relief:
            return
        self._refuse_faults()
        with collected():
            self.case = self.case.replace(relief, by=_BY)
        self.edits += 1
        self.view = "pair"
        gears = [g for g in _GEARS if f"gears.{g}.modification.tip_relief" in relief]
        values = [relief[f"gears.{gears[0]}.modification.{name}"] for name in _RELIEF]
        of = " over ".join(values)
        self.tell(
            f"The case has a tip relief of {of} now: {' and '.join(gears)}. Save it to keep it."
        )

    def _switch(self, key: str, option: Option, unit: str) -> None:
        """Show a value in another unit; the value stays what it is."""
        self.units[key] = unit
        text = self.typed.get(key)
        if text:
            try:
                self.typed[key] = format_quantity(parse(text, option.unit), option.unit, unit)
            except UnitProblemError:
                number = text.partition(" ")[0]
                self.typed[key] = f"{number} {unit}"

    def _judge(self, options: Mapping[str, Option]) -> None:
        """Check the case with all that was typed; where it holds, it is the case from now on."""
        changes: dict[str, Any] = {}
        self.faults = []
        for key, text in self.typed.items():
            try:
                changes[key] = self._meant(options[key], text)
            except InputError as error:
                self.faults.append(_fault(key, error))
        if self.faults:
            return
        try:
            with collected():
                self.case = self.case.replace(changes, by=_BY)
            self.typed = {}
        except InputError as error:
            for problem in error.problems:
                key = str(problem.where).rpartition(" ")[2]
                key = key if key in options else ""
                self.faults.append(_fault(key, InputError(problem)))

    def _meant(self, option: Option, text: str) -> Any:
        """The value of a case file that a text stands for."""
        if not text:
            return None
        if option.kind == "file":
            return str(self.folder.inside(text))
        if option.kind == "flag":
            return text == "true"
        if option.kind == "numbers":
            return [_plain(option, item.strip()) for item in text.split(",")]
        return _plain(option, text) if option.kind in ("number", "integer") else text

    def tell(self, text: str, bad: bool = False) -> None:
        """Say what came of a request."""
        self.notice, self.bad = text, bad
        self.told += 1

    def open(self, name: str) -> None:
        """Take a built-in case, or one of the folder."""
        kind, _, place = name.partition(":")
        if kind == "file":
            self.take(self.folder.load(place), place)
        elif place in case_files() or not place:
            self.take(at_start(self.folder, place)[0], "")
        else:
            raise InputError(f'no built-in case is called "{place}"')
        self.view = "pair"
        self.tell(f"{place or 'A new case'} is open.")

    def save(self, name: str, force: bool) -> None:
        """Write the case into the folder."""
        self._refuse_faults()
        place = self.folder.save_case(self.case, name, force)
        self.name = self.folder.shown(place)
        self.tell(f"The case is saved as {self.name}.")

    def save_job(self, number: int, name: str) -> None:
        """Write the directory of results of a job into the folder."""
        job = self.job(number)
        if job is None or not job.saved:
            why = "Its files are still being written" if job and job.state == "done" else ""
            raise InputError("there are no files of it yet", "", why, "Try again in a moment")
        place = self.folder.save_result(job.result, name)
        self.tell(f"Saved in {self.folder.shown(place)}.")

    def run(self) -> None:
        """Compute the case."""
        self._refuse_faults()
        if len(self.runs) >= RUNS:
            remedy = "Remove one that you no longer need"
            raise InputError(f"{RUNS} runs are kept already", "", "", remedy)
        order = {"case": self.case.to_toml()}
        job = self._start("run", f"Run {self._free()}", order)
        self.runs.append(job)
        self.view = f"job-{job.number}"

    def _free(self) -> int:
        taken = {job.title for job in self.runs}
        return next(n for n in range(1, RUNS + 2) if f"Run {n}" not in taken)

    def _start(self, kind: str, title: str, order: Mapping[str, Any]) -> Job:
        job = self.jobs.start(kind, title, order, self.case)
        if job is None:
            why = "Too many computations wait already"
            raise InputError("this cannot be computed now", "", why, "Stop one of them, or wait")
        return job

    def lay_over(self) -> None:
        """Lay the runs that are picked over each other."""
        runs = [job for job in self.runs if job.number in self.picked]
        if len(runs) < 2 or not all(job.saved for job in runs):
            why = "" if len(runs) < 2 else "The files of one of them are still being written"
            remedy = "Try again in a moment" if why else "Pick them in the list of runs"
            raise InputError("two finished runs are needed", "", why, remedy)
        if self.overlay is not None:
            self.jobs.forget(self.overlay)
        order = {"results": [str(j.result) for j in runs], "names": [j.title for j in runs]}
        self.overlay = self._start("overlay", "Overlay", order)
        self.view = f"job-{self.overlay.number}"

    def pick(self, number: int) -> None:
        """Pick a run for the overlay, or leave it out."""
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
        """Stop a job and forget it."""
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
        """One of its jobs."""
        return next((job for job in self.jobs_here() if job.number == number), None)

    def jobs_here(self) -> list[Job]:
        """All its jobs."""
        return [*self.runs, *self.studies, *([self.overlay] if self.overlay else [])]

    @property
    def busy(self) -> bool:
        """Whether something is still to come."""
        return any(not job.settled for job in self.jobs_here())

    def changes(self, job: Job) -> list[str]:
        """What the case of a run has that the first run has not."""
        if job not in self.runs[1:]:
            return []
        found = differing([dict(each.case.values()) for each in (self.runs[0], job)])
        told = []
        for key, (_, value) in found.items():
            option = spec_of(self.case, key)
            shown = "default" if value is None else option.show(value) if option else str(value)
            told.append(f"{words(key)} {shown}")
        return told

    def close(self) -> None:
        """Stop and forget all its jobs."""
        for job in self.jobs_here():
            self.jobs.forget(job)

    def _refuse_faults(self) -> None:
        if self.faults:
            count = len(self.faults)
            what = f"{count} value{'s are' if count > 1 else ' is'} not in order"
            raise InputError(what, "", "", "Correct what is marked first")


def _fault(key: str, error: TribodynError) -> dict[str, str]:
    """One fault as the page tells it beside its field."""
    problem = error.problems[0]
    parts = (p.rstrip(".") for p in (problem.what, problem.why, problem.remedy) if p)
    text = " ".join(p if p.endswith("?") else f"{p}." for p in parts)
    return {"key": key, "label": words(key) if key else "", "text": text}


def _with_unit(option: Option, text: str, unit: str) -> str:
    """A number with the unit that stands beside its field, unless it has one of its own."""
    if option.kind != "number" or not option.unit or not text:
        return text
    try:
        return text if split(text)[1] else f"{text} {unit}"
    except UnitProblemError:
        return text


def _plain(option: Option, text: str) -> Any:
    """A number without dimension as a number; anything else as text, which the check reads."""
    if option.unit:
        return text
    number = plain_number(text)
    whole = number is not None and option.kind == "integer" and float(number).is_integer()
    return int(number) if whole and number is not None else text if number is None else number


def at_start(folder: Folder, asked: str) -> tuple[Case, str]:
    """The case that ``tribodyn app`` was given: built-in, or a file of the folder."""
    from tribodyn.study.case.read import read_case
    from tribodyn.study.case.reference import start_toml

    if not asked:
        return read_case(start_toml(), "case.toml"), ""
    if asked in case_files() or not Path(asked).exists():
        return load_case(asked), ""  # which tells what there is where there is no such case
    place = Path(asked).resolve()
    if not place.is_relative_to(folder.root):
        why = f"The page reads and writes in {folder.root} alone"
        remedy = f'Start it with --folder "{place.parent}"'
        raise InputError(f"{asked} lies outside of the folder", "CASE", why, remedy)
    name = folder.shown(place)
    return folder.load(name), name
