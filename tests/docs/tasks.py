"""Tasks of engineers: a question, a script of few lines that sets ``answer``, and its check.

The scripts use what the skill and the recipes name; the checks are closed forms.
"""

import math
from typing import Any, NamedTuple

import tribodyn as td


class Task(NamedTuple):
    question: str
    script: str
    expected: Any


_BASE = 0.5 * 20 * 4e-3 * math.cos(math.radians(20.0))

TASKS = [
    Task(
        "Which built-in cases are there?",
        "answer = 'fzg-roughness' in td.cases() and 'planetary-stage' in td.cases(machines=True)",
        True,
    ),
    Task(
        "What is the mesh frequency of the FZG pair at 900 rpm?",
        """
case = td.load_case("fzg-roughness").replace({"operation.speed": "900 rpm"})
lines = td.kinematic_frequencies(case)
answer = lines.frequency[lines.symbol.index("GMF")]
""",
        16 * 900 / 60,
    ),
    Task(
        "At which frequency do the same two teeth of a 20/30 pair meet again at 600 rpm?",
        """
case = td.load_case("time-varying-friction").replace({"operation.speed": "600 rpm"})
lines = td.kinematic_frequencies(case)
answer = lines.frequency[lines.symbol.index("HTF")]
""",
        20 * 10.0 / math.lcm(20, 30),
    ),
    Task(
        "How large is the force along the line of action for 60 N*m on the pinion?",
        """
case = td.load_case("time-varying-friction").replace({"operation.torque": "60 N*m"})
answer = td.run(case).summary()["static_mesh_force"]
""",
        60.0 / _BASE,
    ),
    Task(
        "What power goes through the pair at 12 N*m and 1500 rpm?",
        """
case = td.load_case("time-varying-friction")
case = case.replace({"operation.torque": "12 N*m", "operation.speed": "1500 rpm"})
answer = td.run(case).table.set_index("name").value["input_power"]
""",
        12.0 * 1500 * math.pi / 30.0,
    ),
    Task(
        "How does the static force grow when the torque doubles?",
        """
case = td.load_case("time-varying-friction")
swept = td.sweep(case, {"operation.torque": [10.0, 20.0, 40.0]})
answer = [force / swept["static_mesh_force"][0] for force in swept["static_mesh_force"]]
""",
        [1.0, 2.0, 4.0],
    ),
    Task(
        "What is the transverse contact ratio of the 20/30 pair with module 4 mm?",
        'answer = td.load_case("time-varying-friction").gear_pair.transverse_contact_ratio',
        sum(
            math.sqrt((0.5 * z * 4e-3 + 4e-3) ** 2 - (0.5 * z * 4e-3 * math.cos(math.pi / 9)) ** 2)
            - 0.5 * z * 4e-3 * math.sin(math.pi / 9)
            for z in (20, 30)
        )
        / (math.pi * 4e-3 * math.cos(math.pi / 9)),
    ),
    Task(
        "Is the peak of the summary the greatest force over time?",
        """
result = td.run("time-varying-friction")
table = result.to_dataframe()
answer = table["mesh_force"].max() / result.summary()["peak_mesh_force"]
""",
        1.0,
    ),
    Task(
        "Which orders does the mesh force have?",
        """
orders = td.run("time-varying-friction").to_dataframe("order")
answer = list(orders.index[:3])
""",
        [1.0, 2.0, 3.0],
    ),
    Task(
        "How viscous is ISO VG 220 at 40 degC, over its density?",
        """
from tribodyn.lubricant import from_library
oil = from_library("ISO VG 220", temperature=313.15)
answer = oil.dynamic_viscosity / oil.density
""",
        220e-6,
    ),
    Task(
        "What is the Hertz pressure of a line contact of 200 kN/m, 10 mm, 226 GPa?",
        """
from tribodyn.contact import hertz_line
answer = hertz_line(200e3, 10e-3, 226e9).maximum_pressure
""",
        math.sqrt(200e3 * 226e9 / (2.0 * math.pi * 10e-3)),
    ),
    Task(
        "What is the outer ring frequency of 9 balls of 8 mm on 40 mm at 30 turns per second?",
        """
from tribodyn.faults import BearingImpacts
sizes = {"rolling_elements": 9, "element_diameter": 8e-3, "pitch_diameter": 40e-3}
bearing = BearingImpacts(place="outer", **sizes)
answer = bearing.frequency(30.0)
""",
        9 / 2 * 30.0 * (1.0 - 8 / 40),
    ),
    Task(
        "What are the mesh frequencies of a gearbox over its input?",
        """
lines = td.kinematic_frequencies(td.load_case("two-stage-spur"))
answer = lines.order[[n for n, name in enumerate(lines.symbol) if name == "GMF"][0]]
""",
        abs(next(iter(td.load_case("two-stage-spur").machine().gears.values())).teeth),
    ),
    Task(
        "Does a case come back from a REXS file as it was?",
        """
from tribodyn.exchange import case_from_rexs, read_rexs, write_rexs
case = td.load_case("helical-pair")
write_rexs(case, "pair.rexs")
answer = case_from_rexs(read_rexs("pair.rexs")) == case
""",
        True,
    ),
    Task(
        "Does a changed case come back from its file?",
        """
from pathlib import Path
case = td.load_case("fzg-roughness").replace({"gears.pinion.modification.tip_relief": "12 um"})
Path("my.toml").write_text(case.to_toml(), "utf-8")
answer = td.load_case("my.toml")["gears.pinion.modification.tip_relief"]
""",
        12e-6,
    ),
    Task(
        "What is wrong with a key of mine?",
        """
try:
    td.load_case("fzg-roughness").replace({"operation.torqe": 90.0})
except td.InputError as error:
    answer = 'Did you mean "torque"' in str(error)
""",
        True,
    ),
    Task(
        "Which unit and meaning has a figure of a machine?",
        """
table = td.run("planetary-stage").table
answer = set(table[table.name.str.endswith("peak_mesh_force")].unit)
""",
        {"N"},
    ),
    Task(
        "Which figures can be drawn of a result, and with which options?",
        """
result = td.run("time-varying-friction")
figures = [name for name in dir(result) if name.startswith("plot_")]
answer = "plot_mesh_force" in figures and len(result.plot_mesh_force().data) >= 1
""",
        True,
    ),
    Task(
        "How do two torques compare?",
        """
first = td.run("time-varying-friction")
second = td.run(first.case.replace({"operation.torque": 2.0 * first.case["operation.torque"]}))
row = td.compare_results(first, second, names=("once", "twice")).figures["static_mesh_force"]
answer = row[1] / row[0]
""",
        2.0,
    ),
    Task(
        "What friction law does a constant coefficient need?",
        """
case = td.load_case("time-varying-friction")
case = case.replace({"friction.law": "constant", "friction.coefficient": 0.06})
answer = td.run(case).summary()["mean_friction_coefficient"]
""",
        0.06,
    ),
    Task(
        "What torque leaves a two-stage reducer with 22/65 and 20/61 teeth for 150 N*m?",
        """
case = td.load_case("two-stage-helical")
answer = case.machine().kinematics.shafts["output"].torque
""",
        150.0 * 65 / 22 * 61 / 20,
    ),
    Task(
        "How fast does the generator shaft of the wind turbine turn at 12 rpm of the rotor?",
        """
case = td.load_case("wind-turbine-gearbox").replace({"operation.speed": "12 rpm"})
answer = abs(case.machine().kinematics.shafts["high"].speed)
""",
        12.0 * math.pi / 30.0 * (1.0 + 80 / 22) * 88 / 23,
    ),
    Task(
        "At which frequency do the teeth of a planetary stage mesh at 900 rpm of its sun?",
        """
case = td.load_case("planetary-stage").replace({"operation.speed": "900 rpm"})
lines = td.kinematic_frequencies(case)
answer = lines.frequency[lines.symbol.index("GMF")]
""",
        15.0 * 17 * 61 / (17 + 61),
    ),
    Task(
        "How often do planets pass a sensor on the ring of that stage?",
        """
lines = td.kinematic_frequencies(td.load_case("planetary-stage"))
answer = lines.order[lines.symbol.index("PPF")]
""",
        3.0 * 17 / (17 + 61),
    ),
    Task(
        "Which phases have the sun meshes of three planets with 17 and 61 teeth?",
        """
phases = td.machine.mesh_phases(sun_teeth=17, ring_teeth=61, planets=3)
answer = sorted(phases.sun.tolist())
""",
        [0.0, 1 / 3, 2 / 3],
    ),
    Task(
        "How much torque has the pinion of the second stage under the load case slow?",
        """
case = td.load_case("two-stage-spur")
load = next(each for each in case.load_cases if each.name == "slow")
answer = case.pair("second", load)["operation.torque"]
""",
        180.0 * 57 / 23,
    ),
    Task(
        "How long do two bearings of 10000 and 20000 hours last together?",
        """
from tribodyn.rating import system_life
answer = system_life([10000.0, 20000.0], weibull_exponent=1.5)
""",
        (10000.0**-1.5 + 20000.0**-1.5) ** (-1 / 1.5),
    ),
    Task(
        "Do crowning and lead slope lower the face load factor of a pair that is 10 um askew?",
        """
case = td.load_case("fzg-roughness").replace({"stiffness.model": "iso6336"})
best = td.optimize_lead(case, misalignment="10 um", slices=8)
answer = bool(best.face_load_factor_after.max() < best.face_load_factor_before.max())
""",
        True,
    ),
    Task(
        "In which severity zone is a class III machine that shakes with 4.6 mm/s rms at 60 Hz?",
        """
import numpy as np
from tribodyn.measurement import Recording, analyse_signal
from tribodyn.study import judge_recordings
turns = 2 * np.pi * 60.0
time = np.arange(20000) / 10000.0
wave = 4.6e-3 * np.sqrt(2.0) * turns * np.cos(turns * time)
rig = Recording({"acc": wave}, 10000.0, {"acc": "m/s^2"})
answer = judge_recordings([analyse_signal(rig, "acc")], limits="III").zone
""",
        "C",
    ),
    Task(
        "Does a gearbox with a planetary stage come back from a REXS file as it was?",
        """
from tribodyn.exchange import machine_from_rexs, read_rexs, write_rexs
case = td.load_case("wind-turbine-gearbox")
write_rexs(case, "turbine.rexsj")
answer = machine_from_rexs(read_rexs("turbine.rexsj")) == case
""",
        True,
    ),
]
