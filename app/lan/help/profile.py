"""The authority's certificate as an Apple configuration profile, installed in one go."""

import plistlib
from uuid import NAMESPACE_OID, uuid5

from cryptography import x509
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.serialization import Encoding
from cryptography.x509.oid import NameOID


def mobileconfig(authority: x509.Certificate) -> bytes:
    """An unsigned profile; the same certificate always gives the same, so it replaces itself."""
    digest = authority.fingerprint(hashes.SHA256()).hex()
    (name,) = authority.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
    identifier = f"reembody.authority.{digest[:16]}"
    payload = {
        "PayloadType": "com.apple.security.root",
        "PayloadVersion": 1,
        "PayloadIdentifier": f"{identifier}.certificate",
        "PayloadUUID": str(uuid5(NAMESPACE_OID, f"{digest}.certificate")).upper(),
        "PayloadDisplayName": str(name.value),
        "PayloadCertificateFileName": "reembody-ca.crt",
        "PayloadContent": authority.public_bytes(Encoding.DER),
    }
    return plistlib.dumps(
        {
            "PayloadType": "Configuration",
            "PayloadVersion": 1,
            "PayloadIdentifier": identifier,
            "PayloadUUID": str(uuid5(NAMESPACE_OID, digest)).upper(),
            "PayloadDisplayName": str(name.value),
            "PayloadDescription": "Lets this device trust the server of the lab, and nothing else.",
            "PayloadContent": [payload],
        }
    )
