"""Gear geometry, tooth deformation and losses.

======================  ======================================================================
module                  what it draws
======================  ======================================================================
``gear_pair``           both gears to scale, and the mesh zone enlarged
``contact_lines``       teeth in space with the lines of contact moving over them
``flank_modification``  modifications and deviations of the flanks
``hypoid``              a hypoid pair: blanks, in space, ease-off, contact pattern
``hypoid_running``      kinematics, displaced gears, load, pressure and friction of its flanks
``losses``              losses, heat balance and power flow of gearboxes
``mesh_deformation``    deformation of the teeth under load
``outlines``            outlines of both gears, unloaded and deformed
======================  ======================================================================
"""
