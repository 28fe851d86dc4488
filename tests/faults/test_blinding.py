"""Tests that a blinded operator never receives the condition during a whole session (fault 33).

The conditions of this study have names and latencies that occur nowhere else, so finding one of
them in anything that is sent to an operator is a leak.
"""

import asyncio
import re
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx2
import pytest

from app.features.results.analysis.codebook import CODEBOOK
from app.features.results.exports.writing.blinding import EMPTIED, LEFT_OUT
from app.platform.policy import POLICY
from app.rehearsal.cast import Cast, perform
from app.rehearsal.rehearse import RehearsalPlan, assembled
from tests.faults.blinded_world import (
    HEAVY,
    REVEALED,
    TAKEN_AGAIN,
    Search,
    build_world,
    call_errors,
    canaries,
    fetch,
    fetch_jobs,
    get_routes,
    listen,
    people,
)
from tests.faults.figures import note
from tests.faults.short_study import KEY, ONE_LATENCY_LESS, PHASE_S, ROAM_S
from tests.features.lab import Lab, error, ok
from tests.protocol.helpers import edited
from tests.support.server import ADMIN_PASSWORD, LiveServer

CANARIES = canaries((137.25, 262.5), more=("canary",))
"""Both latencies in ms and s, and the names of their conditions."""
LOOK_EVERY_S = 0.02
SPEED = 8.0
PAGES = ("/", "/tablet", "/vr")


def canary_study() -> str:
    """Return the shipped study, short and blinded, with conditions that are easy to search for."""
    return edited(
        ("key: reembodiment-latency", f"key: {KEY}"),
        ONE_LATENCY_LESS,
        ("duration_s: 120", f"duration_s: {ROAM_S}"),
        *[("duration_s: 60\n        freeze_s: 5", f"duration_s: {PHASE_S}\n        freeze_s: 0.5")]
        * 2,
        *[("preparation_s: 5", "preparation_s: 2.5")] * 2,
        ("operator: false", "operator: true"),
        ("latency_125", "canary_small"),
        ("latency_ms: 125", "latency_ms: 137.25"),
        ("125 ms added", "canary small"),
        ("latency_350", "canary_large"),
        ("latency_ms: 350", "latency_ms: 262.5"),
        ("350 ms added", "canary large"),
    )


def _around(match: re.Match[bytes]) -> str:
    """Return the matched text with some text before and after it."""
    return match.string[max(0, match.start() - 60) : match.end() + 20].decode(errors="replace")


@dataclass
class Spy:
    """A signed-in account that records everything it receives."""

    client: httpx2.AsyncClient
    role: str
    heard: list[tuple[str, bytes]] = field(default_factory=list)

    def leaks(self) -> list[str]:
        """Return each place where the condition was found in the received data, with the text."""
        found = [(where, CANARIES.search(body)) for where, body in self.heard]
        return [f"{where}: {_around(match)}" for where, match in found if match]

    async def look(self, session_id: str) -> None:
        """Request everything that the account's role may request."""
        for name, who in POLICY.items():
            method, template = name.split()
            if method == "GET" and self.role in who and not template.endswith("/live"):
                await self._get(template.replace("{session_id}", session_id))
        for page in PAGES:
            await self._get(page)

    async def _get(self, template: str) -> None:
        path = template
        if template.startswith("/api/studies/{key}"):
            path = template.replace("{key}", KEY)
        path = path.replace("{key}", "karas2020").replace("{number}", "1")
        kinds = ("simulated",) if "ledger" in path or "sessions" in path else ("",)
        for kind in kinds:
            answer = await self.client.get(path, params={"kind": kind} if kind else {})
            headers = repr(sorted(answer.headers.items())).encode()
            self.heard.append((f"{answer.status_code} {path}", headers + answer.content))

    async def listen(self, session_id: str) -> None:
        """Record the live stream, as the cockpit receives it."""
        path = f"/api/sessions/{session_id}/live"
        async with self.client.stream("GET", path, timeout=None) as answer:
            async for piece in answer.aiter_bytes():
                self.heard.append(("stream", piece))


