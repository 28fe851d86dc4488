"""Compute the console's live figures from the latest messages, before they are committed."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from sqlalchemy.orm import Session

from app.features.record.telemetry.movement import hinges_of_body
from app.science.avatar.targets import HingeReference
from app.science.rotations import identity
from app.science.skeleton import JOINT_COUNT, JOINT_NAMES
from app.science.tasks import side_unit
from app.wire import (
    FINGER_STREAMS,
    Batch,
    CompletionReport,
    ContactReport,
    PhaseOrder,
    Report,
    StreamName,
)

PERIOD_S = 0.2
COMPLETIONS_EVERY_S = 10.0
"""How seldom a blinded reader is told the number of completions, in active time.

The completion follows the participant's own movement by the latency. On this beat, the number is
what the participant's mirror shows, but no moment.
"""


@dataclass
class LiveTelemetry:
    """Summarises the messages of one connection as a few figures, at most five times a second.

    Counting is cheap and always done; figures are computed only while a console is subscribed.

    `hinges`: those of a physics avatar, so that its live errors equal the stored ones, which are
    relative to the pose that the hinges are commanded. None for a delayed copy. `hinges_by_body`:
    those of the bodies that conditions name, which may lack parts; `wear` says which is worn.
    """

    hinges: HingeReference | None = None
    hinges_by_body: Mapping[str, HingeReference] = field(default_factory=dict)
    _worn: str | None = None
    _newest: dict[StreamName, Batch] = field(default_factory=dict)
    _published_s: float = 0.0
    _frames: int = 0
    _flagged: int = 0
    _counted_until_s: float = float("nan")
    _phase_id: int = 0
    _completions: int = 0
    _beat: int = -1
    _completions_on_beat: int = 0
    _side_contacts: int = 0
    _side_contact_s: float = 0.0
    _red_until_s: dict[str, float] = field(default_factory=dict)

    def wear(self, order: PhaseOrder | None) -> None:
        """Compute errors for the body of a phase's order; without an order nothing changes.

        A participant stays in a body until the next order.
        """
        if order is not None:
            self._worn = order.body

    @property
    def worn_hinges(self) -> HingeReference | None:
        """Return the hinges of the body that is worn."""
        if self._worn is None:
            return self.hinges
        return self.hinges_by_body.get(self._worn, self.hinges)

    def count(self, report: Report) -> None:
        """Count a completion or a side contact."""
        if isinstance(report.body, CompletionReport):
            self._completions = report.body.number
        elif isinstance(report.body, ContactReport) and report.body.surface_kind == "side":
            self._count_side(report.body)

    def _count_side(self, contact: ContactReport) -> None:
        """Count a finished side contact; what several parts touch at the same time counts once."""
        side = side_unit(contact.surface) or contact.surface
        red_until_s = self._red_until_s.get(side, -1.0)
        if contact.begin_active_s > red_until_s:
            self._side_contacts += 1
        new_s = contact.end_active_s - max(contact.begin_active_s, red_until_s)
        self._side_contact_s += max(0.0, new_s)
        self._red_until_s[side] = max(red_until_s, contact.end_active_s)

    def flagged(self, frames: int) -> None:
        """Count stored frames that contain invalid values."""
        self._flagged += frames

    def take(self, batch: Batch) -> None:
        """Process a batch of frames."""
        header = batch.header
        if header.stream in FINGER_STREAMS:
            return  # only the body's frames enter the figures
        if header.phase_id != self._phase_id:
            self._phase_id, self._completions, self._side_contacts = header.phase_id, 0, 0
            self._side_contact_s, self._red_until_s = 0.0, {}
            self._beat, self._completions_on_beat = -1, 0
        self._newest[header.stream] = batch
        if header.stream is StreamName.TARGET:
            self._frames += header.frame_count

    def figures(self, now_s: float) -> dict[str, Any] | None:
        """Return the figures if they are due, else None."""
        if now_s - self._published_s < PERIOD_S or StreamName.ACTUAL not in self._newest:
            return None
        self._published_s = now_s
        return self._figures()

    def _frame_rate(self, target: Batch | None) -> float | None:
        """Return target frames per second of the client's clock since the last figures."""
        until_s = float("nan") if target is None else float(target.times_s[-1])
        spanned_s = until_s - self._counted_until_s
        frames, self._frames, self._counted_until_s = self._frames, 0, until_s
        return frames / spanned_s if spanned_s > 0 else None

    def _figures(self) -> dict[str, Any]:
        actual = self._newest[StreamName.ACTUAL]
        target = self._newest.get(StreamName.TARGET)
        fps = self._frame_rate(target)
        beat = int(actual.header.active_s // COMPLETIONS_EVERY_S)
        if beat != self._beat:
            self._beat, self._completions_on_beat = beat, self._completions
        errors_deg = {} if target is None else _errors_deg(target, actual, self.worn_hinges)
        return {
            "phase_id": self._phase_id,
            "active_s": actual.header.active_s,
            "client_t_s": _number(actual.times_s[-1]),
            "fps": None if fps is None else round(fps, 1),
            "completions": self._completions,
            "completions_on_beat": self._completions_on_beat,
            "side_contacts": self._side_contacts,
            "side_contact_s": self._side_contact_s,
            "frames_flagged": self._flagged,
            "joint_error_deg": errors_deg,
        }


def live_telemetry(db: Session, session_id: str, bodies: Iterable[str] = ()) -> LiveTelemetry:
    """Create the live telemetry of a session's connection; raises NotFound.

    `bodies`: the names of those that the study's conditions prescribe. This loads what a physics
    avatar needs, which can take a second, so do not call it on the event loop.
    """
    hinges = {body: hinges_of_body(db, session_id, body) for body in (None, *bodies)}
    loaded = {body: own for body, own in hinges.items() if own is not None}
    for own in loaded.values():
        own.pose(identity(JOINT_COUNT))
    named = {body: own for body, own in loaded.items() if body is not None}
    return LiveTelemetry(loaded.get(None), named)


def _errors_deg(
    target: Batch, actual: Batch, hinges: HingeReference | None
) -> dict[str, float | None]:
    """Return the angle between both poses at the latest common seq, per joint except the hips."""
    end = min(target.header.seq_end, actual.header.seq_end)
    first = max(target.header.seq_first, actual.header.seq_first)
    if end <= first:
        return {}
    actual_q = actual.values[end - 1 - actual.header.seq_first, 3:].reshape(-1, 4)
    with np.errstate(invalid="ignore"):
        target_q = target.values[end - 1 - target.header.seq_first, 3:].reshape(-1, 4).astype(float)
        if hinges is not None:
            target_q = hinges.pose(target_q)
        cosine = np.abs(np.einsum("jk,jk->j", target_q, actual_q.astype(float)))
        angle_deg = np.degrees(2.0 * np.arccos(np.clip(cosine, 0.0, 1.0)))
    return {
        name: _number(angle)
        for name, angle in zip(JOINT_NAMES, angle_deg, strict=True)
        if name != "Hips"
    }


def _number(value: np.floating[Any]) -> float | None:
    """Round a number for JSON; return None if it is not finite."""
    return round(float(value), 3) if np.isfinite(value) else None
