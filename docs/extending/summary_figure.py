"""A figure of the summary of one's own: how much the load of the teeth varies."""

import numpy as np

from tribodyn.study import summary_figure


@summary_figure("dynamic_load_factor", meaning="greatest mesh force over that at rest")
def dynamic_load_factor(result):
    """Greatest mesh force over that at rest; None would leave the figure out."""
    force = result.response.contact_force.sum(axis=1)
    return np.max(force) / result.mesh.total_normal_force


@summary_figure(
    "dynamic_load_factor", meaning="greatest mesh force over that at rest", part="meshes"
)
def dynamic_load_factor_of_mesh(load, mesh):
    """The same of a mesh of a machine or a stage, under one load."""
    column = load.motion.mesh.index(mesh)
    return np.max(load.motion.mesh_force[:, column]) / load.static.meshes[mesh].force
