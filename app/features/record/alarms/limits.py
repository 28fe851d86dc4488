"""From where on something is an alarm."""

from dataclasses import dataclass, replace

from app.science.stream_quality import USUAL, QualityLimits


@dataclass(frozen=True)
class WatchLimits:
    """What the watch of a headset tolerates. Seconds are real ones unless they say `client`.

    `silent_s`: no frame while frames are wanted. `clock_unknown_s`: no usable reading of the
    clocks. `clock_uncertain_s`: half of the smallest round trip within `clock_window_s`.
    `backlog_s`: movement that is not on disk yet. `low_rate_share` of the usual frame rate, over
    `low_rate_client_s`: 72 of 90 Hz is a rate that displays have, so a little less than that.
    `gap_client_s`: shorter gaps are counted, and raise nothing. `clear_after_s`: an alarm is
    cleared after so long without its cause. `look_every_s`: how often the watch looks up.
    """

    silent_s: float = 3.0
    clock_unknown_s: float = 15.0
    clock_uncertain_s: float = 0.010
    clock_window_s: float = 60.0
    backlog_s: float = 10.0
    low_rate_share: float = 0.79
    low_rate_client_s: float = 3.0
    gap_client_s: float = 0.25
    clear_after_s: float = 3.0
    look_every_s: float = 0.5
    quality: QualityLimits = USUAL

    def at_scale(self, time_scale: float) -> "WatchLimits":
        """For a simulated session in which `time_scale` seconds of the client pass in a real one.

        A client that runs faster than life waits for the server and shares its machine: it owes
        nobody a steady stream, so it may be silent ten times as long. With one that runs slower,
        what is judged by the second of its clock comes more rarely.
        """
        if time_scale > 1.0:
            return replace(self, silent_s=10.0 * self.silent_s)
        return replace(self, clear_after_s=self.clear_after_s / time_scale)
