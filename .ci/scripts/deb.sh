#!/usr/bin/env bash
# deb.sh
# Packages of Debian into dist/: libhexdbb-dev, and linuxcnc-hexdbb where LinuxCNC's headers are; each is unpacked into an
# empty folder, and programs in C and C++ are compiled against it and run.
set -euo pipefail
cd "$(dirname "$0")/../.."
step=.ci/scripts/step.sh

# CMAKE_INCLUDE_PATH names headers that lie elsewhere.
linuxcnc=OFF
for folder in /usr/include ${CMAKE_INCLUDE_PATH:-}; do
  [ -e "$folder/linuxcnc/kinematics.h" ] && linuxcnc=ON
done
[ $linuxcnc = ON ] || echo "note: linuxcnc-uspace-dev is not installed: LinuxCNC's module is packaged as source alone"

cmake_dir=build/deb
made=build/packages
rm -rf $made
$step "Configure the packages" cmake --preset deb -D HEXDBB_LINUXCNC=$linuxcnc
$step "Compile the packages" cmake --build $cmake_dir
$step "Packages of Debian" cpack --config $cmake_dir/CPackConfig.cmake -B $made
$step "Programs against the packages" .ci/scripts/check_deb.sh $made build/packages-check
mkdir -p dist
mv $made/*.deb dist/
ls -l dist/*.deb
