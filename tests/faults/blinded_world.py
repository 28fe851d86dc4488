"""Build blinded studies with sessions of every status, and search all responses for leaks.

Each status has its own study. The keys, names and latencies of its conditions are canaries: they
occur nowhere else, so anything found in a response can be traced to one session, even where a
response mixes studies. The search covers the conditions' keys, names and bodies, the hashes of the
models that the headset built for these bodies, latencies in ms and s, joint errors that were set
equal to the latency (in degrees), and the hashes of the event log, against which a guessed latency
could be checked. It does not cover that a delay can be computed from frames; instead, the avatar's
frames themselves count as a leak.
"""

import asyncio
import hashlib
import io
import json
import math
import re
import time
import zipfile
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from fastapi.testclient import TestClient
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.clock import Clock
from app.features.design.studies.service import create_study
from app.features.record.sessions import apply_command, store_content
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine import state_from_json, state_to_json
from app.features.record.sessions.engine.commands import ContentRef, LiftBlinding
from app.features.record.sessions.engine.state import Hold, PhaseState, PhaseStatus
from app.features.record.sessions.journal import append_events
from app.models import Participant, Phase, PhaseLatency, SessionEvent, StudySession
from app.platform.policy import POLICY
from app.wire import StreamName
from tests.api.people import ROLES, sign_in
from tests.features.builders import NOW, SessionSpec, build_session
from tests.features.lab import Lab
from tests.features.movement_builders import moving_values, store_chunks
from tests.protocol.helpers import edited

STATUSES = ("planned", "active", "paused", "held", "completed", "aborted", "withdrawn")
TAKEN_AGAIN, REVEALED = "taken again", "revealed"
"""An aborted session whose slot another one has now; an active one whose condition was shown."""
WORLDS = (*STATUSES, TAKEN_AGAIN, REVEALED)
KNOWN = ("completed", REVEALED)
"""Worlds in which roles that read results may know the condition."""
FRAMES, MS_PER_S = 90, 1000.0
HEAVY = ("/dashboard", "/statistics", "/preregistration")
"""Routes that draw figures or run tests: they take seconds."""
DESIGN = {
    "/api/studies/{key}": ("protocol", "yaml"),
    "/api/studies/{key}/versions/{number}": None,
    "/api/studies/{key}/diff": None,
    "/api/studies/{key}/dashboard": ("choices",),
}
"""Routes that show the design itself: the fields that are not searched; None: all of them."""
IDS = {"phase_id": "2", "number": "1", "figure": "joint_error_joints"}
NOBODY = "f" * 32
QUERIES = {"/api/studies/{key}/diff": {"from": "1", "to": "1"}}


@dataclass(frozen=True)
class Canaried:
    """A study with one session (or two that used one slot), and the pattern of its canaries."""

    world: str
    key: str
    session_ids: tuple[str, ...]
    participant_ids: tuple[str, ...]
    words: re.Pattern[bytes]

    def is_known_to(self, role: str) -> bool:
        """Return whether an account with this role may know the condition."""
        return role != "operator" and self.world in KNOWN


@dataclass
class Search:
    """The responses fetched so far, and the leaks found in them."""

    routes: set[str] = field(default_factory=set)
    fetched: Counter[str] = field(default_factory=Counter)
    statuses: Counter[int] = field(default_factory=Counter)
    found_where_known: int = 0
    leaks: list[str] = field(default_factory=list)

    def look(self, role: str, one: Canaried, way: str, body: bytes) -> None:
        """Search one response body and record a leak if the role may not know the condition."""
        self.fetched[way.split(" ")[0]] += 1
        match = one.words.search(body)
        if match is None:
            return
        if one.is_known_to(role):
            self.found_where_known += 1
            return
        near = body[max(0, match.start() - 50) : match.end() + 20].decode(errors="replace")
        self.leaks.append(f"{role}, {one.world}: {way}: {near}")


def number_pattern(latency_ms: float) -> str:
    """Return a pattern that matches a latency in ms or s, in any notation and rounding.

    Digits inside a longer number do not match at its start: the microseconds of a time of day and
    the middle of an identifier contain every sequence of four digits sooner or later. At its end
    only zeros and the digits of a rounding error are accepted: a headset's clock passes 137.256 s.
    """
    whole, _, part = f"{latency_ms:g}".partition(".")
    return rf"(?:0?\.?{whole}[.]?{part})(?:0{{0,3}}(?![0-9])|0{{4}})"


