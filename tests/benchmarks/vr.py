"""Measure the headset's page: a visit and its record, its frames, its latencies, and what it draws.

A scripted participant wears an emulated headset on the page that is shipped (`tests/support/
vr_visit.py`), through the whole shipped study with its six phases, on a real server. The visit is
not drawn, because this machine imitates a graphics card in software; `mirror` draws single moments
of it beside three's Reflector, and `weight` sums what a browser fetches for the page.
"""

import gzip
import re
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median, quantiles

import numpy as np
import yaml
from playwright.sync_api import Browser, Page, Response
from sqlalchemy import select

from app.models import ClientReport
from app.protocol import TIMED_KINDS
from tests.benchmarks.report import Figure, Report
from tests.features.record.headset.site import open_site
from tests.protocol.helpers import SHIPPED, loaded
from tests.support.bodies_page import frame_times, shipped_avatar
from tests.support.browser import launched_browser
from tests.support.room import EVERYTHING, MOMENTS, Drawn, opened_room
from tests.support.server import LiveServer
from tests.support.vr_visit import FRAME_RATE_HZ, Json, begun, journey_script, ok

PARTS = ("session", "frame", "latency", "mirror", "weight")
VISITS = frozenset({"session", "frame", "latency"})
STUDY = "headset-benchmark"
TIME_SCALE = 10.0
PHASE_S, ROAM_S = 20.0, 5.0
AROUND_S = 1.0
"""Preparation and freeze of a phase, s."""
SPEED_LIMIT = 1.5
FRAME_LIMIT_MS, LOOP_LIMIT = 2.5, 1.3
LATENCY_LIMIT_MS = 11.1
CALLS_LIMIT, TRIANGLES_LIMIT = 20, 100_000
PIXELS_LIMIT_PERCENT, PIXEL_TOLERANCE = 0.5, 24
WEIGHT_LIMIT_MB = 4.0
BYTES_PER_MB = 1_000_000


def measure(parts: frozenset[str], duration_s: float = PHASE_S) -> Report:
    """Measure the parts; `duration_s`: active time of each of the visit's six phases."""
    report = Report("vr")
    with (
        tempfile.TemporaryDirectory(prefix="reembody-vr-") as folder,
        LiveServer(Path(folder)) as server,
        launched_browser() as browser,
    ):
        if "weight" in parts:
            report.add(*_weight(browser, server, _made(folder, "weight")))
        if "mirror" in parts:
            report.add(*_mirror(browser, _made(folder, "room")))
        if "frame" in parts:
            report.add(*_bodies(browser, server, _made(folder, "bodies")))
        if parts & VISITS:
            done = _visited(browser, server, _made(folder, "visit"), duration_s)
            if "session" in parts:
                report.add(*_record(done))
            if "frame" in parts:
                report.add(*_frames(done.frames_ms))
            if "latency" in parts:
                report.add(*_latencies(done))
    return report


def study_of(duration_s: float, key: str = STUDY) -> str:
    """Return the shipped study under another key, with phases of this active time."""
    text = SHIPPED.replace("key: reembodiment-latency", f"key: {key}", 1)
    text = text.replace("duration_s: 120", f"duration_s: {ROAM_S:g}")
    text = re.sub(r"(preparation_s|freeze_s): 5\b", rf"\1: {AROUND_S:g}", text)
    return re.sub(r"duration_s: 60\b", f"duration_s: {duration_s:g}", text)


@dataclass(frozen=True)
class _Visited:
    """A visit that has ended, and what it left."""

    view: Json
    receipt: Json
    problems: Sequence[str]
    """Errors of the page."""
    drawn_s: float
    took_s: float
    frames_ms: Sequence[float]
    added_s: dict[int, float]
    """What the headset said that remains of its own latency, by phase."""


def _made(folder: str, name: str) -> Path:
    made = Path(folder, name)
    made.mkdir()
    return made


