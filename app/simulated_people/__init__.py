"""Simulated people: a body, an avatar, and the task phases of a visit, without a server.

A rehearsal lets them take part in a session of a server, a pilot lets a cohort of them do the tasks
of a study. Modules are imported by name, because most of them load the physics.
"""
