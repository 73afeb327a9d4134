"""The command line: stdout is data, stderr is progress, the exit code reports the outcome."""

from __future__ import annotations

from tribodyn.arguments import guard
from tribodyn.cli.entry import call, main

__all__ = ["call", "main"]

guard(__name__)
