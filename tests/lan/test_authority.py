"""What the lab's authority may vouch for, and that nobody believes more of it."""

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
    """An authority made on the lab's computer."""
    return new_authority(LAB_PC, datetime.now(UTC))


def client_accepts(authority: Authority, hosts: tuple[Host, ...], asked: Host) -> bool:
    """Whether a TLS client that trusts the authority goes on when it asks for `asked`.

    A whole handshake in memory, between Python's own (OpenSSL's) client and a server that shows a
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
    asking = client.wrap_bio(back, there, server_hostname=str(asked))
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


def library_accepts(authority: Authority, hosts: tuple[Host, ...], asked: Host) -> bool:
    """The same by the verifier of `cryptography`, written independently after RFC 5280."""
    leaf = new_leaf(authority, hosts, datetime.now(UTC)).certificate
    subject = x509.DNSName(asked) if isinstance(asked, str) else x509.IPAddress(asked)
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
    """Private addresses, local names and the machine's own name, in a real handshake."""
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
def test_a_stolen_key_cannot_pretend_to_be_anybody_else(authority: Authority, host: Host) -> None:
    """Signing is not enough: devices refuse what the authority's certificate rules out."""
    assert not authority.permits(host)
    assert not client_accepts(authority, (host,), host)


def test_two_independent_verifiers_agree_on_names(authority: Authority) -> None:
    """`cryptography` judges names as OpenSSL does: the lab's own yes, anybody else's no."""
    assert library_accepts(authority, ("labpc.local",), "labpc.local")
    assert not library_accepts(authority, ("bank.example",), "bank.example")
    # One foreign name spoils the whole certificate.
    assert not library_accepts(authority, ("labpc.local", "bank.example"), "labpc.local")


def test_it_cannot_make_another_authority(authority: Authority) -> None:
    """Path length 0, critical: what it signs are servers, valid for no longer than itself."""
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


def test_it_lasts_ten_years_also_from_a_leap_day() -> None:
    """Ten years to the day; from 29 February to 28 February."""
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
    """Only names with a place in them are vouched for."""
    assert host_names(host) == expected


def test_a_public_address_is_permitted_alone() -> None:
    """A university gives its machines public addresses: that one counts, its neighbour does not."""
    own: Address = ip_address("203.0.113.9")
    authority = new_authority(Machine(("labpc.local",), (own,)), NOW)
    assert authority.permits(own)
    assert not authority.permits(ip_address("203.0.113.10"))
    assert own in permitted_hosts(Machine(("labpc.local",), (own,)), authority)


def test_reading_gives_back_what_was_written(authority: Authority) -> None:
    """One file holds key and certificate; a key of another certificate is refused."""
    again = authority_from_pem(authority.as_pem())
    assert fingerprint(again.certificate) == fingerprint(authority.certificate)
    other = new_authority(LAB_PC, NOW)
    mixed = other.as_pem().partition(b"-----BEGIN CERTIFICATE")[0] + (
        authority.certificate.public_bytes(Encoding.PEM)
    )
    with pytest.raises(ValueError, match="does not belong"):
        authority_from_pem(mixed)


def test_the_fingerprint_is_the_one_that_other_programs_show(authority: Authority) -> None:
    """Compared with Python's own SSL module and hashlib over the DER bytes."""
    der = ssl.PEM_cert_to_DER_cert(authority.certificate.public_bytes(Encoding.PEM).decode("ascii"))
    assert fingerprint(authority.certificate).replace(":", "").lower() == (
        hashlib.sha256(der).hexdigest()
    )
