"""The scripted headset: moves a body, delays its copy, plays the tasks, streams everything.

The remote avatar is a delayed copy of the movement, or a body that follows it by forces, as the
study says; contacts are what that avatar touches. One that is moved by physics is had from the
server when the participant's stature is known and the T-pose is held.
"""

import asyncio
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from app.client import TelemetryClient, TelemetryError
from app.protocol import Tasks
from app.rehearsal.avatars import AvatarSource, DelayedCopy, RemoteAvatar
from app.rehearsal.body import FRAME_RATE_HZ, Person
from app.rehearsal.goals import goal_of
from app.rehearsal.task_run import BoxRun
from app.rehearsal.timed_run import FreeRun, TimedRun
from app.science.skeleton import JOINT_NAMES, Pose
from app.science.tasks import Laterality, Limb, TaskLayout, TaskRules
from app.wire import (
    ACTIVE,
    VALUES_PER_FRAME,
    HeadsetState,
    MaterialisedReport,
    PhaseOrder,
    ReportBody,
    StreamName,
    encode_batch,
)

FRAMES_PER_BATCH = 6
T_POSE_S = 2.0
MESSAGES_AHEAD = 100
WITHDRAWN = "withdrawn"
"""Status of a session, and why the server takes no more of it."""


@dataclass
class FrameClock:
    """Goes `speed` seconds a second, and never beyond the frame that was drawn last.

    So a machine that is too slow for the speed has a slower clock, as a headset that drops frames
    has not: only a rehearsal faster than life can come to that.
    """

    speed: float
    frame: int = 0
    _started_s: float = field(default_factory=time.monotonic)

    def start(self) -> None:
        """The first frame is due now."""
        self._started_s = time.monotonic()

    @property
    def t_s(self) -> float:
        """The time of the present frame."""
        return self.frame / FRAME_RATE_HZ

    def now_s(self) -> float:
        """The time at any moment, also between two frames."""
        return min(self.t_s, (time.monotonic() - self._started_s) * self.speed)

    @property
    def due_in_s(self) -> float:
        """How many real seconds until the next frame; not above zero where it is late."""
        return self._started_s + self.t_s / self.speed - time.monotonic()


@dataclass
class Buffers:
    """The frames of the batch that is being filled."""

    times_s: NDArray[np.float64] = field(default_factory=lambda: np.zeros(FRAMES_PER_BATCH))
    flags: NDArray[np.uint8] = field(
        default_factory=lambda: np.zeros(FRAMES_PER_BATCH, dtype=np.uint8)
    )
    target: NDArray[np.float32] = field(
        default_factory=lambda: np.zeros((FRAMES_PER_BATCH, VALUES_PER_FRAME), dtype=np.float32)
    )
    actual: NDArray[np.float32] = field(
        default_factory=lambda: np.zeros((FRAMES_PER_BATCH, VALUES_PER_FRAME), dtype=np.float32)
    )
    count: int = 0


