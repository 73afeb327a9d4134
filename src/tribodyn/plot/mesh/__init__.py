"""The mesh at rest.

==================  =========================================================================
module              what it draws
==================  =========================================================================
``table``           stiffness, load sharing, transmission error and force law of a mesh table
``loaded_contact``  loaded tooth contacts, for one torque or several
``studies``         Harris map, search for a tip relief, stiffness with oil film
``cycle``           a mesh table as curves: two cycles, the life of a tooth pair, the events
==================  =========================================================================
"""
