"""Take a scripted participant through a whole session over the public interfaces only.

Three parts run in parallel, as three devices would: an operator who issues commands, a tablet that
reads and answers, a headset that moves, plays and streams. The session is marked as simulated
everywhere.
"""

import json
import re
import time
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from httpx2 import AsyncClient

from app.client import (
    Journal,
    Operator,
    ServerRefusedError,
    Tablet,
    TelemetryClient,
    call,
    call_with_retry,
)
from app.protocol import Tasks
from app.rehearsal.answers import aspects_named
from app.rehearsal.cast import Cast, Interruption, perform
from app.rehearsal.frame_clock import FrameClock
from app.rehearsal.headset import WITHDRAWN, FromServer, Headset
from app.resources import study_configs_dir
from app.simulated_people.body import make_person

Json = dict[str, Any]
AVATARS = ("delayed_copy", "physics")
"""The kinds of avatar that the scripted headset can show."""
PHYSICS_SUFFIX = "-physics"
PHYSICS_AVATAR = "standard"
_KEY = re.compile(r"^key: .*$", re.MULTILINE)
_MOVED = re.compile(r"^avatar: delayed_copy[ \t]*$", re.MULTILINE)


@dataclass(frozen=True)
class RehearsalPlan:
    """The plan of a rehearsal. `token` None logs in with `password`. `speed` 1 is real time.

    `physics`: use a physics avatar, in a copy of the study if that has another one. `fingers`: the
    participant's fingers are recorded: those of the capture, or generated ones. `redo`: the
    phase that is repeated half-way through; `withdraw_during`: the one in which the participant
    withdraws. Phases count from 1, in the order of the visit.
    """

    url: str
    study: str
    speed: float
    seed: int
    capture: Path | None = None
    token: str | None = None
    password: str | None = None
    language: str = "en"
    participant_code: str | None = None
    physics: bool = False
    fingers: bool = False
    redo: int | None = None
    withdraw_during: int | None = None

    @property
    def interruptions(self) -> list[Interruption]:
        """The operator's interruptions, in the order of the visit."""
        redo = [] if self.redo is None else [Interruption("redo", self.redo)]
        if self.withdraw_during is None:
            return redo
        return [*redo, Interruption("withdraw", self.withdraw_during)]

    @property
    def ends_as(self) -> str:
        """The final status of a session that goes as planned."""
        return "completed" if self.withdraw_during is None else WITHDRAWN


@dataclass(frozen=True)
class Visit:
    """The length of a study's visit: the number of timed phases, and their total time in s.

    `physics`: whether it has a physics avatar; assumed if the caller may not see the protocol.
    """

    phases: int
    planned_s: float
    physics: bool


@dataclass(frozen=True)
class RehearsalReport:
    """The result of a rehearsal: what was sent, and what the server reports as stored.

    `status`: how the session ended; somebody else may have aborted it. `speed`: as it was asked
    for; `speed_reached`: as fast as the machine could go. `crossings`: how the participant crossed
    the study's road, if it has one. The latency of phases is
    None if the caller must not know it.
    """

    session_id: str
    status: str
    simulated: bool
    avatar: str
    avatar_configuration_hash: str | None
    frames_sent: dict[str, int]
    frames_stored: dict[str, int]
    streams: list[Json]
    crossings: list[Json]
    phases: list[Json]
    questionnaires: int
    completions: int
    contacts: int
    side_contacts: int
    reconnects: int
    duration_s: float
    seed: int
    speed: float
    speed_reached: float
    capture: str | None


async def store_template(plan: RehearsalPlan) -> None:
    """Store the template of the plan's study on its server, if it is one and is not there yet.

    Raises ServerRefusedError or UnreachableError.
    """
    file = study_configs_dir() / "templates" / f"{plan.study}.yaml"
    if not file.is_file():
        return
    async with _client(plan) as http:
        await _sign_in(http, plan)
        try:
            await call(http, "GET", f"/api/studies/{plan.study}")
        except ServerRefusedError as error:
            if error.code != "not_found":
                raise
            await call(http, "POST", "/api/studies", {"yaml": file.read_text(encoding="utf-8")})


