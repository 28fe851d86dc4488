"""Doors on a running server: opened, closed, busy, and what real datagrams show on the page."""

import json
import socket
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator

import pytest

from app.adapters.live import (
    DATA_PORT,
    OscTrackers,
    connect_request,
    keep_alive,
    model_request,
)
from app.features.movement.live.natnet_link import ASK_EVERY_S, LOST_S, NatNetLink
from tests.adapters.live.packets import bundle, definitions, frame, server_info, vmc
from tests.adapters.live.test_fuzzed_packets import packets
from tests.features.lab import Json, Lab, error, ok
from tests.support.datagrams import HERE, free_udp_port, sender

V4 = (4, 1)
BAD = (422, "invalid_input")
REMEDY = "Choose another port, or close that door first."


def open_door(lab: Lab, door: str, **fields: object) -> Json:
    """Open a door and return it."""
    body = {"is_open": True, "interface": HERE, **fields}
    view = ok(lab.operator.put(f"/api/trackers/doors/{door}", json=body))
    return next(one for one in view["doors"] if one["door"] == door)


def close_doors(lab: Lab) -> Json:
    """Close every door, and return what is then shown."""
    view: Json = {}
    for door in ("osc", "natnet", "json"):
        body = {"is_open": False, "port": 40000}
        view = ok(lab.operator.put(f"/api/trackers/doors/{door}", json=body))
    return view


def shown(lab: Lab, until: Callable[[Json], bool]) -> Json:
    """Return the view once it is as expected."""
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline:
        view: Json = ok(lab.operator.get("/api/trackers"))
        if until(view):
            return view
        time.sleep(0.05)
    pytest.fail(f"not within 30 s: {view}")


@pytest.fixture
def open_lab(fresh_lab: Lab) -> Iterator[Lab]:
    """A lab whose doors are closed in the end."""
    yield fresh_lab
    close_doors(fresh_lab)


def test_all_doors_are_closed_until_somebody_opens_one(open_lab: Lab) -> None:
    """Nothing listens at first; an opened door receives, a closed one does not, and forgets."""
    view = ok(open_lab.operator.get("/api/trackers"))
    assert [(one["is_open"], one["state"]) for one in view["doors"]] == [(False, None)] * 3
    assert view["interfaces"][0] == HERE
    port = free_udp_port()
    door = open_door(open_lab, "osc", port=port)
    assert (door["state"], door["trouble"]) == ("open", None)
    with sender(port) as send:
        for _ in range(20):
            send(bundle(vmc("LHR-1"), vmc("LHR-2")))
        send(b"not OSC")
        view = shown(open_lab, lambda view: bool(view["sources"]) and _packets(view) == 21)
        (source,) = view["sources"]
        assert [one["name"] for one in source["trackers"]] == ["LHR-1", "LHR-2"]
        assert source["trackers"][0]["position_m"] == pytest.approx([0.1, 0.9, -0.2])
        assert (source["name"], source["problems"]) == (HERE, {"malformed": 1})
        assert (source["late"], source["offset_s"]) == (None, None)
    assert not close_doors(open_lab)["sources"]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind((HERE, port))
    actions = [one["action"] for one in ok(open_lab.operator.get("/api/audit"))["entries"]]
    assert actions.count("tracker.opened") == 1


