"""How every figure looks.

==========  ===================================================================
module      what it draws
==========  ===================================================================
``style``   colours with fixed roles, fonts, grids, curves, buttons
``panels``  panels over one common axis or each over its own, marks across them
``labels``  values, axis labels and units as engineers read them
==========  ===================================================================
"""
