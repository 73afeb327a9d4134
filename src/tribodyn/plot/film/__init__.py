"""Oil films and friction.

================  ===========================================================================
module            what it draws
================  ===========================================================================
``path``          a tooth pair along the path of contact: speeds, friction, film
``lubrication``   lubrication regime along the path, over the operation and of rough contacts
``line_contact``  pressure and film of line contacts
``area_contact``  pressure and film of point contacts and rollers
``dynamics``      films over time and frequency, their temperatures, waves in a contact
``animation``     animation of a contact along the path or over time
================  ===========================================================================
"""
