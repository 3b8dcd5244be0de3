#!/usr/bin/env bash
# step.sh TITLE COMMAND...
# Run a command under one title. Its output goes to build/logs; while it runs the last line is shown as progress; if it
# fails the whole output is printed and its exit status returned.
set -uo pipefail

title=$1
shift
mkdir -p build/logs
log=build/logs/$(tr -cs 'A-Za-z0-9\n' '-' <<<"$title" | sed 's/-$//').log

last_line() { tail -n 1 "$log" | tr -d '\r' | cut -c 1-90; }

if [ -t 1 ]; then
  period_s=1
  show() { printf '\r\033[K    %3d s  %s' "$SECONDS" "$(last_line)"; }
  wipe() { printf '\r\033[K'; }
else
  period_s=15
  show() { printf '    %3d s  %s\n' "$SECONDS" "$(last_line)"; }
  wipe() { :; }
fi

echo "==> $title"
SECONDS=0
"$@" >"$log" 2>&1 </dev/null &
job=$!
trap 'kill "$job" 2>/dev/null; exit 130' INT TERM
next_s=$period_s
while kill -0 "$job" 2>/dev/null; do
  sleep 0.1
  if [ "$SECONDS" -ge "$next_s" ]; then
    show
    next_s=$((SECONDS + period_s))
  fi
done
wipe
wait "$job"
status=$?
if [ "$status" -ne 0 ]; then
  cat "$log"
  echo "error: $title failed after $SECONDS s (exit status $status); its output is above and in $log" >&2
fi
exit "$status"
