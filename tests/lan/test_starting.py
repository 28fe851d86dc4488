"""Tests of starting, of refusing to start, and of restarting with another certificate."""

import asyncio
import re
import socket
import subprocess
from itertools import islice
from pathlib import Path

import httpx2

from tests.faults.commands import command
from tests.features.lab import ok
from tests.lan.devices import CREDENTIALS, greeted, pair_headset
from tests.support.lan import LanServer
from tests.support.server import REEMBODY, free_port


def test_a_restart_and_a_renewal_leave_devices_paired(tmp_path: Path) -> None:
    """A restart with a renewed certificate keeps devices paired and the authority's fingerprint."""
    with LanServer(tmp_path) as server:
        trust = server.trusting()
        with server.secure_client() as client:
            ok(client.post("/api/login", json=CREDENTIALS))
            _, token = pair_headset(client)
            before = ok(client.get("/api/network"))["certificate"]
        assert asyncio.run(greeted(server.secure_url, token, ssl=trust))["type"] == "welcome"
        server.stop()
        renewed = _command(server, "tls", "renew", "--json")
        server.start()
        # `trust` is what the device installed before.
        assert asyncio.run(greeted(server.secure_url, token, ssl=trust))["type"] == "welcome"
        with httpx2.Client(base_url=server.secure_url, verify=trust) as client:
            ok(client.post("/api/login", json=CREDENTIALS))
            after = ok(client.get("/api/network"))["certificate"]
    assert after["fingerprint"] == before["fingerprint"] == renewed["authority_fingerprint_sha256"]
    assert after["server_fingerprint"] == renewed["server_fingerprint_sha256"]
    assert after["server_fingerprint"] != before["server_fingerprint"]


def test_a_network_address_without_tls_is_refused(tmp_path: Path) -> None:
    """A network address without TLS is refused before the server listens or creates a folder."""
    result = subprocess.run(
        [*REEMBODY, "serve", "--host", "0.0.0.0", "--port", str(free_port())],  # noqa: S104 - refused
        env={"REEMBODY_DATA_DIR": str(tmp_path / "data")},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert result.returncode == 2
    assert "--lan" in result.stderr
    assert "--without-tls" in result.stderr
    assert not (tmp_path / "data").exists()


def test_any_free_port_is_printed_once_it_is_taken(tmp_path: Path) -> None:
    """With the port 0 the server prints the ports that it took, and answers at them."""
    any_port = ("--port", "0", "--lan", "--lan-host", "127.0.0.1", "--lan-port", "0")
    with subprocess.Popen(
        [*REEMBODY, "serve", *any_port, "--help-port", "0", "--until-input-ends"],
        env={"REEMBODY_DATA_DIR": str(tmp_path / "data")},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as server:
        assert server.stdin is not None
        assert server.stdout is not None
        printed = "".join(islice(server.stdout, 7))
        local, helping = re.findall(r"(?:Reembody +|\? +)(http://\S+)", printed)
        (secure,) = re.findall(r"Network +https://127\.0\.0\.1:(\d+)", printed)
        assert "0" not in (secure, local.rpartition(":")[2], helping.rpartition(":")[2])
        with httpx2.Client(transport=httpx2.HTTPTransport(retries=8), timeout=60) as client:
            assert client.get(f"{local}/api/health").is_success
            assert client.get(helping).is_success
        socket.create_connection(("127.0.0.1", int(secure)), timeout=30).close()
        server.stdin.close()
        server.wait(60)


def test_a_port_in_use_is_reported(tmp_path: Path) -> None:
    """A port in use is reported with the option to change it, before the data are touched."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        result = command(
            {"REEMBODY_DATA_DIR": str(tmp_path / "data")},
            *("serve", "--port", free_port(), "--lan"),
            *("--lan-host", "127.0.0.1", "--lan-port", port),
            *("--help-port", free_port()),
        )
    assert result.code == 2
    assert f"port {port}" in result.err
    assert "--lan-port" in result.err
    assert not (tmp_path / "data" / "reembody.sqlite").exists()


def _command(server: LanServer, *arguments: str) -> dict[str, str]:
    reported: dict[str, str] = command({"REEMBODY_DATA_DIR": str(server.data_dir)}, *arguments).json
    return reported
