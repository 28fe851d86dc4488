"""A simulated participant: a body that moves like a person and carries out the task.

Its visible behaviour, frame by frame:

- without a goal (free movement) the base movement, a looped capture or an idle one, in place;
- with a goal the body stands. Trunk, head and the free arm keep a damped share of the base
  movement; the legs do not stride but stand and step (inverse kinematics to flat feet), so a
  walking capture cannot walk through the boxes; the hand or foot in use moves to the goal;
- the body leans and side-steps only as far as a reach requires;
- no joint turns and no body sinks faster than a person's can;
- to walk somewhere it steps there facing ahead, backwards if need be. It does not see obstacles:
  to go round something, give way-points as goals, one after the other.

The caller closes the loop: it tells where the limb in use is seen (`see`), the task rules judge the
delayed avatar, and the caller changes the goal accordingly. Until then the limb stays where it
arrived. If it is seen at rest without effect for longer than the person's patience, the person
touches once more. Nothing tells the person the latency.

All randomness comes from `rng`: the same seed, times and goals give the same movement.
"""

from typing import cast

import numpy as np

from app.science.rotations import FloatArray, Vector, rotate
from app.science.simulation.aiming import Aim
from app.science.simulation.base import BaseMovement
from app.science.simulation.footing import Footing
from app.science.simulation.goal import Goal, GoalKind, SimulationError
from app.science.simulation.hands import Hand
from app.science.simulation.paths import limit_turn_rate, minimum_jerk
from app.science.simulation.placement import Placement, ReachPlan
from app.science.simulation.posture import SIDE_NAMES, Posture
from app.science.simulation.stance import Stance
from app.science.simulation.traits import MovementTraits, draw_traits
from app.science.simulation.vision import LateVision
from app.science.skeleton import JOINT_INDEX, Movement, Pose, Skeleton, forward_kinematics

_TO_TASK_S = 0.8
_LONGEST_FRAME_S = 0.1
_PRESS_M = 0.012


