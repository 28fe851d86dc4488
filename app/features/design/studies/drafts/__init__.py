"""Drafts: study files that are checked and changed before they are stored."""
