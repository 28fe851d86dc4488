"""Serve the plain-http port: how to trust the lab's certificate, and nothing else.

There is no login and no redirect here: otherwise a device with a cookie or a password would send
them unencrypted.
"""

import plistlib
from collections.abc import Callable
from urllib.parse import urlsplit
from uuid import NAMESPACE_OID, uuid5

from cryptography import x509
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.serialization import Encoding
from cryptography.x509.oid import NameOID
from starlette.requests import Request
from starlette.responses import HTMLResponse, PlainTextResponse, Response
from starlette.types import Receive, Scope, Send

from app.errors import TooManyAttempts
from app.lan.network import STRANGER, Network
from app.lan.serving.authority import fingerprint
from app.lan.serving.help.page import HelpFacts, help_page, style_hash
from app.lan.serving.help.texts import texts_for


class HelpSite:
    """An ASGI application with four addresses; `authority` returns the current certificate.

    `spend` counts a request of a client's address, and raises TooManyAttempts.
    """

    def __init__(
        self,
        network: Network,
        authority: Callable[[], x509.Certificate],
        spend: Callable[[str], object] = lambda _: None,
    ) -> None:
        self._network, self._authority, self._spend = network, authority, spend

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request; WebSockets are refused."""
        if scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1000})
        elif scope["type"] == "http":
            # Every client is a stranger here: no body is read, and the connection is closed.
            scope[STRANGER] = True
            response = self._counted(Request(scope))
            response.headers.update(_headers())
            await response(scope, receive, send)

    def _counted(self, request: Request) -> Response:
        try:
            self._spend(request.client.host if request.client else "")
        except TooManyAttempts as error:
            wait = str(round(error.retry_after_s or 1))
            return PlainTextResponse("Too many requests\n", 429, headers={"retry-after": wait})
        return self._answer(request)

    def _answer(self, request: Request) -> Response:
        if request.method not in ("GET", "HEAD"):
            return PlainTextResponse("Not found\n", 404)
        certificate = self._authority()
        match request.scope["path"]:
            case "/":
                return self._page(request, certificate)
            case "/reembody-ca.crt":
                return Response(
                    certificate.public_bytes(Encoding.DER), media_type="application/x-x509-ca-cert"
                )
            case "/reembody-ca.pem":
                return _download(
                    certificate.public_bytes(Encoding.PEM),
                    "application/x-pem-file",
                    "reembody-ca.pem",
                )
            case "/reembody.mobileconfig":
                return _download(
                    mobileconfig(certificate),
                    "application/x-apple-aspen-config",
                    "reembody.mobileconfig",
                )
            case _:
                return PlainTextResponse("Not found\n", 404)

    def _page(self, request: Request, certificate: x509.Certificate) -> Response:
        reach = self._network.reach
        if not reach.urls:
            # There is no address for other devices; on them, localhost is another machine.
            return PlainTextResponse("The lab's computer is not connected to a network.\n", 503)
        try:
            host = urlsplit(f"//{request.headers.get('host', '')}").hostname
        except ValueError:
            host = None
        # A foreign name must not appear on the page: it may lead to another server.
        same = [one for one in reach.urls if urlsplit(one).hostname == host]
        facts = HelpFacts(
            here=reach.help_url or "",
            secure=(*same, *reach.urls)[0],
            port=reach.port,
            fingerprint=fingerprint(certificate),
            authority_ends=certificate.not_valid_after_utc,
        )
        texts = texts_for(
            request.headers.get("accept-language", ""), request.query_params.get("lang", "")
        )
        page = help_page(facts, texts, request.headers.get("user-agent", ""))
        return HTMLResponse(page, headers={"vary": "accept-language, user-agent"})


def _download(content: bytes, media_type: str, name: str) -> Response:
    return Response(
        content,
        media_type=media_type,
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )


def _headers() -> dict[str, str]:
    return {
        "content-security-policy": (
            f"default-src 'none'; style-src {style_hash()}; base-uri 'none'; form-action 'none';"
            " frame-ancestors 'none'"
        ),
        "x-content-type-options": "nosniff",
        "referrer-policy": "no-referrer",
        "cross-origin-opener-policy": "same-origin",
        "cache-control": "no-store",
    }


def mobileconfig(authority: x509.Certificate) -> bytes:
    """Return an unsigned configuration profile with the authority's certificate.

    The same certificate always gives the same profile, so installing it again replaces it.
    """
    digest = authority.fingerprint(hashes.SHA256()).hex()
    (name,) = authority.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
    identifier = f"reembody.authority.{digest[:16]}"
    payload = {
        "PayloadType": "com.apple.security.root",
        "PayloadVersion": 1,
        "PayloadIdentifier": f"{identifier}.certificate",
        "PayloadUUID": str(uuid5(NAMESPACE_OID, f"{digest}.certificate")).upper(),
        "PayloadDisplayName": str(name.value),
        "PayloadCertificateFileName": "reembody-ca.crt",
        "PayloadContent": authority.public_bytes(Encoding.DER),
    }
    return plistlib.dumps(
        {
            "PayloadType": "Configuration",
            "PayloadVersion": 1,
            "PayloadIdentifier": identifier,
            "PayloadUUID": str(uuid5(NAMESPACE_OID, digest)).upper(),
            "PayloadDisplayName": str(name.value),
            "PayloadDescription": "Lets this device trust the server of the lab, and nothing else.",
            "PayloadContent": [payload],
        }
    )
