"""Place stretches on one timeline of the server, by deciding which of the clocks jumped.

From two clocks alone it cannot be decided which one jumped; from three it can. The server's wall
clock is read with every probe, and if two of the three clocks agree, the third one jumped. A wall
clock that is set on its own changes no offset, so nothing is corrected then.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.science.clock.probes import FloatArray
from app.science.clock.stretch import Stretch

Stepped = Literal["", "client", "server"]


@dataclass(frozen=True, eq=False)
class Placed:
    """A stretch on the server's timeline.

    `shift_s` corrects for jumps of the server's clock, and `doubt_s` (below, above) is the
    uncertainty of that correction. `step_s` is the jump of the offset at the start of the stretch
    as it was read, and `stepped` names the clock that jumped; they are 0 and empty where no jump is
    certain.
    """

    stretch: Stretch
    shift_s: float = 0.0
    doubt_s: tuple[float, float] = (0.0, 0.0)
    step_s: float = 0.0
    stepped: Stepped = ""

    def bounds_at(self, t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the lowest and highest offset on the server's continuous timeline, each (k,)."""
        low, high = self.stretch.bounds_at(t_s)
        return low + (self.shift_s - self.doubt_s[0]), high + (self.shift_s + self.doubt_s[1])

    def offset_at(self, t_s: FloatArray) -> FloatArray:
        """Return the best estimate of the offset on the server's continuous timeline, (k,)."""
        return self.stretch.offset_at(t_s) + self.shift_s

    def server_at(self, t_s: float) -> float:
        """Return the server's time at one client time."""
        return t_s + float(self.offset_at(np.array([t_s]))[0])


def place(stretches: Sequence[Stretch], step_s: float) -> tuple[Placed, ...]:
    """Place stretches on one timeline of the server, each relative to the previous one.

    A jump of the offset is attributed to the client's clock, with two exceptions: the server's
    clock went back; or the server's wall clock is known, and its jump against the monotonic clock
    is closer to the jump of the offset than to zero (two of three clocks agree). In these cases the
    jump is the server's, and its readings are continued by the client's time.
    """
    placed = [Placed(stretch) for stretch in stretches[:1]]
    for stretch in stretches[1:]:
        placed.append(_place_after(placed[-1], stretch, step_s))
    return tuple(placed)


def _place_after(before: Placed, stretch: Stretch, step_s: float) -> Placed:
    at = stretch.knots_s[:1]
    (low,), (high,) = before.bounds_at(at)
    (own_low,), (own_high,) = stretch.bounds_at(at)
    (expected,), (own,) = before.offset_at(at), stretch.offset_at(at)
    jump_s = float(own - (expected - before.shift_s))
    if own_low + before.shift_s <= high and low <= own_high + before.shift_s:
        return Placed(stretch, before.shift_s, before.doubt_s)
    if not _is_server_jump(before.stretch, stretch, jump_s, step_s):
        return Placed(stretch, before.shift_s, before.doubt_s, jump_s, "client")
    shift_s = float(expected - own)
    doubt_s = (float(shift_s - (low - own_high)), float((high - own_low) - shift_s))
    return Placed(stretch, shift_s, doubt_s, jump_s, "server")


def _is_server_jump(before: Stretch, after: Stretch, jump_s: float, step_s: float) -> bool:
    if after.server_first_s < before.server_last_s:
        return True
    wall_s = after.wall_first_s - before.wall_last_s
    return abs(jump_s) >= step_s and abs(wall_s + jump_s) < abs(wall_s)
