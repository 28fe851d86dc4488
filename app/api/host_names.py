"""Which names this server answers to: no page of the internet may pass for it.

A hostile page can make its own name lead to an address inside the lab (DNS rebinding); the browser
then takes this server for that page's own. It cannot do so under a name that only a local network
gives out, nor under an address.
"""

from collections.abc import Iterable
from ipaddress import ip_address
from urllib.parse import urlsplit

from app.errors import NotAllowed

LOCAL_ENDINGS = (".local", ".localhost", ".lan", ".home.arpa", ".internal")


def require_known_host(host: str, known: Iterable[str]) -> None:
    """Raise NotAllowed where a request asks for this server under a name of somebody else's.

    `host` is the Host header; `known` are the names that the lab gave to the server.
    """
    name = (urlsplit(f"//{host}").hostname or "").rstrip(".")
    if "." not in name or name.endswith(LOCAL_ENDINGS) or _is_address(name):
        return
    if name not in {one.lower() for one in known}:
        raise NotAllowed(
            "this server is not known by that name",
            value=host,
            valid="an address, a name of the local network, or one of REEMBODY_HOST_NAMES",
            remedy='Set REEMBODY_HOST_NAMES=["name.example.org"] where the lab gave it that name.',
        )


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True
