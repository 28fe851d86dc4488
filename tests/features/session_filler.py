"""The content of a built session: phases with their results, and forms.

A session has about two thousand rows and most tests of results build several, so rows are inserted
table by table, without an object for each.
"""

import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np
from sqlalchemy import insert
from sqlalchemy.orm import Session

from app.database import Base
from app.features.design.instruments import instrument_of
from app.features.design.studies import instrument_for
from app.models import (
    Answer,
    Completion,
    Contact,
    JointErrorCourseRow,
    JointErrorRow,
    Phase,
    ScoreValue,
    StudySession,
    StudyVersion,
    Submission,
)
from app.protocol.plan import Step
from app.science.instruments import Instrument, item_order, score_answers
from app.science.joint_error import COURSE_BIN_S, ERROR_AXES, ERROR_JOINTS
from tests.features.clock_filler import steady_probes, store_probes

NOW = datetime(2026, 3, 2, 9, 30, tzinfo=UTC)


@dataclass(frozen=True)
class SessionSpec:
    """The properties in which built sessions differ."""

    code: str
    kind: str = "people"
    status: str = "completed"
    redone: tuple[str, ...] = ()
    skipped: tuple[str, ...] = ()
    open_answer: str = "The boxes on the left."
    likert: Callable[[Step, str], int] | None = None
    about: Mapping[str, float | str] = field(default_factory=dict)
    """Answers by the key of the item, in place of those that are made up."""
    completions: Callable[[Step], int] = lambda step: 3 if step.limb == "hand" else 2
    joint_error_rad: Callable[[Step, str], float] = lambda step, _: (step.latency_ms or 0) / 1000


