"""What a door does when too much comes, when it is busy, and when its server starts again."""

import threading
import time

import pytest
from httpx2 import Response

from app.adapters.live import Reading
from app.features.movement.live.datagrams import BUFFER_BYTES, DatagramSocket
from app.features.movement.live.doors import DoorSettings
from app.features.movement.live.listening import (
    BURST_S,
    BYTES_PER_S,
    PACKET_BYTES,
    Budget,
    Listener,
)
from app.features.movement.live.sources import DoorKey
from tests.adapters.live.packets import bundle, vmc
from tests.features.lab import Json, Lab, ok, running_lab
from tests.support.datagrams import HERE, free_udp_port, sender

FLOOD_BYTES = 60_000


def test_a_door_reads_its_rate_after_a_burst_and_no_more() -> None:
    """Offered ten times its rate for four seconds it takes the burst and four seconds' worth."""
    rate, size = 1000.0, 100 - PACKET_BYTES
    budget = Budget(rate)
    taken = sum(budget.takes(size, now_s=number / 100) for number in range(400))
    assert taken * 100 == pytest.approx(rate * (BURST_S + 4), abs=100)
    assert not budget.takes(int(rate), now_s=1e6)
    assert budget.takes(size, now_s=1e6)


def test_a_flood_is_counted_and_what_is_read_is_limited() -> None:
    """8 MB at once: a door reads a burst of it, and knows of the rest that it was left out."""
    taken: list[str] = []

    def take(_: DoorKey, batch: list[tuple[str, Reading, float]]) -> None:
        taken.extend(address for address, _, _ in batch)

    port = free_udp_port()
    # A clock that stands still: nothing is earned while the test sends.
    listener = Listener(DoorSettings("osc", is_open=True, port=port), take, lambda: 0)
    listener.start()
    packet = bundle(*[vmc(f"{number:03}") for number in range(100)])
    try:
        with sender(port) as send:
            for _ in range(8_000_000 // len(packet)):
                send(packet)
            before = -1
            while listener.received.packets > before:
                before = listener.received.packets
                time.sleep(0.3)
    finally:
        listener.stop()
    received = listener.received
    assert len(taken) == BYTES_PER_S["osc"] * BURST_S // (len(packet) + PACKET_BYTES)
    assert received.packets == len(taken) + received.unread
    assert received.packets + (received.dropped or 0) <= 8_000_000 // len(packet)


def test_a_flood_with_nothing_after_it_is_counted() -> None:
    """What the kernel dropped while the door was busy is known without another packet."""
    busy, free = threading.Event(), threading.Event()

    def take(_door: DoorKey, _batch: list[tuple[str, Reading, float]]) -> None:
        busy.set()
        free.wait(30)

    port = free_udp_port()
    listener = Listener(DoorSettings("osc", is_open=True, port=port), take, time.monotonic_ns)
    listener.start()
    try:
        with sender(port) as send:
            send(vmc("foot"))
            assert busy.wait(30)
            sent = 2 * BUFFER_BYTES // FLOOD_BYTES
            for _ in range(sent):
                send(bytes(FLOOD_BYTES))
        free.set()
        deadline = time.monotonic() + 30
        while not _all_known(listener, sent + 1) and time.monotonic() < deadline:
            time.sleep(0.05)
    finally:
        free.set()
        listener.stop()
    if listener.received.dropped is None:
        pytest.skip("this system does not say what it dropped")
    assert listener.received.dropped > 0
    assert listener.received.packets + listener.received.dropped == sent + 1


def _all_known(listener: Listener, sent: int) -> bool:
    return listener.received.packets + (listener.received.dropped or 0) == sent


def test_a_batch_that_cannot_be_taken_does_not_close_the_door() -> None:
    """The state fails once: what comes later is taken all the same."""
    taken: list[int] = []

    def take(_: DoorKey, batch: list[tuple[str, Reading, float]]) -> None:
        taken.append(len(batch))
        if len(taken) == 1:
            raise RuntimeError("once")

    port = free_udp_port()
    listener = Listener(DoorSettings("osc", is_open=True, port=port), take, time.monotonic_ns)
    listener.start()
    try:
        with sender(port) as send:
            deadline = time.monotonic() + 20
            while len(taken) < 2 and time.monotonic() < deadline:
                send(vmc("foot"))
                time.sleep(0.02)
    finally:
        listener.stop()
    assert len(taken) >= 2


def test_a_packet_arrived_when_it_came_and_not_when_it_was_read() -> None:
    """The kernel's stamp tells how long it waited; a system without stamps says that it did not."""
    port = free_udp_port()
    door = DatagramSocket(HERE, port)
    try:
        with sender(port) as send:
            send(b"one")
            time.sleep(0.2)
            packet, (host, _), age_s = door.receive()
        assert (packet, host) == (b"one", HERE)
        assert age_s >= 0.2 if door.dropped() is not None else age_s == 0
    finally:
        door.close()


@pytest.mark.one_engine
def test_open_doors_are_opened_again_with_the_server_which_says_so(database_url: str) -> None:
    """After a restart an open door is open, a closed one is closed, and the page knows by whom."""
    ports = {"osc": free_udp_port(), "json": free_udp_port()}
    with running_lab(database_url) as lab:
        for door, port in ports.items():
            _switch(lab, door, is_open=True, port=port)
        view = _switch(lab, "json", is_open=False, port=ports["json"])
        assert [one["resumed"] for one in view["doors"]] == [False] * 3
    with running_lab(database_url) as lab:
        doors = {one["door"]: one for one in ok(lab.operator.get("/api/trackers"))["doors"]}
        assert doors["osc"]["state"] == "open"
        assert (doors["osc"]["opened_by"], doors["osc"]["resumed"]) == ("account:admin", True)
        assert (doors["json"]["state"], doors["json"]["opened_by"]) == (None, None)
        with sender(ports["osc"]) as send:
            send(vmc("foot"))
        view = _switch(lab, "osc", is_open=True, port=free_udp_port())
        assert [one["resumed"] for one in view["doors"]] == [False] * 3
        _switch(lab, "osc", is_open=False, port=ports["osc"])


@pytest.mark.one_engine
def test_a_door_follows_what_was_stored_last(fresh_lab: Lab) -> None:
    """The answer to a second wish shows the second one, and the first port is free again."""
    first, second = free_udp_port(), free_udp_port()
    _switch(fresh_lab, "osc", is_open=True, port=first)
    view = _switch(fresh_lab, "osc", is_open=True, port=second)
    assert (view["doors"][0]["port"], view["doors"][0]["state"]) == (second, "open")
    DatagramSocket(HERE, first).close()
    again = _switch(fresh_lab, "osc", is_open=True, port=second)
    assert again["doors"][0]["state"] == "open"
    taken = _put(fresh_lab, "json", is_open=True, port=second)
    assert taken.status_code == 422
    assert taken.json()["error"]["message"] == "door osc has this port"
    other_program = DatagramSocket(HERE, first)
    used = _switch(fresh_lab, "json", is_open=True, port=first)["doors"][2]
    assert (used["state"], used["trouble"]) == ("failed", "port_in_use")
    other_program.close()
    for door, port in (("osc", second), ("json", first)):
        _switch(fresh_lab, door, is_open=False, port=port)


def _put(lab: Lab, door: str, *, is_open: bool, port: int) -> Response:
    body = {"is_open": is_open, "interface": HERE, "port": port}
    return lab.operator.put(f"/api/trackers/doors/{door}", json=body)


def _switch(lab: Lab, door: str, *, is_open: bool, port: int) -> Json:
    view: Json = ok(_put(lab, door, is_open=is_open, port=port))
    return view
