"""Seeing to it that the database can be worked with before anything works with it.

wal          whether SQLite's log lost transactions that had been committed
inspection   what is wrong with a SQLite file
beginning    making a new database whole or not at all
quarantine   putting a damaged database away, never deleting it
service      what happens at every start: inspect, put away, back up, migrate
"""
