"""What participants may ask for afterwards: a copy, a correction, and that their data go.

traces       what of a session is about the person, and removing it
erasing      one erasure, in one transaction
overwriting  the bytes that the database itself would leave behind
tombstones   the list of erasures beside the database, which outlives a restored backup
again        making erasures again in a database that does not know of them
copies       exports, access copies and backups that left the database
corrections  later values of answers, with their reasons
people       the participants of a study
access       a person's own copy, as a page to read and as data
service      what others use
"""
