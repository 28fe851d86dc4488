"""The server on the lab's own network: addresses, certificates, doors, and the page that helps.

Three ways lead to the same application. On this machine, and through a USB cable, plain http on the
loopback, which browsers count as secure. Over the network https, with a certificate of the lab's
own or with one from a small authority that lives in the data folder and whose certificate each
device installs once. This package knows no study, no database and no route of the application.

This face tells where the server is reached; `app.lan.serving` opens the doors.
"""

from app.lan.network import STRANGER, Mode, Network, Reach, ShownCertificate, qr_svg, qr_terminal

__all__ = ["STRANGER", "Mode", "Network", "Reach", "ShownCertificate", "qr_svg", "qr_terminal"]