async def visit_of(plan: RehearsalPlan) -> Visit:
    """Return the length of a visit, as the plan's study specifies it.

    Raises ValueError if an interruption is planned for a phase that a visit does not have,
    ServerRefusedError or UnreachableError.
    """
    async with _client(plan) as http:
        await _sign_in(http, plan)
        study: Json = await call(http, "GET", f"/api/studies/{plan.study}")
    avatar = (study["protocol"] or {}).get("avatar", "physics")
    physics = plan.physics or avatar == "physics"
    visit = Visit(study["phases"], 60.0 * study["planned_minutes"], physics)
    for option, phase in (("--redo", plan.redo), ("--withdraw-during", plan.withdraw_during)):
        if phase is not None and phase > visit.phases:
            raise ValueError(
                f"{option} {phase}: a visit of {plan.study} has {visit.phases} phases; practice and"
                f" free movement count, so 1 to {visit.phases} are valid"
            )
    return visit


async def rehearse(
    plan: RehearsalPlan,
    say: Callable[[str], None] = lambda _: None,
    *,
    journal: Journal | None = None,
) -> RehearsalReport:
    """Run a whole session; `say` gets each step, `journal` is the headset's journal.

    Raises UnusableCapture, NoVariantError, ServerRefusedError, UnreachableError or TelemetryError.
    """
    began_s = time.monotonic()
    async with assembled(plan, say, journal=journal) as cast:
        await perform(cast)
        return await report_of(cast, plan, time.monotonic() - began_s)


@asynccontextmanager
async def assembled(
    plan: RehearsalPlan,
    say: Callable[[str], None] = lambda _: None,
    *,
    journal: Journal | None = None,
) -> AsyncIterator[Cast]:
    """Create a session with three paired devices, ready to start.

    Raises the same errors as `rehearse`.
    """
    clock = FrameClock(plan.speed)
    rng = np.random.default_rng(plan.seed)
    person = make_person(rng, plan.capture, with_fingers=plan.fingers)
    async with AsyncExitStack() as stack:
        http = await stack.enter_async_context(_client(plan))
        await _sign_in(http, plan)
        session = await _join(http, plan)
        study: Json = await call(http, "GET", f"/api/studies/{plan.study}")
        operator = Operator(http, session["id"])
        tablet_http = await stack.enter_async_context(AsyncClient(base_url=plan.url, timeout=30))
        await operator.pair("tablet", tablet_http, "rehearsal tablet")
        headset_http = await stack.enter_async_context(AsyncClient(base_url=plan.url, timeout=30))
        paired = await operator.pair("headset", headset_http, "rehearsal headset")
        headset_http.headers["authorization"] = f"Bearer {paired['token']}"
        socket = TelemetryClient(
            url=f"{plan.url.replace('http', 'ws', 1)}/api/vr/stream",
            token=paired["token"],
            name="reembody rehearsal",
            avatars=AVATARS,
            fingers=plan.fingers,
            changes_avatar=True,
            monotonic_s=clock.now_s,
            journal=journal if journal is not None else Journal(),
        )
        await stack.enter_async_context(socket)
        physics = (
            FromServer(headset_http, with_fingers=plan.fingers)
            if session["avatar"] == "physics"
            else None
        )
        headset = Headset(socket, person, tasks_of(socket), clock, physics)
        tablet = Tablet(tablet_http)
        yield Cast(
            operator,
            tablet,
            headset,
            person,
            rng,
            headset_http,
            aspects_named(study["protocol"]),
            say,
            interruptions=list(plan.interruptions),
        )


def tasks_of(socket: TelemetryClient) -> Tasks:
    """Return the study's tasks from the server's welcome message."""
    content = {} if socket.welcome is None else socket.welcome.tasks
    return Tasks.model_validate_json(json.dumps(content))


def _client(plan: RehearsalPlan) -> AsyncClient:
    headers = {"authorization": f"Bearer {plan.token}"} if plan.token else {}
    return AsyncClient(base_url=plan.url, headers=headers, timeout=30)


