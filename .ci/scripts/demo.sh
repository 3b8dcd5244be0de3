#!/usr/bin/env bash
# The main jobs of hexdbb, from an empty folder, on the simulated rig: the circle of the thesis measured, diagnosed and
# compared; then a machine with a fault that the model does not have: detected, identified, added; then one with a fault
# that nobody has a formula for: learned from the readings. Ends at the first step that fails. Expects the commands of the virtual environment on the PATH (`make demo` sets it).
set -euo pipefail

rm -rf demo
mkdir demo

say() {
  printf '\n== %s\n' "$*"
}

run() {
  printf '\n$ %s\n' "$*"
  "$@"
}

# A machine with random geometric errors, and the fault on stdin, which is not in the model: FILE.
machine_with() {
  run hexdbb rig --seed 11 --write-truth "$1" --no-serve
  printf '$ cat >> %s\n' "$1"
  tee -a "$1"
}

say "One level circle: measure, diagnose, compare"
run hexdbb-run --plan thesis -o demo/demo.parquet
run hexdbb diagnose demo/demo.parquet -m demo/demo-model.toml
run hexdbb compare demo/demo.parquet -m demo/demo-model.toml

say "A machine with a hidden fault: slider 4 has 15 µm of play between drive and slider"
machine_with demo/hidden.toml <<'TOML'

[[mechanism]]
kind = "backlash"
slider = 4
width_um = 15.0
TOML
run hexdbb-run --plan standard --rate 20 --truth demo/hidden.toml -o demo/today.parquet

say "Geometry alone does not explain the readings"
run hexdbb diagnose demo/today.parquet -m demo/model.toml
run hexdbb compare demo/today.parquet -m demo/model.toml --plot demo/before

say "What is missing?"
run hexdbb discover demo/today.parquet -m demo/model.toml
run hexdbb add backlash:4 -m demo/model.toml demo/today.parquet

say "Is anything still missing?"
run hexdbb discover demo/today.parquet -m demo/model.toml
run hexdbb compare demo/today.parquet -m demo/model.toml --plot demo/after
run hexdbb history -m demo/model.toml
run hexdbb report demo/today.parquet -m demo/model.toml -o demo/report.html --tolerance "G(b)=80"

say "A fault that no formula knows: guideway 1 has a dent, 30 µm deep"
machine_with demo/dent.toml <<'TOML'

[[mechanism]]
kind = "dent"
guideway = 1
depth_um = 30.0
at_mm = 250.0
width_mm = 10.0
TOML
run hexdbb-run --plan standard --rate 20 --truth demo/dent.toml -o demo/dented.parquet
run hexdbb diagnose demo/dented.parquet -m demo/dent-model.toml

say "No known effect is the cause: its function is learned, added, and nothing is missing"
run hexdbb discover demo/dented.parquet -m demo/dent-model.toml --plot demo/dent
run hexdbb add learned:vertical:1:fine_position -m demo/dent-model.toml demo/dented.parquet
run hexdbb discover demo/dented.parquet -m demo/dent-model.toml
run hexdbb compensate demo/dent-model.toml -o demo/dent.hexcomp

printf '\nResults are in demo/:\n'
ls -1 demo | sed 's/^/  /'
cat <<'TEXT'
By hand, into files of your own:
  . .venv/bin/activate
  hexdbb-run --plan standard --rate 20 --truth demo/hidden.toml -o my.parquet
  hexdbb diagnose my.parquet -m my-model.toml
  hexdbb compare my.parquet -m my-model.toml
  hexdbb discover my.parquet -m my-model.toml
In the browser:
  hexdbb workbench demo/today.parquet -m demo/model.toml
TEXT
