"""Serve on the lab's network: listeners, certificates, deadlines, and the help page.

It is imported only by `reembody serve` and `reembody tls`: the application only needs to know where
it can be reached (`app.lan`).
"""

from app.lan.serving.addresses import current_machine
from app.lan.serving.certificates import Identity, LabAuthority
from app.lan.serving.help.site import HelpSite
from app.lan.serving.listening import (
    Door,
    LabServer,
    SocketProtocol,
    allow_open_files,
    bind,
    port_of,
    tls_context,
)
from app.lan.serving.plan import Plan, make_plan
from app.lan.serving.watch import CertificateWatch

__all__ = [
    "CertificateWatch",
    "Door",
    "HelpSite",
    "Identity",
    "LabAuthority",
    "LabServer",
    "Plan",
    "SocketProtocol",
    "allow_open_files",
    "bind",
    "current_machine",
    "make_plan",
    "port_of",
    "tls_context",
]
