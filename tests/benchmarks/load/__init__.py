"""A load of many headsets and consoles on the real server, with measurements."""
