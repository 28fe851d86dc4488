"""The lab's own certificate authority, whose key can sign for the lab's machines only.

A device that installs its certificate trusts whatever the key signs. So the certificate itself
limits what that may be: private addresses, names that exist in local networks only, and the names
and addresses that this machine had when the authority was created (RFC 5280, 4.2.1.10). With a
stolen key one can impersonate the lab's server, but no bank.
"""

from dataclasses import dataclass
from datetime import datetime, timedelta
from ipaddress import ip_network

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID

from app.lan.serving.addresses import Address, Machine

YEARS = 10
SKEW = timedelta(hours=1)
"""Certificates are valid from this long before their creation: tablets' clocks are not exact."""
NETWORKS = (
    *("10.0.0.0/8", "172.16.0.0/12", "192.168.0.0/16", "169.254.0.0/16", "127.0.0.0/8"),
    *("fc00::/7", "fe80::/10", "::1/128"),
)
DOMAINS = ("localhost", "local", "lan", "home.arpa", "internal")


@dataclass(frozen=True)
class Authority:
    """A certificate authority: its certificate and private key."""

    certificate: x509.Certificate
    key: ec.EllipticCurvePrivateKey

    def permits(self, host: Address | str) -> bool:
        """Return whether devices would accept its certificate for this address or name."""
        permitted = self._constraints().permitted_subtrees or []
        if isinstance(host, str):
            domains = [one.value for one in permitted if isinstance(one, x509.DNSName)]
            return any(host == domain or host.endswith(f".{domain}") for domain in domains)
        networks = [one.value for one in permitted if isinstance(one, x509.IPAddress)]
        return any(host in ip_network(network) for network in networks)

    def as_pem(self) -> bytes:
        """Return key and certificate in one file, so that they cannot be separated."""
        return key_pem(self.key) + self.certificate.public_bytes(serialization.Encoding.PEM)

    def _constraints(self) -> x509.NameConstraints:
        return self.certificate.extensions.get_extension_for_class(x509.NameConstraints).value


def new_authority(machine: Machine, now: datetime) -> Authority:
    """Create an authority for `machine`, valid for ten years from `now`."""
    key = ec.generate_private_key(ec.SECP256R1())
    host = machine.names[-1].removesuffix(".local") if machine.names else "this machine"
    name = x509.Name(
        [
            # The month distinguishes two authorities of one lab in a list.
            x509.NameAttribute(NameOID.COMMON_NAME, f"Reembody on {host[:40]} ({now:%Y-%m})"),
            x509.NameAttribute(NameOID.ORGANIZATION_NAME, "Reembody, the lab's own authority"),
        ]
    )
    identifier = x509.SubjectKeyIdentifier.from_public_key(key.public_key())
    certificate = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - SKEW)
        .not_valid_after(_years_later(now, YEARS))
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_may_sign_certificates(), critical=True)
        .add_extension(_limits(machine), critical=True)
        .add_extension(identifier, critical=False)
        .sign(key, hashes.SHA256())
    )
    return Authority(certificate, key)


def authority_from_pem(pem: bytes) -> Authority:
    """Parse the result of `as_pem`; raise ValueError if it is something else."""
    key = serialization.load_pem_private_key(pem, password=None)
    certificate = x509.load_pem_x509_certificate(pem)
    if not isinstance(key, ec.EllipticCurvePrivateKey) or key.public_key() != (
        certificate.public_key()
    ):
        raise ValueError("the key does not belong to the certificate")
    return Authority(certificate, key)


def key_pem(key: ec.EllipticCurvePrivateKey) -> bytes:
    """Return a private key as PEM, unencrypted: the server must start unattended."""
    return key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )


def fingerprint(certificate: x509.Certificate) -> str:
    """Return the SHA-256 of a certificate as devices show it: pairs of digits with colons."""
    return certificate.fingerprint(hashes.SHA256()).hex(":").upper()


def _limits(machine: Machine) -> x509.NameConstraints:
    networks = [ip_network(text) for text in NETWORKS]
    here = [ip_network(one) for one in machine.addresses]
    outside = [one for one in here if not any(one[0] in network for network in networks)]
    domains = dict.fromkeys((*DOMAINS, *machine.names))
    return x509.NameConstraints(
        permitted_subtrees=[
            *(x509.DNSName(domain) for domain in domains),
            *(x509.IPAddress(network) for network in (*networks, *outside)),
        ],
        excluded_subtrees=None,
    )


def _may_sign_certificates() -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=False,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=True,
        crl_sign=True,
        encipher_only=False,
        decipher_only=False,
    )


def _years_later(now: datetime, years: int) -> datetime:
    try:
        return now.replace(year=now.year + years)
    except ValueError:  # 29 February
        return now.replace(year=now.year + years, day=28)
