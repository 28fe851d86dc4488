"""Ask a running server over HTTP; what it refuses is raised as if it were refused here."""

from typing import Any
from urllib.parse import urlsplit

from httpx2 import Client, HTTPError, InvalidURL, Response

from app.errors import NotFound, ReembodyError

_PATIENCE_S = 60.0
_NOT_FOUND, _UNAUTHORIZED = 404, 401


class RemoteServer:
    """A server at a URL, with the bearer token of an account."""

    def __init__(self, url: str, token: str) -> None:
        if urlsplit(url).scheme not in ("http", "https") or not urlsplit(url).netloc:
            raise ValueError(
                f"--url {url!r} is no address of a server: valid is one such as"
                " http://127.0.0.1:8321, as `reembody serve` prints it"
            )
        self._url, self._token = url.rstrip("/"), token

    def get(self, path: str) -> Any:
        """Return the decoded answer; raises ReembodyError with the server's reason."""
        return self._asked("GET", path, None)

    def post(self, path: str, body: dict[str, Any]) -> Any:
        """Send a body and return the decoded answer; raises as `get`."""
        return self._asked("POST", path, body)

    def _asked(self, method: str, path: str, body: dict[str, Any] | None) -> Any:
        headers = {"authorization": f"Bearer {self._token}"}
        try:
            with Client(base_url=self._url, headers=headers, timeout=_PATIENCE_S) as client:
                response = client.request(method, path, json=body)
        except (HTTPError, InvalidURL) as error:
            raise ReembodyError(
                f"there is no answer from {self._url}: {error}",
                value=self._url,
                remedy="Check that the server runs, and its address: `reembody serve` prints it.",
            ) from error
        return response.json() if response.is_success else _refuse(response, self._url)


def _refuse(response: Response, url: str) -> None:
    try:
        said: dict[str, Any] = response.json()["error"]
    except (ValueError, KeyError, TypeError):
        raise ReembodyError(
            f"{url} is not a server of Reembody, or fails: it answered {response.status_code}",
            value=response.status_code,
            remedy="Check the address: `reembody serve` prints it.",
        ) from None
    remedy = said.get("remedy") or ""
    if response.status_code == _UNAUTHORIZED:
        remedy = "Make a token on the server's machine with: reembody token"
    kind = NotFound if response.status_code == _NOT_FOUND else ReembodyError
    raise kind(
        said.get("message") or "the server refused this",
        value=said.get("value"),
        valid=said.get("valid"),
        remedy=remedy,
        details=said.get("details") or (),
    )
