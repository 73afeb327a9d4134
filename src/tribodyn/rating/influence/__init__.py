"""Influence factors of ISO 6336-1.

| module | content |
| --- | --- |
| `dynamic_factor` | K_v, method B; c', c_gamma,alpha and c_gamma,beta |
| `face_load` | K_Hbeta and K_Fbeta, method C; K_Halpha and K_Falpha, method B |
"""
