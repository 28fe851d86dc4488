"""Starting the server on this machine."""

import gc
import sys
from typing import NoReturn

import uvicorn
from sqlalchemy.exc import DBAPIError

from app.clock import Clock
from app.errors import ReembodyError
from app.features.opening.service import prepare_database
from app.main import create_app
from app.settings import Settings

UNUSABLE = 2
SWITCH_INTERVAL_S = 0.0005
"""The event loop and the telemetry writer let go of the interpreter at every call into the network
or the database. With Python's own 5 ms, each then waits that long for a thread that computes."""


def serve_forever(*, host: str | None, port: int | None, new_database: bool = False) -> None:
    """Serve until interrupted; says where, and on the first start the admin's password.

    A database that cannot be worked with ends it before it listens, saying why and what to do;
    `new_database` begins an empty one in the place of one in quarantine.
    """
    given = {"host": host, "port": port}
    settings = Settings().model_copy(
        update={name: value for name, value in given.items() if value is not None}
    )
    _prepare(settings, new_database=new_database)
    app = create_app(settings, on_first_password=_tell_password)
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    # What is here to stay need not be searched for garbage: that took 0.2 s now and then, in which
    # nothing was acknowledged.
    gc.collect()
    gc.freeze()
    url = f"http://{settings.host}:{settings.port}"
    print(f"Reembody   {url}\nTablet     {url}/tablet\nData       {_where(settings)}", flush=True)
    uvicorn.run(
        app,
        host=settings.host,
        port=settings.port,
        ws="websockets-sansio",
        ws_max_size=settings.max_telemetry_message_bytes,
        log_level="warning",
        proxy_headers=False,
        server_header=False,
        timeout_graceful_shutdown=5,
    )


def _prepare(settings: Settings, *, new_database: bool) -> None:
    try:
        kept = prepare_database(settings, Clock(), new_database=new_database)
    except ReembodyError as error:
        _give_up(f"{error.message}. {error.remedy}")
    except DBAPIError as error:
        _give_up(f"the database cannot be opened: {error.orig}")
    if kept is not None:
        print(f"Backup     {kept}, made before the database was migrated", flush=True)


def _give_up(why: str) -> NoReturn:
    print(f"reembody: {why}", file=sys.stderr)
    raise SystemExit(UNUSABLE)


def _where(settings: Settings) -> str:
    if settings.database_url:
        return settings.database_url.rpartition("@")[2]
    return str(settings.data_dir.resolve())


def _tell_password(password: str) -> None:
    sys.stdout.write(
        f"\nFirst start: log in as  admin  with the password  {password}\n"
        "It is shown this once. Keep it.\n\n"
    )
    sys.stdout.flush()
