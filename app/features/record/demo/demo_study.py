"""The study of the demo lab: made from the one that is shipped, and removed with all of its rows.

Only the demo lab may be removed like this: a study of people keeps its record, from which single
participants are erased.
"""

from pathlib import Path
from typing import Any

import yaml
from sqlalchemy import ColumnElement, Table, delete, or_, select
from sqlalchemy.orm import Session

from app.database import Base
from app.errors import Conflict
from app.features.design.studies import shipped_files
from app.models import AuditEntry, Participant, Study, StudySession
from app.platform.access import Caller, visible_to

DEMO_KEY = "demo-lab"
ORIGIN = "reembodiment-latency"
PEOPLE = 12
PHASE_S = 10
"""The length of every timed phase: long enough for movement and contacts, short enough to wait."""
PAUSE_S = 1
"""The preparation before and the freeze after a task."""
TITLE = {"en": "Demo lab (simulated people)", "de": "Demo-Labor (simulierte Personen)"}
DESCRIPTION = {
    "en": (
        "Twelve simulated people act through a delayed copy of their body at 0, 125 and 350 ms of "
        "added latency, in 10-second phases. Everything here comes from the rehearsal's "
        "generator: it shows what the product does and says nothing about people."
    ),
    "de": (
        "Zwölf simulierte Personen handeln mit einer verzögerten Kopie ihres Körpers bei 0, 125 "
        "und 350 ms zusätzlicher Verzögerung, in Phasen von 10 Sekunden. Alles hier stammt vom "
        "Generator der Probe: Es zeigt, was das Produkt tut, und sagt nichts über Menschen."
    ),
}

PROVENANCE = {
    "source": (
        f"Made by the demo lab from the shipped study {ORIGIN}, whose own provenance says what "
        "follows Karas 2020 and what is ours."
    ),
    "licence": "All texts, colours and measures in this file are ours.",
    "verified": (
        "Latencies, orders, replicates, the order of steps and the rules of both tasks are those "
        "of the shipped study. It was never run with people."
    ),
    "notes": [
        (
            f"Shortened, so that nobody has to wait: every timed phase lasts {PHASE_S} s, with "
            f"{PAUSE_S} s of preparation before a task and {PAUSE_S} s of freeze after it. The "
            "texts for participants still name the durations of the shipped study."
        ),
        (
            "Simplified: the avatar is a delayed copy of the body, which passes through edges; "
            "that of the shipped study follows by forces and collides with them."
        ),
    ],
}
"""What is true of the demo study; the provenance of the shipped one speaks of its durations."""


def demo_code(number: int) -> str:
    """Return the code of a simulated person, counted from 1; they have no names."""
    return f"DEMO-{number:02d}"


OWN_CODES = frozenset(demo_code(number) for number in range(1, PEOPLE + 1))
"""Of the people whom the demo lab sends; anybody else in its study is not counted among them."""


def demo_yaml() -> str:
    """Return the study's file: the shipped study with short phases and a delayed copy.

    A delayed copy needs no physics, which takes longer than the phases.
    """
    origin = next(path for path in shipped_files().studies if path.stem == ORIGIN)
    return shortened(origin)


def shortened(origin: Path) -> str:
    """Return the demo lab's version of a study file."""
    study: dict[str, Any] = yaml.safe_load(origin.read_text(encoding="utf-8"))
    study |= {"key": DEMO_KEY, "title": TITLE, "description": DESCRIPTION, "provenance": PROVENANCE}
    study["avatar"] = "delayed_copy"
    study.pop("avatar_configuration", None)
    procedure = study["procedure"]
    steps = [*procedure["before"], *procedure["block"]["phases"], *procedure["after"]]
    for step in steps:
        if "duration_s" in step:
            step["duration_s"] = PHASE_S
        for pause in {"preparation_s", "freeze_s"} & step.keys():
            step[pause] = PAUSE_S
    text: str = yaml.safe_dump(study, allow_unicode=True, sort_keys=False)
    return text


LOADED = "demo.loaded"
"""The action in the audit trail that marks a study as made by the demo lab, at the same instant."""


def own_study(db: Session, caller: Caller) -> Study | None:
    """Return the study that the demo lab made, or None if there is no study with its key.

    Raises Conflict if somebody else made the study with this key, or if the caller may not see it.
    """
    study = db.scalar(select(Study).where(Study.key == DEMO_KEY))
    if study is None:
        return None
    if db.scalar(select(Study.id).where(Study.id == study.id, visible_to(caller))) is None:
        raise Conflict(
            "the demo lab is not possible here",
            remedy="Ask somebody of the lab who may see all studies.",
        )
    made = select(AuditEntry.seq).where(
        AuditEntry.action == LOADED,
        AuditEntry.subject == DEMO_KEY,
        AuditEntry.at == study.created_at,
    )
    if db.scalar(made.limit(1)) is None:
        raise Conflict(
            f"the study {DEMO_KEY!r} was not made by the demo lab",
            value=DEMO_KEY,
            valid="no study with this key, or the demo lab's own",
            remedy="The demo lab needs this key. Work with the study as with any other; it is "
            "neither filled nor removed from here.",
        )
    return study


def require_only_simulated(db: Session, study: Study) -> None:
    """Raise Conflict if a session of the study is not simulated, or others run one there."""
    rows = db.execute(
        select(StudySession.kind, StudySession.status, Participant.code)
        .join(Participant, Participant.id == StudySession.participant_id)
        .where(StudySession.study_id == study.id)
    ).all()
    people = sum(kind != "simulated" for kind, _, _ in rows)
    running = sum(status == "active" and code not in OWN_CODES for _, status, code in rows)
    if people or running:
        raise Conflict(
            "the demo lab has sessions that it did not make, so it is not removed",
            value={"not_simulated": people, "running": running},
            valid="only simulated sessions, and none that others run",
            remedy="End the running ones. A study with sessions of people or tests keeps its "
            "record: archive it, or erase single participants.",
        )


def remove_study(db: Session, study: Study) -> int:
    """Delete a study and every row that refers to it, directly or not; return how many rows.

    The foreign keys say what belongs to it, so that no table can be forgotten.
    """
    tables = Base.metadata.sorted_tables
    belonging: dict[str, ColumnElement[bool]] = {Study.__tablename__: Study.id == study.id}
    for table in tables:
        if table.name not in belonging and (own := _refers(table, belonging)):
            belonging[table.name] = or_(*own)
    removed = 0
    for table in reversed(tables):
        if table.name in belonging:
            result = db.execute(delete(table).where(belonging[table.name]))
            removed += result.rowcount  # type: ignore[attr-defined]  # of a DELETE
    return removed


def _refers(table: Table, belonging: dict[str, ColumnElement[bool]]) -> list[ColumnElement[bool]]:
    """Return a condition for every column that refers to a row which belongs to the study.

    Of a key of several columns the first one decides: it is the row's owner in all our tables.
    """
    conditions: list[ColumnElement[bool]] = []
    for constraint in table.foreign_key_constraints:
        first = constraint.elements[0]
        parent = first.column.table
        if parent.name in belonging and parent is not table:
            owned = select(first.column).where(belonging[parent.name])
            conditions.append(first.parent.in_(owned))
    return conditions
