"""Compliance of a gear under a load on one of its teeth, in closed form.

| module | what it answers |
| --- | --- |
| `influence` | what a load on a tooth does there and at the other teeth (any provider); Weber |
| `face_influence` | the same over the face width, and between slices of the face |
| `face_kernel` | its compiled sum over all slices in contact |
| `tooth_bending` | point of load on a tooth, and compliance of the beam with its true outline |
| `tooth_compliance` | foundation of a tooth, wind-up of the body; all of one gear together |
| `analytic` | influence of a gear from beam teeth on an elastic ring |
"""
