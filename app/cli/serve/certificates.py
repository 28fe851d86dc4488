"""The certificate of the lab's network: what it is, and a new one."""

import json

from app.cli.serve.run import settings_with
from app.clock import Clock
from app.errors import InvalidInput
from app.lan.serving import Identity, LabAuthority, look_around, make_plan


def show_certificate(*, as_json: bool) -> str:
    """The certificate that `serve --lan` shows; the built-in one is made if there is none."""
    plan = make_plan(settings_with({"lan": True, "without_tls": False}), Clock())
    assert plan.certificates is not None  # noqa: S101 - asked for with lan
    return _told(plan.certificates.current(look_around()), as_json=as_json)


def renew_certificate(*, new_authority: bool, as_json: bool) -> str:
    """A new certificate of the built-in authority; a running server takes it within a minute.

    With `new_authority` also a new authority: every device then has to install it.
    """
    plan = make_plan(settings_with({"lan": True, "without_tls": False}), Clock())
    source, machine = plan.certificates, look_around()
    if not isinstance(source, LabAuthority):
        raise InvalidInput(
            "the certificate is your own file, which only you can renew",
            remedy="Put the new one in its place; a running server takes it within a minute",
        )
    if new_authority:
        source.replace_authority(machine)
    return _told(source.renew(machine), as_json=as_json)


def _told(identity: Identity, *, as_json: bool) -> str:
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
