#!/usr/bin/env bash
# third_party.sh PREFIX
# Build what the wheel carries into PREFIX: a static Ceres without what the engine never calls (sparse solvers, LAPACK,
# CUDA, Schur complements of fixed sizes, covariances, gflags; glog is Ceres' own replacement), and the headers of Eigen
# where the system has none. Sources are those of Debian 12, held to their checksums: the versions that an engine built on
# that system has, hence the same numbers. What is there already is not done again. HEXDBB_DEBIAN names another mirror.
set -euo pipefail

prefix=$(mkdir -p "$1" && cd "$1" && pwd)
work=$prefix/work
downloads=$prefix/downloads
debian=${HEXDBB_DEBIAN:-http://deb.debian.org/debian}
keyring=/usr/share/keyrings/debian-archive-keyring.gpg

checksum() {  # FILE, in every system's way
  if command -v sha256sum >/dev/null; then sha256sum "$1"; else shasum -a 256 "$1"; fi | cut -d ' ' -f 1
}

# By apt where Debian's keys are, with lists of its own: the system's sources need not name source packages.
by_apt() {  # PACKAGE=VERSION
  local apt=$work/apt
  mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial"
  printf 'deb-src [signed-by=%s] %s bookworm main\n' "$keyring" "$debian" > "$apt/sources.list"
  local options=(-o "Dir::State=$apt/state" -o "Dir::Cache=$apt/cache" -o "Dir::Etc::sourcelist=$apt/sources.list")
  options+=(-o Dir::Etc::sourceparts=/nonexistent -o Acquire::Languages=none -o APT::Sandbox::User= -o Dpkg::Use-Pty=0)
  [ -e "$apt/updated" ] || apt-get "${options[@]}" update
  touch "$apt/updated"
  (cd "$downloads" && apt-get "${options[@]}" --only-source --download-only source "$1")
}

# PACKAGE VERSION FILE SHA256: the file in $downloads.
source_of() {
  local file=$downloads/$3
  if [ ! -e "$file" ]; then
    mkdir -p "$downloads"
    if command -v apt-get >/dev/null && [ -e "$keyring" ]; then
      by_apt "$1=$2"
    else
      curl --fail --location --silent --show-error --retry 3 --output "$file" "$debian/pool/main/${1:0:1}/$1/$3"
    fi
  fi
  local found
  found=$(checksum "$file")
  if [ "$found" != "$4" ]; then
    echo "error: $file: SHA-256 $found (expected $4; remove the file to fetch it again)" >&2
    exit 1
  fi
}

# NAME FILE: the source's folder, $work/NAME.
unpacked() {
  rm -rf "${work:?}/$1"
  mkdir -p "$work/$1"
  tar -xf "$downloads/$2" -C "$work/$1" --strip-components=1
}

# NAME OPTION...: configured, compiled, installed into PREFIX.
installed() {
  local folder=$work/$1
  shift
  cmake -S "$folder" -B "$folder/build" -D CMAKE_BUILD_TYPE=Release -D CMAKE_INSTALL_PREFIX="$prefix" \
    -D CMAKE_INSTALL_LIBDIR=lib -D CMAKE_PREFIX_PATH="$prefix" -D BUILD_TESTING=OFF "$@"
  cmake --build "$folder/build" --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-2}"
  cmake --install "$folder/build"
}

# Made by this script, from these sources: another one builds anew.
made_by=$(checksum "${BASH_SOURCE[0]}")
if [ "$(cat "$prefix/made-by" 2>/dev/null)" = "$made_by" ]; then
  exit 0
fi

if ! grep -qs 'EIGEN_MAJOR_VERSION 4' /usr/include/eigen3/Eigen/src/Core/util/Macros.h; then
  eigen=eigen3_3.4.0.orig.tar.bz2
  source_of eigen3 3.4.0-4 $eigen b4c198460eba6f28d34894e3a5710998818515104d6e74e5cc331ce31e46e626
  unpacked eigen $eigen
  installed eigen -D EIGEN_BUILD_DOC=OFF -D EIGEN_BUILD_PKGCONFIG=OFF
fi

ceres=ceres-solver_2.1.0+really2.1.0+dfsg.orig.tar.xz
source_of ceres-solver 2.1.0+really2.1.0+dfsg-1 $ceres acd5774187a8ea92bdf9e6d1faeb22c00bf30b1ad226ef6e2ade8b7636bbc336
unpacked ceres $ceres
# Ceres' covariances have no option of their own, and take longer to compile than any other source of it.
sed -i.orig '/^ *covariance\(_impl\)\{0,1\}\.cc$/d' "$work/ceres/internal/ceres/CMakeLists.txt"
installed ceres -D BUILD_SHARED_LIBS=OFF -D CMAKE_POSITION_INDEPENDENT_CODE=ON \
  -D CMAKE_CXX_FLAGS="-ffunction-sections -fdata-sections -fvisibility=hidden" \
  -D MINIGLOG=ON -D GFLAGS=OFF -D SUITESPARSE=OFF -D CXSPARSE=OFF -D EIGENSPARSE=OFF -D LAPACK=OFF -D CUDA=OFF \
  -D SCHUR_SPECIALIZATIONS=OFF -D BUILD_EXAMPLES=OFF -D BUILD_BENCHMARKS=OFF -D PROVIDE_UNINSTALL_TARGET=OFF
echo "$made_by" > "$prefix/made-by"
