"""Builders that write clock probes directly into the database."""

from datetime import UTC, datetime, timedelta

import numpy as np
from sqlalchemy import insert
from sqlalchemy.orm import Session

from app.models import ClockProbe
from app.science.clock import ClockProbes

EPOCH_UTC = datetime(1970, 1, 1, tzinfo=UTC)


def store_probes(
    db: Session, session_id: str, probes: ClockProbes, *, epoch: int = 1, time_scale: float = 1.0
) -> None:
    """Store probes as the server would; `server_utc_s` is in seconds since 1970."""
    assert probes.server_utc_s is not None
    rows = []
    for at, answered in enumerate(probes.answered):
        back_s = float(probes.client_received_s[at]) * time_scale
        rows.append(
            {
                "session_id": session_id,
                "epoch": epoch,
                "client_sent_s": float(probes.client_sent_s[at]) * time_scale,
                "server_received_ns": _ns(probes.server_received_s[at]) if answered else None,
                "server_sent_ns": _ns(probes.server_sent_s[at]) if answered else None,
                "client_received_s": back_s if answered else None,
                "server_utc": EPOCH_UTC + timedelta(seconds=float(probes.server_utc_s[at])),
            }
        )
    if rows:
        db.execute(insert(ClockProbe), rows)


def steady_probes(begin: datetime) -> ClockProbes:
    """Return a probe every 5 s for 10 minutes, 2 ms each way, the third lost.

    The client's clock is 0 at `begin`, the server's monotonic clock is 5000 s ahead, and its wall
    clock is read 10 ms after an answer.
    """
    sent_s = 0.2503 + 5.00371 * np.arange(120, dtype=np.float64)
    received_s = sent_s + 5000.002
    utc_s = (begin - EPOCH_UTC).total_seconds() + sent_s + 0.012
    back_s = sent_s + 0.004
    back_s[2] = np.nan
    return ClockProbes(sent_s, received_s, received_s.copy(), back_s, utc_s)


def _ns(seconds: float) -> int:
    return round(float(seconds) * 1e9)
