"""Generate straight-line source code of the law and the step of one structure.

The interpreting kernel reads from the arrays of a program which slot each term multiplies. The
generated code holds the same terms in the same order, so that nothing is looked up and the values
of a stage stay in registers. The functions replace those of the same names in
:mod:`tribodyn.dynamics._engine.contact_forces` and :mod:`tribodyn.dynamics._engine.runge_kutta`,
with one number per slot of ``w``.
"""

from __future__ import annotations

from tribodyn.dynamics.equations.program import Program


class _Writer:
    """Generated lines of code, and the position in the program that they have reached."""

    def __init__(self, program: Program) -> None:
        self.code, self.s = [int(item) for item in program.code], program.slots
        self.all_reads = [int(item) for item in program.reads]
        self.lines: list[str] = []

    def begin(self, head: str) -> None:
        """Begin a function and return to the start of the program."""
        self.at, self.read, self.row, self.depth = 4, 0, 0, 0
        self.add(f"def {head}:")
        self.depth = 1

    def add(self, *lines: str) -> None:
        """Append lines at the current indentation."""
        self.lines += ["    " * self.depth + line for line in lines]

    def take(self, count: int) -> list[tuple[str, int]]:
        """Return factors and slots of the next terms."""
        first, self.row, self.read = self.row, self.row + count, self.read + count
        reads = self.all_reads[self.read - count : self.read]
        return [(f"row[{first + item}]", reads[item]) for item in range(count)]

    def value(self, slot: int) -> str:
        """Expression for the number in a slot: states and forces are variables."""
        s = self.s
        for name, first, count in (("x", 0, 2 * s.n), ("f", s.force, s.contacts)):
            if first <= slot < first + count:
                return f"{name}{slot - first}"
        return f"t{slot - s.friction}" if slot >= s.friction else f"w[{slot}]"

    def compression(self, rate: bool) -> tuple[list[str], tuple[int, int]]:
        """Write the compression of the next contact, also its rate; returns factors and kind."""
        s, row = self.s, self.row
        along, turn, dead, kind = self.code[self.at : self.at + 4]
        self.at, self.row = self.at + 4, self.row + 5
        self.add(f"d = row[{row + 2}] * error")
        if rate:
            self.add(f"rate = row[{row + 3}] * (error * beat)")
        for factor, slot in self.take(along):
            self.add(f"d = d + {factor} * {self.value(slot)}")
            if rate:
                self.add(f"rate = rate + {factor} * {self.value(slot + s.n)}")
        for factor, slot in self.take(turn):
            if rate:
                self.add(f"rate = rate + {factor} * {self.value(slot)} * beat")
        factors = [f"row[{row + item}]" for item in (0, 1, 4)]
        if kind >= 2:
            scales = (s.stiffness, s.damping, s.gap)
            factors = [
                f"{f} * (1.0 + w[{scale}])" for f, scale in zip(factors, scales, strict=True)
            ]
        return factors, (dead, kind)

    def forces(self) -> None:
        """Write the forces ``f`` of all contacts and ``t`` of all frictions that follow them."""
        s = self.s
        for j in range(s.contacts):
            (k, c, gap), (dead, kind) = self.compression(rate=True)
            if not dead:
                self.add(f"f{j} = {k} * d + {c} * rate")
                continue
            self.add(f"side = w[{s.side + j}]", "touch = side * side")
            rub = f"{c} * rate" if kind % 2 else f"touch * ({c} * rate)"
            self.add(f"f{j} = touch * ({k} * (d - {gap} * side)) + {rub}")
        self.at += 1
        for f in range(self.code[self.at - 1]):
            self.friction(f)

    def friction(self, f: int) -> None:
        """Write the force of a friction."""
        contacts, terms = self.code[self.at : self.at + 2]
        self.at += 2
        reads = self.all_reads[self.read : self.read + contacts]
        self.read += contacts
        last = self.row + 1 + terms
        self.add(f"carried = {' + '.join(self.value(slot) for slot in reads)}")
        self.add(f"value = row[{last}]")
        if terms > 1:
            self.add(f"x = min(row[{self.row}] * abs(carried), row[{self.row + 1}])")
        for item in range(1, terms):
            self.add(f"value = value * x + row[{last - item}]")
        self.add(f"t{f} = (1.0 + w[{self.s.rub}]) * carried * value")
        self.row = last + 1

    def accelerations(self) -> None:
        """Write the accelerations ``a`` of all coordinates."""
        for i in range(self.s.n):
            terms = [f"{f} * {self.value(slot)}" for f, slot in self.take(self.code[self.at])]
            self.add(f"a{i} = " + " + ".join([f"w[{self.s.load + i}]", *terms]))
            self.at += 1


def write_source(program: Program) -> str:
    """Source code of ``acceleration``, ``left_side`` and ``step``."""
    out, s, columns = _Writer(program), program.slots, int(program.code[2])
    n, once = s.n, f"beat, error = w[{s.beat}], w[{s.error}] - 1.0"
    out.begin("acceleration(lanes, law, r, buffer, out, w)")
    out.add("row = law.rows[r:]", once, f"state = w[{2 * n} * buffer :]")
    out.add(*(f"x{i} = state[{i}]" for i in range(2 * n)))
    out.forces()
    out.accelerations()
    out.add(*(f"w[{s.force + j}] = f{j}" for j in range(s.contacts)))
    out.add(*(f"w[out + {i}] = a{i}" for i in range(n)))

    out.begin("left_side(lanes, law, r, w)")
    out.add("row = law.rows[r:]", f"error, crossed = w[{s.error}] - 1.0, False")
    out.add(*(f"x{i} = w[{4 * n + i}]" for i in range(n)))
    for j in range(s.contacts):
        (_, _, gap), (dead, _) = out.compression(rate=False)
        if dead:
            out.add(f"side, gap = w[{s.side + j}], {gap}")
            out.add("inside = side * d - gap if side != 0.0 else gap - abs(d)")
            out.add("crossed = crossed or inside < 0.0")
    out.add("return crossed")

    out.begin("step(lanes, method, law, number, base, w, statistics_slot)")
    out.add(once, f"h = w[{s.h}]", "sixth = (1.0 / 6.0) * h")
    out.add(*(f"x{i} = w[{i}]" for i in range(2 * n)))
    out.add(*(f"first{i} = inner{i} = a{i} = 0.0" for i in range(n)))
    out.add("for stage in range(4):")
    out.depth = 2
    out.add("part = 0.5 * h if stage < 2 else h")
    out.add(f"row = law.rows[base + ((stage + 1) // 2) * {columns} :]")
    out.forces()
    out.accelerations()
    out.add("if stage == 3:", "    break")
    for i in range(n):
        out.add(f"x{i}, x{n + i} = w[{i}] + part * x{n + i}, w[{n + i}] + part * a{i}")
    out.add("if stage == 0:", *(f"    first{i} = a{i}" for i in range(n)))
    out.add("else:", *(f"    inner{i} = inner{i} + a{i}" for i in range(n)))
    out.depth = 1
    for i in range(n):
        out.add(f"w[{4 * n + i}] = w[{i}] + h * (w[{n + i}] + sixth * (first{i} + inner{i}))")
        total = f"first{i} + 2.0 * inner{i} + a{i}"
        out.add(f"w[{5 * n + i}] = w[{n + i}] + sixth * ({total})")
    out.add("return True")
    return "\n".join(out.lines) + "\n"
