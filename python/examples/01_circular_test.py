"""The circular test of the thesis on the simulated rig, diagnosed and compared: what `make demo` does."""

from pathlib import Path

from hexdbb.capture import Lockstep, Request, measure, open_bus, prepare, simulated_rig
from hexdbb.compare import compare
from hexdbb.diagnosis import diagnose
from hexdbb.model import new_model, save_model
from hexdbb.plan import load_plan
from hexdbb.plots import comparison_pages, save_figure
from hexdbb.samples import Samples

plan = load_plan("thesis")
machine = plan.machine_file()
request = Request(plan, machine, "thesis", machine.can_setup.cycle_s, Path("demo.parquet"))
with simulated_rig([]) as address, open_bus(address, machine.can_setup.bitrate_bit_s) as bus:
    record = measure(request, prepare(request), bus, Lockstep())
samples = Samples.of([record])
found = diagnose(samples, new_model(machine))
save_model(found.model, "demo-model.toml")
comparison = compare(samples, found.model)
save_figure(comparison_pages(comparison)[0].draw(), Path("demo-compare"))
print(f"reading error {found.rms_before_um:.0f} µm -> {1e3 * comparison.rms_mm:.2f} µm, rank {found.rank} of 33")
