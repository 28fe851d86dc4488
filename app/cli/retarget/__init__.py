"""The command `reembody retarget`: transfer a capture to an avatar."""