def _visited(browser: Browser, server: LiveServer, folder: Path, duration_s: float) -> _Visited:
    problems: list[str] = []
    with open_site(server) as site, browser.new_context() as context:
        ok(site.operator.post("/api/studies", json={"yaml": study_of(duration_s)}))
        context.on("weberror", lambda error: problems.append(str(error.error)))
        context.on(
            "console",
            lambda message: problems.append(message.text) if message.type == "error" else None,
        )
        visit, tablet = begun(
            site.operator,
            context,
            journey_script(folder),
            server.url,
            STUDY,
            time_scale=TIME_SCALE,
        )
        began_s = time.monotonic()
        with tablet:
            view = visit.perform()
        took_s = time.monotonic() - began_s
        if view["status"] != "completed":
            raise RuntimeError(f"the visit ended as {view['status']}, not completed")
        receipt = ok(site.operator.get(f"/api/sessions/{visit.session_id}/receipt"))
        told = select(ClientReport).where(
            ClientReport.session_id == visit.session_id, ClientReport.type == "added_latency"
        )
        with site.database.reading() as db:
            payloads = [report.payload for report in db.scalars(told)]
        return _Visited(
            view=view,
            receipt=receipt,
            problems=problems,
            drawn_s=visit.drawn_s,
            took_s=took_s,
            frames_ms=_page_ms(visit.headset.page),
            added_s={one["phase_id"]: one["added_s"] - one["compensated_s"] for one in payloads},
        )


def _record(done: _Visited) -> tuple[Figure, ...]:
    part = "session"
    streams = done.receipt["streams"]
    phases = [one for one in done.view["phases"] if one["kind"] in TIMED_KINDS]
    stored = sum(one["stored"] for one in streams)
    missing = sum(one["missing"] for one in streams)
    return (
        Figure(part, "timed phases done", len(phases), ""),
        Figure(part, "tasks completed", sum(one["completions"] for one in phases), ""),
        Figure(part, "frames and reports stored", stored, ""),
        Figure(part, "frames and reports missing", missing, "", "at most", 0),
        Figure(part, "problems of the receipt", len(done.receipt["problems"]), "", "at most", 0),
        Figure(part, "errors of the page", len(done.problems), "", "at most", 0),
        Figure(part, "duration", done.took_s, "s"),
        Figure(
            part,
            "drawn time by duration",
            done.drawn_s / done.took_s,
            "s/s",
            "at least",
            SPEED_LIMIT,
        ),
    )


def _page_ms(page: Page) -> list[float]:
    took_ms: list[float] = page.evaluate("() => journey.tookMs")
    # The first second loads and compiles.
    return took_ms[FRAME_RATE_HZ:]


def _frames(frames_ms: Sequence[float]) -> tuple[Figure, ...]:
    cuts = quantiles(frames_ms, n=100)
    name = "frame of the page in a visit, not drawn,"
    return (
        Figure("frame", f"{name} p50", median(frames_ms), "ms", "at most", FRAME_LIMIT_MS),
        Figure("frame", f"{name} p95", cuts[94], "ms"),
        Figure("frame", f"{name} p99", cuts[98], "ms"),
    )


def _bodies(browser: Browser, server: LiveServer, folder: Path) -> list[Figure]:
    """Time the bodies in the page and in their worker, beside the plainest loop."""
    layouts = tuple(loaded(SHIPPED).protocol.tasks.layouts().values())
    times = frame_times(browser, server.url, folder, shipped_avatar(layouts))
    computed = {
        where: median(map(sum, zip(one["ik"], one["remote"], strict=True)))
        for where, one in times.items()
    }
    plain_ms = computed["plain"]
    found = []
    for where in ("page", "worker"):
        name = f"bodies computed in the {where}, p50"
        ratio = computed[where] / plain_ms
        found += [
            Figure("frame", name, computed[where], "ms", "plainest loop", plain_ms),
            Figure("frame", f"{name}, by the plainest loop's", ratio, "", "at most", LOOP_LIMIT),
        ]
    waits_ms = median(times["worker"]["page"])
    return [*found, Figure("frame", "the page waits for the worker, p50", waits_ms, "ms")]


