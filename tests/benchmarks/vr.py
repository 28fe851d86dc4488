"""Measure the headset's page: a visit and its record, its frames, its latencies, and what it draws.

A scripted participant wears an emulated headset on the page that is shipped (`tests/support/
vr_visit.py`), through the whole shipped study with its six phases, on a real server. The visit is
not drawn, because this machine imitates a graphics card in software; `mirror` draws single moments
of it beside three's Reflector, `heap` watches the memory of ten minutes, and `weight` sums what a
browser fetches for the page. `desktop` counts the clicks from the console's first page into a body
on this screen. `calibration` needs no browser: `vr_calibration`.
"""

import gzip
import re
import tempfile
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median, quantiles

import httpx2
import numpy as np
import psutil
import yaml
from playwright.sync_api import Browser, Page, Response
from sqlalchemy import select

from app.models import ClientReport
from app.protocol import TIMED_KINDS
from tests.benchmarks.report import Figure, Report
from tests.benchmarks.vr_calibration import calibrations
from tests.benchmarks.vr_memory import memory_figures
from tests.e2e.people import PICTURE_HIDDEN, Experimenter
from tests.features.record.headset.site import open_site
from tests.protocol.helpers import SHIPPED, loaded
from tests.support.acting_on_screen import act_on_this_screen
from tests.support.bodies_page import frame_times, shipped_avatar
from tests.support.browser import launched_browser
from tests.support.room import ACCOMPANIED, EVERYTHING, MOMENTS, PAUSED, Drawn, opened_room
from tests.support.server import LiveServer
from tests.support.vr_rules import Outcome, derived, stored
from tests.support.vr_visit import FRAME_RATE_HZ, QUICK, Json, begun, journey_script, ok

PARTS = ("session", "frame", "latency", "mirror", "heap", "weight", "calibration", "desktop")
VISITS = frozenset({"session", "frame"})
STUDY = "headset-benchmark"
TIME_SCALE = 10.0
PHASE_S, ROAM_S = 20.0, 5.0
AROUND_S = 1.0
"""Preparation and freeze of a phase, s."""
ANALYSED_WITHIN_S = 120.0
"""Patience until the server has measured the latencies of a visit that has just ended, s."""
NOT_YET: Json = {
    "achieved_latency_ms": None,
    "reason": f"the server has not analysed it within {ANALYSED_WITHIN_S:g} s of the visit's end",
}
FETCHED_WITHIN_S = 30.0
SPEED_LIMIT = 1.5
FRAME_LIMIT_MS, LOOP_LIMIT = 2.5, 1.3
LATENCY_LIMIT_MS = 11.1
CALLS_LIMIT, TRIANGLES_LIMIT = 20, 100_000
PIXELS_LIMIT_PERCENT, PIXEL_TOLERANCE = 0.5, 24
WEIGHT_LIMIT_MB = 4.0
CLICKS_LIMIT, DESKTOP_LIMIT_S = 3, 20.0
BYTES_PER_MB = 1_000_000


def measure(parts: frozenset[str], duration_s: float = PHASE_S) -> Report:
    """Measure the parts; `duration_s`: active time of each of the visit's six phases."""
    report = Report("vr")
    if "calibration" in parts:
        report.add(*calibrations())
    if parts - {"calibration"}:
        _in_a_browser(report, parts, duration_s)
    return report


def _in_a_browser(report: Report, parts: frozenset[str], duration_s: float) -> None:
    with (
        tempfile.TemporaryDirectory(prefix="reembody-vr-") as folder,
        LiveServer(Path(folder)) as server,
        launched_browser() as browser,
    ):
        if "desktop" in parts:
            report.add(*_desktop(browser, server))
        if "weight" in parts:
            report.add(*_weight(browser, server, _made(folder, "weight")))
        if "heap" in parts:
            report.add(*memory_figures(browser, server, _made(folder, "memory")))
        if "mirror" in parts:
            report.add(*_mirror(browser, _made(folder, "room")))
        if "frame" in parts:
            report.add(*_bodies(browser, server, _made(folder, "bodies")))
        if parts & VISITS:
            done = _visited(browser, server, _made(folder, "visit"), study_of(duration_s))
            if "session" in parts:
                report.add(*_record(done))
            if "frame" in parts:
                report.add(*_frames(done.frames_ms))
        if "latency" in parts:
            study = study_of(duration_s, f"{STUDY}-latency")
            steps = _made(folder, "steps")
            report.add(*_latencies(_visited(browser, server, steps, study, marches=True)))


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
    processor_s: float
    """Processor time of the browser, the server, the operator and the tablet together."""
    frames_ms: Sequence[float]
    added_s: dict[int, float]
    """What the headset said that remains of its own latency, by phase."""
    reported: Outcome
    """Contacts and completions as the page reported them."""
    derived: Outcome
    """The same as the rules in Python make them of the same inputs."""


