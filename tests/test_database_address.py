"""Tests that a wrong database URL causes one sentence and exit code 2, and prints no password."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import psycopg
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.database import make_engine
from app.database_address import database_address, shown_address
from app.errors import InvalidInput
from app.features.care.ownership import own_data
from app.platform.folders import database_file
from app.settings import Settings, read_settings
from tests.cli.invoked import Invoked
from tests.faults.commands import CommandResult, command
from tests.support.postgres import Cluster, running_cluster

pytestmark = pytest.mark.thorough

SECRET = "tiger-in-the-tank"


@pytest.mark.parametrize(
    ("url", "said"),
    [
        ("", "is empty"),
        ("   ", "is empty"),
        (" postgresql://host/db", "begins or ends with a space"),
        ("postgresql://host/db\n", "begins or ends with a space"),
        (SECRET, "does not begin with a scheme"),
        ("localhost:5432/db", "does not begin with a scheme"),
        (f"mysql://u:{SECRET}@host/db", "begins with mysql://, which is not supported"),
        (f"postgresql+psycopg2://u:{SECRET}@host/db", "postgresql+psycopg2://"),
        (f"postgresql://u:p@{SECRET}@host/db", "more than one @"),
        (f"postgresql://u:p@{SECRET}/x@host/db", "more than one @"),
        (f"postgresql://u:{SECRET}@ho st/db", "host name with a space"),
        (f"postgresql://u:{SECRET}@host:port/db", "port that is not a number"),
        (f"postgresql://u:{SECRET}@host:5 432/db", "port that is not"),
        (f"postgresql://u:{SECRET}@host:70000/db", "not between 1 and 65535"),
        (f"postgresql://u:{SECRET}@host:0/db", "not between 1 and 65535"),
        ("sqlite://reembody.sqlite", "names a host"),
        (f"sqlite://u:{SECRET}@/srv/lab.sqlite", "names a role or a password"),
        ("sqlite:///file:/srv/lab.sqlite?uri=true", "names its file as file:"),
        ("sqlite:///file:lab.sqlite", "names its file as file:"),
        ("sqlite:///FILE::memory:?cache=shared", "names its file as file:"),
        ("sqlite:////srv/lab.sqlite?uri=true", "after a question mark (uri)"),
        ("sqlite:////srv/lab.sqlite?mode=memory&vfs=unix-none", "question mark (mode, vfs)"),
        ("sqlite:////srv/lab.sqlite?immutable=1", "question mark (immutable)"),
        (f"sqlite:////srv/lab.sqlite?key={SECRET}", "options after a question mark,"),
        (f"sqlite:////srv/lab.sqlite?{SECRET}=1", "options after a question mark,"),
        ("sqlite:////srv/lab?", "options after a question mark,"),
        ("sqlite:///:memory:?uri=1", "options after a question mark (uri)"),
    ],
)
def test_an_invalid_url_is_rejected_without_its_password(url: str, said: str) -> None:
    """An invalid URL is rejected wherever it is opened, without printing its password."""
    for read in (database_address, make_engine, shown_address):
        with pytest.raises(InvalidInput) as refused:
            read(url)
        assert said in refused.value.message
        everything = str(refused.value.as_json())
        assert SECRET not in everything
        assert "postgresql://ROLE:PASSWORD@HOST:5432/DATABASE" in everything


@given(st.text(max_size=60))
def test_any_text_is_parsed_as_a_url_or_rejected(rest: str) -> None:
    """Any text given as a database URL is either parsed or rejected with the same error."""
    for scheme in ("", "postgresql://", "postgresql://u:p@", "sqlite:///", "sqlite://"):
        with suppress(InvalidInput):
            database_address(scheme + rest)


@pytest.mark.parametrize(
    ("url", "shown"),
    [
        (f"postgresql://u:{SECRET}@host/db", "host/db"),
        (f"postgres://u:{SECRET}@host:5433/db?sslmode=require&password={SECRET}", "host:5433/db"),
        ("postgresql+psycopg://u@/db?host=/run/postgresql", "/run/postgresql/db"),
        ("sqlite:////srv/my data/lab.sqlite", "/srv/my data/lab.sqlite"),
    ],
)
def test_a_url_is_printed_without_role_and_password(url: str, shown: str) -> None:
    """A database URL is printed without its role and password."""
    assert shown_address(url) == shown


@pytest.mark.parametrize("name", ["link/../lab.sqlite", "./lab.sqlite", "a/../lab.sqlite"])
def test_the_file_that_is_opened_is_the_one_that_is_locked(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file that is opened is the one that is locked, also for a path with a link and `..`.

    The driver and the system resolve such a path differently.
    """
    monkeypatch.chdir(tmp_path)
    (tmp_path / "elsewhere" / "deep").mkdir(parents=True)
    (tmp_path / "link").symlink_to(tmp_path / "elsewhere" / "deep")
    settings = Settings(data_dir=tmp_path, database_url=f"sqlite:///{tmp_path}/{name}")
    engine = make_engine(settings.resolved_database_url)
    with engine.connect() as connection:
        opened = connection.exec_driver_sql("PRAGMA database_list").one()[2]
    engine.dispose()
    file = database_file(settings)
    assert file is not None
    assert file.resolve() == Path(opened).resolve()


