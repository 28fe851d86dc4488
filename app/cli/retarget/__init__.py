"""`reembody retarget`: a capture onto an avatar."""