async def _spy(server: LiveServer, role: str) -> Spy:
    """Create an account through an accepted invitation, as the lab does."""
    async with httpx2.AsyncClient(base_url=server.url) as admin:
        await _done(admin.post("/api/login", json=_admin()))
        link = (await _done(admin.post("/api/invitations", json={"role": role})))["url"]
    client = httpx2.AsyncClient(base_url=server.url, timeout=30.0)
    token = link.rpartition("/")[2]
    wish = {"token": token, "username": f"a-{role}", "password": "four words and a comma"}
    await _done(client.post("/api/invitations/accept", json=wish))
    return Spy(client, role)


def _admin() -> dict[str, str]:
    return {"username": "admin", "password": ADMIN_PASSWORD}


async def _done(asked: Any) -> Any:
    answer = await asked
    answer.raise_for_status()
    return answer.json()


def _moment(cast: Cast) -> tuple[object, ...]:
    """Return the kind of the current step, with its limb and latency."""
    state = cast.headset.client.state
    if state is None:
        return ()
    order = state.phase
    return (state.step_kind, *((order.limb, order.latency_ms) if order is not None else ()))


async def _watched(cast: Cast, spies: list[Spy]) -> None:
    """Record a rehearsal's streams; request everything once per kind of step, limb and latency."""
    session_id = cast.operator.session_id
    seen: set[tuple[object, ...]] = set()
    async with asyncio.TaskGroup() as group:
        listening = [group.create_task(spy.listen(session_id)) for spy in spies]
        acting = group.create_task(perform(cast))
        while not acting.done():
            moment = _moment(cast)
            if moment in seen:
                await asyncio.sleep(LOOK_EVERY_S)
                continue
            seen.add(moment)
            for spy in spies:
                await spy.look(session_id)
        for task in listening:
            task.cancel()
    for spy in spies:
        await spy.look(session_id)


async def _run(server: LiveServer) -> tuple[Spy, Spy]:
    async with httpx2.AsyncClient(base_url=server.url) as admin:
        await _done(admin.post("/api/login", json=_admin()))
        await _done(admin.post("/api/studies", json={"yaml": canary_study()}))
    operator, analyst = await _spy(server, "operator"), await _spy(server, "analyst")
    plan = RehearsalPlan(server.url, KEY, speed=SPEED, seed=5, password=ADMIN_PASSWORD)
    async with assembled(plan) as cast:
        with suppress(asyncio.CancelledError):
            await _watched(cast, [operator])
        await analyst.look(cast.operator.session_id)
    for spy in (operator, analyst):
        await spy.client.aclose()
    return operator, analyst


@pytest.mark.parametrize(
    ("sent", "tells"),
    [
        (b'"latency_ms":262.5,', True),
        (b'"latency_ms": 137.250', True),
        (b"added_latency_s=0.13725", True),
        (b"-.2625 s", True),
        (b"latency_262.5", True),
        (b"hand.Canary_small", True),
        (b'"at":"2026-01-01T12:00:39.262573Z"', False),
        (b'"id":"7c426254f78d4f7e8e90f252d34f3e61"', False),
        (b'"active_s":12.13725', False),
        (b"latency_s=0.13725000000000001", True),
        (b'"client_t_s": 137.256, "fps"', False),
    ],
)
def test_the_search_finds_latencies_and_no_other_numbers(*, sent: bytes, tells: bool) -> None:
    """Latencies are found in every unit and notation; digits inside other numbers are not."""
    assert bool(CANARIES.search(sent)) is tells


def test_a_blinded_operator_cannot_find_the_condition(tmp_path: Path) -> None:
    """No response, page, header or stream shows a blinded operator the condition of a session.

    This holds during the session and after it.
    """
    with LiveServer(tmp_path / "live") as server:
        operator, analyst = asyncio.run(_run(server))
    streamed = sum(len(body) for where, body in operator.heard if where == "stream")
    note(33, "blinded operator", "answers and pages read", len(operator.heard))
    note(33, "blinded operator", "bytes of live stream read", streamed)
    note(33, "blinded operator", "canaries found", len(operator.leaks()))
    assert any(b"event: telemetry" in body for _, body in operator.heard)
    assert operator.leaks() == []
    assert analyst.leaks(), "the search finds a condition where it may be known"


