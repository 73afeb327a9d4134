"""Let ``python -m tribodyn.cli`` be the command line too."""

from __future__ import annotations

from tribodyn.cli.entry import main

main()
