"""Settings of the installation, such as where data are stored and which address is served.

They are built in `create_app` or a command, never at import, so that two applications in one
process (tests, the rehearsal's own server) can have different settings.
"""

import os
from pathlib import Path

from pydantic import Field, SecretStr, ValidationError
from pydantic_settings import BaseSettings, SettingsConfigDict, SettingsError

from app.errors import InvalidInput

PREFIX = "REEMBODY_"
NEVER_EMPTY = ("data_dir", "database_url")
"""Settings that may not be empty: the data would end up in an unexpected place."""


class Settings(BaseSettings):
    """The installation's frozen settings, from `REEMBODY_*` variables, overridden by arguments.

    `database_url` empty means the embedded SQLite database in `data_dir`. `admin_password` is for
    scripts; without it the first start makes a random one and prints it once. When less than
    `low_disk_bytes` are free in `data_dir`, the console warns. A running phase is paused after
    `headset_silent_s` without a frame. A capture file may have up to `max_capture_bytes`, every
    other request `max_body_bytes`.

    `lan` opens https on `lan_port` of every address (or of `lan_host`), with `certificate` and
    `key` or with the built-in authority, whose help page is on `help_port`. An address that others
    can reach is refused without TLS unless `without_tls` is set (docs/lab-network.md). `host_names`
    are full names that the lab's name server has for this machine.
    """

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True, extra="ignore")

    data_dir: Path = Path("data")
    database_url: str = ""
    admin_password: SecretStr | None = None
    host: str = "127.0.0.1"
    port: int = Field(8321, ge=0, le=65535)
    lan: bool = False
    lan_host: str = ""
    lan_port: int = Field(8443, ge=0, le=65535)
    help_port: int = Field(8080, ge=0, le=65535)
    certificate: Path | None = None
    key: Path | None = None
    without_tls: bool = False
    host_names: tuple[str, ...] = ()
    commit_interval_s: float = 0.05
    login_hours: float = 12.0
    pairing_minutes: float = 10.0
    max_body_bytes: int = 2 * 1024 * 1024
    max_capture_bytes: int = 64 * 1024 * 1024
    max_telemetry_message_bytes: int = 256 * 1024
    low_disk_bytes: int = 1024**3
    headset_silent_s: float = 3.0

    @property
    def scratch_dir(self) -> Path:
        """The folder for temporary files, such as exports to download, inside the data folder."""
        return (self.data_dir / "scratch").resolve()

    @property
    def resolved_database_url(self) -> str:
        """The address of the database: the embedded SQLite file, unless one is set."""
        if self.database_url:
            return self.database_url
        return f"sqlite:///{(self.data_dir / 'reembody.sqlite').resolve()}"


def read_settings() -> Settings:
    """Read the settings from the environment.

    Raises InvalidInput that names each invalid variable but no value: a value may contain a
    password.
    """
    for name in NEVER_EMPTY:
        variable = f"{PREFIX}{name.upper()}"
        given = [value for key, value in os.environ.items() if key.upper() == variable]
        if given and not given[0].strip():
            raise InvalidInput(
                f"{variable} is set, but empty",
                remedy="Unset it to use the default, or give it a value",
            )
    try:
        return Settings()
    except ValidationError as error:
        problems = "; ".join(
            f"{PREFIX}{str(one['loc'][0]).upper()}: {one['msg']}" for one in error.errors()
        )
    except SettingsError as error:
        problems = str(error)
    raise InvalidInput(
        f"the settings cannot be used: {problems}",
        remedy="Correct or unset these environment variables",
    )
