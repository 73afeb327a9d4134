"""What to say of a step whose contacts open and close without end."""

from __future__ import annotations

from tribodyn.errors import ComputationError, Problem


def unparted_step(
    contact: int, contacts: int, phase: float, time: float, lane: int | None
) -> ComputationError:
    """Error of a step that cannot be parted; ``phase`` counts mesh cycles [1], ``time`` is in s."""
    who = "" if lane is None else f", in lane {lane}"
    return ComputationError(
        Problem(
            what=f"the contacts open and close more than {16 + 4 * contacts} times within one step",
            where=f"contacts[{contact}], mesh phase {phase % 1.0:.6g} of mesh cycle "
            f"{int(phase) + 1}, time {time:.6g} s{who}",
            why="The flanks chatter at the boundary of the dead zone, where the damping force "
            "jumps: the step cannot be marched in parts with one force law each",
            remedy="Take more steps per mesh cycle, or damping that does not vanish in the gap; "
            "look for an error or a gap that changes fast at that mesh phase",
        )
    )
