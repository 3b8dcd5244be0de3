#!/usr/bin/env bash
# Check and install what pip cannot: a recent Python, the compiler and the C++ libraries of the engine. Missing packages
# are installed with apt on Debian and Ubuntu; elsewhere the list of packages is printed and the build goes on.
# HEXDBB_LINUXCNC=ON adds LinuxCNC, which Debian has from version 12; HEXDBB_DEB=ON what makes packages of Debian.
set -euo pipefail

python=${PYTHON:-python3}
if ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
  found=$("$python" --version 2>/dev/null || echo missing)
  echo "error: $python is $found (expected Python 3.11 or newer; name another one with: make PYTHON=python3.12 ...)" >&2
  exit 2
fi

packages=(g++ ccache cmake ninja-build libeigen3-dev libceres-dev libgtest-dev libbenchmark-dev)
# Reports on paper: WeasyPrint draws with Pango.
packages+=(libpango-1.0-0 libpangoft2-1.0-0 fonts-liberation)
# The browser that the tests of pages drive. Ubuntu has it as a snap only: the tests are skipped there without one.
if grep -qx 'ID=debian' /etc/os-release 2>/dev/null; then
  packages+=(chromium)
fi
# The Python of the distribution has `venv` and its headers in separate packages; any other Python includes them.
if [ "$("$python" -c 'import sys; print(sys.base_prefix)')" = /usr ]; then
  version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  packages+=("python$version-venv" "python$version-dev")
fi

if [ "${HEXDBB_LINUXCNC:-OFF}" = ON ]; then
  packages+=(linuxcnc-uspace linuxcnc-uspace-dev pkg-config)
fi

if [ "${HEXDBB_DEB:-OFF}" = ON ]; then
  packages+=(dpkg-dev file pkg-config)
fi

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "note: not Debian or Ubuntu; assuming that these are installed: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "error: neither root nor sudo, and these packages are missing: ${missing[*]} (install them, then repeat)" >&2
    exit 1
  fi
  echo "==> apt needs administrator rights to install: ${missing[*]}"
  sudo -v
  as_root=(sudo)
fi
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300)
.ci/scripts/step.sh "Package lists of the distribution" "${apt[@]}" update
.ci/scripts/step.sh "System packages: ${missing[*]}" "${apt[@]}" install --yes --no-install-recommends "${missing[@]}"
