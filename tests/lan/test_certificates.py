"""Tests of the certificate in the data folder: stored, renewed and private."""

from dataclasses import replace
from datetime import datetime, timedelta
from ipaddress import ip_address
from pathlib import Path

import pytest
from cryptography import x509
from cryptography.x509.oid import ExtendedKeyUsageOID

from app.clock import Clock
from app.errors import InvalidInput, NotAllowed
from app.lan.serving.addresses import LOOPBACK, Machine
from app.lan.serving.certificates import LabAuthority, OwnFiles
from app.lan.serving.leaf import hosts_of, new_leaf
from app.lan.serving.listening import tls_context
from tests.lan.machines import LAB_PC, NOW

ELSEWHERE = replace(LAB_PC, addresses=(ip_address("10.0.0.5"),))


def at(now: datetime, folder: Path) -> LabAuthority:
    """Return the lab's authority in `folder` with its clock at `now`."""
    return LabAuthority(folder, Clock(utc_now=lambda: now))


def test_only_the_owner_can_read_the_keys(tmp_path: Path) -> None:
    """The key files are private to their owner, and no partial file remains."""
    at(NOW, tmp_path).current(LAB_PC)
    folder = tmp_path / "tls"
    assert folder.stat().st_mode & 0o777 == 0o700
    modes = {file.name: file.stat().st_mode & 0o777 for file in folder.iterdir()}
    assert modes == {"authority.pem": 0o600, "server.pem": 0o600}


@pytest.mark.parametrize("name", ["authority.pem", "server.pem"])
@pytest.mark.parametrize("mode", [0o640, 0o604, 0o660])
def test_a_key_that_others_could_read_is_refused(tmp_path: Path, name: str, mode: int) -> None:
    """A key that others could read is refused with the advice to use chmod."""
    source = at(NOW, tmp_path)
    source.current(LAB_PC)
    (tmp_path / "tls" / name).chmod(mode)
    with pytest.raises(NotAllowed) as refused:
        source.current(LAB_PC)
    assert "chmod 600" in refused.value.remedy


def test_the_certificate_is_reused_at_later_starts(tmp_path: Path) -> None:
    """The certificate is reused at later starts as long as nothing changes."""
    first = at(NOW, tmp_path).current(LAB_PC)
    later = at(NOW + timedelta(days=300), tmp_path).current(LAB_PC)
    assert later == first


def test_the_certificate_has_all_names_and_addresses(tmp_path: Path) -> None:
    """The certificate has all names and addresses of the machine, for at most 397 days."""
    identity = at(NOW, tmp_path).current(LAB_PC)
    assert set(identity.hosts) == {"localhost", *LAB_PC.names, *LOOPBACK, *LAB_PC.addresses}
    assert identity.uncovered == ()
    assert identity.expires_at - NOW <= timedelta(days=397)
    pem = (tmp_path / "tls" / "server.pem").read_bytes()
    leaf = x509.load_pem_x509_certificates(pem)[0]
    usage = leaf.extensions.get_extension_for_class(x509.ExtendedKeyUsage).value
    assert list(usage) == [ExtendedKeyUsageOID.SERVER_AUTH]


def test_a_new_address_brings_a_new_certificate_of_the_same_authority(tmp_path: Path) -> None:
    """A new address of the machine leads to a new certificate of the same authority."""
    before = at(NOW, tmp_path).current(LAB_PC)
    after = at(NOW, tmp_path).current(ELSEWHERE)
    assert ip_address("10.0.0.5") in after.hosts
    assert after.server_fingerprint != before.server_fingerprint
    assert after.authority_fingerprint == before.authority_fingerprint


def test_a_lost_address_keeps_the_certificate(tmp_path: Path) -> None:
    """Losing an address does not change the certificate."""
    before = at(NOW, tmp_path).current(LAB_PC)
    assert at(NOW, tmp_path).current(Machine(LAB_PC.names, ())) == before


