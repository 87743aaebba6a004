#!/bin/sh
# Installs the Debian 12 packages that are missing, as root or with sudo:
#   sh tests/install.sh         what the release preset builds with, which is all that driver/demo.sh needs
#   sh tests/install.sh tests   also the programs that the tests hand our files to (tests/run.sh)
#   sh tests/install.sh bench   what bench/report.sh compares with, beside what it builds with
#   sh tests/install.sh all     also the presets clang and tsan, and tests/tidy.sh
# Where nothing is missing, it uses no network and no privileges.
set -eu

# The build, then the library, the driver, the tests, the benchmarks. lib2geom's headers include
# Boost's, but its package does not ask for them.
packages="
  cmake ninja-build g++ pkg-config
  libxsimd-dev libeigen3-dev
  libopenimageio-dev openimageio-tools libpugixml-dev libtomlplusplus-dev libcli11-dev
  nlohmann-json3-dev lib2geom-dev libboost-dev libcairo2-dev librsvg2-bin
  libgtest-dev
  libbenchmark-dev"
case ${1:-} in
  bench)
    packages="$packages libsuitesparse-dev libmumps-seq-dev libmumps-headers-dev libopenblas-pthread-dev
      libpetsc-real-dev libcgal-dev libopencv-shape-dev libopencv-imgproc-dev libvips-dev"
    ;;
  tests | all)
    packages="$packages chromium-headless-shell imagemagick libvips-tools libopencv-imgproc-dev"
    ;;
esac
if [ "${1:-}" = all ]; then
  packages="$packages clang-14 libomp-14-dev clang-format-14 clang-tidy-14"
fi

missing=
for package in $packages; do
  case $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) in
    installed) ;;
    *) missing="$missing $package" ;;
  esac
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || {
    echo "tests/install.sh: needs root or sudo to install$missing" >&2
    exit 1
  }
  as_root=sudo
fi
apt_install() {
  # $missing is a list of words.
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
}
echo "Installing$missing"
# A fresh system has no package lists, an old one such that the mirrors no longer follow.
update() {
  $as_root apt-get update -q
}
apt-cache show $missing >/dev/null 2>&1 || update
apt_install || { update && apt_install; }
