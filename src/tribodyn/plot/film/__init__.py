"""Oil films and friction.

====================  ================================================================
module                what it draws
====================  ================================================================
``path``              a tooth pair along the path of contact: speeds, friction, film
``lubrication``       lubrication regime along the path and over the operation
``mixed_contact``     rough contacts in which film and asperities share the load
``line_contact``      pressure and film of line contacts
``film_temperature``  temperatures of a heated line contact
``dynamics``          films over time, and their frequency response
``animation``         animation of a contact along the path or over time
====================  ================================================================
"""
