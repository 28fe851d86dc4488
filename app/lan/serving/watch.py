"""Keeping the certificate right while the server runs.

A laptop that joins another network gets another address; a certificate nears its end; the lab puts
new files in place of its own. None of that may wait for a restart in the middle of a session, so it
is looked at every minute, and a new certificate counts from the next handshake on. Connections that
are open stay open, and the tokens of paired devices have nothing to do with certificates.
"""

import asyncio
import logging
import ssl
from collections.abc import Callable
from dataclasses import dataclass

from cryptography import x509

from app.errors import ReembodyError
from app.lan.network import Network
from app.lan.serving.addresses import Machine, look_around
from app.lan.serving.certificates import Identity
from app.lan.serving.plan import Plan

log = logging.getLogger(__name__)
LOOKED_AT_EVERY_S = 60.0


@dataclass
class CertificateWatch:
    """Keeps `network` and the `tls` context in step with the machine and the files."""

    plan: Plan
    network: Network
    tls: ssl.SSLContext | None = None
    look: Callable[[], Machine] = look_around
    identity: Identity | None = None
    _failed: Callable[[Exception], object] = lambda _: None
    _well: Callable[[], object] = lambda: None

    def report_to(self, failed: Callable[[Exception], object], well: Callable[[], object]) -> None:
        """Have each look noticed: `failed` with what went wrong, or `well`."""
        self._failed, self._well = failed, well

    def refresh(self) -> None:
        """Look once; raises ReembodyError where there is no usable certificate."""
        machine = self.look()
        if self.plan.certificates is not None and self.tls is not None:
            identity = self.plan.certificates.current(machine)
            if identity != self.identity:
                self.plan.certificates.load_into(self.tls)
                self.identity = identity
        self.network.reach = self.plan.reach(machine, self.identity)

    def authority(self) -> x509.Certificate:
        """The certificate that devices install now."""
        if self.identity is None or self.identity.authority is None:
            raise LookupError("nothing has to be installed: ask only where there is a help page")
        return self.identity.authority

    async def run(self) -> None:
        """Look again and again; what goes wrong is told, and the old certificate stays."""
        while True:
            await asyncio.sleep(LOOKED_AT_EVERY_S)
            try:
                await asyncio.to_thread(self.refresh)
            except (ReembodyError, OSError, ValueError) as error:
                log.error("the certificate could not be renewed: %s", error)
                self._failed(error)
            except Exception as error:  # whatever it is, the next look may be luckier
                log.exception("the certificate could not be looked at")
                self._failed(error)
            else:
                self._well()
