"""From a client's monotonic clock to the server's, with a bound for every moment.

Clients stamp everything with their own clock and exchange probes with the server. `fit_clock` maps
the one on the other:

1. each probe bounds the offset from both sides, whatever the two ways took (`probes`);
2. all lines between the bounds of a window of minutes are a polygon that is known exactly: what
   any of them says of a moment bounds the truth (`band`);
3. where no line is left a clock jumped, or a single probe is wrong (`windows`);
4. the line that is told is fitted to the probes with the shortest round trips (`band`);
5. windows without a jump between them join to one unbroken course (`stretch`), and these are put on
   one time line of the server (`placing`);
6. the mapping never falls and says how far it can be off (`mapping`).

The bound holds on asymmetric paths too, as long as the clocks keep to `ClockLimits`.
"""

from app.science.clock.fit import fit_clock
from app.science.clock.mapping import ClockMapping
from app.science.clock.probes import ClockError, ClockLimits, ClockProbes

__all__ = [
    "ClockError",
    "ClockLimits",
    "ClockMapping",
    "ClockProbes",
    "fit_clock",
]
