"""Machines of several shafts: parts, kinematics, clock, directions of the meshes, matrices.

Node coordinates have the order x, y, z, theta_x, theta_y, theta_z, with x along the shafts; a
positive speed turns y towards z.

| module | what it answers |
|---|---|
| ``section``, ``shaft`` | what a shaft consists of |
| ``gear``, ``mesh`` | which teeth mesh where, and with which force law |
| ``bearing``, ``housing`` | what carries the shafts |
| ``machine`` | which parts form a machine |
| ``beam``, ``shaft_matrices`` | how stiff and how heavy a shaft is |
| ``structure``, ``reduction`` | matrices of all parts but the meshes, full and reduced |
| ``assembly`` | equations of motion |
| ``modes`` | natural frequencies, and which parts store the energy |
| ``hypoid`` | hypoid pair between engine and load, with shafts and bearings |
| ``planetary`` | planetary stages: kinematics, phases, plane model, load sharing |
| ``graph`` | speeds, torques, clock, directions, places and masses that follow from it |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
