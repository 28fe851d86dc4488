"""A blinded operator rehearses a study, from the command line against a server that runs."""

import json
import threading
import time
from collections.abc import Iterator

import pytest
from typer.testing import Result

from tests.cli.invoked import Invoked
from tests.faults.short_study import add_short_study
from tests.support.server import ADMIN_PASSWORD, LiveServer

SPEED = 40
WITHIN_S = 120.0


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """A server with the short study, blinded."""
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
    """As an operator does, whose login is the token of the command."""
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


def test_a_blinded_operator_gets_the_report_without_latencies(server: LiveServer) -> None:
    """The whole session runs, and its report says that the latencies are hidden."""
    result = rehearse(server)
    assert result.exit_code == 0, result.output
    assert result.stdout.count(" hidden ") == 4
    assert "NOT COMPLETED" not in result.stdout


def test_a_rehearsal_that_was_aborted_elsewhere_does_not_end_well(server: LiveServer) -> None:
    """Its report says so, and so does the exit code."""
    aborting = threading.Thread(target=abort_what_runs, args=(server,))
    aborting.start()
    result = rehearse(server, "--json")
    aborting.join()
    assert result.exit_code == 1, result.output
    assert json.loads(result.stdout)["status"] == "aborted"
    assert "not a whole rehearsal" in result.stderr


def abort_what_runs(server: LiveServer) -> None:
    """From a console, as soon as a session of the study is under way."""
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
