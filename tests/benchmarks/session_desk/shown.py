"""Measure a frame's age when one console draws it while three others receive the stream.

The headset records when it writes a message to its socket. The page acknowledges over its own
socket that it has drawn the preceding poses; a script that runs before the page's own records which
they are, and uses the time of the next animation frame as the time of display, because the drawn
frame has then been sent to the screen. Both clocks are read on the same machine: the page is asked
for its time many times, the shortest exchange counts, and half its duration is the reported bound.
"""

import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import Page

from tests.benchmarks.load.record import Record
from tests.benchmarks.report import Figure
from tests.benchmarks.session_desk.watched import SUBSCRIBERS, watched_session
from tests.support.browser import launched_browser

PART = "shown"
LIMIT_MS = 200.0
WARM_UP_S = 2.0
ASKED = 40
# Byte offsets of an encoded pose: the stream's code at 4, the newest frame's seq at 12.
NOTES = """
window.shownPoses = [];
const Original = window.WebSocket;
window.WebSocket = class extends Original {
  constructor(...given) {
    super(...given);
    this.waiting = [];
    this.addEventListener('message', ({ data }) => {
      if (!(data instanceof ArrayBuffer)) return;
      const view = new DataView(data);
      this.waiting.push([view.getUint8(4), Number(view.getBigUint64(12, true)), performance.now()]);
    });
  }
  send(...given) {
    const drawn = this.waiting.splice(0);
    if (drawn.length > 0) requestAnimationFrame(() => {
      const now = performance.now();
      window.shownPoses.push(...drawn.map((one) => [...one, now]));
    });
    super.send(...given);
  }
};
"""


@dataclass(frozen=True)
class PageClock:
    """The page's clock: machine's monotonic seconds = page's seconds + `offset_s`."""

    offset_s: float
    bound_s: float

    @classmethod
    def of(cls, page: Page) -> "PageClock":
        """Measure the offset many times and use the exchange with the shortest round trip."""
        best = cls(0.0, float("inf"))
        for _ in range(ASKED):
            before_s = time.monotonic()
            page_s = float(page.evaluate("() => performance.now()")) / 1000.0
            after_s = time.monotonic()
            half_s = (after_s - before_s) / 2
            if half_s < best.bound_s:
                best = cls((before_s + after_s) / 2 - page_s, half_s)
        return best


def figures(folder: Path, duration_s: float) -> Iterator[Figure]:
    """Measure the newest frames of both streams, from the headset's socket to the screen."""
    with (
        launched_browser() as browser,
        watched_session(folder, browser, duration_s + WARM_UP_S, NOTES) as watched,
    ):
        watched.sender.join()
        clock = PageClock.of(watched.page)
        rows = np.asarray(watched.page.evaluate("() => window.shownPoses"), float).reshape(-1, 4)
    arrived_ms, shown_ms = ages_ms(watched.sender.record, rows, clock)
    words = f"one drawing console, {SUBSCRIBERS} more; {len(shown_ms)} frames"
    for percent in (50, 95):
        value = float(np.percentile(arrived_ms, percent))
        yield Figure(PART, f"frame sent to its pose in the page p{percent}", value, "ms")
    yield Figure(PART, f"frame sent to shown p50; {words}", float(np.median(shown_ms)), "ms")
    p95_ms = float(np.percentile(shown_ms, 95))
    yield Figure(PART, "frame sent to shown p95", p95_ms, "ms", "limit", LIMIT_MS)
    yield Figure(PART, "the clocks agree within", 1000 * clock.bound_s, "ms")
    sent = sum(len(watched.sender.record.streams[name].ends) for name in ("target", "actual"))
    yield Figure(PART, "messages whose newest frame was shown", 100 * len(rows) / sent, "%")


def ages_ms(
    record: Record, rows: NDArray[np.float64], clock: PageClock
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the ages of the frames on arrival and when they were shown.

    `rows`: stream's code, seq, arrived and shown (page's ms).
    """
    sent_s = {
        (code, end - 1): handed_s
        for code, name in ((1, "target"), (2, "actual"))
        for end, handed_s in zip(
            record.streams[name].ends, record.streams[name].handed_s, strict=True
        )
    }
    began_s = min(sent_s.values()) + WARM_UP_S
    handed = np.array([sent_s[int(code), int(seq)] for code, seq, *_ in rows])
    at_s = rows[:, 2:] / 1000.0 + clock.offset_s
    late = handed >= began_s
    ages = 1000.0 * (at_s - handed[:, None])[late]
    return ages[:, 0], ages[:, 1]