def canaries(latencies_ms: Sequence[float], *, more: Sequence[str] = ()) -> re.Pattern[bytes]:
    """Return a pattern that matches the latencies in any notation, and the words in `more`."""
    numbers = "|".join(number_pattern(one) for one in latencies_ms)
    words = "|".join(re.escape(one) for one in more)
    tail = f"|{words}" if words else ""
    return re.compile(f"(?<![0-9a-f.])(?:{numbers}){tail}".encode(), re.IGNORECASE)


def build_world(lab: Lab, worlds: Sequence[str] = WORLDS) -> list[Canaried]:
    """Create one study with its sessions for each entry of `worlds`."""
    with lab.database.writing() as db:
        return [_build(lab, db, WORLDS.index(world), world) for world in worlds]


def _build(lab: Lab, db: Session, number: int, world: str) -> Canaried:
    name = world.replace(" ", "-")
    body = f"canary{number}body"
    small, large = 137.25 + number, 262.75 + number
    words = [f"canary{number}small", f"canary{number}large"]
    text = edited(
        ("key: reembodiment-latency", f"key: blinded-{name}"),
        ("operator: false", "operator: true"),
        ("latency_125", words[0]),
        ("latency_ms: 125", f"latency_ms: {small}"),
        ("125 ms added", f"{words[0]} added"),
        ("latency_350", words[1]),
        ("latency_ms: 350", f"latency_ms: {large}"),
        ("350 ms added", f"{words[1]} added"),
    )
    key = f"blinded-{name}"
    create_study(db, text, NOW)
    sessions = [_session(db, key, world, body)]
    if world == TAKEN_AGAIN:
        sessions.append(_session(db, key, "active", body, code="P-0002"))
    if world == REVEALED:
        _reveal(lab, db, sessions[0])
    db.flush()
    hashes = [
        row.hash
        for one in sessions
        for row in db.scalars(select(SessionEvent).where(SessionEvent.session_id == one.id))
    ]
    models = [model_hash(body), model_hash(f"{body} as MuJoCo model")]
    degrees = [f"{math.degrees(one / MS_PER_S):.4f}"[:-1] for one in (small, large)]
    return Canaried(
        world,
        key,
        tuple(one.id for one in sessions),
        tuple(one.participant_id for one in sessions),
        canaries((small, large), more=[*words, body, *models, *hashes, *degrees]),
    )


def _session(db: Session, key: str, world: str, body: str, code: str = "P-0001") -> StudySession:
    ended = {"completed", "aborted", "withdrawn"}
    status = {TAKEN_AGAIN: "aborted", REVEALED: "active"}.get(world, world)
    stored = status if status in {*ended, "planned"} else "active"
    session = build_session(db, SessionSpec(f"{world}-{code}", status=stored), key)
    participant = db.get_one(Participant, session.participant_id)
    participant.code = code
    _measured(db, session)
    state = state_from_json(session.snapshot)
    phase = PhaseState(phase_id=2, step=7, attempt=1, status=PhaseStatus.PAUSED)
    if status == "paused":
        state = replace(state, current=7, phase=phase)
    if status == "held":
        state = replace(state, current=7, held=Hold(rule=0, submission_id=NOBODY))
    phases = list(db.scalars(select(Phase).where(Phase.session_id == session.id)))
    for row in phases:
        row.body = body
    built = _built(db, session, body)
    prepared = [
        e.PhasePrepared(
            step=row.step_index,
            phase_id=row.phase_id,
            attempt=1,
            latency_ms=latency,
            body=body,
        )
        for row in phases
        if (latency := row.latency_ms)
    ]
    clock = Clock(utc_now=lambda: NOW, monotonic_ns=lambda: 2_500_000_000)
    append_events(
        db,
        session_id=session.id,
        version=2,
        events=[built, *prepared],
        actor="account:admin",
        command_id=None,
        clock=clock,
    )
    session.version = 3 + len(prepared)
    session.snapshot = state_to_json(replace(state, version=session.version))
    db.flush()
    return session


def _built(db: Session, session: StudySession, body: str) -> e.AvatarBuilt:
    """Store the avatar that the headset built for a condition's body, and return its event."""
    content = {
        "stature_m": 1.7,
        "segments_m": {},
        "body": body,
        "humanoid": model_hash(body),
        "model": f'<mujoco model="{body}"/>',
        "model_hash": model_hash(f"{body} as MuJoCo model"),
    }
    made = store_content(
        db, session_id=session.id, kind="avatar", body=content, by="headset", now=NOW
    )
    assert isinstance(made, ContentRef)
    return e.AvatarBuilt(
        configuration_hash=model_hash("configuration"),
        content_id=made.content_id,
        content_hash=made.content_hash,
        body=body,
    )


