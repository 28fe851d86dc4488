"""Tests of the hosts for which the lab's authority can issue certificates that clients accept."""

import hashlib
import ssl
from datetime import UTC, datetime, timedelta
from ipaddress import ip_address
from tempfile import NamedTemporaryFile

import pytest
from cryptography import x509
from cryptography.hazmat.primitives.serialization import Encoding
from cryptography.x509.verification import PolicyBuilder, Store, VerificationError

from app.lan.serving.addresses import Address, Machine, host_names
from app.lan.serving.authority import Authority, authority_from_pem, fingerprint, new_authority
from app.lan.serving.leaf import Host, new_leaf, permitted_hosts
from app.lan.serving.listening import tls_context
from tests.lan.machines import LAB_PC, NOW


@pytest.fixture(scope="module")
def authority() -> Authority:
    """Return an authority created on the lab's computer."""
    return new_authority(LAB_PC, datetime.now(UTC))


def client_accepts(authority: Authority, hosts: tuple[Host, ...], requested: Host) -> bool:
    """Return whether a TLS client that trusts the authority accepts a server as `requested`.

    Performs a whole handshake in memory between Python's own (OpenSSL's) client and a server with a
    certificate for `hosts`.
    """
    server, client = tls_context(), ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    with NamedTemporaryFile(suffix=".pem") as shown:
        shown.write(new_leaf(authority, hosts, datetime.now(UTC)).pem)
        shown.flush()
        server.load_cert_chain(shown.name)
    client.verify_flags |= ssl.VERIFY_X509_STRICT
    client.load_verify_locations(
        cadata=authority.certificate.public_bytes(Encoding.PEM).decode("ascii")
    )
    there, back = ssl.MemoryBIO(), ssl.MemoryBIO()
    asking = client.wrap_bio(back, there, server_hostname=str(requested))
    answering = server.wrap_bio(there, back, server_side=True)
    for _ in range(4):
        for side in (asking, answering):
            try:
                side.do_handshake()
            except ssl.SSLWantReadError:
                continue
            except ssl.SSLCertVerificationError:
                return False
    return asking.version() is not None


def library_accepts(authority: Authority, hosts: tuple[Host, ...], requested: Host) -> bool:
    """Return whether `cryptography`'s own verifier (RFC 5280) accepts a server as `requested`."""
    leaf = new_leaf(authority, hosts, datetime.now(UTC)).certificate
    subject = x509.DNSName(requested) if isinstance(requested, str) else x509.IPAddress(requested)
    builder = PolicyBuilder().store(Store([authority.certificate])).time(datetime.now(UTC))
    try:
        builder.build_server_verifier(subject).verify(leaf, [])
    except VerificationError:
        return False
    return True


@pytest.mark.parametrize(
    "host",
    [
        *("localhost", "labpc.local", "labpc.psy.example", "other.home.arpa", "printer.lan"),
        *(ip_address("192.168.7.20"), ip_address("10.1.2.3"), ip_address("172.31.0.9")),
        *(ip_address("127.0.0.1"), ip_address("fd12::20"), ip_address("169.254.8.1")),
    ],
)
def test_the_labs_own_hosts_are_accepted(authority: Authority, host: Host) -> None:
    """A client accepts the lab's private addresses, local names and own name."""
    assert authority.permits(host)
    assert client_accepts(authority, (host,), host)


@pytest.mark.parametrize(
    "host",
    [
        *("bank.example", "google.com", "local.example.com", "notlocal", "psy.example", "lab.dev"),
        *(ip_address("8.8.8.8"), ip_address("172.32.0.1"), ip_address("192.169.0.1")),
        ip_address("2001:4860:4860::8888"),
    ],
)
def test_a_certificate_for_a_foreign_host_is_not_accepted(authority: Authority, host: Host) -> None:
    """A client rejects a certificate that the authority signed for a host outside the lab."""
    assert not authority.permits(host)
    assert not client_accepts(authority, (host,), host)


