"""Run `reembody serve` and `reembody tls`: the server and its certificate.

The server listens on this machine, and on the lab's network if requested.
"""

import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import closing
from dataclasses import replace
from socket import socket

import uvicorn
from fastapi import FastAPI
from sqlalchemy.exc import DBAPIError

from app.cli.errors import fail, reported
from app.cli.serve.output import addresses, certificate_text
from app.clock import Clock
from app.database_address import first_line, shown_address
from app.errors import InvalidInput, ReembodyError
from app.features.care.opening import prepare_database, quarantine_if_damaged
from app.features.care.ownership import Ownership, own_data
from app.gc_tuning import freeze_startup_objects, limit_arenas
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
    current_machine,
    make_plan,
    port_of,
    tls_context,
)
from app.main import create_app
from app.platform.background import Background
from app.platform.folders import database_file
from app.platform.rate_limit import network_of, usual_limits
from app.platform.trouble import not_durable_error
from app.settings import Settings, read_settings

ENDS_WITHIN_S = 15.0
CERTIFICATE = "certificate"
"""The name of the certificate's watch among the background tasks."""
SWITCH_INTERVAL_S = 0.0005
"""The switch interval. The event loop and the telemetry writer release the interpreter
lock at every call of the network or the database. With Python's default of 5 ms, each then waits
that long for a thread that computes."""


def serve_forever(
    given: Mapping[str, object], *, new_database: bool = False, until_input_ends: bool = False
) -> None:
    """Serve until interrupted; print the address and, at the first start, the admin's password.

    `given` are settings from the command line, None if not given. If the database cannot be used, a
    port is taken or an address may not be opened, it exits before listening, with the reason and a
    remedy; `new_database` creates an empty database in place of a quarantined one. With
    `until_input_ends` the server ends when its standard input is closed: then the process with the
    other end has ended, even if it was killed and could not stop the server.
    """
    if until_input_ends:
        threading.Thread(target=_end_with_the_input, daemon=True).start()
    with reported():
        settings = settings_with(given)
        # Before anything else, because even a certificate is a file in the data folder.
        own = own_data(settings, port=settings.port)
    with own:
        _serve(settings, own, new_database=new_database)


def _serve(settings: Settings, own: Ownership, *, new_database: bool) -> None:
    with reported():
        bound = _Bound(make_plan(settings, Clock()))
    with closing(bound):
        _serve_on(bound, settings, own, new_database=new_database)


def _serve_on(bound: "_Bound", settings: Settings, own: Ownership, *, new_database: bool) -> None:
    with reported():
        watch = CertificateWatch(
            bound.plan, Network(), None if bound.plan.certificates is None else tls_context()
        )
        watch.refresh()
    own.announce(bound.plan.local_port)
    _prepare(settings, new_database=new_database)
    app = create_app(
        settings,
        network=watch.network,
        on_first_password=_print_password,
        ownership=own,
        # Stop like on a signal of a service manager; the new owner of the data pauses running
        # phases.
        on_taken_over=lambda: os.kill(os.getpid(), signal.SIGTERM),
    )
    background: Background = app.state.context.background
    background.watch_process()
    watch.report_to(
        lambda error: background.failed(CERTIFICATE, error),
        lambda: background.recovered(CERTIFICATE),
    )
    if database_file(settings) is not None:
        # With PostgreSQL the server's memory does not grow, and its threads would wait for another.
        limit_arenas()
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
    """Return the settings of the environment, overridden by those that were `given`.

    Raises InvalidInput if a variable is invalid.
    """
    return read_settings().model_copy(
        update={name: value for name, value in given.items() if value is not None}
    )


def show_certificate(*, as_json: bool) -> str:
    """Describe the certificate of `serve --lan`; the built-in one is created if necessary."""
    plan = make_plan(settings_with({"lan": True, "without_tls": False}), Clock())
    assert plan.certificates is not None  # noqa: S101 - asked for with lan
    return certificate_text(plan.certificates.current(current_machine()), as_json=as_json)


def renew_certificate(*, new_authority: bool, as_json: bool) -> str:
    """Renew the certificate of the built-in authority; a running server uses it within a minute.

    With `new_authority`, a new authority is created, too: every device then has to install it.
    """
    plan = make_plan(settings_with({"lan": True, "without_tls": False}), Clock())
    source, machine = plan.certificates, current_machine()
    if not isinstance(source, LabAuthority):
        raise InvalidInput(
            "the certificate is your own file, which only you can renew",
            remedy="Replace the file; a running server uses the new one within a minute",
        )
    if new_authority:
        source.replace_authority(machine)
    return certificate_text(source.renew(machine), as_json=as_json)


class _Bound:
    """The server's sockets, bound before the database is opened.

    `plan` has the ports that were taken, also where any free one was asked for.
    """

    def __init__(self, plan: Plan) -> None:
        self.local: tuple[socket, ...] = ()
        self.lan: tuple[socket, ...] = ()
        self.help: tuple[socket, ...] = ()
        try:
            self.local = bind(plan.local_hosts, plan.local_port, "--port")
            if plan.certificates:
                self.lan = bind(plan.lan_hosts, plan.lan_port, "--lan-port")
            if plan.help_port is not None:
                self.help = bind(plan.lan_hosts, plan.help_port, "--help-port")
        except BaseException:
            self.close()
            raise
        self.plan = replace(
            plan,
            local_port=port_of(self.local),
            lan_port=port_of(self.lan) if self.lan else plan.lan_port,
            help_port=port_of(self.help) if self.help else plan.help_port,
        )

    def close(self) -> None:
        """Give the ports back."""
        for one in (*self.local, *self.lan, *self.help):
            one.close()

    def doors(self, app: FastAPI, watch: CertificateWatch, settings: Settings) -> list[Door]:
        """Return the listeners: each group of sockets with the application served on it."""
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
            backup = prepare_database(settings, Clock(), new_database=new_database, to_write=True)
        except DBAPIError as error:
            if database_file(settings) is not None:
                raise
            fail(f"the database cannot be opened: {first_line(error)}")
    if backup is not None:
        print(f"Backup     {backup}, made before the database was migrated", flush=True)


def _is_no_trace(record: logging.LogRecord) -> bool:
    """Return whether a log record is not uvicorn's traceback of a failed start.

    `why_not` reports that failure in better words.
    """
    return not record.getMessage().startswith("Traceback (most recent call last)")


def why_not(error: Exception, settings: Settings) -> Exception:
    """Return the error to report for an application that did not start.

    The first check of a large database file skips rows, which are all checked here. An error that
    is neither damage nor caused by the disk or the database is a fault of the program.
    """
    try:
        quarantine_if_damaged(settings, Clock(), every_row=True)
    except ReembodyError as said:
        return said
    return (
        not_durable_error("the server cannot start", error) if isinstance(error, OSError) else error
    )


def _end_with_the_input() -> None:
    # Not through `sys.stdin`: a thread that waits there blocks Python's own exit.
    while os.read(0, 1024):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(ENDS_WITHIN_S)
    os._exit(1)


def _where(settings: Settings) -> str:
    if settings.database_url:
        return shown_address(settings.database_url)
    return str(settings.data_dir.resolve())


def _print_password(password: str) -> None:
    sys.stdout.write(
        f"\nFirst start: sign in as  admin  with the password  {password}\n"
        "It is shown only once. Keep it.\n\n"
    )
    sys.stdout.flush()