def model_hash(name: str) -> str:
    """Return the hash of a made-up model: its digits occur nowhere else."""
    return hashlib.sha256(name.encode()).hexdigest()


def _measured(db: Session, session: StudySession) -> None:
    """Store frames of both bodies, and an achieved latency equal to the set latency."""
    for seed, stream in enumerate((StreamName.TARGET, StreamName.ACTUAL)):
        values = moving_values(FRAMES, seed)
        store_chunks(db, session.id, stream, range(FRAMES), values, phase_id=2)
    for phase in db.scalars(select(Phase).where(Phase.session_id == session.id)).all():
        lag_s = phase.latency_ms / MS_PER_S
        db.add(
            PhaseLatency(
                session_id=session.id,
                phase_id=phase.phase_id,
                ordered_s=lag_s,
                achieved_s=lag_s,
                low_s=lag_s,
                high_s=lag_s,
                movement_s=20.0,
                frame_s=1 / 90,
                samples=1000,
                flagged=False,
                reason=f"the best lag of {phase.latency_ms:g} ms is at the edge",
            )
        )
    db.flush()


def _reveal(lab: Lab, db: Session, session: StudySession) -> None:
    now = lab.context.clock.utc_now()
    made = store_content(
        db, session_id=session.id, kind="reason", body="unwell", by="account:admin", now=now
    )
    assert isinstance(made, ContentRef)
    apply_command(db, lab.context, session, LiftBlinding(content=made), actor="account:admin")


def people(lab: Lab, roles: Sequence[str] = ROLES) -> dict[str, TestClient]:
    """Return one signed-in client for each role."""
    return {role: sign_in(lab, role) for role in roles}


def fetch(
    search: Search, role: str, client: TestClient, all_: Sequence[Canaried], routes: Sequence[str]
) -> None:
    """Request each of `routes` (path templates, no streams) for every study and search it."""
    for route in routes:
        search.routes.add(route)
        told = [(one, path) for one in all_ for path in _paths(route, one)]
        seen: dict[str, Any] = {}
        for one, path in told:
            if path not in seen:
                seen[path] = client.get(path, params=QUERIES.get(route, {}))
                search.statuses[seen[path].status_code] += 1
            answer = seen[path]
            for way, body in pieces_of(route, one, answer.content):
                search.look(role, one, f"GET {way}", body)
            search.look(role, one, "header", repr(sorted(answer.headers.items())).encode())


def _paths(route: str, one: Canaried) -> Iterator[str]:
    """Yield the route's paths for a study, one for each of its sessions or participants."""
    of_study = route.startswith("/api/studies/{key}")
    base = route.replace("{key}", one.key if of_study else "karas2020")
    for session_id, participant_id in zip(one.session_ids, one.participant_ids, strict=True):
        path = base
        for name in re.findall(r"\{(\w+)\}", base):
            ids = {**IDS, "session_id": session_id, "participant_id": participant_id}
            path = path.replace(f"{{{name}}}", ids.get(name, NOBODY))
        yield path
        if "{session_id}" not in base and "{participant_id}" not in base:
            return


def pieces_of(route: str, one: Canaried, body: bytes) -> Iterator[tuple[str, bytes]]:
    """Yield the parts of a response that are searched for canaries.

    An archive is split into its files, and the fields that belong to the study design are left out.
    """
    if body[:2] == b"PK":
        yield from _unpacked(route, one, body)
        return
    if route in DESIGN:
        hidden = DESIGN[route]
        if hidden is None:
            return
        told = json.loads(body)
        body = json.dumps({key: value for key, value in told.items() if key not in hidden}).encode()
    yield route, body


def _unpacked(route: str, one: Canaried, body: bytes) -> Iterator[tuple[str, bytes]]:
    with zipfile.ZipFile(io.BytesIO(body)) as archive:
        for name in archive.namelist():
            content = archive.read(name)
            if name.startswith("samples/") and _has_avatar(content):
                yield f"{route} {name}, the avatar's frames", _mark(one)
            yield f"{route} {name}", content
            yield f"{route} name of a file", name.encode()


def _has_avatar(samples: bytes) -> bool:
    head, *rows = samples.decode().splitlines()
    actual = [at for at, name in enumerate(head.split(",")) if name.startswith("actual_")]
    return any(row.split(",")[at] for row in rows[:3] for at in actual)


def _mark(one: Canaried) -> bytes:
    """Return a canary of the study, to represent a leak that no pattern can find."""
    return f"canary{WORLDS.index(one.world)}small".encode()