@dataclass
class Filler:
    """Fill a session step by step; every attempt of a phase gets the next phase_id."""

    db: Session
    session: StudySession
    spec: SessionSpec
    phase_id: int = 0
    rows: dict[type[Base], list[dict[str, Any]]] = field(default_factory=dict)
    """The rows to insert by table; tables that others refer to come first."""

    def fill(self, plan: Sequence[Step]) -> None:
        """Store the rows of every step, and the clock probes of a single run of the client."""
        store_probes(self.db, self.session.id, steady_probes(NOW))
        for step in plan:
            for attempt in (1, 2) if step.key in self.spec.redone else (1,):
                if step.kind in ("free_roam", "task", "road_crossing"):
                    superseded = step.key in self.spec.redone and attempt == 1
                    voided = superseded or step.key in self.spec.skipped
                    self._phase(step, attempt, "voided" if voided else "done")
                elif step.instrument is not None and step.key not in self.spec.skipped:
                    self._form(step, attempt)
        for model, rows in self.rows.items():
            self.db.execute(insert(model), rows)

    def _add(self, model: type[Base], **columns: Any) -> None:
        self.rows.setdefault(model, []).append(columns)

    def _phase(self, step: Step, attempt: int, status: str) -> None:
        self.phase_id += 1
        begin_s = 100.0 * self.phase_id
        self._add(
            Phase,
            session_id=self.session.id,
            phase_id=self.phase_id,
            step_index=step.index,
            step_key=step.key,
            attempt=attempt,
            kind=step.kind,
            limb=step.limb,
            block=step.block,
            condition=step.condition,
            latency_ms=step.latency_ms or 0.0,
            status=status,
            active_s=step.duration_s,
            paused_count=1,
            walk_back_count=2 if step.limb == "foot" else 0,
            client_started_s=begin_s,
            client_ended_s=begin_s + 60.0,
            prepared_at=NOW,
            started_at=NOW,
            ended_at=NOW,
        )
        if step.kind == "task":
            self._task_rows(step)
        self._joint_errors(step)
        self._joint_error_courses(step)

    def _task_rows(self, step: Step) -> None:
        """Add two overlapping contacts at a side (1-3 s, 2-4 s: 3 s in red) and one at a panel."""
        for surface, kind, side, part, begin_s, end_s in (
            (f"{step.limb}/2/left", "side", "left", "LeftHand", 1.0, 3.0),
            (f"{step.limb}/2/left", "side", "left", "LeftLowerArm", 2.0, 4.0),
            (f"{step.limb}/1/panel", "panel", None, "RightHand", 5.0, 5.5),
        ):
            self._add(
                Contact,
                id=stable_id(self.session.id, self.phase_id, surface, part),
                session_id=self.session.id,
                phase_id=self.phase_id,
                surface=surface,
                surface_kind=kind,
                box=int(surface.split("/")[1]),
                side=side,
                body_part=part,
                begin_s=begin_s,
                end_s=end_s,
                begin_active_s=begin_s,
                end_active_s=end_s,
                effect="side" if side else "green",
            )
        for number in range(1, self.spec.completions(step) + 1):
            self._add(
                Completion,
                session_id=self.session.id,
                phase_id=self.phase_id,
                number=number,
                at_s=10.0 * number,
                active_s=10.0 * number,
                duration_s=10.0,
                order=[4, 3, 2, 1],
                out_of_order_touches=0,
            )

    def _joint_errors(self, step: Step) -> None:
        for reference in ("present", "command"):
            for joint in ERROR_JOINTS:
                for axis in ERROR_AXES:
                    value = self.spec.joint_error_rad(step, joint) if reference == "present" else 0
                    self._add(
                        JointErrorRow,
                        session_id=self.session.id,
                        phase_id=self.phase_id,
                        reference=reference,
                        joint=joint,
                        axis=axis,
                        mean_rad=value,
                        rms_rad=value,
                        p95_rad=value,
                        max_rad=value,
                        samples=5400,
                        excluded=0,
                    )

    def _joint_error_courses(self, step: Step) -> None:
        """Add constant courses: the mean over the joints, with 5400 samples spread evenly."""
        bins = math.ceil((step.duration_s or 0.0) / COURSE_BIN_S)
        mean = float(np.mean([self.spec.joint_error_rad(step, joint) for joint in ERROR_JOINTS]))
        for reference in ("present", "command"):
            self._add(
                JointErrorCourseRow,
                session_id=self.session.id,
                phase_id=self.phase_id,
                reference=reference,
                bin_s=COURSE_BIN_S,
                mean_rad=[mean if reference == "present" else 0.0] * bins,
                samples=[5400 * len(ERROR_JOINTS) // bins] * bins,
            )

    def _form(self, step: Step, attempt: int) -> None:
        version = self.db.get_one(StudyVersion, self.session.study_version_id)
        row = instrument_for(self.db, version, step.instrument or "")
        instrument = instrument_of(row)
        answers = self._answers(instrument, step)
        shown = list(item_order(instrument, 7))
        administration = f"{step.key}#{attempt}"
        submission_id = stable_id(self.session.id, administration)
        self._add(
            Submission,
            id=submission_id,
            session_id=self.session.id,
            administration=administration,
            step_index=step.index,
            attempt=attempt,
            instrument_version_id=row.id,
            instrument=instrument.key,
            idempotency_key=stable_id("key", administration),
            request_hash=stable_id("request", administration),
            salt=None,
            mode="tablet",
            entered_by="tablet",
            language="en",
            item_seed=7,
            shown_order=shown,
            timings=dict.fromkeys(shown, 2.5),
            started_at=NOW,
            submitted_at=NOW + timedelta(minutes=step.index, seconds=attempt),
        )
        for item in instrument.items:
            value = answers[item.key]
            self._add(
                Answer,
                submission_id=submission_id,
                item=item.key,
                position=shown.index(item.key),
                value_number=None if isinstance(value, str) else value,
                value_text=value if isinstance(value, str) else None,
            )
        for key, score in score_answers(instrument, answers).items():
            self._add(ScoreValue, submission_id=submission_id, score=key, value=score)

    def _answers(self, instrument: Instrument, step: Step) -> dict[str, float | str | None]:
        rng = np.random.default_rng([*self.spec.code.encode(), step.index])
        answers: dict[str, float | str | None] = {}
        for item in instrument.items:
            if item.type == "text":
                answers[item.key] = self.spec.open_answer
            elif item.type == "choice":
                answers[item.key] = item.choices[0].key
            elif item.type == "likert" and instrument.scale:
                own = self.spec.likert(step, item.key) if self.spec.likert and step.block else None
                drawn = int(rng.integers(instrument.scale.minimum, instrument.scale.maximum + 1))
                answers[item.key] = float(own if own is not None else drawn)
            else:
                answers[item.key] = float(item.minimum or 0)
        return answers | {key: self.spec.about[key] for key in self.spec.about if key in answers}


def stable_id(*parts: object) -> str:
    """Return an id that depends only on `parts`."""
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]
