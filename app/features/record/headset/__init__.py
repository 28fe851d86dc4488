"""The headset: its state, its socket."""
