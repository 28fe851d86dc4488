"""Map a client's monotonic clock to the server's clock, with an error bound for every moment.

Clients timestamp everything with their own clock and exchange clock probes with the server.
`fit_clock` maps client times to server times:

1. each probe bounds the clock offset from above and below, however the round trip is divided
   between the two directions (`probes`);
2. all straight lines between the bounds of a window of a few minutes form a polygon that is known
   exactly; at any moment, the values of these lines bound the true offset (`band`);
3. where no line fits, either a clock jumped or a single probe is wrong (`windows`);
4. the line that is reported is fitted mainly to the probes with the shortest round trips (`band`);
5. windows without a jump between them are joined to one continuous curve of the offset (`stretch`),
   and the stretches are placed on one timeline of the server (`placing`);
6. the mapping never decreases, and states its uncertainty at every moment (`mapping`).

The bound also holds on asymmetric network paths, provided that the clocks stay within
`ClockLimits`.
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
