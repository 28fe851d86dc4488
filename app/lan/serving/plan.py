"""Determine the listeners ("doors") for the settings, and whether they may be opened.

An address that others can reach is refused without encryption: passwords, answers and movement
would be readable by everybody on the network, and headsets would refuse WebXR.
"""

from dataclasses import dataclass
from ipaddress import ip_address

from app.clock import Clock
from app.errors import InvalidInput, NotAllowed
from app.lan.network import Mode, Reach, ShownCertificate
from app.lan.serving.addresses import Address, Machine, url_host
from app.lan.serving.certificates import CertificateSource, Identity, LabAuthority, OwnFiles
from app.settings import Settings

EVERYWHERE = ("0.0.0.0", "::")  # noqa: S104 - asked for with --lan, and encrypted


@dataclass(frozen=True)
class Plan:
    """The doors: plain http at `local_hosts`; with `certificates` https at `lan_hosts`.

    `help_port` is None if devices need not install anything.
    """

    mode: Mode
    local_hosts: tuple[str, ...]
    local_port: int
    lan_hosts: tuple[str, ...] = ()
    lan_port: int = 0
    help_port: int | None = None
    certificates: CertificateSource | None = None

    @property
    def local_url(self) -> str:
        """The address for this machine's own browser, and for a headset on its cable."""
        host = self.local_hosts[0]
        shown = "127.0.0.1" if host in EVERYWHERE else url_host(host)
        return f"http://{shown}:{self.local_port}"

    def reach(self, machine: Machine, identity: Identity | None) -> Reach:
        """Return how the server can be reached on `machine` with the certificate `identity`."""
        if self.mode == "loopback":
            return Reach(local_url=self.local_url)
        if identity is None:
            hosts = self._reachable(self.local_hosts, machine)
            urls = tuple(f"http://{url_host(one)}:{self.local_port}" for one in hosts)
            return Reach(mode=self.mode, local_url=self.local_url, urls=urls)
        shown = self._shown_hosts(machine, identity)
        urls = tuple(f"https://{url_host(one)}:{self.lan_port}" for one in shown)
        help_urls = [f"http://{url_host(one)}:{self.help_port}" for one in shown]
        return Reach(
            mode=self.mode,
            local_url=self.local_url,
            urls=urls,
            help_url=help_urls[0] if self.help_port and help_urls else None,
            certificate=_shown(identity),
        )

    def _shown_hosts(self, machine: Machine, identity: Identity) -> tuple[Address | str, ...]:
        addresses = self._reachable(self.lan_hosts, machine)
        covered = tuple(one for one in addresses if one in identity.hosts)
        names = tuple(one for one in identity.hosts if isinstance(one, str) and "*" not in one)
        if identity.source == "files":
            # The lab chose the names of its certificate, which seldom contains addresses.
            return (*names, *covered) or addresses
        # A name may resolve to any address of this machine, so use names only if all are served.
        named = [one for one in names if one in machine.names and self.lan_hosts == EVERYWHERE]
        return (*covered, *named) or addresses

    @staticmethod
    def _reachable(hosts: tuple[str, ...], machine: Machine) -> tuple[Address, ...]:
        if any(one in EVERYWHERE for one in hosts):
            return machine.addresses
        return tuple(ip_address(one) for one in hosts)


def make_plan(settings: Settings, clock: Clock) -> Plan:
    """Return the doors for `settings`; raise NotAllowed or InvalidInput with the alternatives."""
    _require_address("--lan-host", settings.lan_host)
    lan_hosts = (settings.lan_host,) if settings.lan_host else EVERYWHERE
    if settings.lan and settings.without_tls:
        return Plan("without_tls", lan_hosts, settings.port)
    if not is_loopback(settings.host):
        if settings.lan:
            raise InvalidInput(
                f"--lan keeps plain http on this machine, but --host is {settings.host}",
                remedy=f"Leave --host out, or use --lan-host {settings.host} for the https door",
            )
        if not settings.without_tls:
            raise _unencrypted(settings.host)
        _require_address("--host", settings.host)
        return Plan("without_tls", (settings.host,), settings.port)
    if not settings.lan:
        return Plan("loopback", (_local(settings.host),), settings.port)
    certificates = _certificates(settings, clock)
    _require_own_ports(settings)
    return Plan(
        mode="lan",
        local_hosts=(_local(settings.host),),
        local_port=settings.port,
        lan_hosts=lan_hosts,
        lan_port=settings.lan_port,
        help_port=settings.help_port if isinstance(certificates, LabAuthority) else None,
        certificates=certificates,
    )


def _certificates(settings: Settings, clock: Clock) -> CertificateSource:
    certificate, key = settings.certificate, settings.key
    if certificate is None and key is None:
        return LabAuthority(settings.data_dir, clock)
    if certificate is None or key is None:
        raise InvalidInput(
            "--certificate and --key belong together",
            remedy="Name both files, or neither to use the built-in authority",
        )
    return OwnFiles(certificate, key, clock)


def _require_own_ports(settings: Settings) -> None:
    """Raise InvalidInput if two doors have the same port.

    The operating system lets two sockets bind one port until they listen; then one gets no
    requests.
    """
    options = {"--port": settings.port, "--lan-port": settings.lan_port}
    if settings.certificate is None:
        options["--help-port"] = settings.help_port
    for number in options.values():
        named = [option for option, port in options.items() if port == number != 0]
        if len(named) > 1:
            raise InvalidInput(
                f"{' and '.join(named)} are both {number}",
                value=number,
                valid="a port of its own for each",
                remedy=f"Give {named[-1]} another number, such as {number + 1}",
            )


def is_loopback(host: str) -> bool:
    """Return whether only this machine can reach an address."""
    if host == "localhost":
        return True
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


def _local(host: str) -> str:
    return "127.0.0.1" if host == "localhost" else host


def _require_address(option: str, host: str) -> None:
    try:
        if host:
            ip_address(host)
    except ValueError as error:
        raise InvalidInput(
            f"{option} is {host!r}, which is not an address",
            valid="an IPv4 or IPv6 address of this machine, such as 192.168.1.20",
            remedy="Leave it out to listen on every address of this machine",
        ) from error


def _unencrypted(host: str) -> NotAllowed:
    return NotAllowed(
        f"others could reach {host}, and plain http would show them every password and every"
        " answer; headsets would also refuse to enter VR",
        value=host,
        remedy=(
            "Choose one of three ways:\n"
            "  1. --lan --certificate FILE --key FILE   https with a certificate of your own\n"
            "  2. --lan                                 https with the built-in authority\n"
            "  3. leave --host out                      this machine, and headsets by USB cable\n"
            "Only where nobody else is on the network: --without-tls"
        ),
    )


def _shown(identity: Identity) -> ShownCertificate:
    authority = identity.authority
    return ShownCertificate(
        source=identity.source,
        server_fingerprint=identity.server_fingerprint,
        authority_fingerprint=identity.authority_fingerprint,
        expires_at=identity.expires_at,
        authority_expires_at=None if authority is None else authority.not_valid_after_utc,
        uncovered=tuple(str(one) for one in identity.uncovered),
    )
