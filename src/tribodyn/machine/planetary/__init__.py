"""Planetary stages: sun, ring, carrier and planets.

| module | what it answers |
|---|---|
| ``kinematics`` | speeds, torques, rolling power and efficiency |
| ``positions`` | where planets can be assembled, and how close neighbours are |
| ``phases`` | phases of all meshes, and which modes their harmonics excite |
| ``plane_model`` | equations of motion in the plane, after Lin and Parker, and its pins |
| ``double_planets`` | stepped planets and pairs of planets of the plane model |
| ``modes`` | which modes are rotational, translational or modes of the planets |
| ``mesh_laws`` | lag of the meshes of a planet behind each other |
| ``ring_sensor`` | signal of a sensor on the ring, with the sidebands of passing planets |
| ``load_sharing`` | static loads of the planets with errors of pins and teeth |
"""
