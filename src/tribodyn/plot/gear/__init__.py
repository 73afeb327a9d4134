"""Gear geometry, tooth deformation and losses.

======================  ===============================================================
module                  what it draws
======================  ===============================================================
``gear_pair``           both gears to scale, and the mesh zone enlarged
``contact_lines``       teeth in space with the lines of contact moving over them
``flank_modification``  modifications and deviations of the flanks
``heat``                power loss and dissipated heat over the temperature
``hypoid``              a hypoid pair: blanks, in space, ease-off, contact pattern
``hypoid_misalignment`` contact patterns with displaced gears
``hypoid_motion``       kinematics of hypoid flanks along their contact lines
``mesh_deformation``    deformation of the teeth under load
``outlines``            outlines of both gears, unloaded and deformed
======================  ===============================================================
"""