def fetch_jobs(search: Search, role: str, client: TestClient, all_: Sequence[Canaried]) -> None:
    """Start export jobs, then search their progress reports and the files they produce."""
    if role not in POLICY["POST /api/studies/{key}/exports"]:
        return
    for one in all_:
        for wish in ({"kind": "people"}, {"kind": "people", "session_id": one.session_ids[0]}):
            job = client.post(f"/api/studies/{one.key}/exports", json=wish)
            give_up_s = time.monotonic() + 120
            view = job.json()
            while view["state"] not in ("ready", "failed") and time.monotonic() < give_up_s:
                time.sleep(0.05)
                answer = client.get(f"/api/exports/{view['id']}")
                search.look(role, one, "JOB progress", answer.content)
                view = answer.json()
            assert view["state"] == "ready", view
            content = client.get(f"/api/exports/{view['id']}/file").content
            for way, body in pieces_of("job", one, content):
                search.look(role, one, f"JOB {way}", body)
            search.look(role, one, "JOB list", client.get("/api/exports").content)
            client.delete(f"/api/exports/{view['id']}")


def call_errors(search: Search, role: str, client: TestClient, all_: Sequence[Canaried]) -> None:
    """Send calls that change nothing or are rejected, and search their responses."""
    for one in all_:
        session = f"/api/sessions/{one.session_ids[0]}"
        command = {"command_id": "c" * 12, "expected_version": 1}
        for path, body in (
            (f"{session}/commands", {**command, "type": "begin_phase"}),
            (f"{session}/commands", {**command, "type": "skip", "reason": "x"}),
            (f"{session}/commands", {}),
            (f"{session}/reveal", {}),
            (f"{session}/reveal" if role == "operator" else f"{session}/x", {"reason": "I want"}),
            (f"/api/studies/{one.key}/exports", {"kind": "nobody"}),
            (f"/api/studies/{one.key}/exports", {"kind": "test", "session_id": NOBODY}),
            (f"/api/studies/{one.key}/imports/check", {}),
            (f"/api/studies/{one.key}/suggestions", {"body": "x", "about": "nowhere"}),
        ):
            answer = client.post(path, json=body)
            search.statuses[answer.status_code] += 1
            search.look(role, one, f"ERROR POST {path}", answer.content)


def listen(lab: Lab, search: Search, role: str, client: TestClient, one: Canaried) -> None:
    """Search the pose socket, and the live stream with telemetry that contains joint errors."""
    session_id = one.session_ids[0]
    with client.websocket_connect(f"/api/sessions/{session_id}/pose") as socket:
        search.look(role, one, "SOCKET pose", socket.receive_text().encode())
    heard = _news(lab, client, session_id)
    assert b"event: session" in heard
    assert b"event: telemetry" in heard
    search.look(role, one, "STREAM live", heard)
    if b"joint_error_deg" in heard:
        search.look(role, one, "STREAM live joint errors", _mark(one))


def _news(lab: Lab, client: TestClient, session_id: str) -> bytes:
    """Return the text that the live stream sends on opening, and after telemetry has arrived."""
    heard: list[bytes] = []
    path = f"/api/sessions/{session_id}/live"
    scope = {
        "type": "http",
        "asgi": {"version": "3.0", "spec_version": "2.3"},
        "http_version": "1.1",
        "method": "GET",
        "scheme": "http",
        "path": path,
        "raw_path": path.encode(),
        "query_string": b"",
        "root_path": "",
        "client": ("testclient", 1),
        "server": ("testserver", 80),
        "headers": [
            (b"host", b"testserver"),
            (b"authorization", client.headers["authorization"].encode()),
        ],
    }

    async def run() -> None:
        enough = asyncio.Event()
        asked = False

        async def receive() -> dict[str, Any]:
            nonlocal asked
            if not asked:
                asked = True
                return {"type": "http.request", "body": b"", "more_body": False}
            await enough.wait()
            return {"type": "http.disconnect"}

        async def send(message: Any) -> None:
            heard.append(message.get("body", b""))
            if b"event: session" in heard[-1]:
                figures = {"fps": 90.0, "joint_error_deg": {"Head": 5.0}}
                lab.context.hub.publish(session_id, "telemetry", figures)
            if b"event: telemetry" in heard[-1]:
                enough.set()

        await asyncio.wait_for(lab.app(scope, receive, send), 30)

    assert lab.operator.portal is not None
    lab.operator.portal.call(run)
    return b"".join(heard)


def get_routes(lab: Lab) -> list[str]:
    """Return the path templates of every GET in the OpenAPI document, without the streams."""
    paths = lab.app.openapi()["paths"]
    return [path for path, calls in paths.items() if "get" in calls and not path.endswith("/live")]