def test_two_independent_verifiers_agree_on_names(authority: Authority) -> None:
    """`cryptography` accepts and rejects the same host names as OpenSSL."""
    assert library_accepts(authority, ("labpc.local",), "labpc.local")
    assert not library_accepts(authority, ("bank.example",), "bank.example")
    # One foreign name invalidates the whole certificate.
    assert not library_accepts(authority, ("labpc.local", "bank.example"), "labpc.local")


def test_the_authority_cannot_sign_another_authority(authority: Authority) -> None:
    """The authority's certificate allows no further authorities, and its servers expire with it."""
    basic = authority.certificate.extensions.get_extension_for_class(x509.BasicConstraints)
    limits = authority.certificate.extensions.get_extension_for_class(x509.NameConstraints)
    usage = authority.certificate.extensions.get_extension_for_class(x509.KeyUsage)
    assert (basic.critical, basic.value.ca, basic.value.path_length) == (True, True, 0)
    assert limits.critical
    assert (usage.critical, usage.value.key_cert_sign) == (True, True)
    assert not usage.value.digital_signature
    last_day = authority.certificate.not_valid_after_utc - timedelta(days=3)
    late = new_leaf(authority, ("localhost",), last_day)
    assert late.expires_at == authority.certificate.not_valid_after_utc


def test_the_authority_is_valid_for_ten_years() -> None:
    """The authority is valid for ten years; one made on 29 February ends on 28 February."""
    assert new_authority(LAB_PC, NOW).certificate.not_valid_after_utc == NOW.replace(year=2036)
    leap_day = NOW.replace(year=2028, month=2, day=29)
    ends = new_authority(LAB_PC, leap_day).certificate.not_valid_after_utc
    assert ends == leap_day.replace(year=2038, day=28)


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("labpc", ("labpc.local",)),
        ("LabPC.local", ("labpc.local",)),
        ("labpc.psy.example", ("labpc.local", "labpc.psy.example")),
        # As a name constraint, `dev` would permit every site of that domain.
        ("dev", ("dev.local",)),
        ("lab pc", ()),
        ("", ()),
    ],
)
def test_a_bare_host_name_never_becomes_a_domain(host: str, expected: tuple[str, ...]) -> None:
    """A bare host name becomes a `.local` name, never a whole domain."""
    assert host_names(host) == expected


def test_only_the_machines_own_public_address_is_permitted() -> None:
    """The authority permits the machine's own public address but not the adjacent one."""
    own: Address = ip_address("203.0.113.9")
    authority = new_authority(Machine(("labpc.local",), (own,)), NOW)
    assert authority.permits(own)
    assert not authority.permits(ip_address("203.0.113.10"))
    assert own in permitted_hosts(Machine(("labpc.local",), (own,)), authority)


def test_an_authority_survives_being_stored(authority: Authority) -> None:
    """An authority read back from its PEM is the same; a key of another certificate is refused."""
    repeated = authority_from_pem(authority.as_pem())
    assert fingerprint(repeated.certificate) == fingerprint(authority.certificate)
    other = new_authority(LAB_PC, NOW)
    mixed = other.as_pem().partition(b"-----BEGIN CERTIFICATE")[0] + (
        authority.certificate.public_bytes(Encoding.PEM)
    )
    with pytest.raises(ValueError, match="does not belong"):
        authority_from_pem(mixed)


def test_the_fingerprint_is_the_sha256_of_the_certificate(authority: Authority) -> None:
    """The fingerprint is the SHA-256 of the certificate's DER bytes, as other programs show it."""
    der = ssl.PEM_cert_to_DER_cert(authority.certificate.public_bytes(Encoding.PEM).decode("ascii"))
    assert fingerprint(authority.certificate).replace(":", "").lower() == (
        hashlib.sha256(der).hexdigest()
    )
