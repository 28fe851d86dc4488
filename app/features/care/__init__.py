"""What keeps the record safe: backups, storage, opening the database, network, rights."""
