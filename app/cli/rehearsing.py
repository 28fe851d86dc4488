"""Run a rehearsal from the command line, with a temporary server if no URL is given."""

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
from collections import Counter
from collections.abc import Callable, Coroutine, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from httpx2 import Client, HTTPError

from app.protocol import BOX_KINDS, COUNTED_KINDS, STEP_KINDS, UNCOUNTED_KINDS
from app.rehearsal.headset import WITHDRAWN
from app.rehearsal.rehearse import (
    RehearsalPlan,
    RehearsalReport,
    Visit,
    rehearse,
    store_template,
    visit_of,
)
from app.simulated_people.body import make_person

T = TypeVar("T")
START_TIMEOUT_S = 60.0
PHYSICS_AT_MOST = 6.0
"""Seconds of study time per second at which two cores simulate a physics avatar and run the server:
the study that ships took 102 s at --speed 20, on a machine that was also doing other work."""
MOST_PARTICIPANTS = 500
_AS_ASKED = 0.9
"""Share of the speed asked for from which it counts as reached."""
BESIDES_S, BESIDES_STUDY_S = 3.0, 25.0
"""The time of a participant outside the phases: of forms and requests in real time, and of the
headset between phases in study time."""


def run_rehearsal(
    plan: RehearsalPlan,
    show: Callable[[str], None],
    *,
    participants: int,
    data: Path | None,
    as_json: bool,
) -> bool:
    """Rehearse one participant after the other; return whether every session ended as planned.

    `plan` is the first participant's; if its `url` is empty, a server is started for it, with its
    data in `data`. The following participants have the following seeds and are not interrupted.
    `show` gets each report as text when it is ready, or all as JSON at the end. Raises ValueError
    or RuntimeError.
    """
    _check(plan, participants)
    # Reject an unusable capture before a server is started.
    make_person(np.random.default_rng(plan.seed), plan.capture)
    reports: list[RehearsalReport] = []
    with _server_for(plan, data) as reachable:
        if not plan.url:
            _run(store_template(reachable))
        _say(_expected(_run(visit_of(reachable)), plan.speed, participants))
        plans = _plans(reachable, participants)
        try:
            for number, one in enumerate(plans, start=1):
                if participants > 1:
                    _say(f"participant {number} of {participants}, seed {one.seed}")
                report = _run(rehearse(one, lambda words: _say(f"  {words}")))
                reports.append(report)
                if not as_json:
                    show(report_text(report))
        finally:
            if reports and (as_json or participants > 1):
                show((_as_json if as_json else summary_text)(reports, participants))
    return all(report.status == one.ends_as for report, one in zip(reports, plans, strict=True))


def _check(plan: RehearsalPlan, participants: int) -> None:
    if plan.url and plan.token is None:
        raise ValueError("--url needs --token; make one with: ./run token")
    if not 0 < plan.speed <= 100:
        raise ValueError(f"a speed of {plan.speed} is not possible; give above 0 and at most 100")
    if plan.seed < 0:
        raise ValueError(f"a seed of {plan.seed} is not possible; give 0 or a greater number")
    if not 1 <= participants <= MOST_PARTICIPANTS:
        raise ValueError(
            f"--participants {participants}: 1 to {MOST_PARTICIPANTS} are valid; they take part one"
            " after the other"
        )
    for option, phase in (("--redo", plan.redo), ("--withdraw-during", plan.withdraw_during)):
        if phase is not None and phase < 1:
            raise ValueError(f"{option} {phase}: phases count from 1, in the order of the visit")
    if plan.redo and plan.withdraw_during and plan.redo > plan.withdraw_during:
        raise ValueError(
            f"--redo {plan.redo} is never reached: the participant withdraws during phase"
            f" {plan.withdraw_during}. Repeat that phase or an earlier one"
        )


def _plans(first: RehearsalPlan, participants: int) -> list[RehearsalPlan]:
    after = replace(first, redo=None, withdraw_during=None)
    return [first, *(replace(after, seed=first.seed + at) for at in range(1, participants))]


def _run(work: Coroutine[Any, Any, T]) -> T:
    try:
        return asyncio.run(work)
    except* (ValueError, RuntimeError) as group:
        raise RuntimeError(str(_first(group))) from group


def _first(error: BaseException) -> BaseException:
    while isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    return error


def _say(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


def _expected(visit: Visit, speed: float, participants: int) -> str:
    """Describe how long the rehearsal will take."""
    reached = min(speed, PHYSICS_AT_MOST) if visit.physics else speed
    each_s = (visit.planned_s + BESIDES_STUDY_S) / reached + BESIDES_S
    who = "" if participants == 1 else f" for {participants} participants"
    limited = (
        ""
        if reached == speed
        else f"; two cores simulate a physics avatar at no more than {reached:g}x"
    )
    return (
        f"This takes about {_length(participants * each_s)}{who}: {visit.phases} phases, together"
        f" {_length(visit.planned_s)}, at {reached:g}x{limited}"
    )


def _length(time_s: float) -> str:
    if time_s < 100.0:
        return f"{time_s:.0f} s"
    minutes = round(time_s / 60.0)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60} min"


@contextmanager
def _server_for(plan: RehearsalPlan, data: Path | None) -> Iterator[RehearsalPlan]:
    """Yield the plan with a running server: the one it names, or a temporary one."""
    if plan.url:
        yield plan
        return
    with _own_server(data) as (url, password):
        yield replace(plan, url=url, password=password)


