"""The achieved latency of the avatar in each phase, together with the latency that was set."""

from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.models import ClientReport, Phase, PhaseLatency

MS_PER_S = 1000.0


@dataclass(frozen=True)
class LatencyReceipt:
    """The achieved latency of one phase with its 95 % interval.

    It is null if it could not be determined; `reason` then says why. `off`: it deviates by more
    than 10 ms and more than one frame. `headset_added_ms`: what the headset's own computing added,
    as it reported itself, and how much of that it took off the set latency
    (`headset_compensated_ms`), which it cannot at 0 ms; null if it reported nothing.
    """

    phase_id: int
    kind: str
    limb: str | None
    latency_ms: float
    achieved_latency_ms: float | None
    achieved_latency_low_ms: float | None
    achieved_latency_high_ms: float | None
    movement_s: float
    off: bool
    reason: str | None
    headset_added_ms: float | None = None
    headset_compensated_ms: float | None = None


def latency_receipts(db: Session, session_id: str) -> tuple[LatencyReceipt, ...]:
    """Return a receipt for every finished phase whose frames have been analysed."""
    rows = db.execute(
        select(Phase, PhaseLatency)
        .join(
            PhaseLatency,
            (PhaseLatency.session_id == Phase.session_id)
            & (PhaseLatency.phase_id == Phase.phase_id),
        )
        .where(Phase.session_id == session_id)
        .order_by(Phase.phase_id)
    )
    added_ms = _added_ms(db, session_id)
    return tuple(_receipt(phase, latency, added_ms.get(phase.phase_id)) for phase, latency in rows)


def _added_ms(db: Session, session_id: str) -> dict[int, tuple[float, float]]:
    """Return what the headset added and compensated, by phase; the report that added the most.

    A refused report states what cannot be, so only accepted ones count.
    """
    payloads = db.scalars(
        select(ClientReport.payload).where(
            ClientReport.session_id == session_id,
            ClientReport.type == "added_latency",
            ClientReport.accepted,
        )
    )
    found: dict[int, tuple[float, float]] = {}
    for payload in payloads:
        added = (MS_PER_S * payload["added_s"], MS_PER_S * payload["compensated_s"])
        found[payload["phase_id"]] = max(found.get(payload["phase_id"], added), added)
    return found


def _receipt(
    phase: Phase, latency: PhaseLatency, added: tuple[float, float] | None
) -> LatencyReceipt:
    added_ms, compensated_ms = added or (None, None)
    return LatencyReceipt(
        phase_id=phase.phase_id,
        kind=phase.kind,
        limb=phase.limb,
        latency_ms=phase.latency_ms,
        achieved_latency_ms=_ms(latency.achieved_s),
        achieved_latency_low_ms=_ms(latency.low_s),
        achieved_latency_high_ms=_ms(latency.high_s),
        movement_s=latency.movement_s,
        off=latency.flagged,
        reason=latency.reason,
        headset_added_ms=added_ms,
        headset_compensated_ms=compensated_ms,
    )


def _ms(time_s: float | None) -> float | None:
    return None if time_s is None else MS_PER_S * time_s
