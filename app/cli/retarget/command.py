"""Define the command `retarget`: parse its options, run it, print the results."""

import json
from pathlib import Path
from typing import Annotated

import typer

from app.cli.errors import fail, reported


def retarget(
    clip: Annotated[
        Path | None, typer.Argument(help="Capture: BVH, Motive CSV, AMC, C3D, TRC and others.")
    ] = None,
    to: Annotated[
        str | None,
        typer.Option(help="130cm, 165cm, 190cm, any other stature, or a file with a skeleton."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="File to write; its ending, such as .bvh, is its format.")
    ] = None,
    lock_feet: Annotated[
        bool, typer.Option("--lock-feet", help="Keep feet in place while they are on the ground.")
    ] = False,
    ground: Annotated[
        str, typer.Option(help="flat, kerb:HEIGHT@DISTANCE or ramp:HEIGHT/LENGTH@DISTANCE in m.")
    ] = "flat",
    joint_map: Annotated[
        Path | None, typer.Option(help="JSON: body joint to clip joint; else matched by name.")
    ] = None,
    skeleton: Annotated[
        Path | None, typer.Option(help="ASF of an AMC; else the one in the same folder.")
    ] = None,
    unit: Annotated[float | None, typer.Option(help="Metres per unit of the clip.")] = None,
    up: Annotated[str | None, typer.Option(help="Upward axis of the clip: x, y or z.")] = None,
    check: Annotated[
        str | None, typer.Option(help="table1: recompute the paper's Table 1 instead.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Retarget a capture to an avatar of any size, and measure its steps."""
    if check is not None:
        _check(check, as_json=as_json)
        return
    if clip is None or to is None:
        fail("a clip and --to are needed, as in: ./run retarget walk.bvh --to 165cm")
    from app.cli.retarget import output as texts
    from app.cli.retarget.run import RetargetOrder, carry_out

    order = RetargetOrder(
        clip=clip,
        to=to,
        out=out,
        ground=ground,
        lock_feet=lock_feet,
        joint_map=joint_map,
        skeleton=skeleton,
        unit=unit,
        up=up,
    )
    with reported(ValueError, OSError):
        done = carry_out(order)
    print(json.dumps(texts.as_json(done)) if as_json else texts.as_text(done))


def _check(what: str, *, as_json: bool) -> None:
    """Recompute a published table and print it."""
    if what != "table1":
        fail(f"--check {what!r}: table1 is valid")
    from app.cli.retarget import output as texts
    from app.science.retargeting import check_table1

    rows = check_table1()
    print(json.dumps(texts.table1_json(rows)) if as_json else texts.table1_text(rows))
