"""The addresses of the running server, as shown by pages, terminals and QR codes.

There is one `Network` per process, which always has the newest `Reach`: a laptop that joins another
Wi-Fi gets other addresses and another certificate while the server runs.
"""

import io
from dataclasses import dataclass, field
from datetime import datetime
from ipaddress import ip_address
from typing import Literal
from urllib.parse import urlsplit

import segno

Mode = Literal["loopback", "lan", "without_tls"]
DEFAULT_PORT = 8321
STRANGER = "reembody.stranger"
"""Marks the ASGI scope of a request without login or pairing, for the protocol that serves it."""


@dataclass(frozen=True)
class ShownCertificate:
    """The certificate of the https address.

    `authority_fingerprint` is that of the certificate which devices install.
    """

    source: Literal["authority", "files"]
    server_fingerprint: str
    authority_fingerprint: str | None
    expires_at: datetime
    authority_expires_at: datetime | None
    uncovered: tuple[str, ...] = ()


@dataclass(frozen=True)
class Reach:
    """The server's addresses (URLs without a trailing slash), the best one first.

    `loopback`: only this machine, and headsets on its USB cable. `lan`: also https at `urls`.
    `without_tls`: plain http at `urls`, without encryption and without WebXR.
    """

    mode: Mode = "loopback"
    local_url: str = f"http://127.0.0.1:{DEFAULT_PORT}"
    urls: tuple[str, ...] = ()
    help_url: str | None = None
    certificate: ShownCertificate | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The host names of the addresses: the lab's own certificate may be for a full name."""
        return tuple(urlsplit(url).hostname or "" for url in self.urls)

    @property
    def port(self) -> int:
        """The port on this machine, which a USB cable forwards to."""
        return urlsplit(self.local_url).port or DEFAULT_PORT

    def for_devices(self, asked_at: str) -> str | None:
        """Return the address for another device, given the URL `asked_at` of the requested page.

        Every page, command and QR code that shows an address for a tablet, a headset or another
        person's computer uses this. A page on this machine has the address `localhost`, which for
        the tablet is the tablet itself: then it is the best address of the network, or None if only
        this machine can reach the server.
        """
        if not is_this_machine(urlsplit(asked_at).hostname or ""):
            return asked_at.rstrip("/")
        return self.urls[0] if self.urls else None

    @property
    def for_tablets(self) -> str | None:
        """The tablet's page for another device; None if only this machine can reach it."""
        base = self.for_devices(self.local_url)
        return None if base is None else f"{base}/tablet"


@dataclass
class Network:
    """Holds the newest reach, which is replaced as a whole, so any thread may read it."""

    reach: Reach = field(default_factory=Reach)


def is_this_machine(host: str) -> bool:
    """Return whether a host name refers to the local machine everywhere, as `localhost` does."""
    name = host.lower().rstrip(".")
    if name in ("", "localhost") or name.endswith(".localhost"):
        return True
    try:
        address = ip_address(name.partition("%")[0])
    except ValueError:
        return False
    mapped = getattr(address, "ipv4_mapped", None) or address
    return bool(mapped.is_loopback or mapped.is_unspecified)


def qr_svg(text: str) -> str:
    """Return a QR code as an SVG element without a fixed size."""
    buffer = io.BytesIO()
    segno.make(text, error="m").save(
        buffer, kind="svg", xmldecl=False, svgns=True, border=2, scale=1, omitsize=True
    )
    return buffer.getvalue().decode()


def qr_terminal(text: str) -> str:
    """Return a QR code in half blocks, two rows per line."""
    buffer = io.StringIO()
    segno.make(text, error="l").terminal(buffer, compact=True, border=2)
    return buffer.getvalue()
