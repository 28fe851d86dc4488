"""A scripted participant goes through a whole session over the public interfaces only.

Three parts run side by side as three devices would: an operator who presses the buttons, a tablet
that reads and answers, a headset that moves, plays and streams. The session is simulated and says
so everywhere.
"""

import asyncio
import json
import time
from collections.abc import Callable
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from httpx2 import AsyncClient

from app.client.http import Operator, ServerRefusedError, Tablet, call
from app.client.telemetry import TelemetryClient
from app.protocol import Tasks
from app.rehearsal.answers import fill_in
from app.rehearsal.body import Person, make_person
from app.rehearsal.headset import Headset

Json = dict[str, Any]
ENDED = ("completed", "aborted", "withdrawn")
LOOK_EVERY_S = 0.1


@dataclass(frozen=True)
class RehearsalPlan:
    """What to rehearse. `token` None logs in with `password`. `speed` 1 is real time."""

    url: str
    study: str
    speed: float
    seed: int
    capture: Path | None = None
    token: str | None = None
    password: str | None = None
    language: str = "en"
    participant_code: str | None = None


@dataclass(frozen=True)
class RehearsalReport:
    """What was sent and what the server says it stored."""

    session_id: str
    simulated: bool
    frames_sent: dict[str, int]
    frames_stored: dict[str, int]
    streams: list[Json]
    phases: list[Json]
    questionnaires: int
    completions: int
    contacts: int
    side_contacts: int
    reconnects: int
    duration_s: float
    seed: int
    speed: float
    capture: str | None


@dataclass
class _Cast:
    """The three devices and what they share."""

    operator: Operator
    tablet: Tablet
    headset: Headset
    person: Person
    rng: np.random.Generator
    speed: float
    say: Callable[[str], None]
    submitted: set[str] = field(default_factory=set)


async def rehearse(
    plan: RehearsalPlan, say: Callable[[str], None] = lambda _: None
) -> RehearsalReport:
    """Run a whole session; `say` is told each step.

    Raises CaptureError, ServerRefusedError, UnreachableError or TelemetryError.
    """
    began_s = time.monotonic()
    rng = np.random.default_rng(plan.seed)
    person = make_person(rng, plan.capture)
    async with AsyncExitStack() as stack:
        http = await stack.enter_async_context(_client(plan))
        await _sign_in(http, plan)
        session = await _join(http, plan)
        operator = Operator(http, session["id"])
        tablet_http = await stack.enter_async_context(AsyncClient(base_url=plan.url, timeout=30))
        await operator.pair("tablet", tablet_http, "rehearsal tablet")
        headset_http = await stack.enter_async_context(AsyncClient(base_url=plan.url, timeout=30))
        paired = await operator.pair("headset", headset_http, "rehearsal headset")
        socket = TelemetryClient(
            url=f"{plan.url.replace('http', 'ws', 1)}/api/vr/stream",
            token=paired["token"],
            name="reembody rehearsal",
            monotonic_s=lambda: (time.monotonic() - began_s) * plan.speed,
        )
        await stack.enter_async_context(socket)
        assert socket.welcome is not None  # noqa: S101 - connected
        tasks = Tasks.model_validate_json(json.dumps(socket.welcome.tasks))
        headset = Headset(socket, person, tasks, plan.speed)
        cast = _Cast(operator, Tablet(tablet_http), headset, person, rng, plan.speed, say)
        await _perform(cast)
        return await _report(cast, plan, began_s)


def _client(plan: RehearsalPlan) -> AsyncClient:
    headers = {"authorization": f"Bearer {plan.token}"} if plan.token else {}
    return AsyncClient(base_url=plan.url, headers=headers, timeout=30)


async def _sign_in(http: AsyncClient, plan: RehearsalPlan) -> None:
    if plan.token is None:
        credentials = {"username": "admin", "password": plan.password or ""}
        await call(http, "POST", "/api/login", credentials)


