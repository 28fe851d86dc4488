"""Tests of what the terminal prints before the server listens."""

from pathlib import Path

import pytest

from app.cli.serve.output import addresses
from app.clock import Clock
from app.lan.network import Reach
from app.lan.serving.plan import make_plan
from app.settings import Settings
from tests.lan.machines import LAB_PC


def test_a_local_server_prints_three_lines() -> None:
    """A server for this machine alone prints its address, a note on tablets and the data folder."""
    assert addresses(Reach(), "data").splitlines() == [
        "Reembody   http://127.0.0.1:8321",
        "Tablet     only this computer can reach the server; for tablets start it with --lan",
        "Data       data",
    ]


def test_a_server_without_encryption_warns() -> None:
    """A server without encryption prints a warning in capitals with the option to use."""
    reported = addresses(Reach(mode="without_tls", urls=("http://192.168.7.20:8321",)), "data")
    assert "WITHOUT ENCRYPTION" in reported
    assert "--lan" in reported


@pytest.mark.parametrize("at_terminal", [True, False])
def test_the_network_is_printed_with_its_fingerprint(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, at_terminal: bool
) -> None:
    """The whole fingerprint and the help page are printed, with a QR code only on a terminal."""
    plan = make_plan(Settings(data_dir=tmp_path, lan=True), Clock())
    assert plan.certificates is not None
    identity = plan.certificates.current(LAB_PC)
    monkeypatch.setattr("sys.stdout.isatty", lambda: at_terminal)
    reported = addresses(plan.reach(LAB_PC, identity), "data")
    shown = identity.authority_fingerprint or ""
    assert shown[:47] in reported
    assert shown[48:] in reported
    assert "Tablet     https://192.168.7.20:8443/tablet" in reported
    assert "http://192.168.7.20:8080" in reported
    assert ("█" in reported) is at_terminal
