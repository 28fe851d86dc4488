"""Make a local Chromium trust a certificate authority, as a user would in its settings.

On Linux Chromium reads the trusted authorities from an NSS database below the home folder. The tool
that writes one (`certutil`) is seldom installed, but the library that Chromium itself loads is
always available, so this module calls it: `trusting_home(folder, authority)` returns a home folder
to start Chromium with. It runs in a process of its own, since the library's folder must be named
before a process starts, and since the library keeps its state permanently.
"""

import ctypes
import os
import subprocess
import sys
from pathlib import Path

from tests.support.chromium_binary import find_chromium

TRUSTED_CA = 0x18
"""CERTDB_VALID_CA | CERTDB_TRUSTED_CA, what `certutil -t C,,` sets."""


class TrustUnavailableError(Exception):
    """Raised if no trust store could be created here; the message says why."""


def trusting_home(home: Path, authority_der: Path) -> Path:
    """Make `home` a folder whose Chromium trusts `authority_der`; raises TrustUnavailableError."""
    database = home / ".pki" / "nssdb"
    database.mkdir(parents=True)
    result = subprocess.run(
        [sys.executable, str(Path(__file__)), str(database), str(authority_der)],
        env={
            **os.environ,
            **find_chromium().environment,
            "PYTHONPATH": str(Path(__file__).resolve().parents[2]),
        },
        capture_output=True,
        text=True,
        check=False,
    )
    if result.returncode != 0:
        raise TrustUnavailableError(result.stderr.strip().splitlines()[-1])
    return home


class _Trust(ctypes.Structure):
    _fields_ = (
        ("ssl", ctypes.c_uint),
        ("email", ctypes.c_uint),
        ("code", ctypes.c_uint),
    )


class _Item(ctypes.Structure):
    _fields_ = (
        ("kind", ctypes.c_int),
        ("data", ctypes.c_char_p),
        ("length", ctypes.c_uint),
    )


def _write(database: str, certificate: bytes) -> None:
    nss = ctypes.CDLL("libnss3.so")
    for name in ("PK11_GetInternalKeySlot", "CERT_FindCertByNickname", "CERT_GetDefaultCertDB"):
        getattr(nss, name).restype = ctypes.c_void_p
    _require(nss.NSS_InitReadWrite(f"sql:{database}".encode()) == 0, "NSS_InitReadWrite")
    slot = ctypes.c_void_p(nss.PK11_GetInternalKeySlot())
    if nss.PK11_NeedUserInit(slot):
        _require(nss.PK11_InitPin(slot, None, b"") == 0, "PK11_InitPin")
    item = _Item(0, certificate, len(certificate))
    imported = nss.PK11_ImportDERCert(slot, ctypes.byref(item), ctypes.c_ulong(0), b"lab", 0)
    _require(imported == 0, "PK11_ImportDERCert")
    store = ctypes.c_void_p(nss.CERT_GetDefaultCertDB())
    found = ctypes.c_void_p(nss.CERT_FindCertByNickname(store, b"lab"))
    _require(found.value, "CERT_FindCertByNickname")
    trust = _Trust(TRUSTED_CA, 0, 0)
    _require(
        nss.CERT_ChangeCertTrust(store, found, ctypes.byref(trust)) == 0, "CERT_ChangeCertTrust"
    )


def _require(worked: object, call: str) -> None:
    if not worked:
        raise OSError(f"{call} of libnss3 failed")


if __name__ == "__main__":
    _write(sys.argv[1], Path(sys.argv[2]).read_bytes())
