"""Response of a run, natural modes and results over the speed.

==================  =============================================================
module              what it draws
==================  =============================================================
``time_histories``  mesh force, transmission error, accelerations, bearing forces; whole turns
``spectra``         mesh harmonics of these signals
``linear``          natural modes, Campbell diagram, response to a harmonic error
``friction``        effect of friction, and published claims about it
``sweeps``          steady states over the speed; a summary figure over case keys
``motion``          signals of a run or a structure; differences of results and printed values
==================  =============================================================
"""
