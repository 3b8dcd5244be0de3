"""Diagnose a record of one's own, Parquet or text form. Usage: 02_own_record.py RECORD."""

import sys

import hexdbb as hx

record = hx.read_record(sys.argv[1])
print(f"{record.name}: {len(record)} samples, readings {1e3 * record.reading_mm.std():.1f} µm about their mean")
found = hx.diagnose(record, hx.new_model(record.machine))
print(f"reading error {found.rms_before_um:.2f} µm -> {found.rms_after_um:.2f} µm")
for parameter, value, sigma in zip(found.model.parameters(), found.model.values, found.model.sigma, strict=True):
    if sigma == sigma:  # what is known only in combination with others has no uncertainty of its own
        print(f"{parameter.label}: {value:.6f} ± {sigma:.6f} {parameter.unit}")
print(*found.unidentifiable, sep="\n")
