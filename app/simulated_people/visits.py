"""The task phases of a whole visit by one simulated person, without a server and without waiting.

The person, the avatar and the task rules are those of a rehearsal (`headset`). What a server adds,
such as forms, recording and the operator, is left out, so that a cohort of many people can be
simulated. Everything about a person follows from the seed and their number, and from nothing else,
so it does not matter where, in which order and beside whom they are simulated.

Latency is set on the avatar and nowhere else: the person is not told (`science.simulation.vision`).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from app.protocol import Step, StudyProtocol, compile_plan, ledger_block, sequences
from app.science.avatar.configuration import DEFAULT_OPTIONS, without_parts
from app.science.avatar.mjcf import avatar_model, default_configuration, scene_of
from app.science.simulation import Build, Goal, ReachingPeople
from app.science.skeleton import FINGER_PARTS
from app.science.tasks import (
    CommandKind,
    EventKind,
    Laterality,
    Limb,
    TaskLayout,
    TaskRules,
    TaskRun,
)
from app.simulated_people.avatars import DelayedCopy, PhysicsBody, RemoteAvatar
from app.simulated_people.body import FRAME_RATE_HZ, Person, make_person
from app.simulated_people.goals import goal_of

AvatarKind = Literal["physics", "physics_without_fingers", "delayed_copy"]
WITHOUT_FINGERS_STEP_S: Final = 0.003
"""Time step of a body without fingers, the lightest of which need the usual 2 ms. Hands in free
movement differ from those of 2 ms by 2 mm (root mean square; 1 mm between .5 and 2 ms), and at 2.3
m/s enter a wall by 5 mm instead of 3. With 4 ms they would by 10 mm, a whole wall."""
SETTLING_S: Final = 1.0
"""How long a person stands with the phase's latency before its clock starts."""
LONGEST_WALKS_BACK_S: Final = 120.0
"""A phase whose walks back take longer in all has not ended as it should."""


class EndlessPhaseError(RuntimeError):
    """A phase did not come to its end; the message says where the person was stuck."""


@dataclass(frozen=True)
class PhaseOutcome:
    """What happened in one phase.

    Attributes:
        block: the block, from 1.
        condition, latency_ms, limb: as the plan has them.
        completions: completed tasks.
        side_contacts: how often a side turned red.
        contact_time_s: how long sides were red, in active seconds, summed over sides.
        out_of_order: touches of a panel before its turn.
        first_completion_s: active time of the first completed task, None without any.
        active_s: active time.
        elapsed_s: time from the start of the clock to its end, with walks back.
    """

    block: int
    condition: str
    latency_ms: float
    limb: str
    completions: int
    side_contacts: int
    contact_time_s: float
    out_of_order: int
    first_completion_s: float | None
    active_s: float
    elapsed_s: float


@dataclass(frozen=True)
class Visit:
    """One simulated person's visit.

    `failure` says why the visit ended early; its phases up to there are kept. `simulated_s`: the
    time that passed for the person. `reaches`: how many movements of hands were drawn from
    recordings, and how many of them over a distance that was not recorded; None without recordings.
    """

    number: int
    build: Build
    order: tuple[str, ...]
    phases: tuple[PhaseOutcome, ...]
    failure: str | None
    simulated_s: float
    reaches: tuple[int, int] | None = None


def avatar_kind_of(study: StudyProtocol) -> AvatarKind:
    """Return the kind of avatar that the study has."""
    return "physics" if study.avatar == "physics" else "delayed_copy"


def no_pause() -> None:
    """Go on at once."""


