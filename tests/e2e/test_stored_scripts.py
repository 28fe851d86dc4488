"""Browser test that entered text is shown as written and never executed (fault 36)."""

from collections.abc import Callable
from typing import Any

import httpx2
from playwright.sync_api import Dialog, Page, expect

from app.database import open_database
from tests.e2e.people import PATIENCE_MS, Experimenter, Participant
from tests.faults.figures import note
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.lab import key, ok
from tests.features.record.self_tests.reports import report
from tests.protocol.helpers import edited
from tests.support.browser import PageWatch
from tests.support.server import ADMIN_PASSWORD, LiveServer
from tests.support.traffic import Traffic

HOSTILE = "hostile"
SCRIPTS = (
    '<img src=x onerror="window.ran=(window.ran||0)+1">',
    "<svg onload=window.ran=(window.ran||0)+1>",
    "</script><script>window.ran=(window.ran||0)+1</script>",
    '"><iframe srcdoc="<script>parent.ran=(parent.ran||0)+1</script>"></iframe>',
    "[click](javascript:window.ran=(window.ran||0)+1) {{window.ran=1}}",
)
EVIL = " ".join(SCRIPTS)
# A title has at most 200 characters; the description has the others.
TITLE = " ".join(SCRIPTS[:3])
TABS = (
    *("", "overview", "ledger", "sessions", "participants", "dashboard", "export", "protocol"),
    *("suggestions", "versions"),
)
PAGES = ("", "people", "people/invitations", "people/audit", "instruments", "equipment", "network")


def hostile_study() -> str:
    """Return the shipped study with scripts in its texts."""
    text = EVIL.replace("'", "''")
    return edited(
        ("key: reembodiment-latency", f"key: {HOSTILE}"),
        ("en: Acting through another body", f"en: '{TITLE}'"),
        ("description:\n  en: >-", f"description:\n  en: >-\n    {text}"),
        ("{en: no added latency,", f"{{en: '{text}',"),
    )


def write_everywhere(api: httpx2.Client, server: LiveServer) -> str:
    """Enter scripts in every text field and return the session that contains them."""
    ok(api.post("/api/studies", json={"yaml": hostile_study()}))
    database = open_database(f"sqlite:///{server.data_dir / 'reembody.sqlite'}")
    with database.writing() as db:
        session_id = build_session(db, SessionSpec("P-0001", open_answer=EVIL)).id
    database.close()
    view = ok(api.get(f"/api/sessions/{session_id}"))
    ok(api.post(f"/api/sessions/{session_id}/commands", json=_note(view)))
    ok(api.post("/api/invitations", json={"role": "analyst", "note": EVIL[:80]}))
    api.post(
        f"/api/studies/{STUDY}/suggestions",
        json={"version": 1, "session_id": session_id, "about": "", "body": EVIL},
    )
    api.post(
        "/api/calibrations",
        json={
            "equipment": EVIL[:100],
            "motion_to_photon_ms": 50.0,
            "sd_ms": 1.0,
            "samples": 10,
            "method": EVIL[:300],
            "measured_on": "2026-01-02",
            "note": EVIL,
        },
    )
    return session_id


def write_self_test(api: httpx2.Client, server: LiveServer, session_id: str) -> None:
    """Store a headset's self-test with scripts in every text of its report."""
    path = f"/api/sessions/{session_id}/pairings"
    code = ok(api.post(path, json={"device": "headset"}))["code"]
    device = {"user_agent": EVIL[:500], "name": EVIL[:200], "inputs": ["hands"]}
    body = report(device=device, page__errors=[EVIL[:200]])
    with server.client() as headset:
        token = ok(headset.post("/api/devices/pair", json={"code": code}))["token"]
        headers = {"authorization": f"Bearer {token}"}
        ok(headset.post("/api/vr/self-tests", json=body, headers=headers))


def _note(view: dict[str, Any]) -> dict[str, Any]:
    about = {"command_id": key(), "expected_version": view["version"], "type": "note"}
    return {**about, "text": EVIL}


def test_entered_scripts_are_never_executed(
    running_server: LiveServer, page_factory: Callable[..., Page], page_watch: PageWatch
) -> None:
    """Scripts in titles, labels, answers, notes, invitations and suggestions are never executed."""
    with running_server.client() as api:
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        session_id = write_everywhere(api, running_server)
        joined = ok(api.post(f"/api/studies/{HOSTILE}/sessions", json={"kind": "test"}))
        write_self_test(api, running_server, joined["id"])
        shown = ok(api.post(f"/api/sessions/{joined['id']}/pairings", json={"device": "tablet"}))
    experimenter = Experimenter(page_factory(), running_server.url)
    page = experimenter.page
    traffic = Traffic(page)
    dialogs: list[str] = []

    def dismiss(dialog: Dialog) -> None:
        dialogs.append(dialog.message)
        dialog.dismiss()

    page.on("dialog", dismiss)
    experimenter.log_in()
    seen = 0
    for address in (
        *PAGES,
        *(f"studies/{study}/{tab}" for study in (STUDY, HOSTILE) for tab in TABS),
        f"sessions/{session_id}",
        f"sessions/{session_id}/consent",
        f"sessions/{joined['id']}",
    ):
        page.goto(f"{running_server.url}/#/{address}")
        expect(page.get_by_role("main")).to_be_visible(timeout=PATIENCE_MS)
        traffic.settle()
        seen += page.get_by_text("onerror").count() > 0
        assert page.evaluate("window.ran") is None, address
        assert page.locator("iframe, svg[onload], img[src=x]").count() == 0, address
    tablet = page_factory((1180, 820))
    page_watch.allow(r"401 \(Unauthorized\)")
    Participant(tablet, running_server.url).pair(shown["code"])
    tablet.wait_for_load_state("networkidle")
    assert tablet.evaluate("window.ran") is None
    assert dialogs == []
    note(36, "scripts in what people wrote", "pages that showed one as words", seen)
    note(36, "scripts in what people wrote", "executions", 0)
    assert seen >= 4
