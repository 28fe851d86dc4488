"""What a person sees of the limb they use, and how they correct it by that.

The person plans a path q(t) and moves along x(t) = q(t) + n(t) + c(t) + o(t): the noise n of their
muscles grows along the movement, and the correction c and what they have learned, o, follow what
they see. They see s(t), the limb of the body that they act through, and perceive it a delay d
later. They know how late vision is, but not that anything else is late, so they take for an error

    e(t) = s(t - d) - q(t - d),        dc/dt = -g e(t),        do/dt = -h e(t)

with the gain g (`MovementTraits.correction_per_s`) and the slow one h (`learning_per_s`). A new
movement is planned from where the limb is: n and c begin at zero, and o stays. A fast and a slow
process: Smith et al. 2006, PLoS Biology 4:e179. If the seen limb is where the person's own is,
e is the noise, and it is corrected with the time constant 1 / g. If the seen limb follows late by
L, then e contains -v L while the limb moves at the speed v: the limb seems to lag behind its plan,
the person pushes on, and overshoots; and since d + L delays the loop, the correction itself
oscillates, and would grow for g (d + L) > pi / 2. If a wall holds the seen limb, the person pushes.

So errors and corrections follow from the latency without a rule that contains it. Corrections of
reaching by late vision: Saunders and Knill 2003, Experimental Brain Research 152:341-352.

A body with other proportions has its limb beside the person's; e is then that offset, c makes up
for it, and o learns it for the movements that follow.
"""

from collections import deque
from math import hypot

from app.science.rotations import Vector, v_add, v_length, v_scale, v_subtract

MOST_CORRECTION_M = 0.3
"""Farther than this nobody corrects: it is beyond the difference of two people's arms."""
STILL_M_PER_S = 0.05
"""A limb that is slower is seen at rest."""
_NOTHING: Vector = (0.0, 0.0, 0.0)


class LateVision:
    """The places at which one limb was seen and planned, and the correction that follows.

    `correction_m`: c, and `learned_m`: o, in world axes. `error_m`: e, as last perceived.
    `still_since_s`: since when the limb is seen at rest; None while it moves, or if it was not seen
    yet. `seen_moving`: whether it was seen moving since the present movement began.
    """

    def __init__(self, delay_s: float) -> None:
        self.correction_m: Vector = _NOTHING
        self.learned_m: Vector = _NOTHING
        self.still_since_s: float | None = None
        self.perceived_m: Vector | None = None
        self.error_m: Vector = _NOTHING
        self.seen_moving = False
        self._delay_s = delay_s
        self._seen: deque[tuple[float, Vector]] = deque()
        self._planned: deque[tuple[float, Vector]] = deque()
        self._before: tuple[float, Vector] | None = None

    @property
    def sees(self) -> bool:
        """Whether the limb was seen at all lately."""
        return bool(self._seen)

    def see(self, time_s: float, place_m: Vector) -> None:
        """Note where the limb is seen; it is perceived later."""
        self._seen.append((time_s, place_m))

    def look_away(self) -> None:
        """Forget the places, but not what was learned: another limb is in use."""
        self._seen.clear()
        self._planned.clear()
        self.still_since_s = self.perceived_m = self._before = None

    def perceive(self, time_s: float) -> None:
        """Bring perception up to a time."""
        latest = _latest(self._seen, time_s - self._delay_s)
        if latest is None or latest == self._before:
            return
        if self._before is not None:
            (before_s, before_m), (now_s, now_m) = self._before, latest
            way_m = v_length(v_subtract(now_m, before_m))
            if way_m > STILL_M_PER_S * (now_s - before_s):
                self.still_since_s, self.seen_moving = None, True
            elif self.still_since_s is None:
                self.still_since_s = time_s
        self._before, self.perceived_m = latest, latest[1]

    def correct(
        self, time_s: float, planned_m: Vector, gains_per_s: tuple[float, float], step_s: float
    ) -> None:
        """Advance correction and learning by a frame.

        `planned_m`: the plan's present place, q(t). `gains_per_s`: g and h.
        """
        self._planned.append((time_s, planned_m))
        intended = _latest(self._planned, time_s - self._delay_s)
        if intended is None or self.perceived_m is None:
            return
        self.error_m = error = v_subtract(self.perceived_m, intended[1])
        fast, slow = gains_per_s
        self.correction_m = _limited(v_add(self.correction_m, v_scale(error, -fast * step_s)))
        self.learned_m = _limited(v_add(self.learned_m, v_scale(error, -slow * step_s)))

    def begin(self) -> None:
        """Begin a new movement, which is planned from where the limb is."""
        self.correction_m = self.error_m = _NOTHING
        self.seen_moving = False
        self._planned.clear()


def _limited(correction: Vector) -> Vector:
    length = hypot(*correction)
    return (
        v_scale(correction, MOST_CORRECTION_M / length)
        if length > MOST_CORRECTION_M
        else correction
    )


def _latest(places: deque[tuple[float, Vector]], until_s: float) -> tuple[float, Vector] | None:
    """Return the last place until a time, and drop those before it."""
    while len(places) > 1 and places[1][0] <= until_s:
        places.popleft()
    return places[0] if places and places[0][0] <= until_s else None
