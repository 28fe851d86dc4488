"""The help page for devices to trust the lab's authority, and its texts."""
