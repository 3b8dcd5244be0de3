#!/usr/bin/env bash
# The main jobs of hexdbb, from an empty folder, on the simulated rig: the circle of the thesis measured, diagnosed and
# compared; then a machine with a fault that the model does not have: detected, identified, added. Ends at the first step
# that fails. Expects the commands of the virtual environment on the PATH (`make demo` sets it).
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

# A machine with random geometric errors, and one fault that is not in the model.
hidden_machine() {
  run hexdbb rig --seed 11 --write-truth demo/hidden.toml --no-serve
  printf '$ cat >> demo/hidden.toml\n'
  tee -a demo/hidden.toml <<'TOML'

[[mechanism]]
kind = "backlash"
slider = 4
width_um = 15.0
TOML
}

say "One level circle: measure, diagnose, compare"
run hexdbb-run --plan thesis -o demo/demo.parquet
run hexdbb diagnose demo/demo.parquet -m demo/demo-model.toml
run hexdbb compare demo/demo.parquet -m demo/demo-model.toml

say "A machine with a hidden fault: slider 4 has 15 µm of play between drive and slider"
hidden_machine
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

printf '\nResults are in demo/:\n'
ls -1 demo | sed 's/^/  /'
cat <<'TEXT'
By hand, into files of your own:
  . .venv/bin/activate
  hexdbb-run --plan standard --rate 20 --truth demo/hidden.toml -o my.parquet
  hexdbb diagnose my.parquet -m my-model.toml
  hexdbb compare my.parquet -m my-model.toml
  hexdbb discover my.parquet -m my-model.toml
TEXT
