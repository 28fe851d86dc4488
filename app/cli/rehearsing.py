"""The rehearsal from the command line, with a server of its own where none is given."""

import asyncio
import json
import os
import secrets
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

import numpy as np
from httpx2 import Client, HTTPError

from app.rehearsal.body import make_person
from app.rehearsal.rehearse import RehearsalPlan, RehearsalReport, rehearse

START_TIMEOUT_S = 60.0
COMPLETED = "completed"


def run_rehearsal(
    *,
    url: str | None,
    token: str | None,
    capture: Path | None,
    speed: float,
    seed: int,
    study: str,
    data: Path | None,
    physics: bool,
    as_json: bool,
) -> tuple[str, bool]:
    """Rehearse; the report as text or JSON, and whether the session was completed.

    Raises ValueError or RuntimeError.
    """
    if url is not None and token is None:
        raise ValueError("--url needs --token; make one with: ./run token")
    if not 0 < speed <= 100:
        raise ValueError(f"a speed of {speed} is not possible; give above 0 and at most 100")
    # A capture that nobody can move by is refused before a server is started.
    make_person(np.random.default_rng(seed), capture)
    plan = RehearsalPlan(
        url=url or "",
        study=study,
        speed=speed,
        seed=seed,
        capture=capture,
        token=token,
        physics=physics,
    )
    if url is not None:
        report = _run(plan)
    else:
        with _own_server(data) as (own_url, password):
            report = _run(RehearsalPlan(**{**asdict(plan), "url": own_url, "password": password}))
    text = json.dumps(asdict(report), indent=2) if as_json else _text(report)
    return text, report.status == COMPLETED


def _run(plan: RehearsalPlan) -> RehearsalReport:
    def say(words: str) -> None:
        print(f"  {words}", file=sys.stderr, flush=True)

    try:
        return asyncio.run(rehearse(plan, say))
    except* (ValueError, RuntimeError) as group:
        raise RuntimeError(str(_first(group))) from group


def _first(error: BaseException) -> BaseException:
    while isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    return error


@contextmanager
def _own_server(data: Path | None) -> Iterator[tuple[str, str]]:
    """A server on a scratch folder (or `data`): its address and the admin's password."""
    with tempfile.TemporaryDirectory(prefix="reembody-") as scratch:
        port, password = _free_port(), secrets.token_urlsafe(12)
        inherited = {k: v for k, v in os.environ.items() if k.upper() != "REEMBODY_DATABASE_URL"}
        environment = {
            **inherited,
            "REEMBODY_DATA_DIR": str(data or scratch),
            "REEMBODY_ADMIN_PASSWORD": password,
            # Whatever the installation opens, this one is for the rehearsal alone.
            "REEMBODY_LAN": "false",
            "REEMBODY_HOST": "127.0.0.1",
        }
        with subprocess.Popen(  # noqa: S603 - our own command
            [sys.executable, "-m", "app.cli", "serve", "--port", str(port), "--until-input-ends"],
            env=environment,
            # This process holds the other end, so the server ends with it, also if it is killed.
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
        ) as process:
            try:
                url = f"http://127.0.0.1:{port}"
                _wait_for(url, process)
                yield url, password
            finally:
                process.send_signal(signal.SIGTERM)
                process.wait(timeout=20)


def _wait_for(url: str, process: "subprocess.Popen[bytes]") -> None:
    give_up_s = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < give_up_s:
        if process.poll() is not None:
            raise RuntimeError("the rehearsal's server did not start; see the lines above")
        try:
            with Client(base_url=url, timeout=2.0) as client:
                if client.get("/api/health").is_success:
                    return
        except HTTPError:
            time.sleep(0.1)
    raise RuntimeError(f"the rehearsal's server did not answer within {START_TIMEOUT_S:.0f} s")


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def _text(report: RehearsalReport) -> str:
    phases = [phase for phase in report.phases if phase["kind"] == "task"]
    practised = sum(phase["kind"] == "practice" for phase in report.phases)
    lines = [
        f"SIMULATED session {report.session_id}: {report.duration_s:.1f} s at {report.speed:g}x",
        *([] if report.status == COMPLETED else [f"NOT COMPLETED: it was {report.status}"]),
        f"avatar {report.avatar} {(report.avatar_configuration_hash or '')[:12]}".rstrip(),
        f"frames sent {report.frames_sent}, stored {report.frames_stored}",
        f"{len(phases)} task phases, {report.questionnaires} questionnaires",
        *([f"{practised} practice phases, which no analysis uses"] if practised else []),
        f"{report.completions} completions, {report.contacts} contacts",
        f"{report.side_contacts} contacts with the sides of boxes",
    ]
    lines += [
        f"  {phase['limb']:4}  {_latency(phase['latency_ms'])}  {phase['active_s']:6.2f} s  "
        f"{phase['completions']:2d} completions  {phase['side_contacts']:3d} side contacts"
        for phase in phases
    ]
    return "\n".join(lines)


def _latency(latency_ms: float | None) -> str:
    """As wide as a number with its unit; a blinded operator is not told which it was."""
    return f"{'hidden':>8}" if latency_ms is None else f"{latency_ms:5.0f} ms"
