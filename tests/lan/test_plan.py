"""Tests of which addresses the server opens, and which it refuses."""

from pathlib import Path
from typing import Any

import pytest

from app.clock import Clock
from app.errors import InvalidInput, NotAllowed
from app.lan.network import Reach
from app.lan.serving.certificates import LabAuthority, OwnFiles
from app.lan.serving.plan import EVERYWHERE, Plan, make_plan
from app.settings import Settings
from tests.lan.machines import LAB_PC


def plan_for(tmp_path: Path, **given: Any) -> Plan:
    """Return the plan for these settings."""
    return make_plan(Settings(data_dir=tmp_path, **given), Clock())


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1", "127.0.0.2"])
def test_a_loopback_address_needs_no_certificate(tmp_path: Path, host: str) -> None:
    """A loopback address is served over plain HTTP without certificates."""
    plan = plan_for(tmp_path, host=host)
    assert (plan.mode, plan.lan_hosts, plan.certificates) == ("loopback", (), None)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "labpc.local"])  # noqa: S104 - as text
def test_a_network_address_without_encryption_is_refused(tmp_path: Path, host: str) -> None:
    """A network address without encryption is refused with all alternatives."""
    with pytest.raises(NotAllowed) as refused:
        plan_for(tmp_path, host=host)
    for way in ("--certificate", "--lan ", "USB", "--without-tls"):
        assert way in refused.value.remedy


def test_without_tls_allows_plain_http(tmp_path: Path) -> None:
    """With `without_tls` a network address is served over plain HTTP, and the plan states it."""
    plan = plan_for(tmp_path, host="192.168.7.20", without_tls=True)
    assert plan.reach(LAB_PC, None) == Reach(
        mode="without_tls",
        local_url="http://192.168.7.20:8321",
        urls=("http://192.168.7.20:8321",),
    )
    everywhere = plan_for(tmp_path, lan=True, without_tls=True)
    assert everywhere.local_hosts == EVERYWHERE
    assert everywhere.certificates is None


def test_the_network_gets_https_and_a_help_page(tmp_path: Path) -> None:
    """With `lan` the network gets HTTPS and a help page; plain HTTP stays on this machine."""
    plan = plan_for(tmp_path, lan=True)
    source = plan.certificates
    assert isinstance(source, LabAuthority)
    assert plan.local_hosts == ("127.0.0.1",)
    reach = plan.reach(LAB_PC, source.current(LAB_PC))
    assert reach.urls == (
        "https://192.168.7.20:8443",
        "https://[fd12::20]:8443",
        "https://labpc.local:8443",
        "https://labpc.psy.example:8443",
    )
    assert reach.help_url == "http://192.168.7.20:8080"


def test_own_certificates_need_no_help_page(tmp_path: Path) -> None:
    """With the lab's own certificate no help port is opened."""
    plan = plan_for(tmp_path, lan=True, certificate=tmp_path / "a", key=tmp_path / "b")
    assert isinstance(plan.certificates, OwnFiles)
    assert plan.help_port is None


@pytest.mark.parametrize(
    "given",
    [
        {"lan": True, "certificate": Path("a")},
        {"lan": True, "key": Path("a")},
        {"lan": True, "lan_host": "labpc"},
        {"lan": True, "host": "192.168.1.5"},
        {"host": "labpc", "without_tls": True},
    ],
)
def test_incomplete_or_contradicting_options_are_refused(
    tmp_path: Path, given: dict[str, Any]
) -> None:
    """Incomplete or contradicting network options are refused with a remedy."""
    with pytest.raises(InvalidInput) as refused:
        plan_for(tmp_path, **given)
    assert refused.value.remedy


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"lan_port": 8443, "help_port": 8443}, "--lan-port and --help-port are both 8443"),
        ({"port": 8080, "help_port": 8080}, "--port and --help-port are both 8080"),
        ({"port": 8443, "lan_port": 8443}, "--port and --lan-port are both 8443"),
    ],
)
def test_equal_ports_are_refused(tmp_path: Path, given: dict[str, int], named: str) -> None:
    """Two options with the same port are refused with both names."""
    with pytest.raises(InvalidInput, match=named):
        plan_for(tmp_path, lan=True, **given)


@pytest.mark.parametrize(
    ("asked_at", "given"),
    [
        ("http://localhost:8321/", "https://192.168.7.20:8443"),
        ("http://127.0.0.1:8321/", "https://192.168.7.20:8443"),
        ("http://[::1]:8321/", "https://192.168.7.20:8443"),
        ("https://labpc.local:8443/", "https://labpc.local:8443"),
    ],
)
def test_a_device_is_never_sent_to_its_own_localhost(asked_at: str, given: str) -> None:
    """A device gets the network's address, or the host name by which the console was opened."""
    reach = Reach(mode="lan", urls=("https://192.168.7.20:8443",))
    assert reach.for_devices(asked_at) == given


@pytest.mark.parametrize(
    "host",
    [
        *("localhost", "LOCALHOST.", "lab.localhost", "127.0.0.1", "127.1.2.3", "0.0.0.0"),  # noqa: S104 - as somebody may type it
        *("[::1]", "[::]", "[::ffff:127.0.0.1]"),
    ],
)
def test_without_a_network_no_device_gets_an_address(host: str) -> None:
    """Without a network there is no address for devices, whatever local name was requested."""
    assert Reach().for_devices(f"http://{host}:8321/") is None
    assert Reach().for_tablets is None
    beyond = Reach(mode="lan", urls=("https://192.168.7.20:8443",))
    assert beyond.for_devices(f"http://{host}:8321/") == "https://192.168.7.20:8443"
    assert beyond.for_tablets == "https://192.168.7.20:8443/tablet"


def test_a_proxys_name_is_an_address_for_devices() -> None:
    """The name of a proxy under which the console was opened is an address for devices."""
    assert Reach().for_devices("https://vr.example.org/") == "https://vr.example.org"
