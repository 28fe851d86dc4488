"""A rehearsal that is performed once in a test run, and whose record any process may read."""

import asyncio
import json
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from sqlalchemy import func, select

from app.client.http import call
from app.database import open_database
from app.models import JointErrorRow
from app.rehearsal.cast import perform
from app.rehearsal.rehearse import RehearsalPlan, assembled, report_of
from tests.rehearsal.ledger import LedgerJournal, load_ledger
from tests.support.server import ADMIN_PASSWORD, LiveServer
from tests.support.shared_run import once, run_folder

STUDY = "reembodiment-latency"
PHASES = 7
SUMMARIES_WITHIN_S = 60.0


@dataclass(frozen=True)
class Performed:
    """What is left of a rehearsal: the record, and what its own side knows."""

    database_url: str
    report: dict[str, Any]
    view: dict[str, Any]
    events: list[dict[str, Any]]
    ledger: LedgerJournal

    @property
    def session_id(self) -> str:
        """The rehearsed session."""
        return str(self.report["session_id"])


def performed_once(
    name: str, plan: RehearsalPlan, database_url: str | None, environment: Mapping[str, str]
) -> Performed:
    """Perform `plan` in the first process that asks; `database_url` None is the server's SQLite."""
    folder = run_folder() / name
    with once(name) as mark:
        if mark:
            with LiveServer(folder, environment=environment) as server:
                url = database_url or f"sqlite:///{server.data_dir / 'reembody.sqlite'}"
                told = asyncio.run(_perform(plan, server, folder / "ledger.json"))
                _wait_for_summaries(url, told["report"]["session_id"])
            mark.write_text(json.dumps({"database_url": url, **told}))
        told = json.loads((run_folder() / f"{name}.done").read_text())
    return Performed(
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
    """Joint errors are computed in the background once a phase has ended."""
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
