"""Tests of opening, refusing and closing the headset's socket."""

import json
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from tests.features.lab import Json
from tests.features.record.headset.site import HELLO, Site


def closing(socket: Any) -> tuple[Json, int]:
    """Return the last message before the server closes the socket, and the close code."""
    last: Json = {}
    try:
        while True:
            last = json.loads(socket.recv(timeout=10.0))
    except ConnectionClosed as closed:
        return last, closed.rcvd.code if closed.rcvd else 1006


def running(site: Site) -> tuple[str, str]:
    """Return a session whose free movement can be started, and its headset's token."""
    session_id = site.join()
    site.skip_to(session_id, "free_roam")
    return session_id, site.token(session_id)


@pytest.mark.one_engine
@pytest.mark.parametrize("token", [None, "", "wrong", "x" * 500])
def test_a_wrong_token_is_refused_with_the_reason(site: Site, token: str | None) -> None:
    """A headset with a wrong token gets an error with the reason and close code 4401."""
    with site.socket(token) as socket:
        last, code = closing(socket)
    assert (last["type"], last["code"], code) == ("error", "not_signed_in", 4401)
    assert "new code" in last["remedy"]


@pytest.mark.one_engine
def test_an_operators_token_does_not_open_the_headsets_socket(site: Site) -> None:
    """An operator's login token does not open the headset's socket."""
    with site.socket(site.operator.cookies["reembody_login"]) as socket:
        assert closing(socket)[1] == 4401


@pytest.mark.one_engine
@pytest.mark.parametrize(
    "first",
    [
        b"RMB1 binary",
        "not json",
        "",
        "{}",
        '{"type": "hello"}',
        '{"type": "hello", "protocol": 2, "client": "old"}',
        '{"type": "probe", "client_sent_s": 1.0}',
        "[" * 10_000,
    ],
)
def test_a_first_message_other_than_hello_is_refused(site: Site, first: str | bytes) -> None:
    """A socket whose first message is not a valid hello is closed with 4400 and an error."""
    with site.socket(site.token(site.join())) as socket:
        socket.send(first)
        last, code = closing(socket)
    assert (last["type"], last["code"], code) == ("error", "invalid_input", 4400)
    assert "Traceback" not in site.server.log


@pytest.mark.one_engine
def test_a_second_hello_closes_the_socket(site: Site) -> None:
    """A second hello on the same socket closes it."""
    with site.headset(site.token(site.join())) as headset:
        headset.say(HELLO)
        assert headset.hear("error")["message"] == "hello came twice"


@pytest.mark.one_engine
def test_another_sites_page_cannot_open_the_socket(site: Site) -> None:
    """A socket from a page with another origin is refused."""
    token = site.token(site.join())
    with (
        pytest.raises(InvalidStatus) as refused,
        site.socket(token, origin="https://elsewhere.example"),
    ):
        pass
    assert refused.value.response.status_code == 403


@pytest.mark.one_engine
def test_an_oversized_message_closes_the_socket(site: Site) -> None:
    """A message of more than 256 KiB closes the socket with 1009."""
    with site.headset(site.token(site.join())) as headset:
        headset.say(b"\0" * (257 * 1024))
        assert closing(headset.socket)[1] == 1009


@pytest.mark.one_engine
def test_the_welcome_has_the_tasks_and_no_condition(site: Site) -> None:
    """The welcome has tasks, texts and state, but no condition and no order."""
    with site.headset(site.token(site.join(language="de"))) as headset:
        welcome = headset.welcome
    assert welcome["language"] == "de"
    assert set(welcome["tasks"]) == {"hand", "foot"}
    assert welcome["state"]["status"] == "planned"
    assert "latency_350" not in json.dumps(welcome)


def test_the_headset_receives_every_change_of_state(site: Site) -> None:
    """The headset receives the new state after the operator's commands and its own reports."""
    session_id, token = running(site)
    with site.headset(token) as headset:
        site.command(session_id, "begin_phase")
        state = headset.hear("state", lambda state: state["phase"] is not None)
        assert state["phase"]["status"] == "preparing"
        headset.report(
            kind="phase", phase_id=state["phase"]["phase_id"], what="started", t_s=1, active_s=0
        )
        headset.hear("state", lambda state: state["phase"]["status"] == "running")


def test_the_state_that_includes_a_report_comes_before_its_acknowledgement(site: Site) -> None:
    """A client whose reports are all acknowledged has a state that includes every one of them."""
    session_id, token = running(site)
    with site.headset(token) as headset:
        site.command(session_id, "begin_phase")
        state = headset.hear("state", lambda state: state["phase"] is not None)
        clock = {"kind": "phase", "phase_id": state["phase"]["phase_id"]}
        for turn in range(12):
            what, status = ("started" if turn == 0 else "resumed"), "running"
            if turn % 2 == 1:
                what, status = "paused", "paused"
            headset.reported(**clock, what=what, t_s=1.0 + turn, active_s=turn // 2)
            newest = [one for one in headset.heard if one["type"] == "state"][-1]
            assert newest["phase"]["status"] == status


def test_unpairing_a_headset_closes_its_socket(site: Site) -> None:
    """Unpairing a headset closes its socket with 4401."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        (device,) = site.view(session_id)["devices"]
        assert device["connected"]
        site.operator.delete(f"/api/sessions/{session_id}/devices/{device['id']}")
        last, code = closing(headset.socket)
    assert (last["code"], code) == ("not_signed_in", 4401)


@pytest.mark.one_engine
def test_a_newer_page_takes_over_from_an_older_one(site: Site) -> None:
    """The page that connects last records the phase alone; the older one is told why it is closed.

    The phase runs on, because the headset is never gone.
    """
    session_id, token = running(site)
    with site.headset(token) as older:
        site.command(session_id, "begin_phase")
        state = older.hear("state", lambda state: state["phase"] is not None)
        phase_id = state["phase"]["phase_id"]
        older.reported(kind="phase", phase_id=phase_id, what="started", t_s=1, active_s=0)
        with site.headset(token) as newer:
            last, code = closing(older.socket)
            assert (last["type"], last["code"], code) == ("error", "taken_over", 4400)
            assert newer.welcome["state"]["phase"]["status"] == "running"
            newer.report(kind="call", t_s=2.0, what="help")
            newer.acknowledged("reports", 1)
            view = site.view(session_id)
            assert view["current"]["status"] == "running"
            assert [one["connected"] for one in view["devices"]] == [True]