def test_a_folder_with_a_question_mark_is_rejected(tmp_path: Path) -> None:
    """A folder with a question mark is rejected before anything is created.

    The path in the URL would end there, and the database would be created elsewhere.
    """
    settings = Settings(data_dir=tmp_path / "why?")
    with pytest.raises(InvalidInput, match="question mark") as refused:
        own_data(settings)
    assert "REEMBODY_DATA_DIR" in refused.value.remedy
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["REEMBODY_DATABASE_URL", "REEMBODY_DATA_DIR"])
def test_an_empty_variable_is_rejected(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """An environment variable that is set but empty is rejected.

    It would create an empty database in an unexpected place.
    """
    monkeypatch.setenv(name, "")
    with pytest.raises(InvalidInput, match=f"{name} is set, but empty"):
        read_settings()


def test_invalid_settings_are_reported_without_values(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Invalid settings are reported by the names of their variables, without the values."""
    monkeypatch.setenv("REEMBODY_PORT", SECRET)
    with pytest.raises(InvalidInput, match="REEMBODY_PORT") as refused:
        read_settings()
    assert SECRET not in str(refused.value.as_json())
    monkeypatch.delenv("REEMBODY_PORT")
    monkeypatch.setenv("REEMBODY_HOST_NAMES", SECRET)
    with pytest.raises(InvalidInput, match="host_names"):
        read_settings()


@pytest.mark.parametrize(
    "command",
    [
        ("serve", "--port", "0"),
        ("backup", "x.reembody"),
        ("verify", "--session", "x"),
        ("token",),
        ("tls", "show"),
    ],
)
def test_each_command_reports_an_invalid_url_and_exits_with_2(
    command: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Each command reports an invalid URL in one sentence and exits with code 2.

    It prints no traceback, no address banner and no password.
    """
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("REEMBODY_DATA_DIR", str(tmp_path))
    wrong = "" if command[0] == "tls" else f"postgresql://u:p@{SECRET}@host/db"
    monkeypatch.setenv("REEMBODY_DATABASE_URL", wrong)
    said = Invoked(*command[:1]).refusal(*command[1:])
    assert "REEMBODY_DATABASE_URL" in said
    assert SECRET not in said
    assert said.count("\n") <= 1


@contextmanager
def database(cluster: Cluster, name: str, *, encoding: str = "UTF8") -> Iterator[str]:
    """Create a database with the given encoding and return its URL."""
    with psycopg.connect(
        host=str(cluster.folder), user="postgres", dbname="postgres", autocommit=True
    ) as connection:
        connection.execute(f"DROP DATABASE IF EXISTS {name}".encode())
        connection.execute(
            f"CREATE DATABASE {name} ENCODING '{encoding}' LOCALE 'C' TEMPLATE template0".encode()
        )
        try:
            yield cluster.url(name)
        finally:
            connection.execute(f"DROP DATABASE {name} WITH (FORCE)".encode())


@pytest.mark.parametrize(
    ("encoding", "statement", "said"),
    [
        ("LATIN1", "SELECT 1", "stores text as LATIN1"),
        ("SQL_ASCII", "SELECT 1", "stores text as SQL_ASCII"),
        (
            "UTF8",
            "ALTER DATABASE unusable SET default_transaction_read_only = on",
            "is read-only",
        ),
        ("UTF8", "DROP SCHEMA public", "the role postgres has no schema"),
    ],
)
def test_a_database_with_an_unsuitable_encoding_is_rejected(
    encoding: str, statement: str, said: str, tmp_path: Path
) -> None:
    """A database with an unsuitable encoding is rejected before anything is created in it.

    The message names the remedy.
    """
    cluster = running_cluster()
    with database(cluster, "unusable", encoding=encoding) as url:
        with psycopg.connect(
            host=str(cluster.folder), user="postgres", dbname="unusable", autocommit=True
        ) as connection:
            connection.execute(statement.encode())
        done = serve(tmp_path, url)
        with psycopg.connect(
            host=str(cluster.folder), user="postgres", dbname="unusable"
        ) as connection:
            tables = connection.execute(
                "SELECT count(*) FROM pg_tables WHERE tablename = 'alembic_version'"
            ).fetchone()
    assert (done.code, done.out) == (2, "")
    assert said in done.err
    assert "docs/postgresql.md" in done.err
    assert done.err.count("\n") == 1
    assert tables == (0,)


def test_an_unreachable_database_server_is_reported(tmp_path: Path) -> None:
    """An unreachable database server is reported in one sentence, without the password.

    The message names what to check.
    """
    done = serve(tmp_path, f"postgresql://role:{SECRET}@127.0.0.1:1/db")
    assert (done.code, done.out) == (2, "")
    assert "the database 127.0.0.1:1/db cannot be reached" in done.err
    assert SECRET not in done.err
    assert done.err.count("\n") == 1


def serve(folder: Path, url: str) -> CommandResult:
    """Run `reembody serve` until it ends."""
    environment = {"REEMBODY_DATA_DIR": str(folder), "REEMBODY_DATABASE_URL": url}
    return command(environment, "serve", "--port", "0")
