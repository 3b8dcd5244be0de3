"""Readings of other programs as records: delimited text, Excel sheets, Renishaw tests.

Model: a file's cells (`text`, `excel`) hold one table (`table`), whose headings name quantities and units (`columns`,
`quantities`); what they and a mapping (`mapping`) do not say follows from the plan that was driven (`setting`). The
series of readings (`tabular`, `b5r`) becomes samples (`sweeps`). Nothing is converted or left out without being said;
what is not stated and cannot be seen is asked for.
"""

from hexdbb.importing.mapping import Mapping, load_mapping, mapping_of, save_mapping
from hexdbb.importing.reader import read_measured, read_record

__all__ = ["Mapping", "load_mapping", "mapping_of", "read_measured", "read_record", "save_mapping"]