def test_the_certificate_is_renewed_in_its_last_month(tmp_path: Path) -> None:
    """The certificate is renewed in its last 30 days, by the same authority."""
    first = at(NOW, tmp_path).current(LAB_PC)
    assert at(first.expires_at - timedelta(days=31), tmp_path).current(LAB_PC) == first
    renewed = at(first.expires_at - timedelta(days=29), tmp_path).current(LAB_PC)
    assert renewed.expires_at > first.expires_at + timedelta(days=300)
    assert renewed.authority_fingerprint == first.authority_fingerprint


def test_a_certificate_of_a_replaced_authority_is_not_reused(tmp_path: Path) -> None:
    """After the authority is replaced, a certificate of the former one is not reused."""
    source = at(NOW, tmp_path)
    first = source.current(LAB_PC)
    source.replace_authority(LAB_PC)
    second = source.current(LAB_PC)
    assert second.authority_fingerprint != first.authority_fingerprint
    assert second.server_fingerprint != first.server_fingerprint


def test_a_later_public_address_is_reported_as_uncovered(tmp_path: Path) -> None:
    """A public address that the authority may not certify is reported as uncovered."""
    at(NOW, tmp_path).current(LAB_PC)
    public = ip_address("198.51.100.4")
    identity = at(NOW, tmp_path).current(replace(LAB_PC, addresses=(public,)))
    assert identity.uncovered == (public,)
    assert public not in identity.hosts


def test_a_broken_authority_file_is_not_replaced(tmp_path: Path) -> None:
    """A broken authority file is reported with the option to replace it, and not replaced."""
    source = at(NOW, tmp_path)
    source.current(LAB_PC)
    source.authority_file.write_bytes(b"not a key")
    with pytest.raises(InvalidInput) as refused:
        source.current(LAB_PC)
    assert "--new-authority" in refused.value.remedy


class TestOwnFiles:
    """A certificate that the lab provides itself."""

    @pytest.fixture
    def files(self, tmp_path: Path) -> OwnFiles:
        """Return a certificate for one name, as an institution would issue it."""
        authority = at(NOW, tmp_path).authority(LAB_PC)
        leaf = new_leaf(authority, ("labpc.psy.example",), NOW)
        key, _, chain = leaf.pem.partition(b"-----BEGIN CERTIFICATE")
        (tmp_path / "key.pem").write_bytes(key)
        (tmp_path / "chain.pem").write_bytes(b"-----BEGIN CERTIFICATE" + chain)
        return OwnFiles(tmp_path / "chain.pem", tmp_path / "key.pem", Clock(utc_now=lambda: NOW))

    def test_the_labs_own_certificate_is_used_unchanged(self, files: OwnFiles) -> None:
        """The lab's own certificate is used unchanged, and addresses it lacks are reported."""
        identity = files.current(LAB_PC)
        assert identity.hosts == ("labpc.psy.example",)
        assert identity.authority is None
        assert identity.uncovered == LAB_PC.addresses
        files.load_into(tls_context())

    def test_files_that_do_not_belong_together_are_refused(self, files: OwnFiles) -> None:
        """A certificate and a key that do not belong together are refused."""
        swapped = replace(files, key_file=files.certificate_file)
        with pytest.raises(InvalidInput):
            swapped.current(LAB_PC)

    def test_an_expired_certificate_is_refused(self, files: OwnFiles) -> None:
        """An expired certificate is refused with its date."""
        late = replace(files, clock=Clock(utc_now=lambda: NOW + timedelta(days=400)))
        with pytest.raises(InvalidInput, match="expired on 2027-04"):
            late.current(LAB_PC)


def test_a_certificate_without_names_has_no_hosts() -> None:
    """A certificate without names has no hosts."""
    from app.lan.serving.authority import new_authority

    assert hosts_of(new_authority(LAB_PC, NOW).certificate) == ()
