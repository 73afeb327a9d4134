"""Printed tables of a study beside what is computed: the rig with twelve degrees of freedom.

Its source prints five harmonics of the transmission error with three frictions, and neither masses
nor stiffness nor damping. The case has those with which the fifth harmonic grows as printed; what
else follows is laid beside the print, figure by figure.
"""

from collections import Counter

import tribodyn as td

found = td.cases.compare_with_paper("fzg-12dof")
print(found.lead)
for table in dict.fromkeys(row["table"] for row in found.rows):
    counts = Counter(row["verdict"] for row in found.rows if row["table"] == table)
    print(f"{table}: {', '.join(f'{count} {verdict}' for verdict, count in counts.items())}")

print("change by friction [%]                            printed  computed")
for row in found.rows:
    if row["table"] == "Table 3, change by friction":
        print(f"{row['row']:48} {row['printed']:8.1f} {row['computed']:9.1f}  {row['verdict']}")
