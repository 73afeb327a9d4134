"""The gears themselves.

======================  ===============================================================
module                  what it draws
======================  ===============================================================
``gear_pair``           both gears to scale, and the mesh zone enlarged
``flank_modification``  what flanks have that involutes have not
``heat``                loss and heat given off over the temperature of gears and oil
``hypoid``              a hypoid pair: blanks, in space, ease-off, contact pattern
``hypoid_motion``       how the flanks of a hypoid pair move along their contact lines
``mesh_deformation``    teeth in mesh, bent by their loads
``outlines``            outlines of both gears in one plane, at rest and bent
``path``                positions A to E of a tooth pair, how many pairs share the load
======================  ===============================================================
"""
