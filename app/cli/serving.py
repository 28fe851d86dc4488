"""Starting the server on this machine."""

import sys

import uvicorn

from app.main import create_app
from app.settings import Settings


def serve_forever(*, host: str | None, port: int | None) -> None:
    """Serve until interrupted; says where, and on the first start the admin's password."""
    given = {"host": host, "port": port}
    settings = Settings().model_copy(
        update={name: value for name, value in given.items() if value is not None}
    )
    app = create_app(settings, on_first_password=_tell_password)
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
