"""Opening, refusing and closing the headset's socket, and what its reports do."""

import json
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from tests.features.lab import Json
from tests.features.record.headset.site import HELLO, Site


def closing(socket: Any) -> tuple[Json, int]:
    """The last message before the server closes, and the code of the close."""
    last: Json = {}
    try:
        while True:
            last = json.loads(socket.recv(timeout=10.0))
    except ConnectionClosed as closed:
        return last, closed.rcvd.code if closed.rcvd else 1006


def running(site: Site) -> tuple[str, str]:
    """A session whose free movement can be called, and its headset's token."""
    session_id = site.join()
    site.skip_to(session_id, "free_roam")
    return session_id, site.token(session_id)


@pytest.mark.one_engine
@pytest.mark.parametrize("token", [None, "", "wrong", "x" * 500])
def test_a_wrong_token_is_refused_with_the_reason(site: Site, token: str | None) -> None:
    """The socket says what is wrong and closes with 4401."""
    with site.socket(token) as socket:
        last, code = closing(socket)
    assert (last["type"], last["code"], code) == ("error", "not_signed_in", 4401)
    assert "new code" in last["remedy"]


@pytest.mark.one_engine
def test_an_operators_token_opens_no_headset(site: Site) -> None:
    """A login is no pairing."""
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
def test_whoever_does_not_say_hello_first_is_refused(site: Site, first: str | bytes) -> None:
    """The refusal says what was expected, and the close is 4400."""
    with site.socket(site.token(site.join())) as socket:
        socket.send(first)
        last, code = closing(socket)
    assert (last["type"], last["code"], code) == ("error", "invalid_input", 4400)
    assert "Traceback" not in site.server.log


@pytest.mark.one_engine
def test_hello_comes_once(site: Site) -> None:
    """A second hello on the same socket closes it."""
    with site.headset(site.token(site.join())) as headset:
        headset.say(HELLO)
        assert headset.hear("error")["message"] == "hello came twice"


@pytest.mark.one_engine
def test_another_sites_page_cannot_open_the_socket(site: Site) -> None:
    """A foreign Origin is refused before anything is said."""
    token = site.token(site.join())
    with (
        pytest.raises(InvalidStatus) as refused,
        site.socket(token, origin="https://elsewhere.example"),
    ):
        pass
    assert refused.value.response.status_code == 403


@pytest.mark.one_engine
def test_an_oversized_message_closes_the_socket(site: Site) -> None:
    """More than 256 KiB at once is answered with 1009."""
    with site.headset(site.token(site.join())) as headset:
        headset.say(b"\0" * (257 * 1024))
        assert closing(headset.socket)[1] == 1009


@pytest.mark.one_engine
def test_the_welcome_tells_the_task_and_no_condition(site: Site) -> None:
    """The headset hears boxes, texts and state; conditions and their order stay here."""
    with site.headset(site.token(site.join(language="de"))) as headset:
        welcome = headset.welcome
    assert welcome["language"] == "de"
    assert set(welcome["tasks"]) == {"hand", "foot"}
    assert welcome["state"]["status"] == "planned"
    assert "latency_350" not in json.dumps(welcome)


def test_the_headset_hears_of_every_change(site: Site) -> None:
    """The operator's command and its own report both come back as the new state."""
    session_id, token = running(site)
    with site.headset(token) as headset:
        site.command(session_id, "begin_phase")
        state = headset.hear("state", lambda state: state["phase"] is not None)
        assert state["phase"]["status"] == "preparing"
        headset.report(
            kind="phase", phase_id=state["phase"]["phase_id"], what="started", t_s=1, active_s=0
        )
        headset.hear("state", lambda state: state["phase"]["status"] == "running")


def test_an_unpaired_headset_is_shut_out_at_once(site: Site) -> None:
    """Revoking its pairing closes the socket with 4401."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        (device,) = site.view(session_id)["devices"]
        assert device["connected"]
        site.operator.delete(f"/api/sessions/{session_id}/devices/{device['id']}")
        last, code = closing(headset.socket)
    assert (last["code"], code) == ("not_signed_in", 4401)
