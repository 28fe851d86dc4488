"""Tests of the plain-HTTP help port, which serves only what devices need to trust the lab."""

import plistlib
import re

import pytest
from cryptography import x509
from cryptography.hazmat.primitives.serialization import Encoding
from starlette.testclient import TestClient

from app.lan.network import Network, Reach
from app.lan.serving.authority import Authority, fingerprint, new_authority
from app.lan.serving.help.site import HelpSite
from app.lan.serving.help.texts import ENGLISH, GERMAN
from tests.lan.machines import LAB_PC, NOW

REACH = Reach(
    mode="lan",
    urls=("https://192.168.7.20:8443", "https://labpc.local:8443"),
    help_url="http://192.168.7.20:8080",
)


@pytest.fixture(scope="module")
def authority() -> Authority:
    """Return the lab's authority."""
    return new_authority(LAB_PC, NOW)


@pytest.fixture
def client(authority: Authority) -> TestClient:
    """Return a client of the help port."""
    site = HelpSite(Network(REACH), lambda: authority.certificate)
    return TestClient(site, base_url="http://192.168.7.20:8080", follow_redirects=False)


@pytest.mark.parametrize(
    "path",
    [
        *("/api/health", "/api/me", "/tablet", "/console", "/assets/../../settings.py", "/docs"),
        *("/../reembody.sqlite", "/%2e%2e/tls/authority.pem", "/tls/authority.pem"),
        *("/reembody-ca.crt/", "/reembody-ca.key", "/index.html", "/favicon.ico"),
    ],
)
def test_other_paths_are_not_found(client: TestClient, path: str) -> None:
    """Any other path is answered with 404, without a redirect or a cookie."""
    answer = client.get(path, headers={"cookie": "reembody_login=secret"})
    assert answer.status_code == 404
    assert "location" not in answer.headers
    assert "set-cookie" not in answer.headers


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS"])
def test_other_methods_are_not_found(client: TestClient, method: str) -> None:
    """A request that would send data is answered with 404."""
    assert client.request(method, "/", content=b"password=x").status_code == 404


def test_the_certificate_is_served_in_every_format(
    client: TestClient, authority: Authority
) -> None:
    """The authority's certificate is served as DER, as PEM and as an Apple profile."""
    der = client.get("/reembody-ca.crt")
    assert der.headers["content-type"] == "application/x-x509-ca-cert"
    assert x509.load_der_x509_certificate(der.content) == authority.certificate
    pem = client.get("/reembody-ca.pem")
    assert x509.load_pem_x509_certificate(pem.content) == authority.certificate
    profile = client.get("/reembody.mobileconfig")
    assert profile.headers["content-type"] == "application/x-apple-aspen-config"
    (payload,) = plistlib.loads(profile.content)["PayloadContent"]
    assert payload["PayloadType"] == "com.apple.security.root"
    assert payload["PayloadContent"] == authority.certificate.public_bytes(Encoding.DER)


@pytest.mark.parametrize("path", ["/", "/reembody-ca.crt", "/nothing"])
def test_no_page_contains_a_key_or_a_script(client: TestClient, path: str) -> None:
    """No answer of the help port contains a private key or a script."""
    answer = client.get(path)
    assert b"PRIVATE" not in answer.content
    assert b"<script" not in answer.content.lower()
    assert answer.headers["content-security-policy"].startswith("default-src 'none'")
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "strict-transport-security" not in answer.headers


def test_the_page_shows_the_fingerprint_and_the_https_address(
    client: TestClient, authority: Authority
) -> None:
    """The page shows the whole fingerprint and the https address of the requested host."""
    page = client.get("/").text
    shown = re.search(r'class="fingerprint">(.*?)</p>', page)
    assert shown is not None
    digits = re.sub("<[^>]*>|[^0-9A-F]", "", shown.group(1))
    assert digits == fingerprint(authority.certificate).replace(":", "")
    assert 'href="https://192.168.7.20:8443/tablet"' in page
    by_name = client.get("/", headers={"host": "labpc.local:8080"}).text
    assert 'href="https://labpc.local:8443/tablet"' in by_name


def test_a_foreign_host_header_is_ignored(client: TestClient) -> None:
    """The page links to the lab's own address, whatever the `Host` header."""
    page = client.get("/", headers={"host": "evil.example"}).text
    assert "evil" not in page
    assert 'href="https://192.168.7.20:8443/"' in page


@pytest.mark.parametrize(
    ("accepted", "query", "heading"),
    [
        ("de-DE,de;q=0.9,en;q=0.5", "", GERMAN.title),
        ("fr-FR,de;q=0.5", "", GERMAN.title),
        ("en-GB", "", ENGLISH.title),
        ("fr", "", ENGLISH.title),
        ("de", "?lang=en", ENGLISH.title),
        ("en", "?lang=de", GERMAN.title),
        ("en", "?lang=%3Cscript%3E", ENGLISH.title),
    ],
)
def test_the_page_speaks_the_devices_language(
    client: TestClient, accepted: str, query: str, heading: str
) -> None:
    """The page is in the browser's language unless the address has another."""
    page = client.get(f"/{query}", headers={"accept-language": accepted}).text
    assert f"<h1>{heading}</h1>" in page


@pytest.mark.parametrize(
    ("agent", "first"),
    [
        ("Mozilla/5.0 (iPad; CPU OS 18_0 like Mac OS X)", "iPad and iPhone"),
        ("Mozilla/5.0 (Macintosh; Intel Mac OS X) Safari", "iPad and iPhone"),
        ("Mozilla/5.0 (Linux; Android 15; SM-X200) Chrome/140", "Android tablet or phone"),
        ("Mozilla/5.0 (X11; Linux x86_64; Quest 3) OculusBrowser/38", "Meta Quest"),
        ("Mozilla/5.0 (Windows NT 10.0; Win64; x64) Chrome/140", "Windows"),
        ("Mozilla/5.0 (X11; Linux x86_64; rv:130.0) Firefox/130.0", "Firefox on a computer"),
    ],
)
def test_the_likely_device_comes_first_and_is_open(
    client: TestClient, agent: str, first: str
) -> None:
    """The instructions for the requesting device come first, unfolded; all others follow."""
    page = client.get("/", headers={"user-agent": agent}).text
    assert page.index(f"<details open><summary>{first}") == page.index("<details")
    assert page.count("<details") == len(ENGLISH.devices)


def test_both_languages_help_with_the_same_devices() -> None:
    """Both languages have the same devices with the same number of steps."""
    steps = [
        [(one.key, len(one.steps), one.marks) for one in texts.devices]
        for texts in (ENGLISH, GERMAN)
    ]
    assert steps[0] == steps[1]