def _latencies(done: _Visited) -> list[Figure]:
    """Compare what the server measured with what it ordered and what the headset said it adds."""
    found: list[Figure] = []
    for one in done.view["phases"]:
        if one["kind"] != "task":
            continue
        name = f"{one['limb']}, {one['latency_ms']:g} ms ordered"
        expected_ms = one["latency_ms"] + 1000.0 * done.added_s[one["phase_id"]]
        achieved_ms = one["achieved_latency_ms"]
        if achieved_ms is None:
            found.append(Figure("latency", f"{name}: not measured", 1, "", "at most", 0))
            continue
        off_ms = abs(achieved_ms - expected_ms)
        found += [
            Figure(
                "latency",
                f"{name}: achieved",
                achieved_ms,
                "ms",
                "ordered and added",
                expected_ms,
            ),
            Figure("latency", f"{name}: off by", off_ms, "ms", "at most", LATENCY_LIMIT_MS),
        ]
    return found


def _mirror(browser: Browser, folder: Path) -> tuple[Figure, ...]:
    """Draw everything that can be seen at once, and free roam with both kinds of mirror."""
    part = "mirror"
    study = yaml.safe_load(SHIPPED)
    with browser.new_context() as context, opened_room(context, folder, study) as room:
        full = room.draw(EVERYTHING)
    pictures: dict[str, Drawn] = {}
    for mirror in ("double", "reflector"):
        with (
            browser.new_context() as context,
            opened_room(context, folder, study, mirror=mirror) as room,
        ):
            pictures[mirror] = room.draw(MOMENTS["free_roam"])
    ours, threes = pictures["double"], pictures["reflector"]
    differing = max(_differing_percent(ours, threes, eye) for eye in (0, 1))
    rival = "three's Reflector"
    limit = PIXELS_LIMIT_PERCENT
    return (
        Figure(part, "draw calls of an eye", full.calls, "", "at most", CALLS_LIMIT),
        Figure(part, "triangles of an eye", full.triangles, "", "at most", TRIANGLES_LIMIT),
        Figure(part, "changes of the render target", full.target_switches, "", "at most", 0),
        Figure(part, "free roam: draw calls of an eye", ours.calls, "", rival, threes.calls),
        Figure(
            part,
            "free roam: changes of the render target",
            ours.target_switches,
            "",
            rival,
            threes.target_switches,
        ),
        Figure(part, "free roam: pixels unlike the Reflector's", differing, "%", "at most", limit),
    )


def _differing_percent(ours: Drawn, theirs: Drawn, eye: int) -> float:
    apart = np.abs(ours.eye(eye) - theirs.eye(eye)).max(axis=2)
    return 100.0 * float((apart > PIXEL_TOLERANCE).mean())


def _weight(browser: Browser, server: LiveServer, folder: Path) -> tuple[Figure, ...]:
    """Sum what the browser fetches for the page, compressed: opened, then paired and in VR."""
    part, peer, limit = "weight", "at most", WEIGHT_LIMIT_MB
    study = study_of(PHASE_S, f"{STUDY}-weight")
    fetched: dict[str, int] = {}

    def weigh(answer: Response) -> None:
        if answer.ok and "/api/" not in answer.url:
            fetched[answer.url] = len(gzip.compress(answer.body(), 6))

    with open_site(server) as site:
        ok(site.operator.post("/api/studies", json={"yaml": study}))
        with browser.new_context() as context:
            page = context.new_page()
            page.on("response", weigh)
            page.goto(f"{server.url}/vr", wait_until="networkidle")
            opened_mb = sum(fetched.values()) / BYTES_PER_MB
        fetched.clear()
        with browser.new_context() as context:
            context.on("response", weigh)
            script = journey_script(folder)
            begun(
                site.operator, context, script, server.url, f"{STUDY}-weight", time_scale=TIME_SCALE
            )
            in_vr_mb = sum(fetched.values()) / BYTES_PER_MB
    return (
        Figure(part, "files of the opened page, gzip", opened_mb, "MB", peer, limit),
        Figure(part, "files until VR is shown, gzip", in_vr_mb, "MB", peer, limit),
    )
