"""Periodic and transient motions of machines: many linear coordinates, few contacts.

The public names are those of :mod:`tribodyn.dynamics`.

| module | content |
|---|---|
| ``clearance_motion`` | the steady motion in supports with a clearance |
| ``harmonic_balance`` | the steady motion on one clock, or over several phases |
| ``newton`` | Newton's method with Krylov solutions for the residual over a period |
| ``orbit_response`` | the response from the harmonics of a motion |
| ``phase_balance`` | the motion over several independent phases |
| ``phase_contacts`` | forces of contacts, integrated between their breaks |
| ``phase_grid`` | transforms on a grid of phases |
| ``phase_march`` | the motion over phases by integration over time |
| ``phase_response`` | that motion at any time, and its spectral lines |
| ``phase_rows`` | entries of the contacts at points of the phases |
| ``radial_clearance`` | the law of a support with a clearance |
"""
