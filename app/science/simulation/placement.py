"""Plan where the body stands and how it leans, so that the limbs reach their goals.

The place is planned once per goal and corrected while reaching.
"""

from dataclasses import dataclass
from math import exp, hypot, sqrt

from app.science.rotations import Vector
from app.science.simulation.goal import Goal
from app.science.simulation.paths import MOST_SINK_M_PER_S
from app.science.simulation.posture import SIDE_SIGNS, Posture
from app.science.simulation.stance import Stance

_BODY_RATE, _LEAN_RATE, _HEIGHT_RATE = 7.0, 6.0, 9.0
_REACH_SHARE, _NEAREST_SHARE = 0.89, 0.45
_LEAN_SHARE, _MOST_LEAN_M, _MOST_SHIFT_M = 0.5, 0.10, 0.7
_STEP_AFTER_M, _MOST_AHEAD_M = 0.12, 0.25
_SMALL_SHIFT_M, _SETTLE_S, _SETTLE_S_PER_M = 0.03, 0.25, 1.0
_DEEP_M, _ASLANT_M = 0.15, 0.12
_CATCH_UP_RATE, _CATCH_UP_EXTRA_M = 3.0, 0.01
_SOFT_KNEES = 0.985
# Where the hips are between the feet, as a share of the way to the foot that bears the weight.
_BEARING_SHARE = 0.65


@dataclass(frozen=True)
class ReachPlan:
    """The goals of hips and shoulder lean for a reach, (x, z) in metres, and the time needed."""

    hips_m: tuple[float, float]
    lean_m: tuple[float, float]
    settle_s: float


class Follower:
    """A number that follows a goal smoothly: a critically damped spring, solved exactly.

    With y = x - goal: x'' = -2 r x' - r^2 y, so y(t) = (y_0 + (v_0 + r y_0) t) exp(-r t).
    """

    def __init__(self, value: float, rate: float) -> None:
        self.value, self._speed, self._rate = value, 0.0, rate

    def follow(self, goal: float, step_s: float) -> float:
        """Advance by one time step and return the new value."""
        away = self.value - goal
        push = self._speed + self._rate * away
        fade = exp(-self._rate * step_s)
        self.value = goal + (away + push * step_s) * fade
        self._speed = (self._speed - self._rate * push * step_s) * fade
        return self.value


def _in_front(dx: float, dz: float, approach_m: Vector) -> tuple[float, float]:
    """Return the shift across a deep opening's axis that lets the arm enter nearly straight."""
    ax, _, az = approach_m
    depth = hypot(ax, az)
    if depth < _DEEP_M:
        return (0.0, 0.0)
    across_x, across_z = -az / depth, ax / depth
    offset = dx * across_x + dz * across_z
    excess = max(abs(offset) - _ASLANT_M, 0.0) * (1.0 if offset > 0.0 else -1.0)
    return excess * across_x, excess * across_z