def _made(folder: str, name: str) -> Path:
    made = Path(folder, name)
    made.mkdir()
    return made


def _visited(
    browser: Browser, server: LiveServer, folder: Path, study: str, *, marches: bool = False
) -> _Visited:
    """Take part in a visit; `marches`: step on the spot instead of doing the foot task."""
    problems: list[str] = []
    protocol = loaded(study).protocol
    with open_site(server) as site, browser.new_context() as context:
        ok(site.operator.post("/api/studies", json={"yaml": study}))
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
            protocol.key,
            time_scale=TIME_SCALE,
            traits=QUICK,
        )
        if marches:
            visit.headset.do("journey.isMarching = true")
        began_s, before_s = time.monotonic(), _processor_s()
        with tablet:
            view = visit.perform()
        took_s, processor_s = time.monotonic() - began_s, _processor_s() - before_s
        if view["status"] != "completed":
            raise RuntimeError(f"the visit ended as {view['status']}, not completed")
        receipt = _receipt(site.operator, visit.session_id, len(view["phases"]))
        told = select(ClientReport).where(
            ClientReport.session_id == visit.session_id, ClientReport.type == "added_latency"
        )
        with site.database.reading() as db:
            payloads = [report.payload for report in db.scalars(told)]
            reported = stored(db, visit.session_id)
        return _Visited(
            view=view,
            receipt=receipt,
            problems=problems,
            drawn_s=visit.drawn_s,
            took_s=took_s,
            processor_s=processor_s,
            frames_ms=_page_ms(visit.headset.page),
            added_s={one["phase_id"]: one["added_s"] - one["compensated_s"] for one in payloads},
            reported=reported,
            derived=derived(visit.headset.tell("journey.rules"), protocol.tasks),
        )


def _processor_s() -> float:
    """Return the processor time so far of this process and all that it has started."""
    own = psutil.Process()
    times = [one.cpu_times() for one in (own, *own.children(recursive=True))]
    return sum(one.user + one.system for one in times)


def _receipt(operator: httpx2.Client, session_id: str, phases: int) -> Json:
    """Return the receipt, once the server has measured the latency of as many phases."""
    until_s = time.monotonic() + ANALYSED_WITHIN_S
    while True:
        receipt: Json = ok(operator.get(f"/api/sessions/{session_id}/receipt"))
        if len(receipt["achieved_latency"]) == phases or time.monotonic() > until_s:
            return receipt
        time.sleep(1.0)


def _record(done: _Visited) -> tuple[Figure, ...]:
    part = "session"
    streams = done.receipt["streams"]
    phases = [one for one in done.view["phases"] if one["kind"] in TIMED_KINDS]
    kept = sum(one["stored"] for one in streams)
    missing = sum(one["missing"] for one in streams)
    return (
        Figure(part, "timed phases done", len(phases), ""),
        Figure(part, "tasks completed", sum(one["completions"] for one in phases), ""),
        Figure(part, "frames and reports stored", kept, ""),
        Figure(part, "frames and reports missing", missing, "", "at most", 0),
        Figure(part, "contacts stored", len(done.reported.contacts), ""),
        Figure(
            part,
            "contacts and completions unlike those of the Python rules",
            _unlike(done.reported, done.derived),
            "",
            "at most",
            0,
        ),
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
        # Does not depend on other work: on an idle machine a visit is at least as fast as this,
        # even if no two of its processes ever ran at once.
        Figure(
            part,
            "drawn time by processor time of all processes",
            done.drawn_s / done.processor_s,
            "s/s",
            "at least",
            SPEED_LIMIT,
        ),
    )


