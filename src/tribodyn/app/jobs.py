"""Computations in separate processes, which can be stopped or crash without harm to the page.

A process starts ahead of its job, so that all modules are loaded when a job begins. It reads one
order as a line of JSON, reports its progress as lines of JSON, and writes its results into the
folder of the job. Stopping a job ends its process only.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from tribodyn.types import ByName, Tree

#: Limits of concurrent and of waiting computations.
_AT_A_TIME, _WAITING = 2, 12
#: Characters of a progress message, and of the error stream, that are read.
_LINE, _ERROR_LENGTH = 100_000, 2000
#: Final states of a job.
ENDED = ("done", "failed", "stopped")


@dataclass
class Job:
    """State of one computation."""

    number: int
    kind: str
    title: str
    order: ByName
    folder: Path
    case: Any = None  #: that is computed
    state: str = "waiting"  #: then "running", and one of ``ENDED``
    task: str = ""
    done: int = 0
    total: int | None = None
    started: float = field(default_factory=time.monotonic)
    content: Tree = field(default_factory=dict)  #: of the page
    saved: bool = False  #: whether its directory of results is complete
    problems: list[str] = field(default_factory=list)
    version: int = 0  #: increases with every message

    @property
    def ended(self) -> bool:
        """Whether it is done, failed or stopped."""
        return self.state in ENDED

    @property
    def settled(self) -> bool:
        """Whether it has ended and its files are complete."""
        return self.ended and (self.state != "done" or self.saved or self.kind == "overlay")

    @property
    def seconds(self) -> int:
        """Seconds since it was started, waiting included."""
        return int(time.monotonic() - self.started)

    def figure(self, name: str) -> Any:
        """Return one of its figures."""
        return json.loads((self.folder / f"{name}.json").read_text("utf-8"))

    @property
    def result(self) -> Path:
        """Its directory of results."""
        return self.folder / "result"


class _Process:
    """Worker process that waits for one order."""

    def __init__(self) -> None:
        command = [sys.executable, "-W", "ignore", "-m", "tribodyn.app.worker"]
        self._errors: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 -- closed by end()
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors
        )

    def order(self, order: ByName) -> None:
        """Send the order to the process."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(order).encode() + b"\n")
        self._process.stdin.flush()

    def lines(self) -> Any:
        """Yield its messages until it ends."""
        assert self._process.stdout is not None
        while line := self._process.stdout.readline(_LINE):
            yield json.loads(line)

    def alive(self) -> bool:
        """Whether it still runs."""
        return self._process.poll() is None

    def exit_reason(self) -> str:
        """Exit code and the last line of its error stream."""
        code = self._process.wait()
        self._errors.seek(0)
        lines = self._errors.read()[-_ERROR_LENGTH:].decode("utf-8", "replace").strip().splitlines()
        return f"It ended with code {code}. {lines[-1] if lines else ''}".strip()

    def stop(self) -> None:
        """Stop it at once."""
        self._process.kill()

    def end(self) -> None:
        """Stop it and close its streams."""
        self.stop()
        self._process.wait()
        self._errors.close()
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()


class Jobs:
    """All jobs of a server."""

    def __init__(self) -> None:
        self._home = Path(tempfile.mkdtemp(prefix="tribodyn-app-"))
        self._lock = threading.RLock()
        self._waiting: list[Job] = []
        self._running: dict[int, _Process] = {}
        self._count, self._closed = 0, False
        self._spare: _Process | None = _Process()

    def start(
        self, kind: str, title: str, order: Mapping[str, object], case: object = None
    ) -> Job | None:
        """Start or queue a job; return None if the queue is full."""
        with self._lock:
            if self._closed or len(self._waiting) >= _WAITING:
                return None
            self._count += 1
            folder = self._home / str(self._count)
            folder.mkdir()
            job = Job(self._count, kind, title, {**order, "kind": kind}, folder, case)
            self._waiting.append(job)
            self._next()
            return job

    def _next(self) -> None:
        while self._waiting and len(self._running) < _AT_A_TIME and not self._closed:
            job = self._waiting.pop(0)
            process, self._spare = self._spare, None
            if process is None or not process.alive():
                process = _Process()
            self._running[job.number] = process
            job.state, job.version = "running", job.version + 1
            threading.Thread(target=self._follow, args=(job, process), daemon=True).start()
            self._spare = _Process()

    def _follow(self, job: Job, process: _Process) -> None:
        """Record the messages of a process until it ends."""
        try:
            process.order({**job.order, "folder": str(job.folder)})
            for message in process.lines():
                self._update(job, message)
        except (OSError, ValueError):  # It was stopped, or a message is no JSON.
            pass
        with self._lock:
            process.stop()
            if not job.ended:
                why = f"The process that computed it ended. {process.exit_reason()}"
                job.state, job.problems = "failed", [why]
            job.version += 1
            process.end()
            self._running.pop(job.number, None)
            self._next()

    def _update(self, job: Job, message: Mapping[str, object]) -> None:
        with self._lock:
            if job.state == "stopped":
                return
            for name in ("state", "task", "done", "total", "content", "saved", "problems"):
                if name in message:
                    setattr(job, name, message[name])
            job.version += 1

    def stop(self, job: Job) -> None:
        """Stop a waiting or running job."""
        with self._lock:
            if job in self._waiting:
                self._waiting.remove(job)
            if not job.ended:
                job.state, job.version = "stopped", job.version + 1
            process = self._running.get(job.number)
        if process is not None:
            process.stop()

    def forget(self, job: Job) -> None:
        """Stop a job and delete its files."""
        self.stop(job)
        shutil.rmtree(job.folder, ignore_errors=True)

    def close(self) -> None:
        """Stop all jobs and delete their files."""
        with self._lock:
            self._closed = True
            running, spare = list(self._running.values()), self._spare
            self._waiting.clear()
        for process in running:
            process.stop()  # its thread closes it
        if spare is not None:
            spare.end()
        shutil.rmtree(self._home, ignore_errors=True)
