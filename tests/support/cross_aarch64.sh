#!/bin/sh
# cross_aarch64.sh ROOT: builds for aarch64 into build/aarch64 and runs some of the tests in an emulator. The libraries of
# that processor are unpacked beside the build; the machine's own package lists stay as they are.
set -eu
root=$1
build=$root/build/aarch64
sysroot=$build/sysroot

if [ ! -f "$sysroot/complete" ]; then
  apt=$build/apt
  rm -rf "$sysroot"
  mkdir -p "$sysroot" "$apt/lists/partial" "$apt/archives/partial"
  : >"$apt/status"
  arm64() {
    apt-get -qq -o Dir::State="$apt" -o Dir::State::status="$apt/status" -o Dir::Cache="$apt" \
      -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User="" "$@"
  }
  arm64 update
  (cd "$apt" && arm64 download libtbb12 libtbbmalloc2 libtbbbind-2-5 libtbb-dev libfftw3-double3 libfftw3-single3 \
    libfftw3-long3 libfftw3-dev libgtest-dev)
  for package in "$apt"/*.deb; do
    dpkg-deb -x "$package" "$sysroot"
  done
  ln -s /usr/include/xsimd "$sysroot/usr/include/xsimd" # headers that fit any processor
  : >"$sysroot/complete"
fi

if [ ! -f "$build/build.ninja" ]; then
  cmake -S "$root" -B "$build" -G Ninja -D CMAKE_TOOLCHAIN_FILE="$root/tests/support/aarch64.cmake" \
    -D SYSROOT="$sysroot" -D BRINELL_CLI=OFF -D BRINELL_BENCH=OFF -D Eigen3_DIR=/usr/share/eigen3/cmake
fi
ninja -C "$build" brinell base_test simd_test parallel_test surface_test press_sphere
cd "$build"
ctest --output-on-failure -R '^(base|simd|parallel|surface|example_press_sphere)$'
