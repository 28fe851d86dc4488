"""Keep the scenes of all sessions whose participants cross a road now."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, field

from anyio import CapacityLimiter
from sqlalchemy import select
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from app.adapters.cosimulation import sumo_folder
from app.errors import Conflict
from app.features.design.studies import protocol_of
from app.features.record.road.participant import Participant
from app.features.record.road.recording import (
    RunPlan,
    next_part,
    require_recording,
    store_begin,
    store_interruption,
)
from app.features.record.road.scene import RoadScene, SceneState
from app.features.record.sessions import plan_of, state_of
from app.models import Phase, RoadRun, StudySession, StudyVersion, new_id
from app.platform.access import session_by_id
from app.platform.context import AppContext, Part
from app.protocol import StudyRoad, sha256_of
from app.science.cosimulation import CosimulationError
from app.wire import RoadHello

_SEED_LIMIT = 2**31
Wake = Callable[[], None]


@dataclass(eq=False)
class Roads(Part):
    """The scenes that run, at most one of each session."""

    context: AppContext
    _scenes: dict[str, RoadScene] = field(default_factory=dict)
    _sockets: dict[str, Wake] = field(default_factory=dict)
    _joining: dict[str, CapacityLimiter] = field(default_factory=dict)
    _lock: threading.RLock = field(default_factory=threading.RLock)

    def start(self) -> None:
        """End the runs that a crash of the server interrupted."""
        with self.context.database.writing() as db:
            for row in db.scalars(select(RoadRun).where(RoadRun.ended == "running")):
                self._interrupt(db, row, "the server was stopped meanwhile")

    def stop(self) -> None:
        """End all scenes, and store what they have."""
        with self._lock:
            scenes, self._scenes = list(self._scenes.values()), {}
        for one in scenes:
            one.end(wait=False)
        for one in scenes:
            one.end(wait=True)

    def state(self, session_id: str) -> SceneState | None:
        """Return how a session's newest scene goes; None if there was none."""
        scene = self._scenes.get(session_id)
        return None if scene is None else scene.state

    def joining(self, session_id: str) -> CapacityLimiter:
        """Return what lets one `join` of a session run at a time, and has the others wait.

        They wait in the event loop, so that a page that is loaded again and again takes no threads
        from anybody else, whatever its scene waits for.
        """
        with self._lock:
            return self._joining.setdefault(session_id, CapacityLimiter(1))

    def join(self, session_id: str, hello: RoadHello, wake: Wake) -> RoadScene:
        """Return the scene of a session's phase, begun now unless the headset goes on with it.

        The headset's older socket is woken: it is no longer attached. Call it under `joining`; it
        waits until the scene before has ended. A hello that is refused changes nothing.

        Raises:
            Conflict: the phase that the headset names is not in progress, or has no road; or the
                participant refuses to take part.
            Withdrawn: the session accepts no more data.
        """
        known = self._scenes.get(session_id)
        if known is not None and not known.is_over and known.is_of(hello):
            self._attach(session_id, wake)
            return known
        with self.context.database.reading() as db:
            self._plan(db, session_by_id(db, session_id), hello)
        self._attach(session_id, wake)
        if known is not None:
            known.end(wait=True)
        scene = self._begun(session_id, hello)
        with self._lock:
            self._scenes[session_id] = scene
            scene.start()
        return scene

    def is_attached(self, session_id: str, wake: Wake) -> bool:
        """Return whether this is still the newest socket of a session's headset on the road."""
        return self._sockets.get(session_id) == wake

    def detach(self, session_id: str, wake: Wake) -> None:
        """Forget a socket that has closed."""
        with self._lock:
            if self.is_attached(session_id, wake):
                del self._sockets[session_id]

    def _attach(self, session_id: str, wake: Wake) -> None:
        with self._lock:
            before = self._sockets.get(session_id)
            self._sockets[session_id] = wake
        if before is not None:
            before()

    def _interrupt(self, db: Session, row: RoadRun, reason: str) -> None:
        road = _road_of(db, db.get_one(StudySession, row.session_id))
        store_interruption(db, row, road, reason, self.context.clock.utc_now())

    def _begun(self, session_id: str, hello: RoadHello) -> RoadScene:
        with self.context.database.writing() as db:
            session = session_by_id(db, session_id, lock=True)
            running = select(RoadRun).where(
                RoadRun.session_id == session_id, RoadRun.ended == "running"
            )
            for row in db.scalars(running):
                self._interrupt(db, row, "its end could not be stored")
            plan, road = self._plan(db, session, hello)
            store_begin(db, plan, road.step_s, self.context.clock.utc_now())
        participant = Participant(
            road.step_s,
            round(road.warm_up_s / road.step_s),
            hello.place,
            time_scale=session.time_scale,
            is_paced=road.participant_late.rule == "extrapolate",
            is_current=lambda: self._is_current(session_id, hello.phase_id),
        )
        return RoadScene(
            self.context,
            plan,
            road,
            participant,
            lambda db: require_recording(db, session_by_id(db, session_id, lock=True)),
        )

    def _plan(
        self, db: Session, session: StudySession, hello: RoadHello
    ) -> tuple[RunPlan, StudyRoad]:
        """Return what a headset's hello begins; raise Conflict if it cannot begin."""
        require_recording(db, session)
        phase = state_of(session).phase
        if phase is None or phase.phase_id != hello.phase_id:
            raise Conflict(
                f"phase {hello.phase_id} is not in progress",
                value=hello.phase_id,
                valid=[] if phase is None else [phase.phase_id],
                remedy="Follow the newest state message.",
            )
        step = plan_of(db, session)[phase.step]
        if not step.spec.has_road:
            raise Conflict(
                f"phase {hello.phase_id} is not on the road",
                value=step.kind,
                remedy="Open this socket during a phase whose order says has_road.",
            )
        road = _road_of(db, session)
        row = db.get_one(Phase, (session.id, hello.phase_id))
        part = next_part(db, session.id, hello.phase_id)
        # Whoever comes to this block in this attempt meets the same traffic.
        place = f"{road.seed}:{step.block}:{row.attempt}:{part}"
        seed = int(sha256_of(place)[:12], 16) % _SEED_LIMIT
        header = {
            "study_version": session.study_version_id,
            "phase": step.key,
            "part": part,
            "begins_at_s": hello.active_s,
            "seed": seed,
            "road": road.model_dump(mode="json"),
        }
        at = (session.id, hello.phase_id, part, seed, hello.active_s)
        return RunPlan(new_id(), *at, header), road

    def _is_current(self, session_id: str, phase_id: int) -> bool:
        """Return whether a phase goes on; raise as `require_recording` if nothing may be stored."""
        try:
            with self.context.database.reading() as db:
                session = session_by_id(db, session_id)
                require_recording(db, session)
                phase = state_of(session).phase
        except DBAPIError:
            return True  # unknown, and the database takes nothing at the moment
        return phase is not None and phase.phase_id == phase_id


def _road_of(db: Session, session: StudySession) -> StudyRoad:
    version = db.get_one(StudyVersion, session.study_version_id)
    road = protocol_of(version).road
    if road is None:
        raise Conflict("the study has no road", remedy="Use the study version that has one.")
    return road


def missing_for(road: StudyRoad | None) -> str:
    """Return what a study's road needs and lacks, with the command that adds it; else empty."""
    if road is None or all(one.kind != "sumo" for one in road.partners):
        return ""
    try:
        sumo_folder()
    except CosimulationError as error:
        return str(error)
    return ""
