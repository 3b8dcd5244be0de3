#!/usr/bin/env bash
# The main job of hexdbb, from an empty folder: measure on the simulated rig, diagnose, compare.
# Expects the commands of the virtual environment on the PATH (`make demo` sees to it).
set -euo pipefail

rm -rf demo
mkdir demo

run() {
  printf '\n$ %s\n' "$*"
  "$@"
}

run hexdbb-run --plan thesis -o demo/demo.parquet
run hexdbb diagnose demo/demo.parquet -m demo/demo-model.toml
run hexdbb compare demo/demo.parquet -m demo/demo-model.toml

echo
echo "Results are in demo/:"
ls -1 demo | sed 's/^/  /'
cat <<'TEXT'
By hand, into files of your own:
  . .venv/bin/activate
  hexdbb-run --plan thesis -o my.parquet
  hexdbb diagnose my.parquet -m my-model.toml
  hexdbb compare my.parquet -m my-model.toml
TEXT