async def _sign_in(http: AsyncClient, plan: RehearsalPlan) -> None:
    if plan.token is None:
        credentials = {"username": "admin", "password": plan.password or ""}
        await call(http, "POST", "/api/login", credentials)


async def _join(http: AsyncClient, plan: RehearsalPlan) -> Json:
    study = await physics_variant(http, plan.study) if plan.physics else plan.study
    session: Json = await call(
        http,
        "POST",
        f"/api/studies/{study}/sessions",
        {
            "kind": "simulated",
            "language": plan.language,
            "time_scale": plan.speed,
            "participant_code": plan.participant_code,
        },
    )
    return session


async def report_of(cast: Cast, plan: RehearsalPlan, duration_s: float) -> RehearsalReport:
    """Return a report on the data that were sent, and on those that the server has stored."""
    view = await cast.operator.view()
    session_id = cast.operator.session_id
    streams: list[Json] = await call_with_retry(
        cast.operator.client, "GET", f"/api/sessions/{session_id}/streams"
    )
    road: Json = await call_with_retry(
        cast.operator.client, "GET", f"/api/sessions/{session_id}/road"
    )
    stored: dict[str, int] = {}
    for row in streams:
        if row["stream"] in cast.headset.frames_sent:
            stored[row["stream"]] = stored.get(row["stream"], 0) + row["frames_stored"]
    return RehearsalReport(
        session_id=session_id,
        status=view["status"],
        simulated=True,
        avatar=view["avatar"],
        avatar_configuration_hash=view["avatar_configuration_hash"],
        frames_sent=cast.headset.frames_sent,
        frames_stored=stored,
        streams=streams,
        crossings=[one for run in road["runs"] for one in run["crossings"]],
        phases=[
            {
                key: phase[key]
                for key in (
                    "phase_id",
                    "kind",
                    "limb",
                    "latency_ms",
                    "body",
                    "status",
                    "active_s",
                    "completions",
                    "side_contacts",
                )
            }
            for phase in view["phases"]
        ],
        questionnaires=len(view["scores"]),
        completions=cast.headset.completions,
        contacts=cast.headset.contacts,
        side_contacts=sum(phase["side_contacts"] or 0 for phase in view["phases"]),
        reconnects=cast.headset.client.reconnects,
        duration_s=duration_s,
        seed=plan.seed,
        speed=plan.speed,
        speed_reached=round(cast.headset.speed_reached, 2),
        capture=None if plan.capture is None else plan.capture.name,
    )


class NoVariantError(ValueError):
    """The study cannot be copied with a physics avatar; the message says why."""


async def physics_variant(http: AsyncClient, study: str) -> str:
    """Return the key of the study if it has a physics avatar, else of its copy that has one.

    The copy is created if it does not exist, and gets a new version if the study has changed since.
    It differs in its key and in its avatar: the newest version of the standard one.

    Raises:
        NoVariantError: the file cannot be changed in these places. ServerRefusedError.
    """
    view: dict[str, Any] = await call(http, "GET", f"/api/studies/{study}")
    text = view["yaml"] or ""
    if (view["protocol"] or {}).get("avatar") == "physics":
        return study
    if len(_MOVED.findall(text)) != 1 or len(_KEY.findall(text)) != 1:
        raise NoVariantError(
            f"the file of {study!r} does not say `avatar: delayed_copy` on a line of its own; make"
            " a version of it with a physics avatar (docs/avatar-configuration.md)"
        )
    newest = (await call(http, "GET", f"/api/avatars/{PHYSICS_AVATAR}"))["newest"]["number"]
    key = study + PHYSICS_SUFFIX
    chosen = f"avatar: physics\navatar_configuration: {{key: {PHYSICS_AVATAR}, version: {newest}}}"
    changed = _MOVED.sub(chosen, _KEY.sub(f"key: {key}", text))
    try:
        existing = await call(http, "GET", f"/api/studies/{key}")
    except ServerRefusedError as error:
        if error.code != "not_found":
            raise
        await call(http, "POST", "/api/studies", {"yaml": changed})
        return key
    if existing["yaml"] != changed:
        await call(http, "POST", f"/api/studies/{key}/versions", {"yaml": changed})
    return key
