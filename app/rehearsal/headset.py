"""The scripted headset: moves a body, delays its copy, plays the tasks, streams everything.

The remote avatar is a delayed copy of the movement, or a body that follows it by forces, as the
study specifies; contacts are those of that avatar. A physics avatar is requested from the server
once the participant's stature is known and the T-pose is held.
"""

import asyncio
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from httpx2 import AsyncClient
from numpy.typing import NDArray

from app.client import Json, RoadClient, TelemetryClient, TelemetryError, call_with_retry
from app.protocol import Tasks
from app.protocol.avatar import AvatarFile, configuration_of
from app.rehearsal.frame_clock import FrameClock
from app.rehearsal.road_run import CrossingRun
from app.rehearsal.road_shape import RoadShape
from app.rehearsal.task_run import BoxRun
from app.rehearsal.timed_run import FreeRun, TimedRun
from app.science.rotations import FloatArray
from app.science.simulation import GoalKind
from app.science.skeleton import JOINT_NAMES, Pose, build_skeleton
from app.science.tasks import Laterality, Limb, TaskLayout, TaskRules
from app.simulated_people.avatars import CannotChange, DelayedCopy, PhysicsBody, RemoteAvatar
from app.simulated_people.body import Person
from app.simulated_people.goals import goal_of
from app.wire import (
    ACTIVE,
    BODY_STREAMS,
    FINGER_STREAMS,
    AvatarChangeReport,
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
"""The status of a session, and the error code with which the server refuses its data."""

ROAD_ANSWERS_S = 20.0
"""How long a rehearsal faster than real time waits for the traffic of a step."""
_SLOWEST_M_S, _LOOKS_FOR_S = 0.55, 1.0


class RoadLostError(Exception):
    """The study's road broke off during a phase; the message says why."""


class AvatarSource(Protocol):
    """A source of the physics avatar of a session."""

    async def request_avatar(self, stature_m: float, body: str | None = None) -> PhysicsBody:
        """Return the avatar for a participant of this stature, with the body of this name.

        Without a name it has the body of the avatar's configuration.
        """


@dataclass(frozen=True)
class FromServer:
    """The avatar that the server builds and records.

    `http` sends as the session's paired headset. `with_fingers`: the participant's are given.
    """

    http: AsyncClient
    with_fingers: bool = False

    async def request_avatar(self, stature_m: float, body: str | None = None) -> PhysicsBody:
        """Return the avatar for a participant of this stature, with the body of this name.

        Raises the errors of `call_with_retry`.
        """
        answer: Json = await call_with_retry(
            self.http, "POST", "/api/vr/avatar", {"stature_m": stature_m, "body": body}
        )
        configuration = configuration_of(AvatarFile.model_validate(answer["configuration"]))
        # Loading the model and the compiled code takes a second or two.
        own_m = build_skeleton(stature_m).standing_hips_m
        scale = answer["standing_hips_m"] / own_m
        return await asyncio.to_thread(
            PhysicsBody, answer["mjcf"], configuration, scale, with_fingers=self.with_fingers
        )


@dataclass
class Buffers:
    """The frames of the batch that is being filled."""

    times_s: NDArray[np.float64] = field(default_factory=lambda: np.zeros(FRAMES_PER_BATCH))
    flags: NDArray[np.uint8] = field(
        default_factory=lambda: np.zeros(FRAMES_PER_BATCH, dtype=np.uint8)
    )
    values: dict[StreamName, NDArray[np.float32]] = field(
        default_factory=lambda: {
            stream: np.zeros((FRAMES_PER_BATCH, stream.values_per_frame), dtype=np.float32)
            for stream in StreamName
        }
    )
    count: int = 0


class Headset:
    """The headset, which runs until the session is over or its recording ends.

    `clock` is also the clock of the client's probes. `physics` is the source of a physics avatar;
    without it the avatar is a delayed copy.
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
        self._streams = (*BODY_STREAMS, *(() if person.fingers is None else FINGER_STREAMS))
        self.frames_sent: dict[str, int] = {name.value: 0 for name in self._streams}
        self.completions = 0
        self.contacts = 0
        self._person, self._clock = person, clock
        self._layouts = tasks.layouts()
        self._physics = physics
        self._avatar: RemoteAvatar | None = None
        self._bodies: dict[str | None, PhysicsBody] = {}
        if physics is None:
            self._avatar = DelayedCopy(person.skeleton, with_fingers=person.fingers is not None)
        self._run: TimedRun | None = None
        self._phase_id = 0
        self._road: RoadClient | None = None
        self._buffers = Buffers()
        self._t_pose_since_s: float | None = None
        self._materialised = False
        self._revision = 0
        self._has_avatar_moved = False
        self._is_unchanged = False

    @property
    def _goes_on_alone(self) -> bool:
        """Whether the study lets a phase continue while the connection is lost."""
        welcome = self.client.welcome
        return welcome is not None and welcome.on_disconnect == "continue"

    @property
    def speed_reached(self) -> float:
        """How many times faster than real time its clock has run."""
        return self._clock.speed_reached

    @property
    def t_s(self) -> float:
        """The headset's monotonic clock: the time of the current frame."""
        return self._clock.t_s

    @property
    def active_s(self) -> float:
        """The active time of the current phase; 0.0 outside phases."""
        return 0.0 if self._run is None else self._run.active_s(self.t_s)

    async def run(self) -> None:
        """Draw frame after frame until the session ends.

        Once the participant has withdrawn, nothing more of their data is sent: the remaining
        messages of the journal are discarded, as the server instructs.
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
                if self._road is not None and self._clock.speed > 1.0:
                    await self._road.caught_up(ROAD_ANSWERS_S)
            await self._sleep_until_due()
        await self._leave_road()
        await self._flush()
        await self.client.drained()

    async def _sleep_until_due(self) -> None:
        """Wait for the next frame; if it is late, only let other tasks run.

        A rehearsal faster than real time also waits for the server: otherwise its commands would
        arrive late in the headset's time. A headset in real time cannot wait, and relies on its
        journal.
        """
        await asyncio.sleep(self._clock.wait_s())
        if self._clock.speed > 1.0:
            await self.client.at_most_waiting(MESSAGES_AHEAD)

    async def _follow(self, state: HeadsetState) -> None:
        """Bring the headset in line with the session's state."""
        if self._avatar is None and state.materialised:
            # An earlier run of the client had requested the avatar.
            await self._request_avatar(state)
        if state.step_kind == "materialise" and not state.materialised:
            await self._materialise(state)
        await self._change_avatar(state)
        order = state.phase
        if self._run is not None and order is not None:
            if self._run.order.phase_id == order.phase_id:
                if self.client.settled:
                    await self._report(self._run.follow(order, self.t_s))
                return
            # Another phase was started: the current one was voided.
            await self._leave_phase()
        if order is None or self._has_ended(order):
            if self._run is not None:
                await self._leave_phase()
            return
        await self._enter_phase(order)

    def _has_ended(self, order: PhaseOrder) -> bool:
        """Return whether the order is older than our own report that the phase has ended."""
        return self._run is None and order.phase_id <= self._phase_id

    async def _materialise(self, state: HeadsetState) -> None:
        if self._t_pose_since_s is None:
            self._t_pose_since_s = self.t_s
        elif self.t_s - self._t_pose_since_s >= T_POSE_S and not self._materialised:
            self._materialised = True
            await self._request_avatar(state)
            await self.client.report(MaterialisedReport(t_s=self.t_s))

    async def _request_avatar(self, state: HeadsetState) -> None:
        """Request the physics avatar, if there is one, for the recorded stature.

        All bodies of the study are requested at once: they are ready when a block begins, and
        neither the time nor the kind of a request reveals which is worn next.
        """
        if self._physics is None:
            return
        stature_m = state.participant.stature_m or self._person.stature_m
        named = () if self.client.welcome is None else self.client.welcome.bodies
        for body in (None, *named):
            self._bodies[body] = await self._physics.request_avatar(stature_m, body)
        self._avatar = self._bodies[None]

    async def _change_avatar(self, state: HeadsetState) -> None:
        """Bring the avatar to the changes in force, and report when they took effect."""
        order = state.avatar_changes
        if order is None or (order.revision == self._revision and not self._is_unchanged):
            return
        if self._avatar is None or not self._has_avatar_moved:
            # A cast is put on a body that has taken the participant's pose.
            return
        self._is_unchanged = False
        if order.revision == self._revision:
            # Already reported with another body; a second report would reveal the new body.
            with suppress(CannotChange):
                self._avatar.change(order)
            return
        self._revision = order.revision
        try:
            held_rad, problem = self._avatar.change(order), None
        except CannotChange as error:
            held_rad, problem = {}, str(error)[:300]
        await self._flush()
        await self.client.report(
            AvatarChangeReport(
                revision=order.revision,
                t_s=self.t_s,
                applied=problem is None,
                problem=problem,
                held_rad=held_rad,
            )
        )

    async def _enter_phase(self, order: PhaseOrder) -> None:
        await self._flush()
        self._phase_id = order.phase_id
        self._wear(order.body)
        self._follow_later(order.latency_ms / 1000.0)
        self._show_boxes(None if order.limb is None else self._layouts[Limb(order.limb)])
        if order.has_road:
            self._run = self._enter_road(order)
        elif order.limb is None:
            self._run = FreeRun(order, self.t_s)
        else:
            hand = Laterality(self._person.handedness)
            rules = TaskRules(self._layouts[Limb(order.limb)], hand)
            parts = JOINT_NAMES if self._avatar is None else self._avatar.parts
            self._run = BoxRun(order, rules, parts, self.t_s)

    def _enter_road(self, order: PhaseOrder) -> CrossingRun:
        """Begin to cross; the road's socket is opened once they stand at the start."""
        content = {} if self.client.welcome is None else self.client.welcome.road
        shape = RoadShape.of(content)
        self._person.participant.stand_on(shape)
        # As long as they need to the other kerb, and a second more.
        accepts_s = 2.0 * shape.lane_width_m / _SLOWEST_M_S + _LOOKS_FOR_S
        return CrossingRun(order, shape, accepts_s, self.t_s)

    def _walk(self, run: CrossingRun, x_m: float, z_m: float) -> None:
        """Say where the participant is on the road, whose traffic comes when they are at the start.

        Raises:
            RoadLostError: the traffic broke off.
        """
        places = run.walk(self.t_s, x_m, z_m)
        if self._road is not None:
            self._road.say(places, running=run.clock_runs)
        elif run.awaits != "start":
            self._road = RoadClient(
                self.client.url.replace("/vr/stream", "/vr/road"),
                self.client.token,
                run.order.phase_id,
                run.active_s(self.t_s),
                run.enter_scene(self.t_s, x_m, z_m),
            )
        if self._road is not None and self._road.problem:
            raise RoadLostError(f"the road broke off: {self._road.problem}")
        run.follow_traffic(has_traffic=self._road is not None and self._road.has_traffic)

    async def _leave_road(self) -> None:
        if self._road is not None:
            road, self._road = self._road, None
            await road.end()
            if road.ended is None:
                raise RoadLostError("the road did not end")
            if road.problem:
                raise RoadLostError(f"the road broke off: {road.problem}")

    async def _leave_phase(self) -> None:
        await self._leave_road()
        await self._flush()
        self._person.participant.stand_on(None)
        self._run = None
        self._follow_later(0.0)
        self._show_boxes(None)

    def _wear(self, body: str | None) -> None:
        """Put on the body that a phase prescribes; it begins at rest, in the participant's pose."""
        worn = self._bodies.get(body)
        if worn is None or worn is self._avatar:
            return
        worn.put_on()
        self._avatar = worn
        # Changes in force apply to this body, too, once it has taken the participant's pose.
        self._has_avatar_moved, self._is_unchanged = False, True

    def _follow_later(self, latency_s: float) -> None:
        if self._avatar is not None:
            self._avatar.set_latency(latency_s)

    def _show_boxes(self, layout: TaskLayout | None) -> None:
        if self._avatar is not None:
            self._avatar.show_boxes(layout)

    async def _draw(self, *, recording: bool) -> None:
        """Draw one frame: the participant's pose, the avatar, its contacts, and the record."""
        self._clock.frame += 1
        t_s, run = self.t_s, self._run
        goal = None
        if isinstance(run, BoxRun):
            solid = self._physics is not None
            goal = goal_of(run.state, self._person.leading_foot, solid=solid)
        elif isinstance(run, CrossingRun):
            known = None if self._road is None else self._road.actors
            goal = run.goal(() if known is None else known.actors)
        avatar = self._avatar
        pose = self._person.participant.pose(t_s, goal)
        if avatar is None:
            return
        reaching = None if goal is None or goal.kind is not GoalKind.REACH else goal.effector
        fingers = None if self._person.fingers is None else self._person.fingers.pose(t_s, reaching)
        shown = avatar.frame(t_s, pose, fingers)
        if goal is not None and goal.effector is not None:
            self._person.participant.see(t_s, goal.effector, avatar.place_of(goal.effector))
        self._has_avatar_moved = True
        if recording:
            self._record(t_s, pose, shown, (fingers, avatar.fingers))
        if run is not None:
            connected = self.client.connected or self._goes_on_alone
            if isinstance(run, CrossingRun):
                x_m, _, z_m = (float(one) for one in shown.root_position_m)
                self._walk(run, x_m, z_m)
            await self._report(run.frame(t_s, avatar.touches, connected=connected))
            if run.ended:
                await self._leave_phase()
        if self._buffers.count == FRAMES_PER_BATCH:
            await self._flush()

    def _record(
        self,
        t_s: float,
        pose: Pose,
        shown: Pose,
        fingers: tuple[FloatArray | None, FloatArray | None],
    ) -> None:
        buffers, at = self._buffers, self._buffers.count
        buffers.times_s[at] = t_s
        buffers.flags[at] = ACTIVE if self._run is not None and self._run.clock_runs else 0
        for stream, of in zip(BODY_STREAMS, (pose, shown), strict=True):
            buffers.values[stream][at, :3] = of.root_position_m
            buffers.values[stream][at, 3:] = of.rotations.ravel()
        for stream, rotations in zip(FINGER_STREAMS, fingers, strict=True):
            if rotations is not None:
                buffers.values[stream][at] = rotations.ravel()
        buffers.count += 1

    async def _flush(self) -> None:
        """Send the frames collected so far; a batch never spans two phases."""
        buffers, count = self._buffers, self._buffers.count
        if count == 0:
            return
        seq_first = self.frames_sent[StreamName.TARGET]
        for stream in self._streams:
            message = encode_batch(
                stream,
                epoch=self.client.epoch,
                phase_id=0 if self._run is None else self._phase_id,
                seq_first=seq_first,
                times_s=buffers.times_s[:count],
                flags=buffers.flags[:count],
                values=buffers.values[stream][:count],
                active_s=0.0 if self._run is None else self._run.active_s(self.t_s),
                closed_at_s=self.t_s,
            )
            await self.client.send_batch(stream, seq_first + count, message)
            self.frames_sent[stream] += count
        buffers.count = 0

    async def _report(self, reports: Sequence[ReportBody]) -> None:
        if reports:
            # Send frames first, so that the movement that led to a report is stored before it.
            await self._flush()
        for body in reports:
            self.contacts += body.kind == "contact"
            self.completions += body.kind == "completion"
            await self.client.report(body)
