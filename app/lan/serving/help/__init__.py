"""The page that helps a device to trust the lab's authority, and its words."""
