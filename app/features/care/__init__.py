"""Protect the record: opening the database, backups, storage, network, participants' rights."""
