"""Walk a simulated participant through one task, to see what they reach and how long it takes.

The participant is the one of a rehearsal, without its server and its clock: the avatar is a delayed
copy, so edges of boxes stop nobody, and every movement aims exactly. A surface on which nothing
has happened for `STALLED_S` is out of reach; it then counts as touched, so that the others are
tried, too.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.science.simulation import MovementTraits, SimulatedParticipant, idle_movement
from app.science.skeleton import build_skeleton
from app.science.tasks import (
    CommandKind,
    Contact,
    ContactChange,
    EventKind,
    Laterality,
    TaskLayout,
    TaskRules,
    TaskRun,
    current_goal,
)
from app.simulated_people.avatars import DelayedCopy
from app.simulated_people.goals import goal_of

RATE_HZ: Final = 45.0
STALLED_S: Final = 15.0
"""Time without effect, besides twice the latency; a step takes 2 to 4 s, and may be repeated."""
SLOW: Final = MovementTraits(
    reaction_s=0.352,
    reaction_spread=0.0,
    tempo=1.28,
    precision=0.0,
    movement_spread=0.0,
    correction_per_s=0.0,
    learning_per_s=0.0,
    caught_s=math.inf,
)
"""Somebody who never misses nor corrects, and whose slowness only 5 % of drawn people exceed."""
_SETTLING_S = 1.0


@dataclass(frozen=True)
class Walkthrough:
    """The first task of one participant.

    Attributes:
        out_of_reach: surfaces that were not reached, in the order of the task.
        completion_s: active time of the first completion; None if a surface was out of reach.
    """

    out_of_reach: tuple[str, ...]
    completion_s: float | None


def walk_through(
    layout: TaskLayout,
    hand: Laterality,
    stature_m: float,
    latency_s: float,
    traits: MovementTraits = SLOW,
) -> Walkthrough:
    """Carry out the first task of a phase.

    Args:
        layout: the boxes of the task.
        hand: the participant's writing hand, and the foot that leads.
        stature_m: the participant's stature; segments have the proportions of `build_skeleton`.
        latency_s: latency of the avatar, whose touches count.
        traits: how the participant moves.

    Raises:
        DelayError: the latency is longer than the avatar's buffer.
        SimulationError: a place is too far away to walk to.
    """
    skeleton, rng = build_skeleton(stature_m), np.random.default_rng(0)
    person = SimulatedParticipant(skeleton, idle_movement(skeleton, rng), rng, traits=traits)
    avatar = DelayedCopy(skeleton)
    avatar.set_latency(latency_s)
    avatar.show_boxes(layout)
    run = TaskRun(TaskRules(layout, hand), avatar.parts)
    missed: list[str] = []
    started = False
    since_s = _SETTLING_S
    for frame in range(round((layout.n_boxes + 2) * 10 * (STALLED_S + 2.0 * latency_s) * RATE_HZ)):
        t_s = frame / RATE_HZ
        goal = goal_of(run.state, hand) if started else None
        avatar.frame(t_s, person.pose(t_s, goal))
        if goal is not None and goal.effector is not None:
            person.see(t_s, goal.effector, avatar.place_of(goal.effector))
        if not started and t_s >= _SETTLING_S:
            run.command(CommandKind.START, t_s)
            started = True
        if not started:
            continue
        before = current_goal(run.state)
        run.frame(t_s, *avatar.touches())
        if current_goal(run.state) != before:
            since_s = t_s
        elif t_s - since_s > STALLED_S + 2.0 * latency_s:
            missed.append(before or "")
            _touch(run, before or "", t_s)
            since_s = t_s
        if any(event.kind is EventKind.TASK_COMPLETED for event in run.events):
            break
    active_s = run.state.clock.active_s(t_s)
    return Walkthrough(tuple(missed), None if missed else active_s)


def _touch(run: TaskRun, surface: str, t_s: float) -> None:
    """Let a surface be touched by a part that counts."""
    contact = Contact(surface, min(run.state.rules.counting_parts))
    run.apply(ContactChange(t_s, begins=(contact,)))
    run.apply(ContactChange(t_s, ends=(contact,)))
