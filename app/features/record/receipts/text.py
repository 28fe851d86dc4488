"""A receipt for people: one screen, the verdict first."""

from app.features.record.receipts.latencies import LatencyReceipt
from app.features.record.receipts.service import SessionReceipt


def receipt_text(receipt: SessionReceipt) -> str:
    """Verdict, what is wrong, then streams, event log, completions and latencies."""
    verdict = "COMPLETE" if receipt.complete else "NOT COMPLETE"
    simulated = ", simulated" if receipt.simulated else ""
    lines = [
        f"{verdict}  session {receipt.session_id} ({receipt.study}, {receipt.status}{simulated})",
        *(f"  ! {problem}" for problem in receipt.problems),
        "",
        f"{'stream':<10}{'epoch':>6}{'sent':>10}{'stored':>10}{'missing':>9}{'flagged':>9}",
        *(
            f"{one.stream:<10}{one.epoch:>6}{one.sent:>10}{one.stored:>10}{one.missing:>9}"
            f"{one.flagged:>9}"
            for one in receipt.streams
        ),
        "",
        f"event log  {receipt.chain.events} events, "
        + ("every hash follows from the one before" if receipt.chain_ok else "CHANGED"),
        _completions_line(receipt),
    ]
    if receipt.achieved_latency:
        lines += ["", f"{'phase':<8}{'':<12}{'ordered':>10}{'achieved (95 %)':>28}"]
        lines += [_latency_line(one) for one in receipt.achieved_latency]
    return "\n".join(lines)


def _completions_line(receipt: SessionReceipt) -> str:
    stored = sum(one.stored for one in receipt.completions)
    rederived = sum(one.rederived for one in receipt.completions)
    return f"completions  {stored} stored, {rederived} follow from the contacts"


def _latency_line(one: LatencyReceipt) -> str:
    name = one.limb or one.kind.replace("_", " ")
    head = f"{one.phase_id:<8}{name:<12}{one.latency_ms:>7.0f} ms"
    if one.achieved_latency_ms is None:
        return f"{head}   {one.reason or 'not known'}"
    interval = f"{one.achieved_latency_low_ms:.1f} to {one.achieved_latency_high_ms:.1f}"
    achieved = f"{one.achieved_latency_ms:.1f} ms ({interval})"
    return f"{head}{achieved:>28}{'  OFF' if one.off else ''}"
