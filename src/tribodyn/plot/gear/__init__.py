"""Gear geometry, tooth deformation and losses.

======================  ======================================================================
module                  what it draws
======================  ======================================================================
``gear_pair``           both gears to scale, their outlines, and the mesh zone enlarged
``flanks``              modifications and deviations of the flanks, lines of contact in space
``hypoid``              a hypoid pair: blanks, in space, ease-off, contact pattern
``hypoid_running``      kinematics, displaced gears, load, pressure and friction of its flanks
``losses``              losses, heat balance and power flow of gearboxes
``mesh_deformation``    deformation of the teeth under load
======================  ======================================================================
"""
