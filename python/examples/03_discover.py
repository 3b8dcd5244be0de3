"""Find out what a model lacks, add it, look again until nothing is missing. Usage: 03_discover.py RECORD."""

import sys

from hexdbb.diagnosis import diagnose
from hexdbb.discovery import discover
from hexdbb.ledger import add_effect, history
from hexdbb.model import new_model
from hexdbb.record import read_record

record = read_record(sys.argv[1])
model = diagnose([record], new_model(record.machine)).model
found = discover([record], model)
while found.verdict == "effect" and found.best is not None:
    print(found.sentence)
    model, _ = add_effect([record], model, found.best.choice)
    found = discover([record], model)
print(found.sentence, history(model).text, sep="\n")
