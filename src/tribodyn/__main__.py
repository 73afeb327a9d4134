"""Let ``python -m tribodyn`` be the command line."""

from __future__ import annotations

from tribodyn.cli import main

main()
