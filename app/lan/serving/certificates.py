"""Sources of the certificate for the lab's network, and when it is renewed.

`LabAuthority` stores an authority in the data folder and signs with it: one file has the authority,
created once, and one the server's certificate, which is renewed whenever an address is missing or
it is about to expire. `OwnFiles` are the lab's own, only ever read. Both provide an `Identity` and
load it into the TLS context in use, so a new one takes effect without a restart.

Files with keys are written atomically, and only their owner can read them.
"""

import os
import secrets
import ssl
import stat
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Literal, Protocol

from cryptography import x509

from app.clock import Clock
from app.errors import InvalidInput, NotAllowed, file_problem, missing_file
from app.lan.serving.addresses import Address, Machine
from app.lan.serving.authority import Authority, authority_from_pem, fingerprint, new_authority
from app.lan.serving.leaf import (
    Host,
    Leaf,
    hosts_of,
    is_usable,
    leaf_from_pem,
    new_leaf,
    permitted_hosts,
)

FOLDER = "tls"
AUTHORITY_FILE, SERVER_FILE = "authority.pem", "server.pem"
OTHERS = stat.S_IRWXG | stat.S_IRWXO
POSIX = os.name == "posix"
"""Whether file modes protect files; on other systems the permissions of the folder do."""


@dataclass(frozen=True)
class Identity:
    """The server's certificate. `authority` is what devices install; None if nothing is needed.

    `uncovered` are addresses of this machine for which the certificate is not valid.
    """

    source: Literal["authority", "files"]
    hosts: tuple[Host, ...]
    expires_at: datetime
    server_fingerprint: str
    authority: x509.Certificate | None = None
    uncovered: tuple[Address, ...] = ()

    @property
    def authority_fingerprint(self) -> str | None:
        """The fingerprint that a person compares before installing the authority."""
        return None if self.authority is None else fingerprint(self.authority)


class CertificateSource(Protocol):
    """Provides the certificate for a machine's current addresses.

    The certificate is renewed or reread if necessary.
    """

    def current(self, machine: Machine) -> Identity:
        """Return the certificate to use; raise ReembodyError if there is no usable one."""

    def load_into(self, context: ssl.SSLContext) -> None:
        """Load the certificate into `context`, for all subsequent handshakes."""


@dataclass(frozen=True)
class LabAuthority:
    """An authority and its server certificate in `data_dir/tls`."""

    data_dir: Path
    clock: Clock

    @property
    def authority_file(self) -> Path:
        """The file with the authority's key and certificate."""
        return self.data_dir / FOLDER / AUTHORITY_FILE

    @property
    def server_file(self) -> Path:
        """The file with the server's key and certificates."""
        return self.data_dir / FOLDER / SERVER_FILE

    def authority(self, machine: Machine) -> Authority:
        """Return the authority, creating it if there is none."""
        if not self.authority_file.exists():
            return self.replace_authority(machine)
        pem = read_private(self.authority_file)
        try:
            return authority_from_pem(pem)
        except ValueError as error:
            raise InvalidInput(
                f"{self.authority_file} cannot be read: {error}",
                remedy=(
                    "Restore it from a copy, or run `./run tls renew --new-authority`; devices"
                    " then install the new certificate"
                ),
            ) from error

    def replace_authority(self, machine: Machine) -> Authority:
        """Create another authority.

        Devices then no longer trust the server until they install it.
        """
        made = new_authority(machine, self.clock.utc_now())
        write_private(self.authority_file, made.as_pem())
        return made

    def current(self, machine: Machine) -> Identity:
        """Return the server's certificate, renewed only if necessary."""
        return self._identity(machine, renew=False)

    def renew(self, machine: Machine) -> Identity:
        """Renew the server's certificate; the authority stays, so devices need no change."""
        return self._identity(machine, renew=True)

    def load_into(self, context: ssl.SSLContext) -> None:
        """Load the server's certificate into `context`."""
        read_private(self.server_file)
        context.load_cert_chain(self.server_file)

    def _identity(self, machine: Machine, *, renew: bool) -> Identity:
        authority, now = self.authority(machine), self.clock.utc_now()
        hosts = permitted_hosts(machine, authority)
        leaf = None if renew else self._stored_leaf()
        if leaf is None or not is_usable(leaf, authority, hosts, now):
            leaf = new_leaf(authority, hosts, now)
            write_private(self.server_file, leaf.pem)
        return Identity(
            source="authority",
            hosts=leaf.hosts,
            expires_at=leaf.expires_at,
            server_fingerprint=fingerprint(leaf.certificate),
            authority=authority.certificate,
            uncovered=tuple(one for one in machine.addresses if not authority.permits(one)),
        )

    def _stored_leaf(self) -> Leaf | None:
        if not self.server_file.exists():
            return None
        try:
            return leaf_from_pem(read_private(self.server_file))
        except ValueError:  # it can simply be recreated
            return None