@pytest.mark.one_engine
def test_a_door_on_a_port_in_use_says_so_and_opens_when_it_is_free(open_lab: Lab) -> None:
    """Another program has the port; nobody has to click again when it has gone."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind((HERE, 0))
        port = other.getsockname()[1]
        door = open_door(open_lab, "json", port=port)
        assert door["state"] == "failed"
        assert door["trouble"] == "port_in_use"
    shown(open_lab, lambda view: view["doors"][2]["state"] == "open")


def test_damaged_packets_are_counted_on_the_page(open_lab: Lab) -> None:
    """Of 300 damaged packets every problem that the decoder names is counted, by kind."""
    port = free_udp_port()
    open_door(open_lab, "osc", port=port)
    sent = [vmc("LHR-1"), *packets("osc", 300, seed=5)]
    decoder, expected = OscTrackers(), Counter[str]()
    for packet in sent:
        expected += decoder.read(packet).problems
    with sender(port) as send:
        for packet in sent:
            send(packet)
    view = shown(open_lab, lambda one: _packets(one) == len(sent))
    counted = sum((Counter(one["problems"]) for one in view["sources"]), Counter[str]())
    assert counted == expected
    assert counted["malformed"] > 10


def test_two_scripts_of_one_name_and_a_limb(open_lab: Lab) -> None:
    """Both are shown and marked; the limb that is chosen holds for the name, also later."""
    port = free_udp_port()
    open_door(open_lab, "json", port=port)

    def packet(number: int) -> bytes:
        pose = {"position_m": [0, 1, 0]}
        return json.dumps({"source": "rig", "frame": number, "trackers": {"a": pose}}).encode()

    with sender(port) as first, sender(port) as second:
        for number in (1, 2, 2, 5):
            first(packet(number))
        second(packet(700))
        view = shown(open_lab, lambda view: len(view["sources"]) == 2 and _packets(view) == 5)
    assert [one["same_name"] for one in view["sources"]] == [True, True]
    by_packets = {one["packets"]: one for one in view["sources"]}
    assert [by_packets[4][key] for key in ("doubled", "late", "skipped")] == [1, 0, 2]
    wish = {"door": "json", "source": "rig", "tracker": "a", "limb": "LeftFoot"}
    view = ok(open_lab.operator.put("/api/trackers/limbs", json=wish))
    assert {one["trackers"][0]["limb"] for one in view["sources"]} == {"LeftFoot"}
    refused = error(
        open_lab.operator.put("/api/trackers/limbs", json={**wish, "limb": "Tail"}), *BAD
    )
    assert "LeftFoot" in refused["valid"]
    view = ok(open_lab.operator.put("/api/trackers/limbs", json={**wish, "limb": None}))
    assert {one["trackers"][0]["limb"] for one in view["sources"]} == {None}


@pytest.mark.one_engine
def test_motive_is_asked_and_its_frames_arrive_with_names(open_lab: Lab) -> None:
    """A server that answers like Motive 3: connect, definitions, unicast frames."""
    stop = threading.Event()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as motive:
        motive.bind((HERE, 0))
        motive.settimeout(0.02)

        def serve() -> None:
            number = 0
            client: tuple[str, int] | None = None
            while not stop.is_set():
                try:
                    request, client = motive.recvfrom(2000)
                except TimeoutError:
                    request = b""
                if client is None:
                    continue
                if request == connect_request():
                    motive.sendto(server_info(V4), client)
                elif request == model_request():
                    motive.sendto(definitions(V4, {3: "Waist"}, {}), client)
                number += 1
                row = (3, (0.0, 1.0, 0.0), (1.0, 0.0, 0.0, 0.0), True)
                motive.sendto(frame(V4, number, number / 50, [row]), client)

        thread = threading.Thread(target=serve)
        thread.start()
        try:
            open_door(open_lab, "natnet", port=motive.getsockname()[1], server=HERE)
            view = shown(
                open_lab,
                lambda view: any(
                    one["name"] == "Waist" and one["samples"] > 3
                    for source in view["sources"]
                    for one in source["trackers"]
                ),
            )
        finally:
            stop.set()
            thread.join()
    (source,) = (one for one in view["sources"] if one["name"] == "Motive")
    assert source["offset_s"] is not None
    assert (source["late"], source["doubled"]) == (0, 0)


def test_a_lost_server_is_asked_to_connect_again() -> None:
    """Connect every second until it answers, then names, then signs of life, then anew."""
    link = NatNetLink()
    assert link.due(0) == connect_request()
    assert link.due(0.5) is None
    assert link.due(ASK_EVERY_S) == connect_request()
    link.read(server_info(V4), 1.1)
    assert link.due(1.1) == model_request()
    assert link.due(1.2) is None
    assert link.due(2.2) == keep_alive()
    link.read(frame(V4, 1, 0.0, [(5, (0, 0, 0), (1, 0, 0, 0), True)]), 3)
    assert link.due(3.3) == model_request()
    assert link.due(3 + LOST_S + 1) == connect_request()


@pytest.mark.one_engine
def test_what_a_door_cannot_be_is_refused(open_lab: Lab) -> None:
    """An address that is not this machine's, no address, NatNet without a server, a low port."""
    put = open_lab.operator.put
    body = {"is_open": True, "port": 39539, "interface": HERE}
    other = error(put("/api/trackers/doors/osc", json={**body, "interface": "192.0.2.1"}), *BAD)
    assert HERE in other["valid"]
    assert "Motive" in error(put("/api/trackers/doors/natnet", json=body), *BAD)["message"]
    for wrong in ({"interface": "lab"}, {"port": 80}, {"port": "38570 "}, {"interface": "::1"}):
        error(put("/api/trackers/doors/osc", json={**body, **wrong}), *BAD)
    assert put("/api/trackers/doors/usb", json=body).status_code == 422
    loopback_network, of_all = "127.255.255.255", "255.255.255.255"
    for server in (of_all, "0.0.0.0", "0.1.2.3", "239.255.42.99", "250.0.0.1", loopback_network):  # noqa: S104
        wish = {**body, "server": server}
        refused = error(put("/api/trackers/doors/natnet", json=wish), *BAD)
        assert refused["message"] == f"{server} is not the address of a computer"
        assert (refused["value"], bool(refused["remedy"])) == (server, True)
        ok(put("/api/trackers/doors/natnet", json={**wish, "is_open": False}))


@pytest.mark.one_engine
def test_two_of_our_own_doors_never_have_one_port(open_lab: Lab) -> None:
    """The second is refused while the first is open, which keeps its port; also Motive's group."""
    put, port = open_lab.operator.put, free_udp_port()
    assert open_door(open_lab, "json", port=port)["state"] == "open"
    body = {"is_open": True, "port": port, "interface": HERE}
    refused = error(put("/api/trackers/doors/osc", json=body), *BAD)
    assert refused["message"] == "door json has this port"
    assert (refused["value"], refused["remedy"]) == (port, REMEDY)
    ok(put("/api/trackers/doors/osc", json={**body, "is_open": False}))
    assert open_door(open_lab, "json", port=port)["state"] == "open"
    open_door(open_lab, "natnet", port=port, server=HERE)
    open_door(open_lab, "natnet", port=port, server=HERE, multicast=True)
    refused = error(put("/api/trackers/doors/osc", json={**body, "port": DATA_PORT}), *BAD)
    assert refused["message"] == "door natnet has this port"
    ok(put("/api/trackers/doors/json", json={**body, "is_open": False}))
    assert open_door(open_lab, "osc", port=port)["state"] == "open"


def _packets(view: Json) -> int:
    return sum(source["packets"] for source in view["sources"])