class Placement:
    """The position of the hips and the lean of the trunk over time."""

    def __init__(self, posture: Posture, home_m: tuple[float, float]) -> None:
        self._posture, self._home_m = posture, home_m
        self._goal_m, self._goal_lean_m = home_m, (0.0, 0.0)
        self._x, self._z = Follower(home_m[0], _BODY_RATE), Follower(home_m[1], _BODY_RATE)
        self._lean_x, self._lean_z = Follower(0.0, _LEAN_RATE), Follower(0.0, _LEAN_RATE)
        self._height_m = _SOFT_KNEES * posture.standing_m
        self._height = Follower(self._height_m, _HEIGHT_RATE)

    def plan_reach(self, goal: Goal, side: int, fingers: Vector) -> ReachPlan:
        """Return the smallest shift from home with which the arm reaches, partly by leaning.

        The arm has to enter an opening straight, so the shoulder first moves in front of it.
        """
        posture, target = self._posture, goal.target_m or (0.0, 0.0, 0.0)
        shoulder_x = self._home_m[0] + SIDE_SIGNS[side] * posture.shoulder_m[0]
        dx = target[0] - posture.hand_m * fingers[0] - shoulder_x
        dy = target[1] - posture.hand_m * fingers[1] - _SOFT_KNEES * posture.shoulder_m[1]
        dz = target[2] - posture.hand_m * fingers[2] - self._home_m[1]
        front_x, front_z = _in_front(dx, dz, goal.approach_m)
        dx, dz = dx - front_x, dz - front_z
        reach, away = _REACH_SHARE * posture.arm_m, max(hypot(dx, dz), 1e-6)
        farthest = sqrt(max(reach * reach - dy * dy, (0.2 * reach) ** 2))
        nearest = min(_NEAREST_SHARE * posture.arm_m, farthest)
        excess = away - farthest if away > farthest else min(away - nearest, 0.0)
        lean = min(max(_LEAN_SHARE * excess, 0.0), _MOST_LEAN_M)
        ux, uz = dx / away, dz / away
        shift_x, shift_z = front_x + (excess - lean) * ux, front_z + (excess - lean) * uz
        scale = min(1.0, _MOST_SHIFT_M / max(hypot(shift_x, shift_z), 1e-6))
        x, z = self._home_m[0] + scale * shift_x, self._home_m[1] + scale * shift_z
        way_m = hypot(x - self._goal_m[0], z - self._goal_m[1])
        settle_s = _SETTLE_S + _SETTLE_S_PER_M * way_m if way_m > _SMALL_SHIFT_M else 0.0
        return ReachPlan((x, z), (lean * ux, lean * uz), settle_s)

    def start(self, plan: ReachPlan) -> None:
        """Start to move the body to the place of a reach plan."""
        self._goal_m, self._goal_lean_m = plan.hips_m, plan.lean_m

    def catch_up(self, missing_m: Vector, step_s: float) -> None:
        """Move nearer while a hand falls short of its goal by `missing_m`."""
        length = hypot(missing_m[0], missing_m[2])
        if length < 1e-9:
            return
        # A little more than is missing, or the last millimetre would never be covered.
        share = min(1.0, _CATCH_UP_RATE * step_s) * (length + _CATCH_UP_EXTRA_M) / length
        x, z = self._goal_m[0] + share * missing_m[0], self._goal_m[1] + share * missing_m[2]
        if hypot(x - self._home_m[0], z - self._home_m[1]) <= _MOST_SHIFT_M:
            self._goal_m = (x, z)

    def stand_upright(self) -> None:
        """Stop leaning and stand upright where the feet are."""
        self._goal_lean_m = (0.0, 0.0)

    def follow(self, stance: Stance, step_s: float, *, reaching: bool) -> tuple[float, float]:
        """Advance the hips by one frame and return their (x, z).

        They are over the feet, or where a reach requires them.
        """
        middle = stance.centre_m
        goal_m = middle
        if reaching:
            goal_m = self._goal_m
            ahead = hypot(goal_m[0] - middle[0], goal_m[1] - middle[1])
            if ahead > _STEP_AFTER_M:
                stance.side_step(goal_m)
            share = min(1.0, _MOST_AHEAD_M / max(ahead, 1e-9))
            goal_m = (
                middle[0] + share * (goal_m[0] - middle[0]),
                middle[1] + share * (goal_m[1] - middle[1]),
            )
        elif (foot := stance.bearing_foot) is not None:
            x, _, z = stance.ankle(foot, 0.0)
            share = 2.0 * _BEARING_SHARE - 1.0
            goal_m = (middle[0] + share * (x - middle[0]), middle[1] + share * (z - middle[1]))
        return self._x.follow(goal_m[0], step_s), self._z.follow(goal_m[1], step_s)

    def lean(self, step_s: float) -> tuple[float, float]:
        """Advance the lean by one frame and return how far the shoulders lean, (x, z) in metres."""
        x, z = self._goal_lean_m
        return self._lean_x.follow(x, step_s), self._lean_z.follow(z, step_s)

    def height(self, highest_m: float, step_s: float) -> float:
        """Return the height of the hips: standing with soft knees, lower if a leg requires it.

        The hips sink no faster than a body can; a foot that is too far away then arrives a little
        late.
        """
        lowest = self._height_m - MOST_SINK_M_PER_S * step_s
        goal_m = min(_SOFT_KNEES * self._posture.standing_m, highest_m)
        self._height_m = max(min(self._height.follow(goal_m, step_s), highest_m), lowest)
        return self._height_m

    def reset(self, place_m: tuple[float, float], height_m: float) -> None:
        """Restart from a given position of the hips."""
        self._x, self._z = Follower(place_m[0], _BODY_RATE), Follower(place_m[1], _BODY_RATE)
        self._height_m = height_m
        self._height = Follower(height_m, _HEIGHT_RATE)
