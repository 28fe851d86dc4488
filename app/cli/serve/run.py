"""What `reembody serve` and `reembody tls` do: the server, and the certificate it shows.

The server listens on this machine, and on the lab's network if asked to.
"""

import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Mapping

import uvicorn
from fastapi import FastAPI
from sqlalchemy.exc import DBAPIError

from app.cli.errors import fail, reported
from app.cli.serve.output import addresses, certificate_text
from app.clock import Clock
from app.database_address import first_line, shown_address
from app.errors import InvalidInput, ReembodyError
from app.features.care.opening import prepare_database, put_away_if_damaged
from app.features.care.ownership import Ownership, own_data
from app.gc_tuning import freeze_startup_objects
from app.lan import Network
from app.lan.serving import (
    CertificateWatch,
    Door,
    HelpSite,
    LabAuthority,
    LabServer,
    Plan,
    SocketProtocol,
    allow_open_files,
    bind,
    look_around,
    make_plan,
    tls_context,
)
from app.main import create_app
from app.platform.background import Background
from app.platform.folders import database_file
from app.platform.rate_limit import network_of, usual_limits
from app.platform.trouble import in_plain_words
from app.settings import Settings, read_settings

ENDS_WITHIN_S = 15.0
CERTIFICATE = "certificate"
"""The name of its watch among what runs in the background."""
SWITCH_INTERVAL_S = 0.0005
"""The event loop and the telemetry writer let go of the interpreter at every call into the network
or the database. With Python's own 5 ms, each then waits that long for a thread that computes."""


def serve_forever(
    given: Mapping[str, object], *, new_database: bool = False, until_input_ends: bool = False
) -> None:
    """Serve until interrupted; says where, and on the first start the admin's password.

    `given` are settings from the command line, None where nothing was said. A database that cannot
    be worked with, a port that is taken or an address that may not be opened ends it before it
    listens, saying why and what to do; `new_database` begins an empty one in the place of one in
    quarantine. With `until_input_ends` it ends when its standard input is closed: then whoever
    holds the other end is gone, also where they were killed and could end nobody.
    """
    if until_input_ends:
        threading.Thread(target=_end_with_the_input, daemon=True).start()
    with reported():
        settings = settings_with(given)
        # Before anything else: even a certificate is a file of somebody's folder.
        own = own_data(settings, port=settings.port)
    with own:
        _serve(settings, own, new_database=new_database)


def _serve(settings: Settings, own: Ownership, *, new_database: bool) -> None:
    with reported():
        plan = make_plan(settings, Clock())
        watch = CertificateWatch(
            plan, Network(), None if plan.certificates is None else tls_context()
        )
        watch.refresh()
        bound = _Bound(plan)
    own.announce(bound.local[0].getsockname()[1])
    _prepare(settings, new_database=new_database)
    app = create_app(
        settings,
        network=watch.network,
        on_first_password=_tell_password,
        ownership=own,
        # As a service manager would: sessions' phases are paused by whoever has the data now.
        on_taken_over=lambda: os.kill(os.getpid(), signal.SIGTERM),
    )
    background: Background = app.state.context.background
    background.watch_process()
    watch.report_to(
        lambda error: background.failed(CERTIFICATE, error), lambda: background.well(CERTIFICATE)
    )
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    freeze_startup_objects()
    print(addresses(watch.network.reach, _where(settings)), flush=True)
    allow_open_files()
    server = LabServer(bound.doors(app, watch, settings), watch.run)
    logging.getLogger("uvicorn.error").addFilter(_is_no_trace)
    try:
        server.run()
    except KeyboardInterrupt:
        return
    except SystemExit:
        error: Exception | None = getattr(app.state, "not_started", None)
        if error is None:
            raise
        with reported():
            raise why_not(error, settings) from error


def settings_with(given: Mapping[str, object]) -> Settings:
    """The settings of the environment, with those that were `given` in their place.

    Raises InvalidInput where a variable cannot be one.
    """
    return read_settings().model_copy(
        update={name: value for name, value in given.items() if value is not None}
    )


