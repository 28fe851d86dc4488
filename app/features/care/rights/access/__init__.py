"""A participant's own copy: a page to read, and everything as data.

words    the fixed texts of the page, in each language
summary  the content of the page, from the record
page     the page as HTML, with answers as the participant saw them
archive  the page and the data as one ZIP
"""