async def _join(http: AsyncClient, plan: RehearsalPlan) -> Json:
    session: Json = await call(
        http,
        "POST",
        f"/api/studies/{plan.study}/sessions",
        {
            "kind": "simulated",
            "language": plan.language,
            "time_scale": plan.speed,
            "participant_code": plan.participant_code,
        },
    )
    return session


async def _perform(cast: _Cast) -> None:
    """All three at once; the first that fails ends the others."""
    async with asyncio.TaskGroup() as group:
        group.create_task(cast.headset.run())
        group.create_task(_answer(cast))
        group.create_task(_operate(cast))


async def _operate(cast: _Cast) -> None:
    """The operator: looks, presses the next button, looks again."""
    told = -1
    while True:
        view = await cast.operator.view()
        if view["status"] in ENDED:
            return
        current = view["current"]
        if current is not None and current["index"] != told:
            told = current["index"]
            cast.say(f"{told + 1}/{len(view['steps'])} {view['steps'][told]['title']}")
        action = _next_action(view, cast.person)
        if action is not None:
            kind, fields = action
            try:
                await cast.operator.command(view, kind, **fields)
            except ServerRefusedError as error:
                # Somebody else, or the headset, was first: look again.
                if error.code not in ("stale", "not_now"):
                    raise
        await asyncio.sleep(LOOK_EVERY_S / min(cast.speed, 4.0))


def _next_action(view: Json, person: Person) -> tuple[str, Json] | None:
    if view["status"] == "planned":
        return "start", {}
    current = view["current"]
    step = view["steps"][current["index"]]
    connected = any(one["kind"] == "headset" and one["connected"] for one in view["devices"])
    match step["kind"]:
        case "height":
            height = {"stated": round(person.stature_m, 2), "matched": round(person.stature_m, 3)}
            return "complete_step", {"height_m": height}
        case "debrief":
            return "complete_step", {}
        case "free_roam" | "task":
            if current["status"] == "ready" and connected:
                return "begin_phase", {}
            if current["status"] == "paused" and connected and not current["resuming"]:
                return "resume", {}
    return None


async def _answer(cast: _Cast) -> None:
    """The tablet: reads, agrees, answers."""
    while True:
        state = await cast.tablet.state()
        match state["screen"]:
            case "finished":
                return
            case "consent" | "instructions":
                await cast.tablet.acknowledge(state["step_index"])
            case "form":
                await _fill_in(cast, state["administration"])
            case _:
                await asyncio.sleep(LOOK_EVERY_S / min(cast.speed, 4.0))


async def _fill_in(cast: _Cast, administration: Json) -> None:
    view = await cast.operator.view()
    step = view["steps"][administration["step_index"]]
    answers = fill_in(
        administration["instrument"], cast.person, step["latency_ms"], step["limb"], cast.rng
    )
    await cast.tablet.submit(administration, answers, f"rehearsal-{administration['key']}"[:64])
    cast.submitted.add(administration["key"])


async def _report(cast: _Cast, plan: RehearsalPlan, began_s: float) -> RehearsalReport:
    view = await cast.operator.view()
    session_id = cast.operator.session_id
    streams: list[Json] = await call(
        cast.operator.client, "GET", f"/api/sessions/{session_id}/streams"
    )
    stored: dict[str, int] = {}
    for row in streams:
        if row["stream"] in cast.headset.frames_sent:
            stored[row["stream"]] = stored.get(row["stream"], 0) + row["frames_stored"]
    return RehearsalReport(
        session_id=session_id,
        simulated=True,
        frames_sent=cast.headset.frames_sent,
        frames_stored=stored,
        streams=streams,
        phases=[
            {
                key: phase[key]
                for key in (
                    "phase_id",
                    "kind",
                    "limb",
                    "latency_ms",
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
        side_contacts=sum(phase["side_contacts"] for phase in view["phases"]),
        reconnects=cast.headset.client.reconnects,
        duration_s=time.monotonic() - began_s,
        seed=plan.seed,
        speed=plan.speed,
        capture=None if plan.capture is None else plan.capture.name,
    )
