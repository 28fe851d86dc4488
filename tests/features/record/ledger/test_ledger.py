"""Tests of the counterbalancing ledger: every order equally often, and no slot taken twice."""

from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import event

from app.features.record.ledger.endpoints import get_ledger
from app.platform.access import Caller
from tests.features.lab import STUDY, Json, Lab, error, ok
from tests.support.server import ADMIN_PASSWORD, LiveServer

JOINS = 100


def orders(views: list[Json]) -> Counter[tuple[float, ...]]:
    """Return how often each order of latencies was assigned."""
    return Counter(tuple(view["sequence"]) for view in views)


def change_study(lab: Lab, old: str, new: str) -> Json:
    """Store a new version of the study with some text replaced."""
    path = f"/api/studies/{STUDY}"
    yaml = ok(lab.operator.get(path))["yaml"]
    assert old in yaml
    changed: Json = ok(
        lab.operator.post(f"{path}/versions", json={"yaml": yaml.replace(old, new, 1)})
    )
    return changed


def ledger(lab: Lab, kind: str = "people") -> Json:
    """Return the ledger as the console shows it."""
    shown: Json = ok(lab.operator.get(f"/api/studies/{STUDY}/ledger?kind={kind}"))
    return shown


def test_twelve_sessions_use_each_order_twice(fresh_lab: Lab) -> None:
    """Twelve sessions take the planned slots in order, and use each of the six orders twice."""
    planned = [slot["sequence"] for slot in ledger(fresh_lab)["slots"]]
    views = [fresh_lab.join() for _ in range(12)]
    assert [view["sequence"] for view in views] == planned
    assert sorted(orders(views).values()) == [2] * 6
    assert sorted(orders(views[:6]).values()) == [1] * 6
    assert [view["slot"]["index"] for view in views] == list(range(12))


def test_a_full_ledger_grows_by_a_whole_block(fresh_lab: Lab) -> None:
    """The thirteenth session adds a block of six slots to the ledger, each order once more."""
    views = [fresh_lab.join() for _ in range(18)]
    assert sorted(orders(views).values()) == [3] * 6
    assert len(ledger(fresh_lab)["slots"]) == 18
    assert views[12]["slot"] == {"index": 12, "block": 2, "replicate": 3}


@pytest.mark.one_engine
def test_a_closed_ledger_refuses_further_sessions(fresh_lab: Lab) -> None:
    """A full ledger that must not grow refuses a session until a slot becomes free."""
    change_study(fresh_lab, "when_full: grow", "when_full: closed")
    views = [fresh_lab.join() for _ in range(12)]
    refusal = error(fresh_lab.try_join(), 409, "conflict")
    assert (refusal["value"], "withdraw a session" in refusal["remedy"]) == (12, True)
    fresh_lab.command(fresh_lab.command(views[4], "start"), "withdraw", reason="felt dizzy")
    assert fresh_lab.join()["slot"]["index"] == 4


@pytest.mark.parametrize(("end", "outcome"), [("withdraw", "withdrawn"), ("abort", "aborted")])
def test_a_freed_slot_is_the_next_to_be_taken(fresh_lab: Lab, end: str, outcome: str) -> None:
    """The slot of a withdrawn or aborted session goes to the next one; both attempts are kept."""
    views = [fresh_lab.join() for _ in range(3)]
    fresh_lab.command(fresh_lab.command(views[1], "start"), end, reason="headset broke")
    next_session = fresh_lab.join()
    assert next_session["sequence"] == views[1]["sequence"]
    slot = ledger(fresh_lab)["slots"][1]
    outcomes = [attempt["outcome"] for attempt in slot["attempts"]]
    assert (slot["state"], outcomes) == ("open", [outcome, "open"])
    assert slot["attempts"][0]["reason"] == "headset broke"


@pytest.mark.one_engine
def test_a_longer_ledger_needs_no_more_statements(fresh_lab: Lab) -> None:
    """The ledger takes as many SQL statements for five aborted sessions as for one."""
    admin = Caller("1", "admin", "admin")

    def needed(sessions: int) -> int:
        for _ in range(sessions):
            view = fresh_lab.command(fresh_lab.join(), "start")
            fresh_lab.command(view, "abort", reason="headset broke")
        sent: list[str] = []

        def note(_connection: Any, _cursor: Any, text: str, *_: Any) -> None:
            sent.append(text)

        with fresh_lab.database.reading() as db:
            event.listen(db.connection(), "before_cursor_execute", note)
            get_ledger(STUDY, db, admin)
        return len(sent)

    assert needed(1) == needed(4) > 0


