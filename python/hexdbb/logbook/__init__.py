"""Logbook: one folder a machine; its records, models, verdicts and compensation files over the years."""

from hexdbb.logbook.check import Finding, check
from hexdbb.logbook.folder import SHORT, Added, Logbook
from hexdbb.logbook.index import Entry
from hexdbb.logbook.kinds import FOLDERS, Content, content_of

__all__ = ["FOLDERS", "SHORT", "Added", "Content", "Entry", "Finding", "Logbook", "check", "content_of"]
