"""Life of rolling bearings, and safety of shafts against fatigue.

| module | content |
| --- | --- |
| `bearing_life` | basic and modified life: ISO 281; life of a system |
| `element_life` | life from the loads of the rolling elements: ISO/TS 16281 |
| `shaft_fatigue` | notched shafts: DIN 743 |
| `rainflow` | cycles of a load history: ASTM E1049 |
"""
