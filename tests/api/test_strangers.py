"""Those who are nobody: what they may send, how often, and what an answer repeats to them."""

import json
import re
from collections.abc import Iterator
from typing import Any

import pytest
from fastapi.testclient import TestClient
from httpx2 import Response
from starlette.testclient import WebSocketDenialResponse

from app.api.guards import STRANGERS_BODY_BYTES
from app.errors import InvalidInput
from app.platform.policy import ANYONE, POLICY
from app.platform.text import require_text_in_head
from app.wire.messages import SUBPROTOCOL
from tests.api.test_access import routes
from tests.features.lab import PASSWORD, Json, Lab, error, ok

JSON = {"content-type": "application/json"}
SECRET = "s3cret-that-nobody-may-repeat"
MOST_ANSWER_BYTES = 128 * 1024
OPEN = sorted(name for name, who in POLICY.items() if who == ANYONE)
LOGOUT = "/api/logout"
WITH_A_BODY = [
    (method, path) for method, path in map(str.split, OPEN) if method != "GET" and path != LOGOUT
]


def in_pieces(size: int, taken: list[int] | None = None) -> Iterator[bytes]:
    """A body that does not say its length, in pieces; notes how many were taken."""
    for at in range(0, size, 1024):
        if taken is not None:
            taken.append(at)
        yield b" " * 1024


def few_requests(lab: Lab) -> None:
    """A budget of a hundred: what happens when it is gone does not depend on how large it was."""
    lab.context.limits.strangers.capacity = 100.0


def spend_all(lab: Lab, client: TestClient | None = None) -> Response:
    """Ask as a stranger until the budget of the address is gone; the last answer."""
    client = client or lab.stranger()
    # It would come back while the test looks at what is left.
    lab.context.limits.strangers.per_s = 1e-6
    for _ in range(2000):
        answer = client.get("/nothing-here")
        if answer.status_code == 429:
            return answer
    raise AssertionError("a stranger may ask for ever")


@pytest.mark.one_engine
@pytest.mark.parametrize(("method", "path"), WITH_A_BODY)
@pytest.mark.parametrize("sent", ["declared", "in chunks"])
def test_a_stranger_may_send_little(lab: Lab, method: str, path: str, sent: str) -> None:
    """Above 16 KiB it is 413, whether the length was said or the body comes in chunks."""
    size = STRANGERS_BODY_BYTES + 1024
    content: Any = b" " * size if sent == "declared" else in_pieces(size)
    answer = lab.stranger().request(method, path, content=content, headers=JSON)
    refusal = error(answer, 413, "too_large")
    assert refusal["valid"] == f"at most {STRANGERS_BODY_BYTES} bytes"


@pytest.mark.one_engine
def test_too_much_is_refused_while_it_comes(lab: Lab) -> None:
    """The rest of a body that is too large is not waited for."""
    taken: list[int] = []
    answer = lab.stranger().post("/api/login", content=in_pieces(2**20, taken), headers=JSON)
    error(answer, 413, "too_large")


@pytest.mark.one_engine
@pytest.mark.parametrize("path", ["/api/studies", "/api/captures?name=a.bvh"])
def test_a_closed_route_takes_no_more_from_a_stranger(lab: Lab, path: str) -> None:
    """The larger limits are for those who are in."""
    answer = lab.stranger().post(path, content=b" " * 100_000, headers=JSON)
    error(answer, 413, "too_large")
    tablet = lab.tablet(lab.join()["id"])
    refusal = tablet.post(path, content=json.dumps({"yaml": "a" * 100_000}), headers=JSON)
    error(refusal, 401, "not_signed_in")


@pytest.mark.one_engine
def test_an_ended_login_hears_that_it_has_ended(lab: Lab) -> None:
    """Whoever saves a large study after their login has ended is asked to log in."""
    client = lab.stranger()
    client.headers["authorization"] = f"Bearer {'x' * 43}"
    answer = client.post("/api/studies/check", json={"yaml": "a" * 100_000})
    error(answer, 401, "not_signed_in")


@pytest.mark.one_engine
@pytest.mark.parametrize(
    "body",
    [
        {"username": "admin", "password": [SECRET]},
        {"username": ["admin"], "password": SECRET},
        {"password": SECRET},
        {"username": "admin", "pasword": SECRET},
        {"username": "admin", "password": SECRET * 100},
        [SECRET],
        SECRET,
        {"code": {"code": SECRET}},
        {"token": SECRET, "username": "a", "password": {"": SECRET}},
        {"current": SECRET},
    ],
)
@pytest.mark.parametrize(("method", "path"), [*WITH_A_BODY, ("PUT", "/api/me/password")])
def test_no_answer_repeats_a_secret(lab: Lab, method: str, path: str, body: object) -> None:
    """Whatever field it was typed into: an answer about it leaves it out."""
    assert SECRET not in lab.operator.request(method, path, json=body).text


