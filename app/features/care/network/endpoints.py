"""The HTTP endpoint of the network view."""

from fastapi import APIRouter

from app.features.care.network.schemas import (
    AddressView,
    CableView,
    CertificateView,
    HelpView,
    NetworkView,
)
from app.lan import Reach, ShownCertificate, qr_svg
from app.platform.dependencies import Context, SignedIn

router = APIRouter(tags=["network"])


@router.get("/network")
def get_network(context: Context, _: SignedIn) -> NetworkView:
    """Return the server's current addresses, its certificate and the help page for devices."""
    reach = context.network.reach
    return NetworkView(
        mode=reach.mode,
        local_url=reach.local_url,
        addresses=[_address(url) for url in reach.urls],
        certificate=None if reach.certificate is None else _certificate(reach.certificate),
        help=(
            None
            if reach.help_url is None
            else HelpView(url=reach.help_url, qr_svg=qr_svg(reach.help_url))
        ),
        cable=_cable(reach),
    )


def _address(url: str) -> AddressView:
    tablet, headset = f"{url}/tablet", f"{url}/vr"
    return AddressView(
        url=url,
        tablet_url=tablet,
        tablet_qr_svg=qr_svg(tablet),
        headset_url=headset,
        headset_qr_svg=qr_svg(headset),
    )


def _certificate(shown: ShownCertificate) -> CertificateView:
    return CertificateView(
        source=shown.source,
        fingerprint=shown.authority_fingerprint or shown.server_fingerprint,
        server_fingerprint=shown.server_fingerprint,
        expires_at=shown.expires_at,
        authority_expires_at=shown.authority_expires_at,
        uncovered=list(shown.uncovered),
    )


def _cable(reach: Reach) -> CableView:
    # The headset's port of this number is forwarded here; browsers treat `localhost` as secure.
    port = reach.port
    return CableView(
        command=f"adb reverse tcp:{port} tcp:{port}", url=f"http://localhost:{port}/vr"
    )
