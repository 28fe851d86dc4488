"""Tests of the live hub: messages reach the subscribers that requested them."""

import asyncio
from datetime import UTC, datetime
from typing import Any

from app.platform.hub import Hub


async def heard_by(hub: Hub, *more: str) -> dict[str, Any]:
    """Return the messages that a subscriber of session `a` receives about `a` and `b`."""
    with hub.subscribe("a", *more) as subscription:
        hub.publish("a", "telemetry", {"fps": 90})
        hub.publish("a", "session")
        hub.publish("b", "session")
        await asyncio.sleep(0.01)
        return await subscription.next(1.0)


def test_figures_reach_only_those_that_subscribed_to_them() -> None:
    """All subscribers of a session get its changes, but figures only if they requested them."""
    assert asyncio.run(heard_by(Hub())) == {"session": None}
    assert asyncio.run(heard_by(Hub(), "telemetry")) == {
        "session": None,
        "telemetry": {"fps": 90},
    }


def test_figures_have_listeners_while_someone_is_subscribed() -> None:
    """The hub has listeners for figures only while someone is subscribed to them."""

    async def look() -> list[bool]:
        hub = Hub()
        seen = [hub.has_listeners("a", "telemetry")]
        with hub.subscribe("a"):
            seen.append(hub.has_listeners("a", "telemetry"))
            with hub.subscribe("a", "telemetry"):
                seen += [hub.has_listeners("a", "telemetry"), hub.has_listeners("b", "telemetry")]
        return [*seen, hub.has_listeners("a", "telemetry")]

    assert asyncio.run(look()) == [False, False, True, False, False]


def test_a_headset_was_last_there_when_its_last_socket_closed() -> None:
    """The time of a loss is that of the last socket's end, and of no socket that still serves."""
    hub = Hub()
    hub.headset_joined("a")
    hub.headset_joined("a")
    hub.headset_left("a", datetime(2026, 3, 2, 9, 30, tzinfo=UTC))
    assert hub.headset_left_at("a") is None
    lost = datetime(2026, 3, 2, 9, 45, tzinfo=UTC)
    hub.headset_left("a", lost)
    assert hub.headset_left_at("a") == lost


def test_frames_of_any_socket_of_a_session_are_its_frames() -> None:
    """The time of a session's last frame is kept until the last of its headsets disconnects."""
    hub = Hub()
    hub.headset_joined("a")
    hub.headset_joined("a")
    assert hub.frames_heard_s("a") == float("-inf")
    hub.note_frames("a", 12.0)
    hub.headset_left("a")
    assert hub.frames_heard_s("a") == 12.0
    hub.headset_left("a")
    assert hub.frames_heard_s("a") == float("-inf")
