"""Measure the time from an empty folder to the first page for `./run` and for oTree by pip.

The runs alternate. Each begins with the tracked files (ours) or an empty folder (oTree's), with
empty caches and an empty home, and ends when the first page has arrived with every script and style
sheet that it names. Both download from the indexes configured for pip, uv and npm, so the network
counts for both.

- reembody: `./run --port N`, including its whole set-up; it also downloads uv, if this machine has
  none.

- otree: a new environment, `pip install`, one app with one page, `otree devserver`.
"""

import os
import re
import resource
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urljoin

import httpx2

from tests.benchmarks.peers.otree import VERSION, write_project
from tests.benchmarks.report import Figure, Report
from tests.benchmarks.starting import ANSWERS_WITHIN_S, copy_repository, environment_with
from tests.support.server import free_port

PARTS = ("reembody", "otree")
RUNS = 5
LIMIT_S = 22.0
ASSET = re.compile(r"""<(?:script[^>]*\ssrc|link[^>]*\shref)="([^"]+\.(?:js|css)[^"]*)\"""")
OTREE = """\
set -e
"$1" -m venv venv
PATH=$PWD/venv/bin:$PATH
python -m pip install --quiet "otree==$2"
cd project
exec otree devserver "$3"
"""


@dataclass(frozen=True)
class Run:
    """The seconds until the first page, and the processor seconds until all processes had ended."""

    duration_s: float
    processor_s: float


def measure(parts: frozenset[str], runs: int = RUNS) -> Report:
    """Measure both systems alternately, `runs` times each."""
    report = Report("from_nothing")
    begin: dict[str, Callable[[Path], Run]] = {"reembody": our_run, "otree": otree_run}
    seen: dict[str, list[Run]] = {part: [] for part in PARTS if part in parts}
    for number in range(1, runs + 1):
        for part, done in seen.items():
            with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
                done.append(begin[part](Path(scratch)))
            report.add(Figure(part, f"run {number}, to first page", done[-1].duration_s, "s"))
    report.add(*figures(seen))
    return report


def figures(seen: Mapping[str, list[Run]]) -> list[Figure]:
    """Return our figures with oTree's from the same runs, and with the limit."""
    made = []
    for name, value_of in (
        ("to first page, median", lambda run: run.duration_s),
        ("processor time, median", lambda run: run.processor_s),
    ):
        medians = {part: statistics.median(map(value_of, runs)) for part, runs in seen.items()}
        if "otree" in medians:
            made.append(Figure("otree", name, medians["otree"], "s"))
        if "reembody" in medians:
            peer = f"oTree {VERSION}" if "otree" in medians else ""
            made.append(
                Figure("reembody", name, medians["reembody"], "s", peer, medians.get("otree"))
            )
    if "reembody" in seen:
        longest_s = max(run.duration_s for run in seen["reembody"])
        made.append(
            Figure("reembody", "to first page, longest", longest_s, "s", "at most", LIMIT_S)
        )
    return made


def our_run(scratch: Path) -> Run:
    """Measure `./run` in a copy of the tracked files."""
    copy, port = scratch / "reembody", free_port()
    copy_repository(copy)
    return timed(["./run", "--port", str(port)], copy, port, scratch)


def otree_run(scratch: Path) -> Run:
    """Measure the commands that oTree's own documentation gives."""
    port = free_port()
    write_project(scratch / "project", ["I felt as if the body was mine."], rounds=1)
    python = getattr(sys, "_base_executable", sys.executable)
    return timed(["sh", "-c", OTREE, "sh", python, VERSION, str(port)], scratch, port, scratch)


def timed(command: list[str], folder: Path, port: int, scratch: Path) -> Run:
    """Return the time from the call to the first page; then end everything that was started.

    Raises:
        RuntimeError: the program ended before its first page, or showed none.
    """
    caches = scratch / "caches"
    home = scratch / "home"
    home.mkdir()
    before_s = processor_s()
    began_s = time.monotonic()
    with (scratch / "log").open("w+") as log:
        process = subprocess.Popen(
            command,
            cwd=folder,
            env={**environment_with(caches), "HOME": str(home)},
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            wait_for_page(port, process)
            duration_s = time.monotonic() - began_s
        except RuntimeError as error:
            raise RuntimeError(f"{error}:\n{(scratch / 'log').read_text()[-3000:]}") from error
        finally:
            end(process)
    return Run(duration_s, processor_s() - before_s)


def wait_for_page(port: int, process: "subprocess.Popen[bytes]") -> None:
    """Wait until `/` and the files it names have arrived; raise RuntimeError if they do not."""
    give_up_s = time.monotonic() + ANSWERS_WITHIN_S
    with httpx2.Client(base_url=f"http://127.0.0.1:{port}", timeout=5.0) as client:
        while time.monotonic() < give_up_s:
            if process.poll() is not None:
                raise RuntimeError(f"ended with {process.returncode} before its first page")
            try:
                page = client.get("/", follow_redirects=True)
                if page.is_success:
                    for name in ASSET.findall(page.text):
                        client.get(urljoin(str(page.url), name)).raise_for_status()
                    return
            except httpx2.TransportError:
                pass
            time.sleep(0.05)
    raise RuntimeError(f"no page within {ANSWERS_WITHIN_S:g} s")


def end(process: "subprocess.Popen[bytes]") -> None:
    """Terminate the process and its group; kill them if they do not end."""
    for request in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(process.pid, request)
            process.wait(timeout=30)
        except (ProcessLookupError, subprocess.TimeoutExpired):
            continue


def processor_s() -> float:
    """Return the processor time of all collected child processes and their descendants."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
