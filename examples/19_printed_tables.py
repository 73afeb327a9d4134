"""Published tables compared with computed values: the rig with twelve degrees of freedom.

The source prints five harmonics of the transmission error for three friction coefficients, but no
masses, stiffnesses or damping. The case uses values for which the fifth harmonic grows as printed;
all other figures are compared with the print one by one.
"""

from collections import Counter

import tribodyn as td

comparison = td.cases.compare_with_paper("fzg-12dof")
print(comparison.lead)
for table in dict.fromkeys(row["table"] for row in comparison.rows):
    counts = Counter(row["verdict"] for row in comparison.rows if row["table"] == table)
    print(f"{table}: {', '.join(f'{count} {verdict}' for verdict, count in counts.items())}")

print("change by friction [%]                            printed  computed")
for row in comparison.rows:
    if row["table"] == "Table 3, change by friction":
        print(f"{row['row']:48} {row['printed']:8.1f} {row['computed']:9.1f}  {row['verdict']}")
