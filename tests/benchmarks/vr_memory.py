"""Measure whether the headset's page keeps memory over ten minutes of a visit.

A scripted participant acts in one long hand phase, with physics and its record, not drawn. What the
page itself holds is read after forced collections: the JavaScript objects of the page, and those of
all its workers together with the page's, as the browser accounts for them. What the emulated
headset keeps for the test (times of frames, inputs of the rules) is let go first.
"""

import re
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Browser, CDPSession, Page

from tests.benchmarks.report import Figure
from tests.features.record.headset.site import open_site
from tests.protocol.helpers import SHIPPED
from tests.support.server import LiveServer
from tests.support.vr_visit import QUICK, Json, Visit, begun, journey_script, ok

STUDY = "headset-memory"
PART = "heap"
WARM_S, WATCHED_S = 60.0, 600.0
GROWTH_LIMIT_MIB = 2.0
TIME_SCALE = 10.0
_MIB = 2**20
_COLLECTIONS = 3


@dataclass(frozen=True)
class _Held:
    """Memory in use at one moment of the visit, after collections."""

    at_s: float
    page_mib: float
    nodes: int
    listeners: int


def memory_figures(browser: Browser, server: LiveServer, folder: Path) -> list[Figure]:
    """Let a participant act for eleven minutes; compare the end with the first minute's."""
    with open_site(server) as site, browser.new_context() as context:
        ok(site.operator.post("/api/studies", json={"yaml": _one_long_phase()}))
        script = journey_script(folder)
        visit, tablet = begun(
            site.operator, context, script, server.url, STUDY, time_scale=TIME_SCALE, traits=QUICK
        )
        devtools = context.new_cdp_session(visit.headset.page)
        with tablet:
            visit.perform(until=_is_acting)
            held = [_watched(visit, devtools, WARM_S)]
            held.extend(_watched(visit, devtools, WATCHED_S / 5) for _ in range(5))
    first, last = held[0], held[-1]
    growth = last.page_mib - first.page_mib
    watched = f"over {(last.at_s - first.at_s) / 60:.1f} min"
    return [
        Figure(PART, "objects of the page after a minute", first.page_mib, "MiB"),
        Figure(PART, f"growth {watched}", growth, "MiB", "at most", GROWTH_LIMIT_MIB),
        Figure(PART, f"growth {watched}: nodes", last.nodes - first.nodes, ""),
        Figure(PART, f"growth {watched}: listeners", last.listeners - first.listeners, ""),
    ]


def _one_long_phase() -> str:
    text = SHIPPED.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
    return re.sub(r"duration_s: 60\b", f"duration_s: {2 * (WARM_S + WATCHED_S):g}", text)


def _is_acting(view: Json) -> bool:
    current = view["current"]
    return (
        current is not None
        and current["status"] == "running"
        and view["steps"][current["index"]]["kind"] == "task"
    )


def _watched(visit: Visit, devtools: CDPSession, duration_s: float) -> _Held:
    until_s = visit.drawn_s + duration_s
    visit.perform(until=lambda _: visit.drawn_s >= until_s)
    page: Page = visit.headset.page
    page.evaluate("() => journey.forget()")
    for _ in range(_COLLECTIONS):
        devtools.send("HeapProfiler.collectGarbage")
    used = devtools.send("Runtime.getHeapUsage")
    counters = devtools.send("Memory.getDOMCounters")
    return _Held(
        visit.drawn_s,
        float(used["usedSize"]) / _MIB,
        int(counters["nodes"]),
        int(counters["jsEventListeners"]),
    )
