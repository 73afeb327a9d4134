"""Motions of a run, natural modes, figures over the speed.

===========  ====================================================================
module       what it draws
===========  ====================================================================
``courses``  mesh force, transmission error, accelerations, bearing forces
``spectra``  their mesh harmonics
``linear``   natural modes, Campbell diagram, response to a harmonic error
``friction`` what friction changes, and claims about it judged
``response`` contact forces, compressions, coordinates of a structure over the time
``sweeps``   steady motions over the speed, a figure of the summary over keys
``motion``   a response as curves: over mesh cycles, or over time for a transient
===========  ====================================================================
"""
