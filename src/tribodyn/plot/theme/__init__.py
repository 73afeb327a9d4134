"""Common style of all figures.

==========  ===================================================================
module      contents
==========  ===================================================================
``style``   colours with fixed roles, fonts, grids, curves, buttons
``curves``  curves of quantities in their display units, panels of them
``panels``  stacked panels with a common axis or one axis each, event lines
``labels``  axis labels, display units and rounding of values
``path``    positions A to E of a tooth pair, number of pairs in contact
==========  ===================================================================
"""
