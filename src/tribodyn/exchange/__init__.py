"""Exchange with other gear programs: gearbox models in the REXS format.

| module | what it answers |
|---|---|
| ``rexs_file`` | what a REXS file holds, as XML, JSON or zip |
| ``gearbox`` | which stages and loads there are, and what is odd about them |
| ``to_case`` | the case of a spur stage, with what had to be assumed |
| ``write`` | a case as a REXS model, which reads back without loss |
"""

from tribodyn.exchange.gearbox import GearboxModel, Load, Stage, StageGear, read_rexs
from tribodyn.exchange.to_case import case_from_rexs
from tribodyn.exchange.write import write_rexs

__all__ = [
    "GearboxModel",
    "Load",
    "Stage",
    "StageGear",
    "case_from_rexs",
    "read_rexs",
    "write_rexs",
]
