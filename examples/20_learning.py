"""Surrogate models of a vibration: a published data set, one without leakage, and a map.

The published inputs include mesh stiffness and compression, whose product is the mesh force
except for damping, and its rows sample only five phases of the mesh cycle. The "honest" table has
all phases and only inputs that are available before the computation; the split never divides a
run. Finally a network predicts the rms mesh force over the operating point.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import tribodyn as td
from tribodyn import surrogate

warnings.simplefilter("ignore", td.ModelWarning)  # the thin tip of this pair, rows far apart
case = td.load_case("fzg-film").replace({"film.model": "none"})
targets = ["acceleration", "mesh_force"]


def report(label, model, simpler):
    """Print the errors over the held-out rows."""
    for name, error in model.errors.items():
        table = simpler["table"][name].determination
        print(f"{label} {name}: R2 {error.determination:.5f} (table over the phase {table:.5f}), "
              f"{100 * error.mean_absolute_relative:.3g} % off on the average")  # fmt: skip


published = td.vibration_data(case, seed=1, trajectories=40)
published = published.where(published["time"] > 0.205)
inputs = ["mesh_stiffness", "friction_coefficient", "backlash_function", "transmission_error"]
settings = {"features": inputs, "targets": targets, "seed": 1}
size = surrogate.Training(hidden=(11, 11), activations=("tansig", "relu"), patience=6)
model = surrogate.train(published, **settings, training=size)
report(f"published, {published.rows} rows,", model, surrogate.baselines(published, **settings))

honest = td.vibration_data(case, seed=1, trajectories=20, over="cycle", samples=64)
inputs = ["cos_phase", "sin_phase", "stiffness_scale", "friction_scale"]
settings = {"features": inputs, "targets": targets, "seed": 1, "groups": "trajectory"}
model = surrogate.train(honest, **settings)
report(f"honest, {honest.rows} rows,", model, surrogate.baselines(honest, **settings))

over = {
    "force_scale": "0.5 .. 1.5",
    "friction_scale": "0 .. 2",
    "operation.speed": "1300 rpm .. 1500 rpm",
}
points = td.operating_data(case, over, 128, seed=1)
steady = surrogate.train(points, features=list(over), targets=["rms_mesh_force"], seed=1,
                         training=surrogate.Training(shares=(7, 1, 2)))  # fmt: skip
torque = np.linspace(0.6, 1.4, 1000)
force = steady.predict({"force_scale": torque, "friction_scale": 1.0, "operation.speed": 146.6})
rms = force["rms_mesh_force"]
print(f"steady, 128 points: R2 {steady.errors['rms_mesh_force'].determination:.5f}, "
      f"1000 forces from {rms[0]:.0f} to {rms[-1]:.0f} N")  # fmt: skip

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
spread = {"friction.coefficient": "0.0692 +- 5 %", "stiffness_scale": "1 +- 2 %"}
td.ensemble(case, spread, 32, seed=1).plot().write_html(folder / "ensemble.html")
model.plot().write_html(folder / "learned.html")
print(f"figures in {folder.resolve()}:")
print("ensemble.html learned.html")
