"""The certificate of this server, signed by the lab's authority for all its names and addresses."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from ipaddress import IPv4Address, IPv6Address

from cryptography import x509
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from app.lan.serving.addresses import LOOPBACK, Address, Machine
from app.lan.serving.authority import SKEW, Authority, key_pem

LASTS = timedelta(days=397)
"""Validity of the certificate: browsers reject server certificates of more than 398 days."""
RENEWED_BEFORE = timedelta(days=30)
Host = Address | str


@dataclass(frozen=True)
class Leaf:
    """A server's certificate as PEM (key first, then the chain), and parsed."""

    pem: bytes
    certificate: x509.Certificate

    @property
    def hosts(self) -> tuple[Host, ...]:
        """The names and addresses for which the certificate is valid."""
        return hosts_of(self.certificate)

    @property
    def expires_at(self) -> datetime:
        """The time at which the certificate expires."""
        return self.certificate.not_valid_after_utc


def hosts_of(certificate: x509.Certificate) -> tuple[Host, ...]:
    """Return the names and addresses for which a certificate is valid; empty if it names none."""
    try:
        names = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return ()
    addresses: list[Address] = [
        one
        for one in names.get_values_for_type(x509.IPAddress)
        if isinstance(one, IPv4Address | IPv6Address)
    ]
    return (*names.get_values_for_type(x509.DNSName), *addresses)


def permitted_hosts(machine: Machine, authority: Authority) -> tuple[Host, ...]:
    """Return all names and addresses of this machine that the authority may sign."""
    hosts: Sequence[Host] = ("localhost", *machine.names, *LOOPBACK, *machine.addresses)
    return tuple(one for one in dict.fromkeys(hosts) if authority.permits(one))


def new_leaf(authority: Authority, hosts: Sequence[Host], now: datetime) -> Leaf:
    """Create a key and a certificate for `hosts`, valid for 397 days."""
    key = ec.generate_private_key(ec.SECP256R1())
    begin = now - SKEW
    certificate = (
        x509.CertificateBuilder()
        .subject_name(x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "Reembody server")]))
        .issuer_name(authority.certificate.subject)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(begin)
        .not_valid_after(min(begin + LASTS, authority.certificate.not_valid_after_utc))
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_may_sign_handshakes(), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .add_extension(
            x509.SubjectAlternativeName(
                [
                    x509.DNSName(one) if isinstance(one, str) else x509.IPAddress(one)
                    for one in hosts
                ]
            ),
            critical=False,
        )
        .add_extension(
            x509.AuthorityKeyIdentifier.from_issuer_public_key(authority.key.public_key()),
            critical=False,
        )
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
        .sign(authority.key, hashes.SHA256())
    )
    chain = (certificate, authority.certificate)
    pem = b"".join(one.public_bytes(serialization.Encoding.PEM) for one in chain)
    return Leaf(key_pem(key) + pem, certificate)


def leaf_from_pem(pem: bytes) -> Leaf:
    """Parse the result of `new_leaf`; raise ValueError if it is something else."""
    return Leaf(pem, x509.load_pem_x509_certificates(pem)[0])


def is_usable(leaf: Leaf, authority: Authority, hosts: Sequence[Host], now: datetime) -> bool:
    """Return whether a certificate can still be used.

    It must be signed by this authority, cover all hosts and be valid for another month.
    """
    try:
        leaf.certificate.verify_directly_issued_by(authority.certificate)
    except (ValueError, TypeError, InvalidSignature):
        return False
    ends = leaf.expires_at
    # A certificate that expires with its authority cannot be extended.
    lasts = ends - now > RENEWED_BEFORE or ends == authority.certificate.not_valid_after_utc
    return lasts and set(hosts) <= set(leaf.hosts)


def _general_name(host: Host) -> x509.GeneralName:
    return x509.DNSName(host) if isinstance(host, str) else x509.IPAddress(host)


def _may_sign_handshakes() -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=True,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=False,
        crl_sign=False,
        encipher_only=False,
        decipher_only=False,
    )
