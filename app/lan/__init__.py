"""The server on the lab's own network: addresses, certificates, listeners and a help page.

The application can be reached in three ways. On this machine, and through a USB cable, by plain
http on the loopback, which browsers count as secure. Over the network by https, with the lab's own
certificate, or with one from a small authority in the data folder whose certificate each device
installs once. This package depends on no study, no database and no route of the application.

This module describes where the server can be reached; `app.lan.serving` serves it there.
"""

from app.lan.network import STRANGER, Mode, Network, Reach, ShownCertificate, qr_svg, qr_terminal

__all__ = ["STRANGER", "Mode", "Network", "Reach", "ShownCertificate", "qr_svg", "qr_terminal"]
