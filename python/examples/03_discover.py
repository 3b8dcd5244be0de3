"""Find what a model lacks, add it, look again until nothing is missing. Usage: 03_discover.py RECORD."""

import sys

import hexdbb as hx

record = hx.read_record(sys.argv[1])
model = hx.diagnose(record, hx.new_model(record.machine)).model
found = hx.discover(record, model)
while found.verdict == "effect" and found.best is not None:
    print(found.sentence)
    model = hx.add_effect(record, model, found.best.choice).model
    found = hx.discover(record, model)
print(found.sentence, hx.history(model).text, sep="\n")
