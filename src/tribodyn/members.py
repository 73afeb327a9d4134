"""Earlier name of :mod:`tribodyn.checkpoints`."""

from __future__ import annotations

from tribodyn.aliases import old_module

__getattr__ = old_module(__name__)