@contextmanager
def _own_server(data: Path | None) -> Iterator[tuple[str, str]]:
    """Run a server on a scratch folder (or `data`); yield its address and the admin's password."""
    with tempfile.TemporaryDirectory(prefix="reembody-") as scratch:
        port, password = _free_port(), secrets.token_urlsafe(12)
        inherited = {k: v for k, v in os.environ.items() if k.upper() != "REEMBODY_DATABASE_URL"}
        environment = {
            **inherited,
            "REEMBODY_DATA_DIR": str(data or scratch),
            "REEMBODY_ADMIN_PASSWORD": password,
            # Whatever addresses the installation serves, this server is only for the rehearsal.
            "REEMBODY_LAN": "false",
            "REEMBODY_HOST": "127.0.0.1",
        }
        with subprocess.Popen(  # noqa: S603 - our own command
            [sys.executable, "-m", "app.cli", "serve", "--port", str(port), "--until-input-ends"],
            env=environment,
            # This process has the pipe's other end, so the server ends with it, even if it is
            # killed.
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


def report_text(report: RehearsalReport) -> str:
    """Describe one participant's session, with a line for each task phase."""
    phases = [phase for phase in report.phases if phase["kind"] in COUNTED_KINDS]
    voided = sum(phase["status"] == "voided" for phase in phases)
    kinds = Counter(phase["kind"] for phase in report.phases)
    lines = [
        f"SIMULATED session {report.session_id}: {report.duration_s:.1f} s at {_speed(report)}",
        *_ended(report),
        f"avatar {report.avatar} {(report.avatar_configuration_hash or '')[:12]}".rstrip(),
        f"frames sent {report.frames_sent}, stored {report.frames_stored}",
        f"{len(phases) - voided} task phases, {report.questionnaires} questionnaires",
        *([f"{voided} voided, which no analysis uses"] if voided else []),
        *(
            f"{kinds[kind]} {STEP_KINDS[kind].name.en.lower()} phases, which no analysis uses"
            for kind in UNCOUNTED_KINDS
            if kind in BOX_KINDS and kinds[kind]
        ),
        f"{report.completions} completions, {report.contacts} contacts",
        f"{report.side_contacts} contacts with the sides of boxes",
    ]
    lines += [
        f"  {phase['limb'] or '-':4}  {_latency(phase['latency_ms'])}  {phase['active_s']:6.2f} s  "
        f"{phase['completions']:2d} completions  {phase['side_contacts']:3d} side contacts"
        + ("" if phase["body"] is None else f"  body {phase['body']}")
        + ("  voided" if phase["status"] == "voided" else "")
        for phase in phases
    ]
    lines += [f"  {_crossing(one)}" for one in report.crossings]
    return "\n".join(lines)


def _crossing(one: dict[str, Any]) -> str:
    """Return a line for one crossing of the study's road."""
    if one["steps_on_s"] is None:
        return f"phase {one['phase_id']}: not on the carriageway, waited {one['waited_s']:.1f} s"
    gap, closest = one["gap_accepted_s"], one["closest_m"]
    return (
        f"phase {one['phase_id']}, crossing {one['number']}: on at {one['steps_on_s']:.1f} s,"
        f" waited {one['waited_s']:.1f} s,"
        f" gap {'none coming' if gap is None else f'{gap:.1f} s'},"
        f" {len(one['gaps_refused_s'])} refused,"
        f" closest {'-' if closest is None else f'{closest:.1f} m'}"
        + ("" if one["is_across"] else ", not across")
        + ("" if one["collision_car"] is None else ", COLLISION")
    )


def _speed(report: RehearsalReport) -> str:
    """Return the speed that was reached, and the one asked for if that was clearly higher."""
    if report.speed_reached >= _AS_ASKED * report.speed:
        return f"{report.speed:g}x"
    return f"{report.speed_reached:.1f}x ({report.speed:g}x was asked for; this machine is slower)"


def _ended(report: RehearsalReport) -> list[str]:
    if report.status == WITHDRAWN:
        return ["WITHDRAWN: the participant withdrew"]
    return [] if report.status == "completed" else [f"NOT COMPLETED: it was {report.status}"]


def summary_text(reports: Sequence[RehearsalReport], participants: int) -> str:
    """Summarise all participants on two lines."""
    statuses = Counter(report.status for report in reports)
    ended = ", ".join(f"{count} {status}" for status, count in statuses.items())
    missing = participants - len(reports)
    absent = f"; {missing} did not take part" if missing else ""
    together = (
        f"{sum(report.completions for report in reports)} completions,"
        f" {sum(report.contacts for report in reports)} contacts,"
        f" {sum(report.questionnaires for report in reports)} questionnaires"
        f" in {_length(sum(report.duration_s for report in reports))}"
    )
    return f"{len(reports)} of {participants} participants: {ended}{absent}\n{together}"


def _as_json(reports: Sequence[RehearsalReport], participants: int) -> str:
    """Return a single report as an object, or several in a list with the number of each status."""
    if participants == 1:
        return json.dumps(asdict(reports[0]), indent=2)
    statuses = dict(Counter(report.status for report in reports))
    result = {
        "wanted": participants,
        "statuses": statuses,
        "participants": list(map(asdict, reports)),
    }
    return json.dumps(result, indent=2)


def _latency(latency_ms: float | None) -> str:
    """Format a latency in a fixed width; None means hidden from a blinded operator."""
    return f"{'hidden':>8}" if latency_ms is None else f"{latency_ms:5.0f} ms"
