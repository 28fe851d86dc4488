"""A participant's own copy: a page to read, and everything as data.

words    what the page says around the answers, in each language
answers  an answer as the participant saw it
summary  what the page holds
page     the page as HTML
archive  the page and the data as one ZIP
"""
