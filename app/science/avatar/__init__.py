"""The avatars: bodies that follow the participant's, driven by motors.

Each folder is a face of its own, so that importing one loads what it needs and no more. From the
bottom: `body`, `configuration`, `mjcf`, `targets`, `ik`, `simulation`, `tuning`.
"""