class SimulatedParticipant:
    """The body of one simulated person in one session.

    Args:
        skeleton: the person's body.
        base: looping background movement: `loop(resample(retarget(...), 90.0))` or
            `idle_movement(...)`.
        rng: source of all randomness; seed it and keep the seed.
        traits: the traits of the person's movement; drawn from rng if None.
        home_m: position (x, z) at which the person stands at first and for hand tasks.

    Raises:
        SimulationError: the base movement does not loop.
    """

    def __init__(
        self,
        skeleton: Skeleton,
        base: Movement,
        rng: np.random.Generator,
        *,
        traits: MovementTraits | None = None,
        home_m: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.traits = traits or draw_traits(rng)
        self._rng, self._skeleton = rng, skeleton
        self._base = BaseMovement(base, rng.uniform(0.0, base.duration_s))
        self._feet_seen = LateVision(self.traits.vision_s)
        self._posture, self._stance = Posture(skeleton), Stance(skeleton, home_m, self._feet_seen)
        self._placement = Placement(self._posture, home_m)
        self._hands = tuple(Hand(LateVision(self.traits.vision_s)) for _ in SIDE_NAMES)
        self._footing: Footing | None = None
        self._goal: Goal | None = None
        self._time_s: float | None = None
        self._pose: Pose | None = None
        self._local: FloatArray | None = None
        self._plan: tuple[Hand, ReachPlan] | None = None
        self._task = 0.0

    @property
    def base_offset_s(self) -> float:
        """The place of the looping background movement at time 0."""
        return self._base.offset_s

    @property
    def aimed_m(self) -> Vector | None:
        """The end point of the present goal's movement, with scatter; None before it starts."""
        if self._goal is None or self._goal.effector is None:
            return None
        for hand in self._hands:
            if hand.goal == self._goal:
                return hand.aimed_m
        return self._stance.aimed_m if self._stance.goal == self._goal else None

    def stand_on(self, footing: Footing | None) -> None:
        """Set the feet on this ground from now on when they stand or step; None: a flat floor."""
        self._footing = footing

    def see(self, time_s: float, effector: str, place_m: Vector) -> None:
        """Show the person where the limb of a goal is: call once per frame, after `pose`.

        Args:
            time_s: the time of the frame.
            effector: the goal's hand or foot.
            place_m: the finger tip, or the ankle, of the body that the person sees.
        """
        self._vision_of(effector).see(time_s, place_m)

    def learned_m(self, hand: str) -> Vector:
        """Return how far beside its goal the person has learned to move this hand."""
        return self._vision_of(hand).learned_m

    def _vision_of(self, effector: str) -> LateVision:
        for side, hand in zip(SIDE_NAMES, self._hands, strict=True):
            if effector == f"{side}Hand":
                return hand.vision
        return self._feet_seen

    def pose(self, time_s: float, goal: Goal | None) -> Pose:
        """Return the body's pose at a time, pursuing a goal; call once per frame, in order of time.

        Raises:
            SimulationError: the time goes back, or the goal is too far away to walk to.
        """
        before = time_s if self._time_s is None else self._time_s
        if not before <= time_s < float("inf"):
            raise SimulationError(
                f"Time went from {before} s to {time_s} s: request poses in order of time."
            )
        # After a pause the springs must not advance through the whole gap in one step.
        step_s = min(time_s - before, _LONGEST_FRAME_S)
        self._time_s = time_s
        if goal != self._goal:
            self._assign_goal(goal, time_s)
        change = step_s / _TO_TASK_S
        self._task = min(1.0, self._task + change) if goal else max(0.0, self._task - change)
        if self._task == 0.0 and not goal:
            root, local = self._roaming(time_s)
        else:
            root, local = self._at_task(time_s, step_s)
        if self._local is not None:
            local = limit_turn_rate(self._local, local, time_s - before)
        self._local = local
        self._pose = Pose(np.array(root), local)
        return self._pose

    def _assign_goal(self, goal: Goal | None, time_s: float) -> None:
        """Pass a new goal to the limbs that it concerns, and let the others rest."""
        if self._task == 0.0:
            x, y, z = self._roaming(time_s)[0]
            self._stance.place_at(self._stance.centre_m)
            self._placement.reset((x, z), y)
        used = goal.effector if goal is not None else None
        if used is not None and (self._goal is None or self._goal.effector != used):
            self._vision_of(used).look_away()
        self._goal, self._plan = goal, None
        reaction_s = self.traits.reaction(self._rng)
        reaching = goal is not None and goal.kind is GoalKind.REACH
        for side, hand in enumerate(self._hands):
            selected = reaching and goal is not None and goal.effector == f"{SIDE_NAMES[side]}Hand"
            if selected and goal is not None:
                plan = self._placement.plan_reach(goal, side, hand.fingers)
                hand.set_goal(goal, time_s, reaction_s, plan.settle_s)
                self._plan = (hand, plan)
            elif hand.goal is not None or not hand.idle:
                hand.set_goal(None, time_s, 0.0)
        stepping = goal is not None and goal.kind in {GoalKind.STEP, GoalKind.WALK_TO}
        self._stance.set_goal(goal if stepping else None, time_s, reaction_s)
        if not reaching:
            self._placement.stand_upright()

    def _roaming(self, time_s: float) -> tuple[Vector, FloatArray]:
        """Return the base movement, in place above the midpoint of the feet."""
        x, y, z = self._base.root(time_s)
        cx, cz = self._stance.centre_m
        return (x + cx, y, z + cz), self._base.whole(time_s)

    def _at_task(self, time_s: float, step_s: float) -> tuple[Vector, FloatArray]:
        local = self._base.damped(time_s)
        root = self._stand(local, time_s, step_s)
        for side, hand in enumerate(self._hands):
            if hand.idle:
                continue
            tip = self._tip(side) if hand.work == 0.0 else None
            hand.vision.perceive(time_s)
            aim = Aim(self.traits, 1.0, _PRESS_M, self.traits.reaching)
            hand.follow(time_s, step_s, tip, aim, self._rng)
            if hand.work > 0.0:
                missing = self._posture.arm(local, root, side, hand.tip_m, hand.fingers, hand.work)
                if hand.goal is not None:
                    self._placement.catch_up(missing, step_s)
        if self._task >= 1.0:
            return root, local
        share = minimum_jerk(self._task)
        free_root, free = self._roaming(time_s)
        mixed = self._posture.blended(free, local, share)
        blended = [a + share * (b - a) for a, b in zip(free_root, root, strict=True)]
        return cast("Vector", tuple(blended)), mixed

    def _stand(self, local: FloatArray, time_s: float, step_s: float) -> Vector:
        """Place feet, hips and trunk; return the position of the hips."""
        posture, stance, placement = self._posture, self._stance, self._placement
        self._feet_seen.perceive(time_s)
        aim = Aim(self.traits, self.traits.foot_tempo, 0.0)
        stance.follow(time_s, aim, self._rng)
        # The avatar's hips follow without delay but its arm late: wait until its arm is out.
        if self._plan and self._plan[0].seen_out(time_s):
            placement.start(self._plan[1])
            self._plan = None
        reaching = self._goal is not None and self._goal.kind is GoalKind.REACH
        x, z = placement.follow(stance, step_s, reaching=reaching)
        sway_x, sway_z = self._base.sway(time_s)
        x, z = x + sway_x, z + sway_z
        posture.lean(local, placement.lean(step_s))
        ankles = tuple(stance.ankle(foot, posture.ankle_height_m) for foot in (0, 1))
        left, right = ankles
        highest = posture.highest_hips((x, z), local, (left, right))
        root = (x, placement.height(highest, step_s), z)
        if self._footing is not None:
            left, right = (self._set_down(ankle, (x, z)) for ankle in ankles)
        posture.legs(local, root, (left, right))
        return root

    def _set_down(self, ankle: Vector, hips_m: tuple[float, float]) -> Vector:
        """Return where an ankle is on the ground that is seen there."""
        x, y, z = ankle
        lift_m = 0.0 if self._footing is None else self._footing.lift_m((x, z), hips_m)
        return (x, y + lift_m, z)

    def _tip(self, side: int) -> Vector:
        """Return where a hanging hand's finger tip was in the last frame."""
        if self._pose is None:
            root, local = self._roaming(self._time_s or 0.0)
            self._pose = Pose(np.array(root), local)
        world = forward_kinematics(self._skeleton, self._pose.root_position_m, self._pose.rotations)
        hand = JOINT_INDEX[f"{SIDE_NAMES[side]}Hand"]
        tip = world.positions_m[hand] + rotate(world.rotations[hand], self._skeleton.ends_m[hand])
        return cast("Vector", tuple(tip.tolist()))