def show_certificate(*, as_json: bool) -> str:
    """The certificate that `serve --lan` shows; the built-in one is made if there is none."""
    plan = make_plan(settings_with({"lan": True, "without_tls": False}), Clock())
    assert plan.certificates is not None  # noqa: S101 - asked for with lan
    return certificate_text(plan.certificates.current(look_around()), as_json=as_json)


def renew_certificate(*, new_authority: bool, as_json: bool) -> str:
    """A new certificate of the built-in authority; a running server takes it within a minute.

    With `new_authority` also a new authority: every device then has to install it.
    """
    plan = make_plan(settings_with({"lan": True, "without_tls": False}), Clock())
    source, machine = plan.certificates, look_around()
    if not isinstance(source, LabAuthority):
        raise InvalidInput(
            "the certificate is your own file, which only you can renew",
            remedy="Put the new one in its place; a running server takes it within a minute",
        )
    if new_authority:
        source.replace_authority(machine)
    return certificate_text(source.renew(machine), as_json=as_json)


class _Bound:
    """The ports, taken before the database is looked at."""

    def __init__(self, plan: Plan) -> None:
        self.local = bind(plan.local_hosts, plan.local_port, "--port")
        self.lan = bind(plan.lan_hosts, plan.lan_port, "--lan-port") if plan.certificates else ()
        self.help = (
            bind(plan.lan_hosts, plan.help_port, "--help-port")
            if plan.help_port is not None
            else ()
        )

    def doors(self, app: FastAPI, watch: CertificateWatch, settings: Settings) -> list[Door]:
        """What is served behind each of them."""
        config = _config(app, settings)
        doors = [Door(self.local, config)]
        if self.lan:
            doors.append(Door(self.lan, config, watch.tls))
        if self.help:
            budget = usual_limits(Clock().monotonic_ns).strangers
            site = HelpSite(
                watch.network, watch.authority, lambda address: budget.spend(network_of(address))
            )
            doors.append(Door(self.help, _config(site, settings)))
        return doors


def _config(app: object, settings: Settings) -> uvicorn.Config:
    return uvicorn.Config(
        app,  # type: ignore[arg-type]  # any ASGI application
        ws=SocketProtocol,
        ws_max_size=settings.max_telemetry_message_bytes,
        log_level="warning",
        proxy_headers=False,
        server_header=False,
        timeout_graceful_shutdown=5,
    )


def _prepare(settings: Settings, *, new_database: bool) -> None:
    with reported():
        try:
            kept = prepare_database(settings, Clock(), new_database=new_database, to_write=True)
        except DBAPIError as error:
            if database_file(settings) is not None:
                raise
            fail(f"the database cannot be opened: {first_line(error)}")
    if kept is not None:
        print(f"Backup     {kept}, made before the database was migrated", flush=True)


def _is_no_trace(record: logging.LogRecord) -> bool:
    """uvicorn's own account of an application that did not start; `why_not` has a better."""
    return not record.getMessage().startswith("Traceback (most recent call last)")


def why_not(error: Exception, settings: Settings) -> Exception:
    """Why the application did not start, after the first look at its database found it whole.

    What that look leaves out in a large file may be damaged; any error that is neither that nor the
    disk's or the database's is a fault of the program.
    """
    try:
        put_away_if_damaged(settings, Clock(), every_row=True)
    except ReembodyError as said:
        return said
    return in_plain_words("the server cannot start", error) if isinstance(error, OSError) else error


def _end_with_the_input() -> None:
    # Not through `sys.stdin`: a thread that waits there is in the way of Python's own end.
    while os.read(0, 1024):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(ENDS_WITHIN_S)
    os._exit(1)


def _where(settings: Settings) -> str:
    if settings.database_url:
        return shown_address(settings.database_url)
    return str(settings.data_dir.resolve())


def _tell_password(password: str) -> None:
    sys.stdout.write(
        f"\nFirst start: log in as  admin  with the password  {password}\n"
        "It is shown this once. Keep it.\n\n"
    )
    sys.stdout.flush()
