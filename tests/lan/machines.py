"""Made-up machines and dates for the tests of certificates."""

from datetime import UTC, datetime
from ipaddress import ip_address

from app.lan.serving.addresses import Machine

NOW = datetime(2026, 3, 2, 9, 30, tzinfo=UTC)
LAB_PC = Machine(
    names=("labpc.local", "labpc.psy.example"),
    addresses=(ip_address("192.168.7.20"), ip_address("fd12::20")),
)