class Headset:
    """Runs until the session is over or recording ends with the debriefing.

    `clock` is the one that the client shows in its probes, too. `physics` is where an avatar moved
    by physics is had from; without it the avatar is a delayed copy.
    """

    def __init__(
        self,
        client: TelemetryClient,
        person: Person,
        tasks: Tasks,
        clock: FrameClock,
        physics: AvatarSource | None = None,
    ) -> None:
        self.client = client
        self.frames_sent: dict[str, int] = {name.value: 0 for name in StreamName}
        self.completions = 0
        self.contacts = 0
        self._person, self._clock = person, clock
        self._layouts = tasks.layouts()
        self._physics = physics
        self._avatar: RemoteAvatar | None = None if physics else DelayedCopy(person.skeleton)
        self._run: TimedRun | None = None
        self._phase_id = 0
        self._buffers = Buffers()
        self._t_pose_since_s: float | None = None
        self._materialised = False

    @property
    def _goes_on_alone(self) -> bool:
        """Whether the study lets a phase run on while the connection is broken."""
        welcome = self.client.welcome
        return welcome is not None and welcome.on_disconnect == "continue"

    @property
    def t_s(self) -> float:
        """The headset's monotonic clock: the time of the present frame."""
        return self._clock.t_s

    @property
    def active_s(self) -> float:
        """Active time used of the phase under way; 0.0 where there is none."""
        return 0.0 if self._run is None else self._run.active_s(self.t_s)

    async def run(self) -> None:
        """Draw frame after frame while the session lasts.

        Once the participant has withdrawn nothing more is taken of them: what the journal still
        holds is left, as the server says.
        """
        try:
            await self._draw_while_it_lasts()
        except TelemetryError:
            if self.client.failure is None or self.client.failure.code != WITHDRAWN:
                raise

    async def _draw_while_it_lasts(self) -> None:
        self._clock.start()
        while True:
            state = self.client.state
            if state is not None and state.status == WITHDRAWN:
                return
            if state is None or state.status in ("completed", "aborted"):
                break
            await self._follow(state)
            for _ in range(FRAMES_PER_BATCH):
                await self._draw(recording=state.recording)
            await self._sleep_until_due()
        await self._flush()
        await self.client.drained()

    async def _sleep_until_due(self) -> None:
        """Keep the pace; a machine that is behind goes on at once but lets others run.

        A rehearsal faster than life also waits for the server: else its orders would come late in
        the headset's time. A headset in real time cannot wait, and goes on by its journal.
        """
        await asyncio.sleep(max(0.0, self._clock.due_in_s))
        if self._clock.speed > 1.0:
            await self.client.at_most_waiting(MESSAGES_AHEAD)

    async def _follow(self, state: HeadsetState) -> None:
        """Converge to the session's state."""
        if self._avatar is None and state.materialised:
            # Another run of the client had taken it up.
            await self._take_up(state)
        if state.step_kind == "materialise" and not state.materialised:
            await self._materialise(state)
        order = state.phase
        if self._run is not None and order is not None:
            if self._run.order.phase_id == order.phase_id:
                if self.client.settled:
                    await self._report(self._run.follow(order, self.t_s))
                return
            # Another phase was called: the one under way was voided.
            await self._leave_phase()
        if order is None or self._has_ended(order):
            if self._run is not None:
                await self._leave_phase()
            return
        await self._enter_phase(order)

    def _has_ended(self, order: PhaseOrder) -> bool:
        """Whether the state is older than our own report that the phase has ended."""
        return self._run is None and order.phase_id <= self._phase_id

    async def _materialise(self, state: HeadsetState) -> None:
        if self._t_pose_since_s is None:
            self._t_pose_since_s = self.t_s
        elif self.t_s - self._t_pose_since_s >= T_POSE_S and not self._materialised:
            self._materialised = True
            await self._take_up(state)
            await self.client.report(MaterialisedReport(t_s=self.t_s))

    async def _take_up(self, state: HeadsetState) -> None:
        """Have the avatar that physics moves, for the stature that is on record."""
        if self._physics is not None:
            stature_m = state.participant.stature_m or self._person.stature_m
            self._avatar = await self._physics.take_up(stature_m)

    async def _enter_phase(self, order: PhaseOrder) -> None:
        await self._flush()
        self._phase_id = order.phase_id
        self._follow_later(order.latency_ms / 1000.0)
        self._show_boxes(None if order.limb is None else self._layouts[Limb(order.limb)])
        if order.limb is None:
            self._run = FreeRun(order, self.t_s)
        else:
            hand = Laterality(self._person.handedness)
            rules = TaskRules(self._layouts[Limb(order.limb)], hand)
            self._run = BoxRun(order, rules, JOINT_NAMES, self.t_s)

    async def _leave_phase(self) -> None:
        await self._flush()
        self._run = None
        self._follow_later(0.0)
        self._show_boxes(None)

    def _follow_later(self, latency_s: float) -> None:
        if self._avatar is not None:
            self._avatar.set_latency(latency_s)
        self._person.participant.set_latency(latency_s)

    def _show_boxes(self, layout: TaskLayout | None) -> None:
        if self._avatar is not None:
            self._avatar.show_boxes(layout)

    async def _draw(self, *, recording: bool) -> None:
        """One frame: the person's pose, the delayed avatar, its contacts, and the record."""
        self._clock.frame += 1
        t_s, run = self.t_s, self._run
        goal = None
        if isinstance(run, BoxRun):
            foot = "right" if self._person.footedness == "both" else self._person.footedness
            solid = self._physics is not None
            goal = goal_of(run.state, Laterality(foot), solid=solid)
        pose = self._person.participant.pose(t_s, goal)
        avatar = self._avatar
        if avatar is None:
            return
        shown = avatar.frame(t_s, pose)
        if recording:
            self._record(t_s, pose, shown)
        if run is not None:
            connected = self.client.connected or self._goes_on_alone
            await self._report(run.frame(t_s, avatar.touches, connected=connected))
            if run.ended:
                await self._leave_phase()
        if self._buffers.count == FRAMES_PER_BATCH:
            await self._flush()

    def _record(self, t_s: float, pose: Pose, shown: Pose) -> None:
        buffers, at = self._buffers, self._buffers.count
        buffers.times_s[at] = t_s
        buffers.flags[at] = ACTIVE if self._run is not None and self._run.clock_runs else 0
        for values, of in ((buffers.target, pose), (buffers.actual, shown)):
            values[at, :3] = of.root_position_m
            values[at, 3:] = of.rotations.ravel()
        buffers.count += 1

    async def _flush(self) -> None:
        """Send the frames so far; a batch never spans two phases."""
        buffers, count = self._buffers, self._buffers.count
        if count == 0:
            return
        seq_first = self.frames_sent[StreamName.TARGET]
        for stream, values in (
            (StreamName.TARGET, buffers.target),
            (StreamName.ACTUAL, buffers.actual),
        ):
            message = encode_batch(
                stream,
                epoch=self.client.epoch,
                phase_id=0 if self._run is None else self._phase_id,
                seq_first=seq_first,
                times_s=buffers.times_s[:count],
                flags=buffers.flags[:count],
                values=values[:count],
                active_s=0.0 if self._run is None else self._run.active_s(self.t_s),
                closed_at_s=self.t_s,
            )
            await self.client.send_batch(stream, seq_first + count, message)
            self.frames_sent[stream] += count
        buffers.count = 0

    async def _report(self, reports: Sequence[ReportBody]) -> None:
        if reports:
            # Frames first: whoever reads a report finds the movement that led to it.
            await self._flush()
        for body in reports:
            self.contacts += body.kind == "contact"
            self.completions += body.kind == "completion"
            await self.client.report(body)
