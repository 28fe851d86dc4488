"""When a NatNet client asks its server for what; a function of time and of what was read."""

from app.adapters.live import NatNetClient, Reading, connect_request, keep_alive, model_request

ASK_EVERY_S = 1.0
LOST_S = 3.0
"""A server that said nothing for so long was perhaps restarted: connect again."""


class NatNetLink:
    """The conversation with one server: connect, ask for names, stay connected."""

    def __init__(self) -> None:
        self.client = NatNetClient()
        self._heard_s = float("-inf")
        self._asked_s = float("-inf")
        self._has_names = False

    def read(self, packet: bytes, now_s: float) -> Reading:
        """Return what a packet says."""
        self._heard_s = now_s
        return self.client.read(packet)

    def due(self, now_s: float) -> bytes | None:
        """Return the request to send now, if any."""
        if self.client.version is not None and not self._has_names:
            self._has_names, self._asked_s = True, now_s
            return model_request()
        if now_s - self._asked_s < ASK_EVERY_S:
            return None
        self._asked_s = now_s
        if self.client.version is None or now_s - self._heard_s > LOST_S:
            self._has_names = False
            return connect_request()
        return model_request() if self.client.unnamed else keep_alive()
