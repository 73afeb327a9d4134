"""Oil films and friction.

================  ================================================================
module            what it draws
================  ================================================================
``path``          one tooth pair along the path of contact: speeds, friction, film
``lubrication``   the regime along the path, and what film and asperities do
``line_contact``  pressure and film of one line contact or several
``dynamics``      films over time, and against vibrations of any frequency
``animation``     a contact that moves or changes, with a slider and a play button
================  ================================================================
"""