@pytest.mark.one_engine
@pytest.mark.parametrize(("method", "path"), [*WITH_A_BODY, ("PUT", "/api/me/password")])
def test_no_answer_to_a_secret_repeats_the_name_of_a_field(
    lab: Lab, method: str, path: str
) -> None:
    """A password that was pasted into the place of a name is not shown; our own names are."""
    told = error(lab.operator.request(method, path, json={SECRET: 1}), 422, "invalid_input")
    assert SECRET not in json.dumps(told)
    paths = [one["path"] for one in told["details"]]
    assert "(an unknown field)" in paths
    assert len(set(paths)) > 1


@pytest.mark.one_engine
@pytest.mark.parametrize("body", [b"9" * 9000, b"[" * 8000 + b"]" * 8000, b'{"a":' * 2500])
def test_json_beyond_what_can_be_read_is_refused_in_words(lab: Lab, body: bytes) -> None:
    """A number of thousands of digits, or thousands of lists inside each other: to a stranger, and
    to whoever is signed in.
    """
    for client, path in ((lab.stranger(), "/api/login"), (lab.operator, "/api/studies/check")):
        answer = client.post(path, content=body, headers=JSON)
        told = error(answer, 422, "invalid_input")
        assert "the request" in told["message"]
        assert told["remedy"]


@pytest.mark.one_engine
@pytest.mark.parametrize("filling", ["\x01", "é", '"', "x"])
def test_an_answer_is_small_however_much_was_sent(lab: Lab, filling: str) -> None:
    """No route gives back what it did not understand, neither values nor names of fields."""
    large = filling * 250_000
    bodies: list[Any] = [large, [large], {large: large}, {"yaml": [large]}, [filling] * 200_000]
    for method, path in routes(lab):
        if method == "get" or "{" in path or path == LOGOUT:
            continue
        for body in bodies[: 2 if "/edit" not in path else 5]:
            answer = lab.operator.request(method, path, json=body)
            assert len(answer.content) < MOST_ANSWER_BYTES, (method, path)
    for body in bodies:
        answer = lab.operator.post("/api/studies/check", json=body)
        assert len(answer.content) < MOST_ANSWER_BYTES


BAD_TEXTS = (b"\\ud800", b"\\uDFFF", b"\\u0000", b"a\\udc00\\ud800b", b"\xed\xa0\x80", b"\x00")


@pytest.mark.parametrize("bad", BAD_TEXTS)
def test_text_that_cannot_be_stored_is_refused_everywhere(lab: Lab, bad: bytes) -> None:
    """Half a surrogate pair and NUL in any text of any route's body, as a value or as a name."""
    for method, path in routes(lab):
        if method == "get" or path in BINARY:
            continue
        address = re.sub(r"\{\w+\}", "x", path)
        for body in (b'{"a": [{"b": "%s"}]}' % bad, b'{"%s": 1}' % bad, b'"%s"' % bad):
            answer = lab.operator.request(method, address, content=body, headers=JSON)
            error(answer, 422, "invalid_input")


BINARY = ("/api/captures", "/api/humanoids", "/api/walking/walk-sets/tracks")


def test_text_outside_of_the_first_plane_is_text(lab: Lab) -> None:
    """A whole pair, and a backslash before a u, are what people write."""
    for text in (rb"\ud83d\ude00", rb"\\u0000", rb"\\ud800", "😀".encode()):
        body = b'{"yaml": "key: %s"}' % text
        ok(lab.operator.post("/api/studies/check", content=body, headers=JSON))


@pytest.mark.parametrize("bad", ["%00", "%ED%A0%80", "%ff", "a%00b"])
def test_an_address_that_is_no_text_is_refused(lab: Lab, bad: str) -> None:
    """In the path and in the query string of every route, also as the name of a file."""
    for method, path in routes(lab):
        asked = [f"{re.sub(r'[{][a-z_]+[}]', 'x', path)}?name={bad}&{bad}=1"]
        if "{" in path:
            asked.append(re.sub(r"\{\w+\}", bad, path))
        for address in asked:
            error(lab.operator.request(method, address), 422, "invalid_input")
    for page in ("/", "/tablet", "/assets/x"):
        error(lab.stranger().get(f"{page}?{bad}"), 422, "invalid_input")


@pytest.mark.one_engine
def test_a_header_that_is_no_text_is_refused(lab: Lab) -> None:
    """Whichever it is; Latin-1 is what old clients write."""
    for name in (b"authorization", b"cookie", b"user-agent", b"accept-language", b"x-any"):
        answer = lab.stranger().get("/api/me", headers=[(name, b"x a\x00b")])
        error(answer, 422, "invalid_input")
        with pytest.raises(InvalidInput):
            require_text_in_head(b"/", b"", [(name, b"x \xed\xa0\x80")])
        require_text_in_head(b"/", b"", [(name, b"M\xfcller"), (name, "Müller".encode())])


@pytest.mark.one_engine
@pytest.mark.parametrize("name", ["host", "origin"])
def test_a_broken_address_in_a_header_is_refused(lab: Lab, name: str) -> None:
    """Half an IPv6 address is nobody's name, and no trouble of the server's."""
    answer = lab.stranger().post(
        "/api/logout", headers={name: "http://[::1" if name == "origin" else "[::1"}
    )
    assert answer.status_code in (403, 422)


