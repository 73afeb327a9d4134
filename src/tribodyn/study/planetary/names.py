"""Names of an earlier version: a planetary stage is a machine, the one case of named parts."""

from __future__ import annotations

from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.result import LoadResult, MachineResult

PartsCase = MachineCase
PlanetaryCase, PlanetaryResult, PlanetaryLoadResult = MachineCase, MachineResult, LoadResult