@dataclass(frozen=True)
class OwnFiles:
    """The lab's own certificate (with its chain) and key, as PEM files."""

    certificate_file: Path
    key_file: Path
    clock: Clock

    def current(self, machine: Machine) -> Identity:
        """Return the identity of the certificate; raise InvalidInput if it cannot be used."""
        for file in (self.certificate_file, self.key_file):
            if not file.exists():
                raise InvalidInput(
                    missing_file(file),
                    value=str(file),
                    valid="PEM files: the server's certificate followed by its chain; its key",
                    remedy="Name the right file, or leave both out to use the built-in authority",
                )
        try:
            certificate = x509.load_pem_x509_certificates(self.certificate_file.read_bytes())[0]
            self.load_into(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER))
        except (OSError, ValueError) as error:  # ssl.SSLError is an OSError
            why = file_problem(error) if isinstance(error, OSError) else str(error)
            raise InvalidInput(
                f"the certificate {self.certificate_file} with the key {self.key_file} cannot be"
                f" used: {why}",
                valid="PEM files: the server's certificate followed by its chain; its key",
                remedy="Name the right files, or leave both out to use the built-in authority",
            ) from error
        ends = certificate.not_valid_after_utc
        if ends <= self.clock.utc_now():
            raise InvalidInput(
                f"the certificate {self.certificate_file} expired on {ends:%Y-%m-%d}",
                remedy="Renew it, or leave both files out to use the built-in authority",
            )
        hosts = hosts_of(certificate)
        return Identity(
            source="files",
            hosts=hosts,
            expires_at=ends,
            server_fingerprint=fingerprint(certificate),
            uncovered=tuple(one for one in machine.addresses if one not in hosts),
        )

    def load_into(self, context: ssl.SSLContext) -> None:
        """Load the lab's certificate into `context`."""
        # An encrypted key would prompt on the terminal; an error is better than a server that
        # waits.
        context.load_cert_chain(self.certificate_file, self.key_file, password=_no_password)


def _no_password() -> str:
    raise ValueError("the key is encrypted; the server needs one without a password")


def write_private(file: Path, content: bytes) -> None:
    """Write `content` to `file` atomically and durably, readable by its owner only."""
    file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    file.parent.chmod(0o700)
    part = file.with_name(f".{file.name}.{secrets.token_hex(4)}")
    try:
        handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(handle, "wb") as writing:
            writing.write(content)
            writing.flush()
            os.fsync(writing.fileno())
        part.replace(file)
    finally:
        part.unlink(missing_ok=True)
    _flush_folder(file.parent)


def read_private(file: Path) -> bytes:
    """Return the content of a file with a key; raise NotAllowed if others could have read it."""
    if POSIX and file.stat().st_mode & OTHERS:
        raise NotAllowed(
            f"{file} contains a private key, but others on this machine can read it",
            value=oct(stat.S_IMODE(file.stat().st_mode)),
            valid="0o600",
            remedy=(
                f"If nobody has: chmod 600 {file}. If somebody may have: delete it and start again;"
                " devices then install the new certificate"
            ),
        )
    return file.read_bytes()


def _flush_folder(folder: Path) -> None:
    if not POSIX:
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
