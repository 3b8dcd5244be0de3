"""From a record to a diagnosis and a comparison. Usage: 01_diagnose.py RECORD."""

import sys

from hexdbb.compare import compare
from hexdbb.diagnosis import diagnose
from hexdbb.model import new_model
from hexdbb.prediction import predict_reading_mm
from hexdbb.record import read_record

record = read_record(sys.argv[1])
found = diagnose([record], new_model(record.machine))
print(f"{found.rms_before_um:.2f} um -> {found.rms_after_um:.2f} um, rank {found.rank}")
comparison = compare([record], [predict_reading_mm(record, found.model)])
print(f"worst: {comparison.worst[0].where}, {comparison.worst[0].rms_mm * 1e3:.2f} um")
