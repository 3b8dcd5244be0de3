"""Find out what a model lacks, add it, look again until nothing is missing. Usage: 03_discover.py RECORD."""

import sys

from hexdbb.discovery import discover
from hexdbb.ledger import add_effect, fit_model, history
from hexdbb.model import new_model
from hexdbb.record import read_record
from hexdbb.samples import Samples

samples = Samples.of([read_record(sys.argv[1])])
model = fit_model(samples, new_model(samples.machine)).model
found = discover(samples, model)
while found.verdict == "effect" and found.best is not None:
    print(found.sentence)
    model = add_effect(samples, model, found.best.choice).model
    found = discover(samples, model)
print(found.sentence, history(model).text, sep="\n")
