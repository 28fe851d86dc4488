"""The real server with its network ports open, on the loopback only."""

import ssl
from collections.abc import Sequence
from pathlib import Path

import httpx2

from tests.support.server import LiveServer, free_port


class LanServer(LiveServer):
    """`reembody serve --lan` with https and the help page on 127.0.0.1, each on a free port."""

    def __init__(self, folder: Path, *, arguments: Sequence[str] = ()) -> None:
        self.lan_port, self.help_port = free_port(), free_port()
        self._folder = folder
        super().__init__(
            folder,
            arguments=(
                *("--lan", "--lan-host", "127.0.0.1"),
                *("--lan-port", str(self.lan_port), "--help-port", str(self.help_port)),
                *arguments,
            ),
        )

    @property
    def secure_url(self) -> str:
        """Return the base URL of the https port."""
        return f"https://127.0.0.1:{self.lan_port}"

    @property
    def help_url(self) -> str:
        """Return the base URL of the help page."""
        return f"http://127.0.0.1:{self.help_port}"

    def authority(self) -> bytes:
        """Return the authority's certificate as a device receives it, in DER."""
        return httpx2.get(f"{self.help_url}/reembody-ca.crt").raise_for_status().content

    def trusting(self) -> ssl.SSLContext:
        """Return the TLS context of a device that installed only the authority's certificate."""
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.load_verify_locations(cadata=self.authority())
        return context

    def secure_client(self) -> httpx2.Client:
        """Return an https client that trusts the authority."""
        return httpx2.Client(base_url=self.secure_url, verify=self.trusting(), timeout=30.0)
