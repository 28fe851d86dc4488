"""Format what the terminal shows about a starting server and its certificate."""

import json
import sys
from collections.abc import Mapping

from app.lan import Mode, Reach, qr_terminal
from app.lan.serving import Identity

WITHOUT_TLS = """
  !!  WITHOUT ENCRYPTION  !!
  Everybody on this network can read passwords, answers and movement, and change them.
  Headsets refuse to enter VR on these addresses. Use --lan instead.
"""


_NO_TABLET: Mapping[Mode, str] = {
    "loopback": "only this computer can reach the server; for tablets start it with --lan",
    "lan": "this computer is not connected to a network",
    "without_tls": "this computer is not connected to a network",
}


def addresses(reach: Reach, data: str) -> str:
    """Return the addresses of the server, one per line."""
    lines = [
        f"Reembody   {reach.local_url}",
        f"Tablet     {reach.for_tablets or _NO_TABLET[reach.mode]}",
        f"Data       {data}",
    ]
    if reach.urls:
        lines += ["Network    " + "\n           ".join(reach.urls)]
    if reach.mode == "without_tls":
        lines.append(WITHOUT_TLS)
    if reach.certificate is not None:
        lines += _certificate(reach)
    return "\n".join(lines)


def _certificate(reach: Reach) -> list[str]:
    shown = reach.certificate
    assert shown is not None  # noqa: S101 - asked for above
    lines = [f"Valid      until {shown.expires_at:%Y-%m-%d}, then renewed automatically"]
    if shown.source == "files":
        lines = [f"Valid      until {shown.expires_at:%Y-%m-%d} (your own certificate)"]
    if shown.uncovered:
        lines.append(f"Careful    the certificate is not valid for {', '.join(shown.uncovered)}")
    if reach.help_url is not None:
        lines += [
            "",
            f"First time with a device?  {reach.help_url}",
            "Compare the fingerprint there with this one before you install (SHA-256):",
            *_halves(shown.authority_fingerprint or ""),
        ]
        if sys.stdout.isatty():
            lines.append(qr_terminal(reach.help_url))
    return lines


def _halves(fingerprint: str) -> list[str]:
    middle = len(fingerprint) // 2
    return [f"  {fingerprint[:middle]}", f"  {fingerprint[middle + 1 :]}"]


def certificate_text(identity: Identity, *, as_json: bool) -> str:
    """Describe a certificate, line by line or as JSON."""
    facts = {
        "source": identity.source,
        "hosts": [str(one) for one in identity.hosts],
        "expires_at": identity.expires_at.isoformat(),
        "server_fingerprint_sha256": identity.server_fingerprint,
        "authority_fingerprint_sha256": identity.authority_fingerprint,
        "authority_expires_at": (
            None
            if identity.authority is None
            else identity.authority.not_valid_after_utc.isoformat()
        ),
        "uncovered_addresses": [str(one) for one in identity.uncovered],
    }
    if as_json:
        return json.dumps(facts, indent=2)
    return "\n".join(
        f"{name.replace('_', ' '):<29} {', '.join(value) if isinstance(value, list) else value}"
        for name, value in facts.items()
        if value
    )
