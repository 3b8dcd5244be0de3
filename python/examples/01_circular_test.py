"""The circular test of the thesis on the simulated rig, diagnosed and compared: what `make demo` does."""

import hexdbb as hx

record = hx.measure("thesis", "demo.parquet")
found = hx.diagnose(record, hx.new_model(record.machine))
print(found)
print(hx.compare(record, found.model))
hx.save_model(found.model, "demo-model.toml")
