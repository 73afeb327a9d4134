"""Oil films and friction.

=================  ================================================================
module             what it draws
=================  ================================================================
``path``           one tooth pair along the path of contact: speeds, friction, film
``lubrication``    the regime along the path, and what film and asperities do
``mixed_contact``  rough contacts in which film and asperities share the load
``line_contact``   pressure and film of one line contact or several
``dynamics``       films over time, and against vibrations of any frequency
``animation``      a contact that moves or changes, with a slider and a play button
=================  ================================================================
"""
