"""Exchange with other programs: gearbox models in the REXS format, tables as CSV and JSON.

| module | what it answers |
|---|---|
| ``rexs_file`` | what a REXS file holds, as XML, JSON or zip |
| ``gearbox`` | which stages and loads there are, and what is odd about them |
| ``flank_forms`` | which reliefs and crownings the flanks have |
| ``to_case`` | the case of a spur stage, with what had to be assumed |
| ``tables`` | tables and figures of a result as CSV and JSON |
| ``write`` | a case as a REXS model, which reads back without loss |
"""

from tribodyn.arguments import guard
from tribodyn.exchange.gearbox import GearboxModel, Load, Stage, StageGear, read_rexs
from tribodyn.exchange.tables import write_tables
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
    "write_tables",
]

guard(__name__)
