"""Tests of practice phases: run like a task, ended early if the study says so, never analysed."""

import pytest
from sqlalchemy import select

from app.features.record.sessions.engine import Refused, decide, evolve, initial_state
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine.state import SessionState
from app.features.results.analysis.dashboard import build_dashboard
from app.features.results.analysis.tables import phases_table
from app.models import ClientReport, Completion, Phase
from app.protocol.plan import compile_plan
from tests.features.lab import Lab, ok
from tests.features.record.sessions.engine_run import WORDS
from tests.protocol.helpers import loaded
from tests.protocol.options import KEY, with_options

PLAN = compile_plan(loaded(with_options()).protocol, ("latency_0", "latency_125", "latency_350"))
PRACTICE = next(step for step in PLAN if step.kind == "practice")


def running() -> SessionState:
    """Return a session with a running practice."""
    state = initial_state(len(PLAN))
    for command in (c.Start(), *(c.Skip(content=WORDS) for _ in range(PRACTICE.index))):
        state = after(state, command)
    state = after(state, c.BeginPhase(headset_connected=True))
    return after(state, report("started", 0.0))


def after(state: SessionState, command: c.Command) -> SessionState:
    """Return the state after a command."""
    for event in decide(PLAN, state, command):
        state = evolve(state, event)
    return state


def report(what: str, active_s: float, completions: int = 0) -> c.Report:
    """Return a headset's report about the practice."""
    return c.Report(
        what=what, phase_id=1, client_t_s=1.0, active_s=active_s, completions=completions
    )


def test_a_practice_ends_once_enough_tasks_are_completed() -> None:
    """A practice may end early once two tasks are completed, but not after one."""
    state = running()
    with pytest.raises(Refused, match="active time"):
        decide(PLAN, state, report("time_up", 12.0, completions=1))
    frozen = after(state, report("time_up", 12.0, completions=2))
    ended = after(frozen, report("ended", 12.0))
    assert ended.ended_phases[0].active_s == 12.0
    assert ended.current == PRACTICE.index + 1


def test_a_practice_ends_when_its_time_is_used_up() -> None:
    """A practice ends at the latest when its time is used up."""
    frozen = after(running(), report("time_up", 30.0))
    assert after(frozen, report("ended", 30.0)).ended_phases[0].active_s == 30.0


def test_a_task_never_ends_early() -> None:
    """A task does not end early, however many times it was completed."""
    index = next(step.index for step in PLAN if step.kind == "task")
    state = after(running(), c.Skip(content=WORDS))
    while state.current != index:
        state = after(state, c.Skip(content=WORDS))
    state = after(state, c.BeginPhase(headset_connected=True))
    for what, active_s in (("started", 0.0), ("paused", 20.0)):
        reported = c.Report(what=what, phase_id=2, client_t_s=1.0, active_s=active_s, completions=9)
        state = after(state, reported)
    early = c.Report(what="time_up", phase_id=2, client_t_s=1.0, active_s=20.0, completions=99)
    with pytest.raises(Refused):
        decide(PLAN, state, early)


@pytest.mark.one_engine
def test_the_server_counts_the_completed_tasks_of_a_practice(lab: Lab) -> None:
    """The server counts a practice's completed tasks itself and leaves it out of every figure."""
    if lab.operator.get(f"/api/studies/{KEY}").status_code == 404:
        ok(lab.operator.post("/api/studies", json={"yaml": with_options()}))
    view = ok(lab.operator.post(f"/api/studies/{KEY}/sessions", json={}))
    view = lab.skip_to(view, "practice.hand")
    step = view["steps"][view["current"]["index"]]
    assert (step["kind"], step["limb"], step["block"]) == ("practice", "hand", None)
    token = lab.headset_token(view["id"])
    with lab.operator.websocket_connect(
        "/api/vr/stream", subprotocols=["reembody.v1", f"bearer.{token}"]
    ) as socket:
        socket.send_json({"type": "hello", "protocol": 1, "client": "x", "epoch": None})
        assert socket.receive_json()["type"] == "welcome"
        lab.command(lab.view(view["id"]), "begin_phase")
        reply = socket.receive_json()
        while reply["type"] != "state" or reply["phase"] is None:
            reply = socket.receive_json()
        assert (reply["phase"]["kind"], reply["phase"]["until_completions"]) == ("practice", 2)
        bodies = [
            _phase("started", 0.0),
            _completion(1, 5.0),
            _phase("time_up", 6.0),
            _completion(2, 10.0),
            _phase("time_up", 11.0),
            _phase("ended", 11.0),
        ]
        for seq, body in enumerate(bodies):
            socket.send_json({"type": "report", "epoch": 1, "seq": seq, "body": body})
        while lab.view(view["id"])["phases"][0]["status"] != "done":
            socket.receive_json()
    with lab.database.reading() as db:
        reply = select(ClientReport.seq).where(ClientReport.session_id == view["id"])
        assert list(db.scalars(reply.where(ClientReport.accepted.is_(False)))) == [2]
        row = db.scalars(select(Phase).where(Phase.session_id == view["id"])).one()
        assert (row.kind, row.block, row.condition, row.active_s) == ("practice", None, None, 11.0)
        stored = select(Completion.number).where(Completion.session_id == view["id"])
        assert set(db.scalars(stored)) == {1, 2}
        table = phases_table(db, KEY, "people")
        own = table[table["session_id"] == view["id"]]
        assert own[["phase_kind", "completions"]].to_numpy().tolist() == [["practice", 2]]
        figures = {one.key: one for one in build_dashboard(db, KEY, "people").figures}
        assert figures["completions"].n == 0


def _phase(what: str, active_s: float) -> dict[str, object]:
    return {
        "kind": "phase", "phase_id": 1, "what": what, "t_s": 1.0 + active_s,
        "active_s": active_s, "cause": "headset",
    }  # fmt: skip


def _completion(number: int, active_s: float) -> dict[str, object]:
    return {
        "kind": "completion", "phase_id": 1, "number": number, "t_s": 1.0 + active_s,
        "active_s": active_s, "duration_s": 5.0, "order": [4, 3, 2, 1],
        "out_of_order_touches": 0,
    }  # fmt: skip
