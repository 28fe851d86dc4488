"""Cookies that hold a token: out of reach of scripts, of other sites, and of other hosts.

Over https the name begins with `__Host-`: the browser then takes the cookie only if it is Secure,
for this host alone and for every path, so nobody who controls plain http or a neighbouring name can
plant one. Over http (this machine, a USB cable) that prefix is not allowed and the name is plain.
A request is read for the name of its own scheme only.
"""

from fastapi import Request, Response
from starlette.requests import HTTPConnection

HOST_ONLY = "__Host-"


def cookie_name(request: HTTPConnection, name: str) -> str:
    """What the cookie `name` is called where `request` comes from."""
    return f"{HOST_ONLY}{name}" if _is_secure(request) else name


def read_cookie(request: HTTPConnection, name: str) -> str | None:
    """The token in the cookie `name`."""
    return request.cookies.get(cookie_name(request, name))


def set_cookie(request: Request, response: Response, name: str, token: str, age_s: int) -> None:
    """Let the browser keep a token in the cookie `name` for `age_s`."""
    response.set_cookie(
        cookie_name(request, name),
        token,
        max_age=age_s,
        path="/",
        httponly=True,
        samesite="strict",
        secure=_is_secure(request),
    )


def delete_cookie(request: Request, response: Response, name: str) -> None:
    """Let the browser forget the cookie `name`; a browser obeys only if all attributes agree."""
    response.delete_cookie(
        cookie_name(request, name),
        path="/",
        httponly=True,
        samesite="strict",
        secure=_is_secure(request),
    )


def _is_secure(request: HTTPConnection) -> bool:
    return request.url.scheme in ("https", "wss")
