"""Where do the flanks of a hypoid pair touch?

The flanks follow from the blank, the cutter and the ease-off. The contact pattern moves with
the misalignment of the axes.

Read on: hypoid
"""

import math

from tribodyn.gear import EaseOff, Misalignment, hypoid_blank, hypoid_flanks, tooth_contact

blank = hypoid_blank(
    teeth_pinion=10, teeth_wheel=43, offset=31.7e-3, outer_pitch_diameter_wheel=336e-3,
    face_width_wheel=47.7e-3, mean_spiral_angle_pinion=math.radians(46.0), cutter_radius=114.3e-3,
)  # fmt: skip
flanks = hypoid_flanks(blank, "drive", EaseOff(lengthwise_crowning=30e-6, profile_crowning=8e-6))
aligned = tooth_contact(flanks)
shifted = tooth_contact(flanks, Misalignment(pinion_axial=50e-6))
print(f"contact ratio {aligned.contact_ratio:.2f}, shifted {shifted.contact_ratio:.2f}")
aligned.plot().write_html("hypoid_contact.html")
