"""Influence factors of ISO 6336-1.

| module | content |
| --- | --- |
| `tooth_stiffness` | c', c_gamma,alpha and c_gamma,beta |
| `running_in` | y_alpha, y_p, y_f and y_beta |
| `dynamic_factor` | K_v, method B |
| `face_load` | K_Hbeta and K_Fbeta, method C |
| `transverse_load` | K_Halpha and K_Falpha, method B |
"""
