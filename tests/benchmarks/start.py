"""Measure a start of the server in a checkout that is set up: its imports, and `./run` to a page.

Processor time (user and system) depends least on other work of the machine, so the limits are of
processor time; the seconds on the clock are reported beside it. Every figure is a median.

- import: what `reembody serve` loads before it listens, in a fresh interpreter. The peer is the
  import of the libraries alone; uncompiled means that nothing of Python was compiled before.
- warm: `./run` with existing data until `GET /` answers, with the check of what is set up.
"""

import os
import signal
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import httpx2
import psutil

from tests.benchmarks.report import Figure, Report
from tests.support.server import free_port

PARTS = ("import", "warm")
RUNS = 5
REPOSITORY = Path(__file__).resolve().parents[2]
PYTHON = REPOSITORY / ".venv" / "bin" / "python"
LOOK_EVERY_S = 0.01
ANSWERS_WITHIN_S = 120.0
IMPORT_LIMIT_S, PAGE_LIMIT_S = 1.5, 2.0
SERVER = """
from app.cli.serve.command import loading_modules
with loading_modules():
    import app.cli.serve.run, uvicorn.protocols.http.httptools_impl
"""
LIBRARIES = "import alembic.command, fastapi, numpy, pydantic_settings, sqlalchemy.orm, uvicorn"


def measure(parts: frozenset[str], runs: int = RUNS) -> Report:
    """Measure the parts, `runs` times each; everything runs once before it counts."""
    report = Report("start")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        if "import" in parts:
            report.add(*_imports(runs))
        if "warm" in parts:
            report.add(*_warm(runs, Path(scratch)))
    return report


def _imports(runs: int) -> Iterator[Figure]:
    libraries_s = _median(runs, lambda: _import(LIBRARIES))
    server_s = _median(runs, lambda: _import(SERVER))
    part, unit = "import", "s of processor"
    yield Figure(part, "server", server_s, unit, "limit", IMPORT_LIMIT_S)
    yield Figure(part, "server beside its libraries", server_s, unit, "libraries", libraries_s)
    uncompiled_s = _median(runs, lambda: _import(SERVER, compiled=False))
    yield Figure(part, "server, uncompiled", uncompiled_s, unit)


def _import(what: str, *, compiled: bool = True) -> float:
    """Return the processor seconds of a fresh interpreter that imports something."""
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as empty:
        more = {} if compiled else {"PYTHONPYCACHEPREFIX": empty, "PYTHONDONTWRITEBYTECODE": "1"}
        before_s = _children_s()
        subprocess.run([PYTHON, "-c", what], cwd=REPOSITORY, env=_environment(more), check=True)
        return _children_s() - before_s


def _warm(runs: int, scratch: Path) -> Iterator[Figure]:
    seen = [_to_first_page(scratch) for _ in range(runs + 1)][1:]
    clock_s, processor_s = (statistics.median(column) for column in zip(*seen, strict=True))
    part = "./run to first page"
    yield Figure("warm", part, processor_s, "s of processor", "limit", PAGE_LIMIT_S)
    yield Figure("warm", f"{part}, on the clock", clock_s, "s", "limit", PAGE_LIMIT_S)
    check: list[str | Path] = [PYTHON, "-S", "-B", REPOSITORY / "set_up.py", "run", "--check"]
    check_s = _median(runs, lambda: _spent_s(check))
    yield Figure("warm", "of it the check of the set-up", check_s, "s of processor")


def _to_first_page(data: Path) -> tuple[float, float]:
    """Return the seconds until `./run` serves its first page, on the clock and of processor."""
    port = free_port()
    began_s = time.monotonic()
    process = subprocess.Popen(
        ["./run", "serve", "--port", str(port)],
        cwd=REPOSITORY,
        env=_environment({"REEMBODY_DATA_DIR": str(data)}),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )
    try:
        _wait_for_page(port, process, began_s + ANSWERS_WITHIN_S)
        took_s = time.monotonic() - began_s
        # The script has replaced itself by the server; the check that it made counts as its child.
        used = psutil.Process(process.pid).cpu_times()
        return took_s, used.user + used.system + used.children_user + used.children_system
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(timeout=30)


def _wait_for_page(port: int, process: "subprocess.Popen[bytes]", until_s: float) -> None:
    with httpx2.Client(base_url=f"http://127.0.0.1:{port}", timeout=5.0) as client:
        while time.monotonic() < until_s:
            if process.poll() is not None:
                raise RuntimeError(f"./run ended with {process.returncode}; see the lines above")
            try:
                client.get("/").raise_for_status()
            except httpx2.TransportError:
                time.sleep(LOOK_EVERY_S)
            else:
                return
    raise RuntimeError(f"no page within {ANSWERS_WITHIN_S:g} s")


def _median(runs: int, once: Callable[[], float]) -> float:
    return statistics.median([once() for _ in range(runs + 1)][1:])


def _spent_s(command: list[str | Path]) -> float:
    before_s = _children_s()
    subprocess.run(command, check=True)
    return _children_s() - before_s


def _children_s() -> float:
    """Return the processor seconds of all child processes that have ended."""
    spent = os.times()
    return spent.children_user + spent.children_system


def _environment(more: Mapping[str, str]) -> dict[str, str]:
    left_out = ("VIRTUAL_ENV", "PYTHONPATH", "REEMBODY_DATABASE_URL", "PYTHONDONTWRITEBYTECODE")
    kept = {name: value for name, value in os.environ.items() if name not in left_out}
    return {**kept, "PYTHONPATH": str(REPOSITORY), **more}
