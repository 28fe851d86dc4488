"""Perform a rehearsal once in a test run; any process may read its record."""

import asyncio
import json
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from sqlalchemy import func, select

from app.client.http import call
from app.database import open_database
from app.models import JointErrorRow
from app.rehearsal.cast import perform
from app.rehearsal.rehearse import RehearsalPlan, assembled, report_of
from tests.protocol.helpers import edited
from tests.rehearsal.ledger import LedgerJournal, load_ledger
from tests.support.server import ADMIN_PASSWORD, LiveServer
from tests.support.shared_run import once, run_folder

STUDY = "reembodiment-latency"
PHASES, TASK_PHASES = 7, 6
SUMMARIES_WITHIN_S = 60.0


@dataclass(frozen=True)
class Lengths:
    """The durations of the shipped study's phases, in s of active time.

    `around_s` is the duration of a task's preparation, and of its freeze at the end.
    """

    roam_s: float
    task_s: float
    around_s: float = 5.0

    @property
    def key(self) -> str:
        """Return the key of the study with these durations."""
        return STUDY if self == SHIPPED else f"{STUDY}-{self.task_s:g}-s"

    def text(self) -> str:
        """Return the shipped study with these durations, as the text of a file."""
        return edited(
            (f"key: {STUDY}", f"key: {self.key}"),
            ("duration_s: 120", f"duration_s: {self.roam_s}"),
            *[("duration_s: 60\n", f"duration_s: {self.task_s}\n")] * 2,
            *[("preparation_s: 5\n", f"preparation_s: {self.around_s}\n")] * 2,
            *[("freeze_s: 5\n", f"freeze_s: {self.around_s}\n")] * 2,
        )

    def store(self, server: LiveServer) -> str:
        """Store the study with these durations and return its key."""
        if self == SHIPPED:
            return STUDY
        with server.client() as client:
            credentials = {"username": "admin", "password": ADMIN_PASSWORD}
            client.post("/api/login", json=credentials).raise_for_status()
            client.post("/api/studies", json={"yaml": self.text()}).raise_for_status()
        return self.key


SHIPPED = Lengths(120.0, 60.0)
LONGER, SHORT = Lengths(15.0, 30.0), Lengths(10.0, 25.0, 1.0)
"""Long enough for a task with each limb, and to measure a latency in every phase."""
BRIEF = Lengths(6.0, 10.0, 1.0)
"""Long enough for a task with the hand, and to measure a latency for each condition."""


@dataclass(frozen=True)
class Performed:
    """The results of a rehearsal: the stored record, and the ledger and report of its own side."""

    lengths: Lengths
    database_url: str
    report: dict[str, Any]
    view: dict[str, Any]
    events: list[dict[str, Any]]
    ledger: LedgerJournal

    @property
    def session_id(self) -> str:
        """Return the id of the rehearsed session."""
        return str(self.report["session_id"])


def performed_once(
    name: str,
    plan: RehearsalPlan,
    database_url: str | None,
    environment: Mapping[str, str],
    lengths: Lengths = SHIPPED,
) -> Performed:
    """Perform `plan` in the first process that needs it; SQLite if `database_url` is None.

    The study of the plan is the shipped one, with phases of these `lengths`.
    """
    folder = run_folder() / name
    with once(name) as mark:
        if mark:
            with LiveServer(folder, environment=environment) as server:
                url = database_url or f"sqlite:///{server.data_dir / 'reembody.sqlite'}"
                here = replace(plan, study=lengths.store(server))
                told = asyncio.run(_perform(here, server, folder / "ledger.json"))
                _wait_for_summaries(url, told["report"]["session_id"])
            mark.write_text(json.dumps({"database_url": url, **told}))
        told = json.loads((run_folder() / f"{name}.done").read_text())
    return Performed(
        lengths,
        told["database_url"],
        told["report"],
        told["view"],
        told["events"],
        load_ledger(folder / "ledger.json"),
    )


async def _perform(plan: RehearsalPlan, server: LiveServer, ledger_file: Path) -> dict[str, Any]:
    here = RehearsalPlan(**{**asdict(plan), "url": server.url, "password": ADMIN_PASSWORD})
    ledger, began_s = LedgerJournal(), time.monotonic()
    async with assembled(here, journal=ledger) as cast:
        await perform(cast)
        report = await report_of(cast, here, time.monotonic() - began_s)
        events = await call(
            cast.operator.client, "GET", f"/api/sessions/{report.session_id}/events"
        )
        told = {"report": asdict(report), "view": await cast.operator.view(), "events": events}
    ledger.save(ledger_file)
    return told


def _wait_for_summaries(url: str, session_id: str) -> None:
    """Wait for the joint errors, which are computed in the background after each phase."""
    database, give_up_s = open_database(url), time.monotonic() + SUMMARIES_WITHIN_S
    count = select(func.count(JointErrorRow.phase_id.distinct()))
    try:
        while time.monotonic() < give_up_s:
            with database.reading() as db:
                if db.scalar(count.where(JointErrorRow.session_id == session_id)) == PHASES:
                    return
            time.sleep(0.1)
    finally:
        database.close()
    raise RuntimeError(f"no joint errors of all phases within {SUMMARIES_WITHIN_S:g} s")
