"""Run `reembody pilot power`: the study's files, and the options of the command."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from app.cli.errors import require_folder_of
from app.cli.pilot.inputs import read_assumptions, read_study, require_sharing
from app.cli.pilot.output import told
from app.features.results.pilot.simulation import Curve, PowerOrder, Sharing, simulate_power


@dataclass(frozen=True)
class PowerOptions:
    """The options of `pilot power`."""

    study: str
    assumptions: Path | None
    order: PowerOrder
    sharing: Sharing
    out: Path | None


def carry_out_power(options: PowerOptions, now: Callable[[str], None]) -> Curve:
    """Compute a power curve; `now` is told what is being done.

    Raises ValueError if the input does not allow it, OSError if the record cannot be written.
    """
    require_sharing(options.sharing, options.out)
    if not 0.0 < options.order.target < 1.0:
        raise ValueError(
            f"--target {options.order.target:g}: give a power between 0 and 1, as in 0.8"
        )
    require_folder_of(options.out)
    file = read_study(options.study)
    return simulate_power(
        file,
        read_assumptions(options.assumptions, file),
        options.order,
        told(file.study.protocol.key, now),
        record=options.out,
        sharing=options.sharing,
    )
