"""Tests of rehearsals by a blinded operator, from the command line with a running server."""

import json
import threading
import time
from collections.abc import Iterator

import pytest
from typer.testing import Result

from app.cli.errors import UNUSABLE
from app.cli.rehearsing import report_text, summary_text
from app.rehearsal.rehearse import RehearsalReport
from tests.cli.invoked import Invoked
from tests.faults.short_study import TASKS, add_short_study
from tests.support.server import ADMIN_PASSWORD, LiveServer

SPEED = 40
WITHIN_S = 120.0
PHASES = TASKS + 1


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide a server with the short study, blinded."""
    with LiveServer(tmp_path_factory.mktemp("blinded")) as running:
        key = add_short_study(running)
        with running.client() as admin:
            credentials = {"username": "admin", "password": ADMIN_PASSWORD}
            admin.post("/api/login", json=credentials).raise_for_status()
            yaml = admin.get(f"/api/studies/{key}").json()["yaml"]
            blinded = yaml.replace("operator: false", "operator: true")
            path = f"/api/studies/{key}/versions"
            admin.post(path, json={"yaml": blinded}).raise_for_status()
        yield running


def rehearse(server: LiveServer, *more: object) -> Result:
    """Run a rehearsal from the command line with an operator's token."""
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        link = client.post("/api/invitations", json={"role": "operator"}).json()["url"]
    with server.client() as client:
        name = f"operator-{time.monotonic_ns()}"
        wish = {"username": name, "password": "four words and a comma"}
        token = {"token": link.rpartition("/")[2]}
        client.post("/api/invitations/accept", json={**token, **wish}).raise_for_status()
        login = next(value for key, value in client.cookies.items() if "reembody" in key.lower())
    study = ("--study", "short-latency")
    how = ("--url", server.url, "--token", login, "--speed", SPEED)
    return Invoked("rehearse").run(*how, *study, *more)


def test_a_blinded_operator_rehearses_a_repeated_phase_and_a_withdrawal(server: LiveServer) -> None:
    """A blinded operator rehearses a repeated phase with a withdrawal, and a complete session.

    The first participant repeats a phase and withdraws in the next; the second completes. The
    reports hide every latency. At this speed half of a phase takes less than a busy machine needs
    to receive the operator's command: then the withdrawal comes right after it.
    """
    how = ("--participants", 2, "--redo", 1, "--withdraw-during", 2, "--json")
    result = rehearse(server, *how)
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["statuses"] == {"withdrawn": 1, "completed": 1}
    reports = [RehearsalReport(**one) for one in told["participants"]]
    first, second = reports
    assert (first.seed, second.seed) == (1, 2)
    *before, interrupted = [one["status"] for one in first.phases]
    assert before == ["voided", "done"]
    assert interrupted in ("voided", "done")
    assert [one["status"] for one in second.phases] == ["done"] * PHASES
    assert report_text(first).count("WITHDRAWN") == 1
    assert report_text(first).count("  voided") == [interrupted].count("voided")
    assert report_text(second).count(" hidden ") == TASKS
    assert "NOT COMPLETED" not in report_text(second)
    assert summary_text(reports, 2).startswith("2 of 2 participants: 1 withdrawn, 1 completed\n")
    said = result.stderr.splitlines()
    assert said[0].startswith("This takes about ")
    assert "for 2 participants" in said[0]
    assert "participant 2 of 2, seed 2" in said
    assert "  phase 1: is repeated from its beginning" in said


def test_an_aborted_rehearsal_exits_with_1(server: LiveServer) -> None:
    """A rehearsal that is aborted from a console reports that and exits with code 1."""
    aborting = threading.Thread(target=abort_what_runs, args=(server,))
    aborting.start()
    result = rehearse(server, "--json")
    aborting.join()
    assert result.exit_code == 1, result.output
    assert json.loads(result.stdout)["status"] == "aborted"
    assert "not a whole rehearsal" in result.stderr


def abort_what_runs(server: LiveServer) -> None:
    """Abort a session from a console as soon as one of the study is active."""
    give_up_s = time.monotonic() + WITHIN_S
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        while time.monotonic() < give_up_s:
            listed = client.get("/api/studies/short-latency/sessions").json()
            for one in listed:
                if one["status"] == "active":
                    view = client.get(f"/api/sessions/{one['id']}").json()
                    command = {
                        "command_id": f"abort-{view['version']}",
                        "expected_version": view["version"],
                        "type": "abort",
                        "reason": "this is a test",
                    }
                    path = f"/api/sessions/{one['id']}/commands"
                    if client.post(path, json=command).is_success:
                        return
            time.sleep(0.05)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--participants", 0), "--participants 0: 1 to 500 are valid"),
        (("--redo", 0), "--redo 0: phases count from 1"),
        (("--redo", 3, "--withdraw-during", 2), "--redo 3 is never reached"),
        (("--redo", 6), "--redo 6: a visit of short-latency has 5 phases"),
        (("--withdraw-during", 9), "so 1 to 5 are valid"),
        (("--speed", 0), "a speed of 0.0 is not possible"),
        (("--seed", -1), "a seed of -1 is not possible"),
        (("--study", "none"), "there is no study 'none'"),
    ],
)
def test_invalid_options_are_rejected_before_a_session_is_created(
    server: LiveServer, options: tuple[object, ...], words: str
) -> None:
    """Invalid options are rejected in one sentence before a session is created.

    This holds also for an operator who must not know the conditions.
    """
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        before = client.get("/api/studies/short-latency/sessions").json()
        result = rehearse(server, *options)
        assert result.exit_code == UNUSABLE, result.output
        assert words in result.stderr
        assert client.get("/api/studies/short-latency/sessions").json() == before


def test_the_help_says_how_long_a_rehearsal_takes() -> None:
    """The help says how long a rehearsal takes."""
    said = " ".join(Invoked("rehearse").run("--help").output.split())
    assert "divided by --speed: 9 minutes with the study that ships" in said
