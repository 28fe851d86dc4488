"""Where the certificate for the lab's network comes from, and when it is made anew.

`LabAuthority` keeps an authority in the data folder and signs with it: one file with the authority,
made once, and one with the server's certificate, made again whenever an address is missing or its
end is near. `OwnFiles` are the lab's own, looked at and never written. Both hand out an `Identity`
and load it into the context that the open door uses, so a new one takes effect without a restart.
Files with keys are written whole or not at all, and readable by their owner only.
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
    leaf_from_pem,
    new_leaf,
    still_good,
    wanted_hosts,
)

FOLDER = "tls"
AUTHORITY_FILE, SERVER_FILE = "authority.pem", "server.pem"
OTHERS = stat.S_IRWXG | stat.S_IRWXO
POSIX = os.name == "posix"
"""Elsewhere a file's mode says nothing about who may read it; its folder's rights hold."""


@dataclass(frozen=True)
class Identity:
    """What the server shows of itself. `authority` is what devices install; None: nothing.

    `uncovered` are addresses of this machine that the certificate is not valid for.
    """

    source: Literal["authority", "files"]
    hosts: tuple[Host, ...]
    expires_at: datetime
    server_fingerprint: str
    authority: x509.Certificate | None = None
    uncovered: tuple[Address, ...] = ()

    @property
    def authority_fingerprint(self) -> str | None:
        """The fingerprint that a person compares before installing."""
        return None if self.authority is None else fingerprint(self.authority)


class CertificateSource(Protocol):
    """Gives the certificate for a machine as it is now, made or read anew where needed."""

    def current(self, machine: Machine) -> Identity:
        """The certificate to show; raises ReembodyError where there is no usable one."""

    def load_into(self, context: ssl.SSLContext) -> None:
        """Let `context` show it, to every handshake from now on."""


@dataclass(frozen=True)
class LabAuthority:
    """An authority and its server certificate in `data_dir/tls`."""

    data_dir: Path
    clock: Clock

    @property
    def authority_file(self) -> Path:
        """Where the authority's key and certificate are."""
        return self.data_dir / FOLDER / AUTHORITY_FILE

    @property
    def server_file(self) -> Path:
        """Where the server's key and certificates are."""
        return self.data_dir / FOLDER / SERVER_FILE

    def authority(self, machine: Machine) -> Authority:
        """The authority, made if there is none."""
        if not self.authority_file.exists():
            return self.replace_authority(machine)
        pem = read_private(self.authority_file)
        try:
            return authority_from_pem(pem)
        except ValueError as error:
            raise InvalidInput(
                f"{self.authority_file} cannot be read: {error}",
                remedy=(
                    "Put it back from a copy, or run `./run tls renew --new-authority`; devices"
                    " then install the new certificate"
                ),
            ) from error

    def replace_authority(self, machine: Machine) -> Authority:
        """Make another authority: devices trust nothing of the old one's from then on."""
        made = new_authority(machine, self.clock.utc_now())
        write_private(self.authority_file, made.as_pem())
        return made

    def current(self, machine: Machine) -> Identity:
        """The server's certificate, kept as long as it is good."""
        return self._identity(machine, anew=False)

    def renew(self, machine: Machine) -> Identity:
        """The server's certificate, made anew; the authority stays, so devices notice nothing."""
        return self._identity(machine, anew=True)

    def load_into(self, context: ssl.SSLContext) -> None:
        """Let `context` show the server's certificate."""
        read_private(self.server_file)
        context.load_cert_chain(self.server_file)

    def _identity(self, machine: Machine, *, anew: bool) -> Identity:
        authority, now = self.authority(machine), self.clock.utc_now()
        hosts = wanted_hosts(machine, authority)
        leaf = None if anew else self._stored_leaf()
        if leaf is None or not still_good(leaf, authority, hosts, now):
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
        except ValueError:  # it holds nothing that could not be made again
            return None


@dataclass(frozen=True)
class OwnFiles:
    """The lab's own certificate (with its chain) and key, as PEM files."""

    certificate_file: Path
    key_file: Path
    clock: Clock

    def current(self, machine: Machine) -> Identity:
        """What the certificate says; raises InvalidInput if it cannot be served."""
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
                f"the certificate {self.certificate_file} ended on {ends:%Y-%m-%d}",
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
        """Let `context` show the lab's certificate."""
        # An encrypted key would ask at the terminal; refusing is better than a server that waits.
        context.load_cert_chain(self.certificate_file, self.key_file, password=_no_password)


def _no_password() -> str:
    raise ValueError("the key is encrypted; the server needs one without a password")


def write_private(file: Path, content: bytes) -> None:
    """Put `content` at `file` for its owner alone, on disk before it replaces what was there."""
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
    """The content of a file with a key; raises NotAllowed if others could have read it."""
    if POSIX and file.stat().st_mode & OTHERS:
        raise NotAllowed(
            f"{file} holds a private key, and others on this machine can read it",
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
