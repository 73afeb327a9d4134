"""Response of a run, natural modes and results over the speed.

==================  =============================================================
module              what it draws
==================  =============================================================
``time_histories``  mesh force, transmission error, accelerations, bearing forces
``spectra``         mesh harmonics of these signals
``linear``          natural modes, Campbell diagram, response to a harmonic error
``friction``        effect of friction, and published claims about it
``response``        contact forces, compressions and coordinates over the time
``sweeps``          steady states over the speed; a summary figure over case keys
``motion``          signals of a run over mesh cycles, or over time for a transient
==================  =============================================================
"""
