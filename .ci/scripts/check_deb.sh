#!/usr/bin/env bash
# check_deb.sh PACKAGES WORK
# Unpack the packages of a folder into WORK, then compile and run what an outside project does, by CMake and by pkg-config;
# compile LinuxCNC's module from its packaged source, where its headers are.
set -euo pipefail
cd "$(dirname "$0")/../.."
packages=$1
rm -rf "$2"
mkdir -p "$2"
work=$(cd "$2" && pwd)
root=$work/root
outside=$PWD/tests/embed/outside

for package in "$packages"/*.deb; do
  dpkg-deb --info "$package"
  dpkg-deb --extract "$package" "$root"
done
version=$(sed -n 's/^version = "\(.*\)"$/\1/p' pyproject.toml)

cmake -S "$outside" -B "$work/outside" -D CMAKE_PREFIX_PATH="$root/usr" -D HEXDBB_WANTED="$version"
cmake --build "$work/outside"
"$work/outside/controller" "$work/outside/sp120.hexcomp"
"$work/outside/workshop"
"$work/outside/firmware" | tee "$work/by-cmake"

export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find "$root" -name hexdbb.pc)")
# shellcheck disable=SC2046  # words
cc -std=c11 -I"$work/outside" "$outside/firmware.c" $(pkg-config --cflags --libs hexdbb) -o "$work/firmware"
"$work/firmware" > "$work/by-pkg-config"
cmp "$work/by-cmake" "$work/by-pkg-config"

source=$root/usr/share/hexdbb/linuxcnc
if cmake -S "$source" -B "$work/linuxcnc" -D CMAKE_PREFIX_PATH="$root/usr" > "$work/linuxcnc.log" 2>&1; then
  cmake --build "$work/linuxcnc"
  nm --dynamic --defined-only "$work/linuxcnc/hexdbb_kins.so" | grep -q rtapi_app_main
else
  cat "$work/linuxcnc.log"
  grep -q LINUXCNC_INCLUDE_DIR "$work/linuxcnc.log"
fi
