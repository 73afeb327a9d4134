"""Commands that are killed at a call of the system that changes a place."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

#: Makes a command quick to start, and kills it at a call of the system that changes a place.
_AIMED = """
import os, signal, sys
import tribodyn.files, tribodyn.checkpoints
at = int(sys.argv.pop(1))
def counted(function):
    def call(*arguments, **options):
        global at
        at -= 1
        if at == 0:
            os.kill(os.getpid(), signal.SIGKILL)
        found = function(*arguments, **options)
        at -= 1
        if at == 0:
            os.kill(os.getpid(), signal.SIGKILL)
        return found
    return call
for name in ("mkdir", "rename", "replace", "rmdir", "unlink", "fsync", "utime"):
    setattr(os, name, counted(getattr(os, name)))
tribodyn.files._exchange = counted(tribodyn.files._exchange)
from tribodyn.cli import main
main()
"""


def started(folder: Path, arguments: list[str], at: int = 0) -> subprocess.Popen[str]:
    """Begin a command; ``at`` is the call at which it is killed, if it comes that far."""
    code = [sys.executable, "-c", _AIMED, str(at)]
    return subprocess.Popen([*code, *arguments], cwd=folder, text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE)  # fmt: skip
