"""Serving on the lab's network: doors, certificates, who may take how long, and the help page.

Loaded by `reembody serve` and `reembody tls` alone: the application needs only to know where it can
be reached (`app.lan`).
"""

from app.lan.serving.addresses import look_around
from app.lan.serving.certificates import Identity, LabAuthority
from app.lan.serving.help.site import HelpSite
from app.lan.serving.listening import (
    Door,
    LabServer,
    SocketProtocol,
    allow_open_files,
    bind,
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
    "look_around",
    "make_plan",
    "tls_context",
]
