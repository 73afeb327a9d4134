"""Earlier name of :mod:`tribodyn.checkpoints`, which it forwards to."""

from __future__ import annotations

import warnings

from tribodyn.checkpoints import NAME as NAME
from tribodyn.checkpoints import Members as Members
from tribodyn.checkpoints import read_lines as read_lines

warnings.warn("tribodyn.members is now tribodyn.checkpoints", DeprecationWarning, stacklevel=2)