@pytest.mark.parametrize("bad", ["\\u0000", "\\ud800"])
def test_a_message_that_is_no_text_is_refused(lab: Lab, bad: str) -> None:
    """A headset's message with such a character ends its connection, with the reason."""
    token = lab.headset_token(lab.join()["id"])
    with lab.stranger().websocket_connect(
        "/api/vr/stream", subprotocols=[SUBPROTOCOL, f"bearer.{token}"]
    ) as socket:
        socket.send_text(f'{{"type": "hello", "protocol": 1, "client": "{bad}"}}')
        told: Json = socket.receive_json()
        assert told["code"] == "invalid_input"
        assert socket.receive()["code"] == 4400


@pytest.mark.one_engine
class TestBudget:
    """What one address may ask for in a while."""

    def test_every_open_address_has_one(self, fresh_lab: Lab) -> None:
        """Pages, routes, what is not there, and sockets: 429 with Retry-After."""
        refused = spend_all(fresh_lab)
        assert int(refused.headers["retry-after"]) >= 1
        stranger = fresh_lab.stranger()
        for name in OPEN:
            method, path = name.split()
            assert stranger.request(method, path, json={}).status_code == 429, name
        for page in ("/", "/tablet", "/tablet-worker.js", "/assets/x.js", "/api/openapi.json"):
            assert stranger.get(page).status_code == 429, page
        for socket in ("/api/vr/stream", "/api/sessions/x/pose"):
            with (
                pytest.raises(WebSocketDenialResponse) as denied,
                stranger.websocket_connect(socket),
            ):
                pass
            assert denied.value.status_code == 429

    def test_a_flood_refuses_nobody_who_is_in(self, fresh_lab: Lab) -> None:
        """Everybody has one address: the login, the tablet and the headset go on, new ones too."""
        few_requests(fresh_lab)
        session_id = fresh_lab.join()["id"]
        tablet, token = fresh_lab.tablet(session_id), fresh_lab.headset_token(session_id)
        spend_all(fresh_lab)
        for _ in range(30):
            ok(fresh_lab.operator.get("/api/studies"))
            ok(tablet.get("/api/tablet/state"))
            assert tablet.get("/tablet").status_code in (200, 503)
        with fresh_lab.stranger().websocket_connect(
            "/api/vr/stream", subprotocols=[SUBPROTOCOL, f"bearer.{token}"]
        ) as socket:
            socket.send_json({"type": "hello", "protocol": 1, "client": "test"})
            assert socket.receive_json()["type"] == "welcome"
        assert spend_all(fresh_lab).status_code == 429

    def test_an_invented_token_is_no_way_around(self, fresh_lab: Lab) -> None:
        """What opens nothing counts like nothing, a new one each time."""
        few_requests(fresh_lab)
        stranger = fresh_lab.stranger()
        for at in range(2000):
            stranger.headers["authorization"] = f"Bearer {at:043d}"
            if stranger.get("/api/me").status_code == 429:
                return
        raise AssertionError("an invented token opens the budget")

    def test_an_unpaired_tablet_is_a_stranger_soon(self, fresh_lab: Lab) -> None:
        """A token that was good counts as known for a minute at most; it opens nothing at once."""
        session_id = fresh_lab.join()["id"]
        tablet = fresh_lab.tablet(session_id)
        device = ok(tablet.get("/api/tablet/state"))
        (paired,) = fresh_lab.view(session_id)["devices"]
        fresh_lab.operator.delete(f"/api/sessions/{session_id}/devices/{paired['id']}")
        error(tablet.get("/api/tablet/state"), 401, "not_signed_in")
        assert device

    def test_many_names_from_one_address_are_stopped(self, fresh_lab: Lab) -> None:
        """Beside ten for each name there are thirty for the address; a right one costs nothing."""
        stranger = fresh_lab.stranger()
        found = []
        for at in range(40):
            body = {"username": f"name{at}", "password": "a wrong guess"}
            found.append(stranger.post("/api/login", json=body))
        assert [one.status_code for one in found] == [401] * 30 + [429] * 10
        assert int(found[-1].headers["retry-after"]) >= 1

    def test_right_sign_ins_use_nothing_up(self, fresh_lab: Lab) -> None:
        """A lab behind one address signs in as often as it likes."""
        for _ in range(40):
            body = {"username": "admin", "password": PASSWORD}
            ok(fresh_lab.stranger().post("/api/login", json=body))

    def test_guessing_codes_takes_no_turn_at_writing(self, fresh_lab: Lab) -> None:
        """While somebody writes, wrong codes and logouts of nobody are answered all the same."""
        with fresh_lab.database.writing():
            stranger = fresh_lab.stranger()
            error(stranger.post("/api/devices/pair", json={"code": "XXX-XXX"}), 404, "not_found")
            assert stranger.post("/api/logout").status_code == 204
