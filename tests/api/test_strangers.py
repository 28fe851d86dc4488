"""Tests of anonymous requests: limits of size and rate, and secrets in the answers."""

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

pytestmark = pytest.mark.thorough

JSON = {"content-type": "application/json"}
SECRET = "s3cret-that-nobody-may-repeat"
MOST_ANSWER_BYTES = 128 * 1024
OPEN = sorted(name for name, who in POLICY.items() if who == ANYONE)
LOGOUT = "/api/logout"
WITH_A_BODY = [
    (method, path) for method, path in map(str.split, OPEN) if method != "GET" and path != LOGOUT
]


def in_pieces(size: int, taken: list[int] | None = None) -> Iterator[bytes]:
    """Yield a body in pieces without a declared length, recording how many were read."""
    for at in range(0, size, 1024):
        if taken is not None:
            taken.append(at)
        yield b" " * 1024


def few_requests(lab: Lab) -> None:
    """Lower the budget to a hundred requests; behaviour beyond it does not depend on its size."""
    lab.context.limits.strangers.capacity = 100.0


def spend_all(lab: Lab, client: TestClient | None = None) -> Response:
    """Send anonymous requests until the address's budget is used up; return the last answer."""
    client = client or lab.stranger()
    # The budget would refill during the test.
    lab.context.limits.strangers.per_s = 1e-6
    for _ in range(2000):
        answer = client.get("/nothing-here")
        if answer.status_code == 429:
            return answer
    raise AssertionError("anonymous requests are not limited")


@pytest.mark.one_engine
@pytest.mark.parametrize(("method", "path"), WITH_A_BODY)
@pytest.mark.parametrize("sent", ["declared", "in chunks"])
def test_an_anonymous_body_is_limited_to_16_kib(
    lab: Lab, method: str, path: str, sent: str
) -> None:
    """An anonymous body above 16 KiB is refused with 413, declared or in chunks."""
    size = STRANGERS_BODY_BYTES + 1024
    content: Any = b" " * size if sent == "declared" else in_pieces(size)
    answer = lab.stranger().request(method, path, content=content, headers=JSON)
    refusal = error(answer, 413, "too_large")
    assert refusal["valid"] == f"at most {STRANGERS_BODY_BYTES} bytes"


@pytest.mark.one_engine
def test_a_too_large_body_is_refused_while_it_arrives(lab: Lab) -> None:
    """A body that is too large is refused without reading the rest."""
    taken: list[int] = []
    answer = lab.stranger().post("/api/login", content=in_pieces(2**20, taken), headers=JSON)
    error(answer, 413, "too_large")


@pytest.mark.one_engine
@pytest.mark.parametrize("path", ["/api/studies", "/api/captures?name=a.bvh"])
def test_larger_bodies_need_a_login(lab: Lab, path: str) -> None:
    """The larger size limit of a closed route applies only to authenticated requests."""
    answer = lab.stranger().post(path, content=b" " * 100_000, headers=JSON)
    error(answer, 413, "too_large")
    tablet = lab.tablet(lab.join()["id"])
    refusal = tablet.post(path, content=json.dumps({"yaml": "a" * 100_000}), headers=JSON)
    error(refusal, 401, "not_signed_in")


@pytest.mark.one_engine
def test_a_large_request_with_an_expired_login_gets_401(lab: Lab) -> None:
    """A large request with an expired login is answered with 401, not with a size error."""
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
    """No answer repeats a secret, in whatever field of the request it was."""
    assert SECRET not in lab.operator.request(method, path, json=body).text


@pytest.mark.one_engine
@pytest.mark.parametrize(("method", "path"), [*WITH_A_BODY, ("PUT", "/api/me/password")])
def test_no_answer_repeats_an_unknown_field_name(lab: Lab, method: str, path: str) -> None:
    """An answer does not repeat unknown field names, which may be a pasted password."""
    refusal = error(lab.operator.request(method, path, json={SECRET: 1}), 422, "invalid_input")
    assert SECRET not in json.dumps(refusal)
    paths = [one["path"] for one in refusal["details"]]
    assert "(an unknown field)" in paths
    assert len(set(paths)) > 1