def _unlike(one: Outcome, other: Outcome) -> int:
    pairs = ((one.contacts, other.contacts), (one.completions, other.completions))
    return sum(len(set(a) ^ set(b)) for a, b in pairs)


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
    """Compare what the server measured with what it ordered and what the headset said it adds.

    The receipt is read, not the session: the last phase is measured after the session has ended.
    """
    found: list[Figure] = []
    measured = {one["phase_id"]: one for one in done.receipt["achieved_latency"]}
    for one in done.view["phases"]:
        if one["kind"] != "task":
            continue
        name = f"{one['limb']}, {one['latency_ms']:g} ms ordered"
        expected_ms = one["latency_ms"] + 1000.0 * done.added_s[one["phase_id"]]
        latency = measured.get(one["phase_id"], NOT_YET)
        achieved_ms = latency["achieved_latency_ms"]
        if achieved_ms is None:
            why = f"{name}: not measured: {latency['reason']}"
            found.append(Figure("latency", why, 1, "", "at most", 0))
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
        full = room.draw_fading(EVERYTHING)
        without = room.draw_fading({**EVERYTHING, "panel": None})
        stopping = room.draw_fading({**EVERYTHING, "panel": "stopping"})
        beside = room.draw_fading(ACCOMPANIED)
        paused = room.draw_fading(PAUSED)
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
        Figure(part, "draw calls of an eye", without.calls, "", "at most", CALLS_LIMIT),
        Figure(part, "with a panel pointed at", full.calls, "", "at most", CALLS_LIMIT),
        Figure(
            part, "with a panel and a stop on its way", stopping.calls, "", "at most", CALLS_LIMIT
        ),
        Figure(
            part,
            "in the body, with all this and a companion",
            beside.calls,
            "",
            "at most",
            CALLS_LIMIT,
        ),
        Figure(part, "in the pause room", paused.calls, "", "at most", CALLS_LIMIT),
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


def _desktop(browser: Browser, server: LiveServer) -> tuple[Figure, ...]:
    """Go from the console's first page into a body on this screen, drawn as it is shown."""
    with browser.new_context(viewport={"width": 1280, "height": 800}) as context:
        # The console is behind the new tab then, where browsers draw nothing; headless ones do.
        context.add_init_script(PICTURE_HIDDEN)
        page = context.new_page()
        Experimenter(page, server.url).log_in()
        acted = act_on_this_screen(page)
    return (
        Figure("desktop", "clicks", acted.clicks, "", "at most", CLICKS_LIMIT),
        Figure("desktop", "seconds", acted.took_s, "s", "at most", DESKTOP_LIMIT_S),
    )


def _weight(browser: Browser, server: LiveServer, folder: Path) -> tuple[Figure, ...]:
    """Sum what the browser fetches for the page, compressed: opened, then paired and in VR.

    In VR the physics comes beside standby: the worker of the bodies, and MuJoCo for it.
    """
    part, peer, limit = "weight", "at most", WEIGHT_LIMIT_MB
    study = study_of(PHASE_S, f"{STUDY}-weight")
    fetched: set[str] = set()

    def note(answer: Response) -> None:
        if answer.ok and "/api/" not in answer.url:
            fetched.add(answer.url)

    with open_site(server) as site:
        ok(site.operator.post("/api/studies", json={"yaml": study}))
        with browser.new_context() as context:
            page = context.new_page()
            page.on("response", note)
            page.goto(f"{server.url}/vr", wait_until="networkidle")
            opened_mb = _gzipped_mb(site.operator, fetched)
        fetched.clear()
        with browser.new_context() as context:
            context.on("response", note)
            script = journey_script(folder)
            visit, _ = begun(
                site.operator, context, script, server.url, f"{STUDY}-weight", time_scale=TIME_SCALE
            )
            until_s = time.monotonic() + FETCHED_WITHIN_S
            while len(physics := _of_physics(fetched)) < 2:
                if time.monotonic() > until_s:
                    raise RuntimeError(f"beside standby the page fetched {physics} of the physics")
                visit.headset.page.wait_for_timeout(100)
            physics_mb = _gzipped_mb(site.operator, physics)
            in_vr_mb = _gzipped_mb(site.operator, fetched)
    return (
        Figure(part, "files of the opened page, gzip", opened_mb, "MB", peer, limit),
        Figure(part, "files in VR with the bodies' worker, gzip", in_vr_mb, "MB", peer, limit),
        Figure(part, "of them for the physics, beside standby", physics_mb, "MB"),
    )


def _gzipped_mb(client: httpx2.Client, urls: Iterable[str]) -> float:
    """Return what the files take compressed; browsers keep no body as large as MuJoCo's to ask."""
    sizes = (len(gzip.compress(client.get(url).content, 6)) for url in sorted(urls))
    return sum(sizes) / BYTES_PER_MB


def _of_physics(urls: Iterable[str]) -> list[str]:
    """Return the URLs of the bodies' worker and of MuJoCo."""
    return [
        url
        for url in urls
        if "/wasm/bodiesWorker-" in url or ("/mujoco-" in url and url.endswith(".wasm"))
    ]
