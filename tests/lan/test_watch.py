"""Tests that the certificate changes while the server runs, without breaking connections."""

import asyncio
import ssl
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from ipaddress import ip_address
from pathlib import Path

import pytest
from cryptography import x509
from cryptography.hazmat.primitives.serialization import Encoding

from app.clock import Clock
from app.lan.network import Network
from app.lan.serving.certificates import LabAuthority
from app.lan.serving.leaf import hosts_of
from app.lan.serving.listening import tls_context
from app.lan.serving.plan import Plan, make_plan
from app.lan.serving.watch import CertificateWatch
from app.settings import Settings
from tests.lan.machines import LAB_PC

OTHER_NETWORK = replace(LAB_PC, addresses=(ip_address("10.8.0.3"),))


class Lab:
    """A machine that changes networks, a clock that is set by hand, and a certificate watch."""

    def __init__(self, folder: Path) -> None:
        self.machine, self.now = LAB_PC, datetime.now(UTC)
        clock = Clock(utc_now=lambda: self.now)
        self.plan: Plan = make_plan(Settings(data_dir=folder, lan=True), clock)
        self.tls = tls_context()
        self.watch = CertificateWatch(self.plan, Network(), self.tls, look=lambda: self.machine)
        self.watch.refresh()

    @property
    def authority(self) -> LabAuthority:
        """The lab's authority."""
        source = self.plan.certificates
        assert isinstance(source, LabAuthority)
        return source


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    """Return a lab with its first certificate."""
    return Lab(tmp_path)


def trust(lab: Lab) -> ssl.SSLContext:
    """Return the TLS context of a device that installs the current authority's certificate."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    pem = lab.watch.authority().public_bytes(Encoding.PEM)
    context.load_verify_locations(cadata=pem.decode("ascii"))
    return context


async def _echo(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    while line := await reader.readline():
        writer.write(line)
    writer.close()


async def _connected(
    port: int, device: ssl.SSLContext, host: str
) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    return await asyncio.open_connection("127.0.0.1", port, ssl=device, server_hostname=host)


async def _change_under_open_connection(lab: Lab) -> tuple[bytes, tuple[object, ...]]:
    """Return an open connection's answer after the change, and the next certificate's hosts."""
    device = trust(lab)
    server = await asyncio.start_server(_echo, "127.0.0.1", 0, ssl=lab.tls)
    port = server.sockets[0].getsockname()[1]
    reader, writer = await _connected(port, device, "192.168.7.20")
    lab.machine = OTHER_NETWORK
    lab.watch.refresh()
    writer.write(b"still here\n")
    answered = await reader.readline()
    _, another = await _connected(port, device, "10.8.0.3")
    shown = another.get_extra_info("ssl_object").getpeercert(binary_form=True)
    writer.close()
    another.close()
    server.close()
    return answered, hosts_of(x509.load_der_x509_certificate(shown))


def test_a_network_change_renews_the_certificate_without_a_restart(lab: Lab) -> None:
    """After a network change open connections continue and new ones get a new certificate."""
    answered, hosts = asyncio.run(_change_under_open_connection(lab))
    assert answered == b"still here\n"
    assert ip_address("10.8.0.3") in hosts
    assert lab.watch.network.reach.urls[0] == "https://10.8.0.3:8443"
    assert lab.watch.network.reach.help_url == "http://10.8.0.3:8080"


def test_a_certificate_near_its_end_is_renewed(lab: Lab) -> None:
    """A running server renews its certificate before it expires."""
    first = lab.watch.network.reach.certificate
    assert first is not None
    lab.now = first.expires_at - timedelta(days=20)
    lab.watch.refresh()
    second = lab.watch.network.reach.certificate
    assert second is not None
    assert second.expires_at > first.expires_at
    assert second.authority_fingerprint == first.authority_fingerprint


def test_a_new_authority_reaches_the_help_page(lab: Lab) -> None:
    """The help page serves the current authority, not that of the start."""
    before = lab.watch.authority()
    lab.authority.replace_authority(LAB_PC)
    lab.watch.refresh()
    assert lab.watch.authority() != before


def test_an_unchanged_certificate_is_not_rewritten(lab: Lab) -> None:
    """Refreshing without a change does not rewrite the certificate file."""
    before = lab.authority.server_file.stat().st_mtime_ns
    lab.watch.refresh()
    assert lab.authority.server_file.stat().st_mtime_ns == before


def test_a_machine_without_a_network_still_serves_itself(lab: Lab) -> None:
    """A machine without a network is still reachable at its local address."""
    lab.machine = replace(LAB_PC, addresses=())
    lab.watch.refresh()
    reach = lab.watch.network.reach
    assert reach.local_url == "http://127.0.0.1:8321"
    assert reach.urls == ("https://labpc.local:8443", "https://labpc.psy.example:8443")
