"""Keep the certificate up to date while the server runs.

A laptop that joins another network gets another address; a certificate is about to expire; the lab
replaces its own files. None of that may wait for a restart in the middle of a session, so it is
checked every minute, and a new certificate takes effect with the next handshake. Open connections
stay open, and the tokens of paired devices do not depend on certificates.
"""

import asyncio
import logging
import ssl
from collections.abc import Callable
from dataclasses import dataclass

from cryptography import x509

from app.errors import ReembodyError
from app.lan.network import Network
from app.lan.serving.addresses import Machine, current_machine
from app.lan.serving.certificates import Identity
from app.lan.serving.plan import Plan

log = logging.getLogger(__name__)
LOOKED_AT_EVERY_S = 60.0


@dataclass
class CertificateWatch:
    """Keeps `network` and the `tls` context in line with the machine and the files."""

    plan: Plan
    network: Network
    tls: ssl.SSLContext | None = None
    look: Callable[[], Machine] = current_machine
    identity: Identity | None = None
    _failed: Callable[[Exception], object] = lambda _: None
    _well: Callable[[], object] = lambda: None

    def report_to(self, failed: Callable[[Exception], object], well: Callable[[], object]) -> None:
        """Set the callbacks after each check: `failed` with the error, or `well`."""
        self._failed, self._well = failed, well

    def refresh(self) -> None:
        """Check once; raise ReembodyError if there is no usable certificate."""
        machine = self.look()
        if self.plan.certificates is not None and self.tls is not None:
            identity = self.plan.certificates.current(machine)
            if identity != self.identity:
                self.plan.certificates.load_into(self.tls)
                self.identity = identity
        self.network.reach = self.plan.reach(machine, self.identity)

    def authority(self) -> x509.Certificate:
        """Return the certificate that devices install now; raise LookupError if there is none."""
        if self.identity is None or self.identity.authority is None:
            raise LookupError("there is no authority to install, hence no help page")
        return self.identity.authority

    async def run(self) -> None:
        """Check periodically; an error is reported, and the old certificate stays in use."""
        while True:
            await asyncio.sleep(LOOKED_AT_EVERY_S)
            try:
                await asyncio.to_thread(self.refresh)
            except (ReembodyError, OSError, ValueError) as error:
                log.error("the certificate could not be renewed: %s", error)
                self._failed(error)
            except Exception as error:  # the next check may succeed
                log.exception("the certificate could not be checked")
                self._failed(error)
            else:
                self._well()
