"""`reembody tls`: the certificate of the lab's network."""

from typing import Annotated

import typer

from app.cli.failing import fail

tls = typer.Typer(help="The certificate of the lab's network.", no_args_is_help=True)


@tls.command("show")
def tls_show(
    as_json: Annotated[bool, typer.Option("--json", help="Print it as JSON.")] = False,
) -> None:
    """Show fingerprints, names and expiry."""
    from app.cli.serve.certificates import show_certificate
    from app.errors import ReembodyError

    try:
        print(show_certificate(as_json=as_json))
    except ReembodyError as error:
        fail(f"{error.message}. {error.remedy}".strip())


@tls.command("renew")
def tls_renew(
    new_authority: Annotated[
        bool,
        typer.Option("--new-authority", help="Also a new authority, for each device to install."),
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print it as JSON.")] = False,
) -> None:
    """Make a new certificate; devices notice nothing, and stay paired."""
    from app.cli.serve.certificates import renew_certificate
    from app.errors import ReembodyError

    try:
        print(renew_certificate(new_authority=new_authority, as_json=as_json))
    except ReembodyError as error:
        fail(f"{error.message}. {error.remedy}".strip())
