"""Earlier name of :mod:`tribodyn.checkpoints`."""

from __future__ import annotations

from tribodyn import aliases

__getattr__ = aliases.old_module(__name__)