@pytest.mark.one_engine
def test_each_kind_of_session_has_its_own_ledger(fresh_lab: Lab) -> None:
    """People, simulated and test sessions have separate ledgers."""
    first = {kind: fresh_lab.join(kind=kind) for kind in ("people", "simulated", "test")}
    assert {view["slot"]["index"] for view in first.values()} == {0}
    assert [view["participant_code"] for view in first.values()] == [
        "P-0001",
        "SIM-0001",
        "TEST-0001",
    ]
    assert len(ok(fresh_lab.operator.get(f"/api/studies/{STUDY}/sessions?kind=people"))) == 1


@pytest.mark.one_engine
def test_versions_of_one_design_share_their_ledger(fresh_lab: Lab) -> None:
    """Versions with the same design share a ledger; another seed of the orders starts a new one."""
    fresh_lab.join()
    change_study(fresh_lab, "Acting through another body", "Acting through a second body")
    second = fresh_lab.join()
    assert (second["study_version"], second["slot"]["index"]) == (2, 1)
    change_study(fresh_lab, "seed: 20200415", "seed: 7")
    assert fresh_lab.join()["slot"]["index"] == 0


@pytest.mark.one_engine
def test_generated_codes_skip_those_in_use(fresh_lab: Lab) -> None:
    """A generated participant code is never one that is already in use."""
    fresh_lab.join(participant_code="P-0002")
    codes = [fresh_lab.join()["participant_code"] for _ in range(3)]
    assert len({*codes, "P-0002"}) == 4


@pytest.mark.one_engine
@pytest.mark.parametrize("code", ["Anna Müller", "-x", "a/b", "x" * 41, "=1+1"])
def test_an_invalid_participant_code_is_refused(lab: Lab, code: str) -> None:
    """An invalid participant code is refused with the rule for codes, and takes no slot."""
    before = len([slot for slot in ledger(lab)["slots"] if slot["state"] != "free"])
    refusal = error(lab.try_join(participant_code=code), 422, "invalid_input")
    assert refusal["valid"] == "1 to 40 letters, digits, - and _"
    after = [slot for slot in ledger(lab)["slots"] if slot["state"] != "free"]
    assert len(after) == before


def test_a_participant_code_with_a_nul_character_is_refused(lab: Lab) -> None:
    """A participant code with a NUL character is refused and takes no slot."""
    before = len([slot for slot in ledger(lab)["slots"] if slot["state"] != "free"])
    refusal = error(lab.try_join(participant_code="a\x00b"), 422, "invalid_input")
    assert "NUL" in refusal["message"]
    assert len([slot for slot in ledger(lab)["slots"] if slot["state"] != "free"]) == before


def test_a_participant_with_an_open_session_is_refused(lab: Lab) -> None:
    """A participant with an open session gets no second one until the first has ended."""
    view = lab.join(participant_code="busy-1")
    refusal = error(lab.try_join(participant_code="busy-1"), 409, "conflict")
    assert refusal["details"] == [{"session_id": view["id"], "status": "planned"}]
    lab.command(lab.command(view, "start"), "withdraw", reason="came back later")
    assert lab.join(participant_code="busy-1")["id"] != view["id"]


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("fields", "status"),
    [
        ({"kind": "martians"}, 422),
        ({"language": "fr"}, 422),
        ({"time_scale": 10.0}, 422),
        ({"kind": "test", "time_scale": 10.0}, 422),
        ({"kind": "simulated", "time_scale": 0.0}, 422),
        ({"kind": "simulated", "time_scale": 101.0}, 422),
        ({"surprise": True}, 422),
        ({"kind": "simulated", "time_scale": 20.0, "language": "de"}, 201),
    ],
)
def test_only_simulated_sessions_run_faster_than_real_time(
    lab: Lab, fields: Json, status: int
) -> None:
    """Only simulated sessions may have a time scale; an invalid kind or language is refused."""
    assert lab.try_join(**fields).status_code == status


def test_a_hundred_simultaneous_joins_stay_balanced(database_url: str, tmp_path: Path) -> None:
    """A hundred simultaneous sessions share no slot, and orders differ by at most one."""
    environment = {"REEMBODY_DATABASE_URL": database_url}
    with LiveServer(tmp_path, environment=environment) as server, server.client() as client:
        ok(client.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))

        def join(_: int) -> Json:
            view: Json = ok(client.post(f"/api/studies/{STUDY}/sessions", json={}))
            return view

        with ThreadPoolExecutor(20) as pool:
            views = list(pool.map(join, range(JOINS)))
    counts = orders(views)
    assert len({view["slot"]["index"] for view in views}) == JOINS
    assert len({view["participant_code"] for view in views}) == JOINS
    assert len(counts) == 6
    assert max(counts.values()) - min(counts.values()) <= 1
