"""Measure the time from a fresh copy of the repository to the first page, and a second start."""

import os
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import httpx2

from tests.benchmarks.report import Figure
from tests.support.server import free_port

REPOSITORY = Path(__file__).resolve().parents[2]
ANSWERS_WITHIN_S = 900.0
LEFT_OUT = ("VIRTUAL_ENV", "PYTHONPATH", "REEMBODY_DATA_DIR", "REEMBODY_DATABASE_URL")


@dataclass(frozen=True)
class Start:
    """Seconds from the call to the response, and the bytes of the first page."""

    duration_s: float
    page_bytes: int


def figures(folder: Path) -> list[Figure]:
    """Measure a cold `./run` in a fresh copy with empty caches, then a warm one."""
    copy = folder / "reembody"
    copy_repository(copy)
    caches = folder / "caches"
    cold, warm = start_once(copy, caches), start_once(copy, caches)
    return [
        Figure("start", "cold ./run to first page", cold.duration_s, "s"),
        Figure("start", "warm ./run to first page", warm.duration_s, "s"),
        Figure("start", "first page", cold.page_bytes / 1024, "KiB"),
    ]


def copy_repository(to: Path) -> None:
    """Copy the working tree as git tracks it, without anything that was built or installed."""
    to.mkdir(parents=True)
    names = subprocess.run(
        ["git", "ls-files", "-z", "--cached"], cwd=REPOSITORY, capture_output=True, check=True
    ).stdout.split(b"\0")
    for name in filter(None, names):
        source = REPOSITORY / os.fsdecode(name)
        if source.is_file():
            target = to / os.fsdecode(name)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)


def start_once(repository: Path, caches: Path) -> Start:
    """Call ./run, wait for its first page, and stop it."""
    port = free_port()
    process = subprocess.Popen(
        ["./run", "serve", "--port", str(port)],
        cwd=repository,
        env=environment_with(caches),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        start_new_session=True,
    )
    began_s = time.monotonic()
    try:
        page = _first_page(port, process)
        return Start(time.monotonic() - began_s, len(page))
    finally:
        os.killpg(process.pid, signal.SIGTERM)
        process.wait(timeout=30)


def environment_with(caches: Path) -> dict[str, str]:
    """Return this machine's environment variables (including registries) with empty caches."""
    kept = {name: value for name, value in os.environ.items() if name not in LEFT_OUT}
    return {
        **kept,
        "UV_CACHE_DIR": str(caches / "uv"),
        "PIP_CACHE_DIR": str(caches / "pip"),
        "npm_config_cache": str(caches / "npm"),
        "XDG_CACHE_HOME": str(caches / "other"),
    }


def _first_page(port: int, process: "subprocess.Popen[bytes]") -> bytes:
    give_up_s = time.monotonic() + ANSWERS_WITHIN_S
    with httpx2.Client(base_url=f"http://127.0.0.1:{port}", timeout=5.0) as client:
        while time.monotonic() < give_up_s:
            if process.poll() is not None:
                raise RuntimeError(f"./run ended with {process.returncode}; see the lines above")
            try:
                response = client.get("/", follow_redirects=True)
                if response.is_success:
                    return response.content
            except httpx2.TransportError:
                pass
            time.sleep(0.05)
    raise RuntimeError(f"no page within {ANSWERS_WITHIN_S:g} s")
