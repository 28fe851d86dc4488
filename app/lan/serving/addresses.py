"""Determine this machine's names and addresses.

Nothing is sent for this: the interfaces are listed, and the kernel is asked which of them it would
use for the internet.
"""

import re
import socket
from dataclasses import dataclass
from ipaddress import IPv4Address, IPv6Address, ip_address

import psutil

Address = IPv4Address | IPv6Address
LOOPBACK: tuple[Address, ...] = (IPv4Address("127.0.0.1"), IPv6Address("::1"))
_DNS_NAME = re.compile(r"(?=.{1,253}$)[a-z0-9]([a-z0-9-]{0,61}[a-z0-9])?(\.[a-z0-9-]{1,63})*")
# Reserved for documentation: no packet is sent, the kernel only chooses an interface.
_SOMEWHERE = (
    (socket.AF_INET, "192.0.2.1"),
    (socket.AF_INET6, "2001:db8::1"),
)


@dataclass(frozen=True)
class Machine:
    """The `names` of a machine, and its `addresses` without the loopback, the likeliest first."""

    names: tuple[str, ...]
    addresses: tuple[Address, ...]


def current_machine() -> Machine:
    """Return this machine's current names and addresses, which change with its network."""
    return Machine(names=host_names(socket.gethostname()), addresses=_addresses())


def host_names(host: str) -> tuple[str, ...]:
    """Return the names of a host: its first part in the local network, and its full name.

    `.local` names are found without a name server (multicast DNS). A name of one part is left out:
    an authority that may sign `dev` may sign all of `.dev`.
    """
    full = host.lower().rstrip(".")
    if not _DNS_NAME.fullmatch(full):
        return ()
    local = f"{full.partition('.')[0]}.local"
    return tuple(dict.fromkeys((local, full))) if "." in full else (local,)


def url_host(address: Address | str) -> str:
    """Return an address as written in a URL: IPv6 in brackets."""
    text = str(address)
    return f"[{text}]" if ":" in text else text


def _addresses() -> tuple[Address, ...]:
    up = {name for name, state in psutil.net_if_stats().items() if state.isup}
    found = [
        ip_address(one.address)
        for name, group in psutil.net_if_addrs().items()
        if name in up
        for one in group
        # Link-local IPv6 is valid on one interface only, which a URL cannot specify.
        if one.family in (socket.AF_INET, socket.AF_INET6) and "%" not in one.address
    ]
    usable = {one for one in found if not (one.is_loopback or one.is_link_local)}
    # An address of 169.254/16 means that none was assigned, as with two machines on one cable.
    if not usable:
        usable = {one for one in found if one.version == 4 and not one.is_loopback}
    likeliest = _ways_out()
    return tuple(sorted(usable, key=lambda one: (one not in likeliest, one.version, int(one))))


def _ways_out() -> set[Address]:
    found: set[Address] = set()
    for family, somewhere in _SOMEWHERE:
        try:
            with socket.socket(family, socket.SOCK_DGRAM) as probe:
                probe.connect((somewhere, 9))
                found.add(ip_address(probe.getsockname()[0].partition("%")[0]))
        except OSError:
            continue
    return found
