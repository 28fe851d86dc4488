"""The scientific code of Reembody: functions on arrays that return frozen results.

Nothing in here knows about the web, the database or the settings.
"""