@pytest.mark.one_engine
@pytest.mark.parametrize("body", [b"9" * 9000, b"[" * 8000 + b"]" * 8000, b'{"a":' * 2500])
def test_excessive_json_is_refused_with_a_remedy(lab: Lab, body: bytes) -> None:
    """JSON with huge numbers or deep nesting is refused with a remedy, signed in or not."""
    for client, path in ((lab.stranger(), "/api/login"), (lab.operator, "/api/studies/check")):
        answer = client.post(path, content=body, headers=JSON)
        refusal = error(answer, 422, "invalid_input")
        assert "the request" in refusal["message"]
        assert refusal["remedy"]


@pytest.mark.one_engine
@pytest.mark.parametrize("filling", ["\x01", "é", '"', "x"])
def test_an_answer_is_small_whatever_was_sent(lab: Lab, filling: str) -> None:
    """An answer to a large invalid request is small, as it does not repeat the content."""
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
    """Every route refuses text with a lone surrogate or NUL, as a value or as a key."""
    for method, path in routes(lab):
        if method == "get" or path in BINARY:
            continue
        address = re.sub(r"\{\w+\}", "x", path)
        for body in (b'{"a": [{"b": "%s"}]}' % bad, b'{"%s": 1}' % bad, b'"%s"' % bad):
            answer = lab.operator.request(method, address, content=body, headers=JSON)
            error(answer, 422, "invalid_input")


BINARY = ("/api/captures", "/api/humanoids", "/api/walking/walk-sets/tracks")


def test_surrogate_pairs_and_escaped_backslashes_are_accepted(lab: Lab) -> None:
    """Complete surrogate pairs and escaped backslashes in a text are accepted."""
    for text in (rb"\ud83d\ude00", rb"\\u0000", rb"\\ud800", "😀".encode()):
        body = b'{"yaml": "key: %s"}' % text
        ok(lab.operator.post("/api/studies/check", content=body, headers=JSON))


@pytest.mark.parametrize("bad", ["%00", "%ED%A0%80", "%ff", "a%00b"])
def test_an_address_with_invalid_text_is_refused(lab: Lab, bad: str) -> None:
    """A NUL or invalid UTF-8 in the path or query of any route is refused."""
    for method, path in routes(lab):
        addresses = [f"{re.sub(r'[{][a-z_]+[}]', 'x', path)}?name={bad}&{bad}=1"]
        if "{" in path:
            addresses.append(re.sub(r"\{\w+\}", bad, path))
        for address in addresses:
            error(lab.operator.request(method, address), 422, "invalid_input")
    for page in ("/", "/tablet", "/assets/x"):
        error(lab.stranger().get(f"{page}?{bad}"), 422, "invalid_input")


@pytest.mark.one_engine
def test_a_header_with_invalid_text_is_refused(lab: Lab) -> None:
    """A NUL or a surrogate in any header is refused; Latin-1 and UTF-8 are accepted."""
    for name in (b"authorization", b"cookie", b"user-agent", b"accept-language", b"x-any"):
        answer = lab.stranger().get("/api/me", headers=[(name, b"x a\x00b")])
        error(answer, 422, "invalid_input")
        with pytest.raises(InvalidInput):
            require_text_in_head(b"/", b"", [(name, b"x \xed\xa0\x80")])
        require_text_in_head(b"/", b"", [(name, b"M\xfcller"), (name, "Müller".encode())])


@pytest.mark.one_engine
@pytest.mark.parametrize("name", ["host", "origin"])
def test_a_broken_address_in_a_header_is_refused(lab: Lab, name: str) -> None:
    """A malformed IPv6 address in `Host` or `Origin` is refused without a server error."""
    answer = lab.stranger().post(
        "/api/logout", headers={name: "http://[::1" if name == "origin" else "[::1"}
    )
    assert answer.status_code in (403, 422)


