"""Measure durable acknowledgements under load, compared with the bare disk."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import httpx2
import numpy as np
import psutil

from tests.benchmarks.report import Figure
from tests.rehearsal.performed import STUDY
from tests.support.server import ADMIN_PASSWORD, LiveServer

SESSIONS, DURATION_S, IDLE_S, FIRST_S = 8, 22.0, 5.0, 2.0
COMMIT_S = 0.05
# The bytes of 8 sessions in one commit interval: 2 streams, 90 Hz, 22 joints and a root.
BYTES_PER_COMMIT = int(SESSIONS * 2 * 90 * COMMIT_S * (8 + 1 + 4 * 91))


def figures(folder: Path) -> list[Figure]:
    """Measure latency and CPU with 8 headsets on SQLite (synchronous FULL), and the bare disk."""
    with LiveServer(folder) as server:
        tokens = [paired_headset(server) for _ in range(SESSIONS)]
        process = psutil.Process(server.pid)
        idle = _cpu_share(process, lambda: time.sleep(IDLE_S))
        told: list[tuple[float, float]] = []
        busy = _cpu_share(process, lambda: told.extend(stream(server, tokens)))
        memory_mib = process.memory_info().rss / 2**20
    bare_s = _bare_disk(folder / "bare")
    words = f"{SESSIONS} sessions x 22 joints x 90 Hz x 2 streams"
    steady = [latency_s for sent_s, latency_s in told if sent_s >= FIRST_S]
    first = [latency_s for sent_s, latency_s in told if sent_s < FIRST_S]
    ours, bare = (np.percentile(one, [50, 99, 100]) * 1000 for one in (steady, bare_s))
    peer = "the same bytes written and fsynced, waiting included"
    return [
        Figure("telemetry", f"durable ack p50, {words}", ours[0], "ms", peer, bare[0]),
        Figure("telemetry", "durable ack p99", ours[1], "ms", peer, bare[1]),
        Figure("telemetry", "durable ack max", ours[2], "ms", peer, bare[2]),
        Figure("telemetry", "the same in the first 2 s, max", 1000 * max(first), "ms"),
        Figure("telemetry", "messages acknowledged", len(told) / DURATION_S, "1/s"),
        Figure("telemetry", "server CPU under load", 100 * busy, "% of a core"),
        Figure("telemetry", "server CPU idle", 100 * idle, "% of a core"),
        Figure("telemetry", "server memory after", memory_mib, "MiB"),
    ]


def paired_headset(server: LiveServer) -> str:
    """Return the token of a headset paired with a new session that has not started."""
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        session = _post(client, f"/api/studies/{STUDY}/sessions", {"kind": "simulated"})
        shown = _post(client, f"/api/sessions/{session['id']}/pairings", {"device": "headset"})
        return str(_post(client, "/api/devices/pair", {"code": shown["code"]})["token"])


def _post(client: httpx2.Client, path: str, body: dict[str, str]) -> dict[str, str]:
    response = client.post(path, json=body)
    response.raise_for_status()
    answered: dict[str, str] = response.json()
    return answered


def stream(
    server: LiveServer, tokens: list[str], duration_s: float = DURATION_S
) -> list[tuple[float, float]]:
    """Run the headsets in their own process; return each message's send time and latency."""
    url = f"{server.url.replace('http', 'ws', 1)}/api/vr/stream"
    plan = json.dumps({"url": url, "tokens": tokens, "duration_s": duration_s})
    done = subprocess.run(
        [sys.executable, "-m", "tests.benchmarks.headsets"],
        cwd=Path(__file__).resolve().parents[2],
        input=plan,
        capture_output=True,
        text=True,
        check=False,
        timeout=300 + 2 * duration_s,
    )
    if done.returncode != 0:
        raise RuntimeError(f"the headsets failed:\n{done.stderr[-3000:]}")
    return [(sent_s, latency_s) for sent_s, latency_s in json.loads(done.stdout)]


def _cpu_share(process: psutil.Process, work: Callable[[], object]) -> float:
    """Return the CPU seconds of a process per second while `work()` runs."""
    before, began_s = process.cpu_times(), time.monotonic()
    work()
    after, passed_s = process.cpu_times(), time.monotonic() - began_s
    return (after.user + after.system - before.user - before.system) / passed_s


def _bare_disk(path: Path) -> list[float]:
    """Return the latencies of a bare writer that appends, syncs and acknowledges each interval.

    This is the lower limit. A message that arrives at a random moment waits for the end of its
    interval, then for the disk.
    """
    rng = np.random.default_rng(1)
    messages = SESSIONS * 2 * int(90 * COMMIT_S / 6 + 1)
    latencies_s: list[float] = []
    payload = rng.bytes(BYTES_PER_COMMIT)
    with path.open("ab", buffering=0) as file:
        next_s = time.monotonic()
        for _ in range(int(DURATION_S / 2 / COMMIT_S)):
            next_s += COMMIT_S
            time.sleep(max(0.0, next_s - time.monotonic()))
            began_s = time.monotonic()
            file.write(payload)
            os.fsync(file.fileno())
            took_s = time.monotonic() - began_s
            latencies_s += (rng.uniform(0.0, COMMIT_S, messages) + took_s).tolist()
    return latencies_s
