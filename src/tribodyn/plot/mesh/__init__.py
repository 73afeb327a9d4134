"""Static results of the mesh.

==================  ==========================================================================
module              what it draws
==================  ==========================================================================
``table``           stiffness, load sharing, transmission error and force law
``loaded_contact``  loaded tooth contact over the torque; maps over path and face
``studies``         Harris map, tip relief, lead, stiffness with oil film, coupling
``cycle``           curves of a mesh table over cycles and over the engagement of a pair
==================  ==========================================================================
"""
