"""Exchange with other programs: gearbox models in the REXS format, tables as CSV and JSON.

| module | content |
|---|---|
| ``rexs_file`` | content of a REXS file in XML, JSON or zip |
| ``gearbox`` | stages and load cases of a REXS model, with remarks |
| ``flank_forms`` | reliefs and crownings of the flanks |
| ``to_case`` | case of a spur stage, with the assumed values |
| ``to_machine`` | machine of all stages, with shafts, bearings and load cases |
| ``machine_parts`` | shafts, gears and bearings at their positions |
| ``planet_stages`` | sun, planets, ring and carrier of planetary stages |
| ``tables`` | tables and figures of a result as CSV and JSON |
| ``write`` | export of a case as a REXS model, without loss |
"""

from tribodyn.arguments import guard
from tribodyn.exchange.gearbox import GearboxModel, Load, Stage, StageGear, read_rexs
from tribodyn.exchange.tables import write_tables
from tribodyn.exchange.to_case import case_from_rexs
from tribodyn.exchange.to_machine import machine_from_rexs, stage_from_rexs
from tribodyn.exchange.write import write_rexs

__all__ = [
    "GearboxModel",
    "Load",
    "Stage",
    "StageGear",
    "case_from_rexs",
    "machine_from_rexs",
    "read_rexs",
    "stage_from_rexs",
    "write_rexs",
    "write_tables",
]

guard(__name__)
