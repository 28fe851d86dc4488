"""Who is told what: news reach those who asked for them, and need not be made for nobody."""

import asyncio
from typing import Any

from app.platform.hub import Hub


async def heard_by(hub: Hub, *more: str) -> dict[str, Any]:
    """What a reader of session `a` hears of a change, of figures, and of another session."""
    with hub.subscribe("a", *more) as subscription:
        hub.publish("a", "telemetry", {"fps": 90})
        hub.publish("a", "session")
        hub.publish("b", "session")
        await asyncio.sleep(0.01)
        return await subscription.next(1.0)


def test_everybody_hears_of_changes_and_only_the_console_of_figures() -> None:
    """Headset and tablet follow the session; a page that shows figures asks for them."""
    assert asyncio.run(heard_by(Hub())) == {"session": None}
    assert asyncio.run(heard_by(Hub(), "telemetry")) == {
        "session": None,
        "telemetry": {"fps": 90},
    }


def test_figures_have_listeners_while_somebody_asked_for_them() -> None:
    """A headset that follows its own session is none."""

    async def look() -> list[bool]:
        hub = Hub()
        seen = [hub.has_listeners("a", "telemetry")]
        with hub.subscribe("a"):
            seen.append(hub.has_listeners("a", "telemetry"))
            with hub.subscribe("a", "telemetry"):
                seen += [hub.has_listeners("a", "telemetry"), hub.has_listeners("b", "telemetry")]
        return [*seen, hub.has_listeners("a", "telemetry")]

    assert asyncio.run(look()) == [False, False, True, False, False]


def test_frames_of_any_socket_of_a_session_are_its_frames() -> None:
    """They are forgotten with the last of its headsets."""
    hub = Hub()
    hub.headset_joined("a")
    hub.headset_joined("a")
    assert hub.frames_heard_s("a") == float("-inf")
    hub.note_frames("a", 12.0)
    hub.headset_left("a")
    assert hub.frames_heard_s("a") == 12.0
    hub.headset_left("a")
    assert hub.frames_heard_s("a") == float("-inf")
