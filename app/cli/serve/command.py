"""Define the commands `serve`, `tls show` and `tls renew`: parse their options and run them."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.errors import reported
from app.gc_tuning import loading_modules

MOST = 65_535
"""The highest port number."""
tls = typer.Typer(help="The certificate of the lab's network.", no_args_is_help=True)


def serve(
    port: Annotated[
        int | None, typer.Option(min=0, max=MOST, help="Port to listen on; 0: any free one.")
    ] = None,
    host: Annotated[str | None, typer.Option(help="Address to listen on.")] = None,
    lan: Annotated[
        bool | None, typer.Option("--lan", help="Also https on the lab's network.")
    ] = None,
    lan_port: Annotated[
        int | None, typer.Option(min=0, max=MOST, help="Port of https (8443).")
    ] = None,
    lan_host: Annotated[
        str | None, typer.Option(help="Address of https; every one of this machine if left out.")
    ] = None,
    help_port: Annotated[
        int | None,
        typer.Option(min=0, max=MOST, help="Port of the page that helps devices (8080)."),
    ] = None,
    certificate: Annotated[
        Path | None, typer.Option(help="Your own certificate with its chain, PEM.")
    ] = None,
    key: Annotated[Path | None, typer.Option(help="Its key, PEM.")] = None,
    without_tls: Annotated[
        bool | None, typer.Option("--without-tls", help="Reachable by others, unencrypted.")
    ] = None,
    new_database: Annotated[
        bool,
        typer.Option(
            "--new-database", help="Create a new database after quarantining the old one."
        ),
    ] = False,
    until_input_ends: Annotated[bool, typer.Option("--until-input-ends", hidden=True)] = False,
) -> None:
    """Serve Reembody on this machine, with --lan also on the lab's network."""
    with loading_modules():
        from app.cli.serve.run import serve_forever

    given = {
        "port": port,
        "host": host,
        "lan": lan,
        "lan_port": lan_port,
        "lan_host": lan_host,
        "help_port": help_port,
        "certificate": certificate,
        "key": key,
        "without_tls": without_tls,
    }
    serve_forever(given, new_database=new_database, until_input_ends=until_input_ends)


@tls.command("show")
def tls_show(
    as_json: Annotated[bool, typer.Option("--json", help="Print it as JSON.")] = False,
) -> None:
    """Show fingerprints, names and expiry."""
    from app.cli.serve.run import show_certificate

    with reported():
        print(show_certificate(as_json=as_json))


@tls.command("renew")
def tls_renew(
    new_authority: Annotated[
        bool,
        typer.Option("--new-authority", help="Also make a new authority, to install on devices."),
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print it as JSON.")] = False,
) -> None:
    """Make a new certificate; devices stay paired and need no change."""
    from app.cli.serve.run import renew_certificate

    with reported():
        print(renew_certificate(new_authority=new_authority, as_json=as_json))
