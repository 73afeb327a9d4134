"""Common style of all figures.

==========  ===================================================================
module      contents
==========  ===================================================================
``colors``  colours with fixed roles
``style``   fonts, grids, curves, bars, maps, buttons
``panels``  stacked panels with a common axis or one axis each, curves of quantities in them
``labels``  axis labels, display units and rounding of values
``path``    positions A to E of a tooth pair, number of pairs in contact
==========  ===================================================================
"""
