"""Response models of the lab's network."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel


class AddressView(BaseModel):
    """An address for devices, with the QR codes of the tablet's and headset's pages there."""

    url: str
    tablet_url: str
    tablet_qr_svg: str
    headset_url: str
    headset_qr_svg: str


class CertificateView(BaseModel):
    """The certificate of the HTTPS server.

    `source` is `authority` (the built-in one, which devices install) or `files` (the lab's own).
    `fingerprint` is the SHA-256 that a device shows: of the authority, or of the lab's certificate.
    `uncovered` are addresses of this machine that the certificate is not valid for.
    """

    source: Literal["authority", "files"]
    fingerprint: str
    server_fingerprint: str
    expires_at: datetime
    authority_expires_at: datetime | None
    uncovered: list[str]


class HelpView(BaseModel):
    """The help page, over plain HTTP, from which a device installs the lab's certificate."""

    url: str
    qr_svg: str


class CableView(BaseModel):
    """The connection of a headset by USB: run `command` here, then open `url` in the headset."""

    command: str
    url: str


class NetworkView(BaseModel):
    """The ways in which devices currently reach the server.

    `mode` is `loopback` (this machine only), `lan` (with HTTPS) or `without_tls` (unencrypted).
    """

    mode: Literal["loopback", "lan", "without_tls"]
    local_url: str
    addresses: list[AddressView]
    certificate: CertificateView | None
    help: HelpView | None
    cable: CableView
