"""Compare what the headset's side sent with what the database returns.

The ledger is a journal that removes nothing: the digest of every frame by (stream, epoch, seq),
every report, and how far the server acknowledged each stream. All acknowledged data must be stored,
nothing may be duplicated or altered, and a stream may not have holes.
"""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.client.journal import Entry, Journal
from app.features.record.telemetry import epochs_of, iter_frames
from app.models import ClientReport, TelemetryBatch, TelemetryChunk
from app.wire import BODY_STREAMS, decode_batch
from app.wire.messages import REPORT_STREAM

Key = tuple[str, int]
"""Stream and epoch."""


@dataclass
class LedgerJournal(Journal):
    """A journal that removes nothing; `sent[key][seq]` is the digest of a frame, or a report."""

    sent: dict[Key, list[str]] = field(default_factory=dict)
    acked: dict[Key, int] = field(default_factory=dict)
    active_s: dict[Key, list[tuple[int, int, float]]] = field(default_factory=dict)
    acknowledgements: int = 0
    """How often the server said what it has stored."""

    def add(self, entry: Entry) -> None:
        """Add a message, whose sequence numbers must follow the previous ones."""
        key = (entry.stream, entry.epoch)
        told = self.sent.setdefault(key, [])
        if isinstance(entry.message, bytes):
            batch = decode_batch(entry.message)
            header = batch.header
            assert header.seq_first == len(told)
            told += digests(batch.times_s, batch.flags, batch.values, header.phase_id)
            reached = (header.seq_end, header.phase_id, header.active_s)
            self.active_s.setdefault(key, []).append(reached)
        else:
            assert entry.seq_end == len(told) + 1
            body = json.loads(entry.message)["body"]
            told.append(json.dumps(body, sort_keys=True))
            if "active_s" in body:
                reached = (entry.seq_end, body["phase_id"], body["active_s"])
                self.active_s.setdefault(key, []).append(reached)
        super().add(entry)

    def acknowledge(self, positions: "Sequence[tuple[str, int, int]]") -> None:  # type: ignore[override]  # a wider argument
        """Record the positions that the server acknowledged."""
        known = list(positions)
        self.acknowledgements += 1
        for stream, epoch, next_seq in known:
            self.acked[stream, epoch] = max(next_seq, self.acked.get((stream, epoch), 0))
        super().acknowledge(known)

    def acknowledged_active_s(self, phase_id: int) -> float:
        """Return the greatest active time of a phase that the server acknowledged."""
        return max(
            (
                active_s
                for key, told in self.active_s.items()
                for seq_end, phase, active_s in told
                if phase == phase_id and seq_end <= self.acked.get(key, 0)
            ),
            default=0.0,
        )

    def used_active_s(self, phase_id: int) -> float:
        """Return the greatest active time of a phase that the headset reported."""
        return max(
            (
                active_s
                for told in self.active_s.values()
                for _, phase, active_s in told
                if phase == phase_id
            ),
            default=0.0,
        )

    def save(self, path: Path) -> None:
        """Save the sent and acknowledged messages for another process."""
        rows = [[*key, told, self.acked.get(key, 0)] for key, told in self.sent.items()]
        path.write_text(json.dumps(rows))


def load_ledger(path: Path) -> LedgerJournal:
    """Load the sent and acknowledged messages that another process saved."""
    ledger = LedgerJournal()
    for stream, epoch, told, acked in json.loads(path.read_text()):
        ledger.sent[stream, epoch] = told
        ledger.acked[stream, epoch] = acked
    return ledger


def digests(
    times_s: NDArray[np.float64],
    flags: NDArray[np.uint8],
    values: NDArray[np.float32],
    phase_id: int,
) -> list[str]:
    """Return one digest per frame over all its bits, and the phase that the frame belongs to."""
    return [
        hashlib.blake2b(
            times_s[at].tobytes() + flags[at].tobytes() + values[at].tobytes(),
            digest_size=8,
            salt=phase_id.to_bytes(4, "little"),
        ).hexdigest()
        for at in range(len(times_s))
    ]


@dataclass(frozen=True)
class Reconciliation:
    """Counts of frames and reports, over all streams and epochs.

    `lost`: acknowledged and not stored. `altered`: stored with other bits than were sent.
    `duplicated`: stored twice. `holes`: seqs missing before the last stored one.
    """

    sent: int
    acked: int
    stored: int
    lost: int
    altered: int
    duplicated: int
    holes: int

    @property
    def sound(self) -> bool:
        """Return whether no data are lost, altered, duplicated or missing."""
        return not (self.lost or self.altered or self.duplicated or self.holes)


def reconcile(db: Session, session_id: str, ledger: LedgerJournal) -> Reconciliation:
    """Compare a session's record with what its headset sent."""
    totals = np.zeros(7, dtype=np.int64)
    known = {
        (stream, epoch)
        for stream in (*BODY_STREAMS, REPORT_STREAM)
        for epoch in epochs_of(db, session_id, stream)
    }
    for key in sorted(known | ledger.sent.keys()):
        totals += _compare(db, session_id, key, ledger)
    return Reconciliation(*(int(total) for total in totals))


def _compare(db: Session, session_id: str, key: Key, ledger: LedgerJournal) -> NDArray[np.int64]:
    stream, epoch = key
    if stream == REPORT_STREAM:
        stored, rows = _stored_reports(db, session_id, epoch)
    else:
        stored, rows = _stored_frames(db, session_id, stream, epoch)
    sent, acked = ledger.sent.get(key, []), ledger.acked.get(key, 0)
    lost = sum(seq not in stored for seq in range(acked))
    altered = sum(seq >= len(sent) or digest != sent[seq] for seq, digest in stored.items())
    end = max(stored, default=-1) + 1
    return np.array(
        [len(sent), acked, len(stored), lost, altered, rows - len(stored), end - len(stored)]
    )


def _stored_reports(db: Session, session_id: str, epoch: int) -> tuple[dict[int, str], int]:
    rows = db.scalars(
        select(ClientReport).where(
            ClientReport.session_id == session_id, ClientReport.epoch == epoch
        )
    ).all()
    return {row.seq: json.dumps(row.payload, sort_keys=True) for row in rows}, len(rows)


def _stored_frames(
    db: Session, session_id: str, stream: str, epoch: int
) -> tuple[dict[int, str], int]:
    """Return digests by sequence number as readers see them, and the number of stored frames."""
    stored: dict[int, str] = {}
    for phase_id, frames in iter_frames(db, session_id, stream, epoch):
        told = digests(frames.times_s, frames.flags, frames.values, phase_id)
        stored.update(zip(frames.seq.tolist(), told, strict=True))
    held = 0
    for table in (TelemetryChunk, TelemetryBatch):
        counts = db.scalars(
            select(table.frame_count).where(
                table.session_id == session_id, table.stream == stream, table.epoch == epoch
            )
        )
        held += sum(counts)
    return stored, held