def simulate_visit(
    study: StudyProtocol,
    number: int,
    seed: int,
    kind: AvatarKind,
    pause: Callable[[], None] = no_pause,
    reaching: ReachingPeople | None = None,
) -> Visit:
    """Simulate the task phases of one person.

    Args:
        study: the study; the person's order is that of slot `number` of its ledger, which goes on
            after its last replicate.
        number: the person's number, from 0.
        seed: of the cohort.
        kind: `physics`: the standard avatar with simple shapes (its version 1) in the person's
            stature, touched by real contacts. `physics_without_fingers`: the same with hands that
            are one piece each and longer steps (`WITHOUT_FINGERS_STEP_S`), at half the cost.
            `delayed_copy`: a copy that passes through boxes.
        pause: called between frames, for who has to wait while others need the processor.
        reaching: how people reach, fitted to recordings; None for the simulation's constants.
    """
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(number,)))
    person = make_person(rng, None, reaching=reaching)
    length = len(sequences(study))
    order = ledger_block(study, number // length)[number % length].sequence
    steps = [step for step in compile_plan(study, order) if step.kind == "task"]
    room = _Room(study, person, kind, pause)
    phases: list[PhaseOutcome] = []
    failure = None
    for step in steps:
        try:
            phases.append(room.play(step))
        except EndlessPhaseError as error:
            failure = str(error)
            break
    own = person.participant.traits.reaching
    reaches = None if own is None else own.counts
    return Visit(number, person.build, tuple(order), tuple(phases), failure, room.t_s, reaches)


class _Room:
    """One person with their avatar, on a clock that runs frame by frame."""

    def __init__(
        self,
        study: StudyProtocol,
        person: Person,
        kind: AvatarKind,
        pause: Callable[[], None],
    ) -> None:
        self._layouts: Mapping[Limb, TaskLayout] = study.tasks.layouts()
        self._person, self._solid = person, kind != "delayed_copy"
        self._avatar: RemoteAvatar = (
            DelayedCopy(person.skeleton)
            if kind == "delayed_copy"
            else _physics_body(self._layouts, person.stature_m, with_fingers=kind == "physics")
        )
        self._frame, self._pause = 0, pause

    @property
    def t_s(self) -> float:
        """The time of the last frame."""
        return self._frame / FRAME_RATE_HZ

    def play(self, step: Step) -> PhaseOutcome:
        """Play one phase to its end; raises EndlessPhaseError."""
        limb, latency_ms = Limb(step.limb or "hand"), step.latency_ms or 0.0
        duration_s = step.duration_s or 0.0
        layout = self._layouts[limb]
        self._avatar.set_latency(latency_ms / 1000.0)
        self._avatar.show_boxes(layout)
        run = TaskRun(
            TaskRules(layout, Laterality(self._person.handedness)), tuple(self._avatar.parts)
        )
        for _ in range(round(SETTLING_S * FRAME_RATE_HZ)):
            self._draw(None)
        start_s = self.t_s
        run.command(CommandKind.START, start_s)
        judged, goal = run.state, self._goal_in(run)
        while run.state.clock.active_s(self.t_s) < duration_s:
            if self.t_s - start_s > duration_s + LONGEST_WALKS_BACK_S:
                raise EndlessPhaseError(
                    f"{step.key}: walks back took more than {LONGEST_WALKS_BACK_S:g} s"
                )
            # The state is the same in most frames.
            if run.state is not judged:
                judged, goal = run.state, self._goal_in(run)
            self._draw(goal)
            run.frame(self.t_s, *self._avatar.touches())
        run.command(CommandKind.FREEZE, self.t_s)
        self._avatar.show_boxes(None)
        return _outcome(step, run, elapsed_s=self.t_s - start_s)

    def _goal_in(self, run: TaskRun) -> Goal | None:
        return goal_of(run.state, self._person.leading_foot, solid=self._solid)

    def _draw(self, goal: Goal | None) -> None:
        self._pause()
        self._frame += 1
        t_s, person = self.t_s, self._person.participant
        self._avatar.frame(t_s, person.pose(t_s, goal))
        if goal is not None and goal.effector is not None:
            person.see(t_s, goal.effector, self._avatar.place_of(goal.effector))


def _outcome(step: Step, run: TaskRun, elapsed_s: float) -> PhaseOutcome:
    summary = run.summary()
    done = summary.completions
    return PhaseOutcome(
        block=step.block or 0,
        condition=step.condition or "",
        latency_ms=step.latency_ms or 0.0,
        limb=str(step.limb),
        completions=sum(event.kind is EventKind.TASK_COMPLETED for event in run.events),
        side_contacts=summary.side_contacts,
        contact_time_s=summary.side_contact_s,
        out_of_order=summary.out_of_order,
        first_completion_s=done[0].completed_active_s if done else None,
        active_s=run.state.clock.active_before_s,
        elapsed_s=elapsed_s,
    )


def _physics_body(
    layouts: Mapping[Limb, TaskLayout], stature_m: float, *, with_fingers: bool
) -> PhysicsBody:
    configuration = default_configuration()
    if not with_fingers:
        configuration = without_parts(configuration, frozenset(FINGER_PARTS))
    built = avatar_model(
        configuration,
        round(stature_m, 3),
        scene=scene_of(tuple(layouts.values())),
        step_s=DEFAULT_OPTIONS.step_s if with_fingers else WITHOUT_FINGERS_STEP_S,
    )
    return PhysicsBody(built.mjcf, configuration)