QUICK = ("active", TAKEN_AGAIN, "completed")
QUICK_ROLES = ("operator", "experimenter")
"""The roles that differ in what they may know; `./run bench blinding` has all roles."""


@pytest.mark.one_engine
def test_no_output_reveals_a_hidden_condition(fresh_lab: Lab) -> None:
    """No route, archive, socket or error reveals a condition to a role that must not know it.

    Routes that draw figures or run statistics are covered by the benchmark.
    """
    all_ = build_world(fresh_lab, QUICK)
    search = Search()
    routes = [one for one in get_routes(fresh_lab) if not any(part in one for part in HEAVY)]
    for role, client in people(fresh_lab, QUICK_ROLES).items():
        fetch(search, role, client, all_, routes)
        call_errors(search, role, client, all_)
        listen(fresh_lab, search, role, client, all_[0])
    note(33, "blinded studies, two roles", "answers and files searched", search.fetched.total())
    note(33, "blinded studies, two roles", "leaks", len(search.leaks))
    assert search.leaks == []
    assert search.found_where_known > 0, "the search finds a condition where it may be known"


@pytest.mark.one_engine
def test_a_copy_with_an_open_sessions_condition_is_audited(fresh_lab: Lab) -> None:
    """The audit trail records each copy that contains the condition of an open session.

    An entry for an export, a file or a participant's own copy names the session, the account and
    the time.
    """
    revealed, hidden = build_world(fresh_lab, (REVEALED, "active"))
    reader = people(fresh_lab, ["experimenter"])["experimenter"]
    fetch_jobs(Search(), "experimenter", reader, [revealed])
    for one in (revealed, hidden):
        base = f"/api/studies/{one.key}"
        assert reader.get(f"{base}/export").is_success
        assert reader.get(f"{base}/participants/{one.participant_ids[0]}/access").is_success
    entries = ok(fresh_lab.operator.get("/api/audit"))["entries"]
    copies = [one for one in entries if one["action"] in ("study.exported", "participant.copied")]
    told = [one["details"].get("revealed") for one in copies]
    assert told.count([revealed.session_ids[0]]) == 4
    assert told.count(None) == 2
    assert {one["actor"].partition("-")[0] for one in copies} == {"account:experimenter"}
    events = ok(fresh_lab.operator.get(f"/api/sessions/{revealed.session_ids[0]}/events"))
    assert [one["by"] for one in events if one["type"] == "blinding_lifted"] == ["account:admin"]


def test_a_session_that_gave_up_its_slot_does_not_reveal_the_order(fresh_lab: Lab) -> None:
    """A session that gave up its slot does not reveal the order until the slot is completed.

    Showing the condition of that session does not reveal it either.
    """
    (taken,) = build_world(fresh_lab, (TAKEN_AGAIN,))
    given_up, holder = taken.session_ids
    wish = {"reason": "looking for a fault"}
    refused = fresh_lab.operator.post(f"/api/sessions/{given_up}/reveal", json=wish)
    assert (
        "another session now has this session's slot" in error(refused, 409, "conflict")["message"]
    )
    assert fresh_lab.view(given_up)["sequence"] is None
    shown = ok(fresh_lab.operator.post(f"/api/sessions/{holder}/reveal", json=wish))
    assert shown["sequence"] == fresh_lab.view(given_up)["sequence"] is not None


def test_every_column_named_after_a_condition_is_emptied_or_harmless() -> None:
    """Every column named after what only a condition has is emptied or harmless."""
    telling = re.compile("condition|latency|compensated|^body$|order|hash|slot|delay|lag")
    told = {
        column.name
        for column in CODEBOOK
        if column.table not in LEFT_OUT and telling.search(column.name)
    }
    harmless = {
        *("study_content_hash", "avatar_configuration_hash", "slot_block", "slot_replicate"),
        *("latency_off", "latency_samples", "out_of_order", "backwards", "flagged"),
        # Of a headset's self-test: the configuration's own body at 1.75 m, whatever the condition.
        "model_hash",
        # Of the lab's trackers behind its headset: equipment's delay, whatever the condition.
        *("delay_s", "delay_uncertainty_s"),
    }
    assert told - EMPTIED <= harmless
    assert told >= EMPTIED
