"""Static results of the mesh.

==================  ==========================================================================
module              what it draws
==================  ==========================================================================
``table``           stiffness, load sharing, transmission error and force law
``face_maps``       maps over path and face: load, film, friction, load capacity
``loaded_contact``  loaded tooth contact for one or several torques
``studies``         Harris map, tip relief, lead, stiffness with oil film, coupling
``cycle``           curves of a mesh table over cycles and over the engagement of a pair
==================  ==========================================================================
"""