@pytest.mark.parametrize("bad", ["\\u0000", "\\ud800"])
def test_a_headset_message_with_invalid_text_is_refused(lab: Lab, bad: str) -> None:
    """A headset's message with NUL or a lone surrogate closes its socket with the reason."""
    token = lab.headset_token(lab.join()["id"])
    with lab.stranger().websocket_connect(
        "/api/vr/stream", subprotocols=[SUBPROTOCOL, f"bearer.{token}"]
    ) as socket:
        socket.send_text(f'{{"type": "hello", "protocol": 1, "client": "{bad}"}}')
        reply: Json = socket.receive_json()
        assert reply["code"] == "invalid_input"
        assert socket.receive()["code"] == 4400


@pytest.mark.one_engine
class TestBudget:
    """The budget of requests of one address."""

    def test_every_public_route_is_rate_limited(self, fresh_lab: Lab) -> None:
        """Pages, public routes, missing paths and sockets answer 429 once the budget is used up."""
        refused = spend_all(fresh_lab)
        assert int(refused.headers["retry-after"]) >= 1
        stranger = fresh_lab.stranger()
        for name in OPEN:
            method, path = name.split()
            assert stranger.request(method, path, json={}).status_code == 429, name
        for page in ("/", "/tablet", "/tablet-worker.js", "/assets/x.js", "/api/openapi.json"):
            assert stranger.get(page).status_code == 429, page
        sockets = ("stream", "trackers", "self-tests/storage")
        for socket in (*(f"/api/vr/{one}" for one in sockets), "/api/sessions/x/pose"):
            with (
                pytest.raises(WebSocketDenialResponse) as denied,
                stranger.websocket_connect(socket),
            ):
                pass
            assert denied.value.status_code == 429

    def test_a_flood_does_not_affect_authenticated_clients(self, fresh_lab: Lab) -> None:
        """When an address has used up its budget, its signed-in and paired clients still work."""
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

    def test_invalid_tokens_count_as_anonymous(self, fresh_lab: Lab) -> None:
        """Requests that each carry a different invalid token use up the anonymous budget."""
        few_requests(fresh_lab)
        stranger = fresh_lab.stranger()
        for at in range(2000):
            stranger.headers["authorization"] = f"Bearer {at:043d}"
            if stranger.get("/api/me").status_code == 429:
                return
        raise AssertionError("requests with invalid tokens are not limited")

    def test_an_unpaired_tablet_is_refused_immediately(self, fresh_lab: Lab) -> None:
        """An unpaired tablet's token is refused immediately."""
        session_id = fresh_lab.join()["id"]
        tablet = fresh_lab.tablet(session_id)
        device = ok(tablet.get("/api/tablet/state"))
        (paired,) = fresh_lab.view(session_id)["devices"]
        fresh_lab.operator.delete(f"/api/sessions/{session_id}/devices/{paired['id']}")
        error(tablet.get("/api/tablet/state"), 401, "not_signed_in")
        assert device

    def test_failed_logins_are_limited_per_address(self, fresh_lab: Lab) -> None:
        """After thirty failed logins under different names an address is refused."""
        stranger = fresh_lab.stranger()
        found = []
        for at in range(40):
            body = {"username": f"name{at}", "password": "a wrong guess"}
            found.append(stranger.post("/api/login", json=body))
        assert [one.status_code for one in found] == [401] * 30 + [429] * 10
        assert int(found[-1].headers["retry-after"]) >= 1

    def test_successful_logins_are_not_limited(self, fresh_lab: Lab) -> None:
        """Successful logins from one address are not limited."""
        for _ in range(40):
            body = {"username": "admin", "password": PASSWORD}
            ok(fresh_lab.stranger().post("/api/login", json=body))

    def test_wrong_codes_do_not_wait_for_the_write_lock(self, fresh_lab: Lab) -> None:
        """Wrong pairing codes and anonymous logouts are answered while the write lock is taken."""
        with fresh_lab.database.writing():
            stranger = fresh_lab.stranger()
            error(stranger.post("/api/devices/pair", json={"code": "XXX-XXX"}), 404, "not_found")
            assert stranger.post("/api/logout").status_code == 204
